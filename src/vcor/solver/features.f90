!> Which method solves what: one table of methods and of the features of impacts
!>
!> `auto`, the refusals of settings and of cases, the reasons why keys are not read and the table of
!> docs/which_model.md follow from it. An impact and its settings have some of `features`. A row of
!> `refusals` says which methods, or which other features, exclude one of them; what no row excludes
!> is solved. A row of `unread` says which keys a method does not read, and a row of `own_rules`
!> which value of a key is a method's own.
!>
!> A new method needs its row in `method_table`, its name in `method_choices` and `refusals` of what
!> it does not solve. A new feature needs a row in `features`, its exclusions in `refusals`, a line
!> in `features_of` of `vcor_solver_type`, which sees it in an impact, and one in `features_of_case`
!> of `vcor_case_mechanics`, which sees it in the keys of a case.
module vcor_solver_features
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_words, only : contains_word
   implicit none
   private

   public :: method_t, method_table, method_choices, methods
   public :: feature_t, features, solves, refuse_features, method_for, method_in_use
   public :: unread_t, unread, why_unread, own_rule_t, own_rules, refusal_t, refusals, reads
   public :: ive, direct, paper, coupled, of_body, of_thin_plate, of_hereditary_plate, &
      of_frozen_plate, of_layer, of_viscosity, of_boltzmann, of_receding, of_eq1, of_gravity, &
      of_second_term, of_ghost, of_paper_scheme, of_structure, of_relaxing_plate, of_bounces

   !> A method
   type :: method_t
      !> Its name: the schemes product and adams_bashforth of method direct are direct and paper
      character(len=7) :: name = ''
      !> What it does, in words
      character(len=64) :: meaning = ''
      !> Keys and values that ask for it, as in a case
      character(len=64) :: keys = ''
      !> Accuracy of the coefficient of restitution if none is requested [-]
      real(wp) :: accuracy = 0.0_wp
   end type method_t

   !> The methods
   type(method_t), parameter :: method_table(*) = [ &
      method_t('ive', 'internal variables of a sum of exponentials, by collocation', &
      "method = 'ive'", 1.0e-8_wp), &
      method_t('direct', 'time steps of the integral equation', "method = 'direct'", 1.0e-6_wp), &
      method_t('paper', "the paper's time steps", &
      "method = 'direct', scheme = 'adams_bashforth'", 1.0e-6_wp), &
      method_t('coupled', "contact and waves together, of waves = 'body'", "method = 'coupled'", &
      1.0e-5_wp)]
   !> Their names
   character(len=7), parameter :: methods(*) = method_table%name
   !> Their places
   integer, parameter :: ive = findloc(methods == 'ive', .true., dim=1), &
      direct = findloc(methods == 'direct', .true., dim=1), &
      paper = findloc(methods == 'paper', .true., dim=1), &
      coupled = findloc(methods == 'coupled', .true., dim=1)
   !> Those that `solver.method` may have
   character(len=*), parameter :: method_choices = 'auto ive direct coupled'

   !> Places of the features, after those of the methods
   integer, parameter :: of_body = size(methods) + 1, of_paper_scheme = of_body + 1, &
      of_thin_plate = of_body + 2, of_hereditary_plate = of_body + 3, &
      of_frozen_plate = of_body + 4, of_layer = of_body + 5, of_boltzmann = of_body + 6, &
      of_receding = of_body + 7, of_eq1 = of_body + 8, of_viscosity = of_body + 9, &
      of_gravity = of_body + 10, of_second_term = of_body + 11, of_ghost = of_body + 12, &
      of_structure = of_body + 13, of_relaxing_plate = of_body + 14, of_bounces = of_body + 15

   !> A feature of an impact, or of the way in which it is to be solved
   type :: feature_t
      !> In words
      character(len=64) :: meaning = ''
      !> Keys and values that make it, as in a case
      character(len=64) :: keys = ''
   end type feature_t

   integer :: k
   !> The features; the first ones are the methods themselves
   type(feature_t), parameter :: features(*) = [ &
      (feature_t(method_table(k)%meaning, method_table(k)%keys), k=1, size(method_table)), &
      feature_t('waves in a plate of any thickness or a half space', "waves = 'body'"), &
      feature_t("the paper's scheme", "scheme = 'adams_bashforth'"), &
      feature_t('waves in a thin plate', "waves = 'constant', 'relaxing'"), &
      feature_t('waves in a thin plate that remembers', "waves = 'hereditary'"), &
      feature_t('waves in a frozen thin plate', "waves = 'frozen'"), &
      feature_t('a layer on a base', "base = 'bonded', 'sliding'"), &
      feature_t('the integral over all the past', "law = 'boltzmann'"), &
      feature_t('contact that recedes', "law = 'receding'"), &
      feature_t("moduli of two bodies by the paper's Eq. (1)", "pair = 'eq1'"), &
      feature_t('a dashpot', 'viscosity'), &
      feature_t('a weight', 'gravity'), &
      feature_t('the second term of the Volterra series', 'volterra_order = 2'), &
      feature_t('motion after the separation', 'continue_after_separation'), &
      feature_t('a struck structure', '&target'), &
      feature_t('waves in a thin plate whose modulus relaxes', "waves = 'relaxing'"), &
      feature_t('several bounces', 'bounces')]

   !> A feature that methods, or other features, exclude
   type :: refusal_t
      !> Methods and features that exclude it; 0: none
      integer :: by(3) = 0
      !> The feature
      integer :: feature = 0
      !> Why
      character(len=152) :: message = ''
      !> Names of the arguments that make it, as `error%about` has them; blank: those of the case
      character(len=48) :: about = ''
   end type refusal_t

   !> The exclusions; of several the first is the message
   type(refusal_t), parameter :: refusals(*) = [ &
      refusal_t([ive, direct, paper], of_body, &
      "waves = 'body' are solved by method = 'coupled' only", 'method waves'), &
      refusal_t([coupled, 0, 0], of_thin_plate, &
      "method = 'coupled' solves waves = 'body' or 'none', not those of a thin plate", &
      'method waves'), &
      refusal_t([coupled, 0, 0], of_hereditary_plate, &
      "method = 'coupled' solves waves = 'body' or 'none', not those of a thin plate", &
      'method waves'), &
      refusal_t([coupled, 0, 0], of_frozen_plate, &
      "method = 'coupled' solves waves = 'body' or 'none', not those of a thin plate", &
      'method waves'), &
      refusal_t([coupled, 0, 0], of_relaxing_plate, &
      "method = 'coupled' solves waves = 'body' or 'none', not those of a thin plate", &
      'method waves'), &
      refusal_t([coupled, 0, 0], of_second_term, &
      "method = 'coupled' is linear theory, a second term of the Volterra series is not", &
      'volterra_order method waves'), &
      refusal_t([coupled, 0, 0], of_paper_scheme, &
      "adams_bashforth is a scheme of method = 'direct'", 'scheme method waves'), &
      refusal_t([coupled, 0, 0], of_ghost, &
      'nothing is left of a coupled contact at separation: continuing has no meaning', &
      'continue_after_separation method waves'), &
      refusal_t([ive, 0, 0], of_paper_scheme, &
      "adams_bashforth is a scheme of method = 'direct'", 'scheme method'), &
      refusal_t([of_body, 0, 0], of_bounces, "with waves = 'body' no dent is kept between two " &
      //'bounces: expected bounces = 1, or other waves', 'bounces waves'), &
      refusal_t([of_hereditary_plate, of_frozen_plate, of_relaxing_plate], of_bounces, &
      "a plate that has a memory is not followed from bounce to bounce: expected waves = 'none' " &
      //"or 'constant', or bounces = 1", 'bounces waves'), &
      refusal_t([of_second_term, of_ghost, 0], of_bounces, "bounces are followed for one term of " &
      //'the Volterra series, and with the separation: expected bounces = 1', &
      'bounces volterra_order continue_after_separation'), &
      refusal_t([ive, paper, coupled], of_bounces, 'bounces after the first one are followed by ' &
      //"method = 'direct' with scheme = 'product'", 'bounces method scheme'), &
      refusal_t([ive, 0, 0], of_second_term, &
      "the second term of the Volterra series is solved by method = 'direct' only", &
      'volterra_order volterra_coefficient method'), &
      refusal_t([ive, 0, 0], of_ghost, &
      "only method = 'direct' continues after the separation", &
      'continue_after_separation method'), &
      refusal_t([ive, 0, 0], of_frozen_plate, &
      "waves = 'frozen' are solved by method = 'direct' only", 'waves method'), &
      refusal_t([paper, 0, 0], of_layer, "adams_bashforth is the scheme of the paper, for a free " &
      //"plate; use method = 'ive', or 'direct' with scheme = 'product'", 'scheme base'), &
      refusal_t([of_viscosity, 0, 0], of_second_term, 'the second term of the Volterra series ' &
      //'has no meaning with a viscosity, whose kernel is a delta function', &
      'volterra_order volterra_coefficient viscosity'), &
      refusal_t([of_viscosity, 0, 0], of_frozen_plate, "a frozen plate is made for the paper's " &
      //"contacts, without a viscosity; use waves = 'relaxing'", 'waves viscosity'), &
      refusal_t([of_receding, 0, 0], of_second_term, 'receding contact is exact for a force that ' &
      //'is linear in u = s^1.5: the second term of the Volterra series has no meaning in it', &
      'law volterra_order'), &
      refusal_t([paper, 0, 0], of_receding, 'adams_bashforth sums the force over all the past, ' &
      //"receding contact does not; use method = 'ive', or 'direct' with scheme = 'product'", &
      'law scheme'), &
      refusal_t([of_receding, 0, 0], of_ghost, 'nothing is left of a receding contact at ' &
      //'separation: continuing has no meaning', 'law continue_after_separation'), &
      refusal_t([paper, 0, 0], of_gravity, "adams_bashforth marches the paper's wave equation, " &
      //"without a weight; use method = 'ive', or 'direct' with scheme = 'product'", &
      'gravity scheme'), &
      refusal_t([paper, 0, 0], of_hereditary_plate, 'adams_bashforth differentiates ' &
      //"U = alpha(t) I, which a hereditary plate does not have; use method = 'ive', or " &
      //"'direct' with scheme = 'product'", 'waves scheme'), &
      refusal_t([of_thin_plate, 0, 0], of_structure, 'these waves are those of an infinite ' &
      //"plate, the structure of &target is a finite one: expected waves = 'none', or no &target", &
      'waves body'), &
      refusal_t([paper, 0, 0], of_structure, "adams_bashforth marches the paper's wave equation " &
      //"of a plate; a struck structure is solved by 'ive', or 'direct' with scheme = 'product'", &
      'scheme body'), &
      refusal_t([of_second_term, 0, 0], of_structure, 'the second term of the Volterra series is ' &
      //'not solved with a structure: expected volterra_order = 1', 'volterra_order body'), &
      refusal_t([of_ghost, 0, 0], of_structure, 'a structure may strike again after the ' &
      //'separation, which is solved: continuing has no meaning', &
      'continue_after_separation body'), &
      refusal_t([paper, 0, 0], of_viscosity, "scheme = 'adams_bashforth' has no term for a " &
      //"viscosity; use scheme = 'product' or method = 'ive'")]

   !> A value of a key that is a method's own, and the feature that it replaces
   type :: own_rule_t
      integer :: method = 0
      integer :: feature = 0
      character(len=8) :: group = ''
      character(len=8) :: key = ''
      character(len=8) :: value = ''
   end type own_rule_t

   !> The coupled contact recedes, and its two bodies are in series
   type(own_rule_t), parameter :: own_rules(*) = [ &
      own_rule_t(coupled, of_boltzmann, 'contact', 'law', 'receding'), &
      own_rule_t(coupled, of_eq1, 'contact', 'pair', 'series')]

   !> Keys that a method does not read
   type :: unread_t
      !> The methods; 0: none
      integer :: by(3) = 0
      !> Feature without which no method reads them; 0: none
      integer :: without = 0
      !> Their group
      character(len=8) :: group = ''
      !> Their names, separated by blanks
      character(len=80) :: keys = ''
      !> Why
      character(len=112) :: reason = ''
      !> Whether a case is refused in which they differ from their defaults; otherwise only a value
      !> from --set, or a sweep over one
      logical :: contradicts = .false.
   end type unread_t

   !> Reason for what is not read by the coupled contact
   character(len=*), parameter :: is_linear = 'method coupled is linear theory and takes its own ' &
      //"steps: this key is for method = 'direct'"

   !> The keys; of several rows the first is the reason
   type(unread_t), parameter :: unread(*) = [ &
      unread_t([coupled, 0, 0], 0, 'solver', &
      'scheme form quadrature volterra_order continue_after_separation time_step', is_linear, &
      contradicts=.true.), &
      unread_t([coupled, 0, 0], 0, 'solver', 'volterra_coefficient', is_linear), &
      unread_t([ive, 0, 0], 0, 'solver', 'time_step', 'method ive takes its own steps, ' &
      //"solver.time_step is for method = 'direct'"), &
      unread_t([0, 0, 0], of_second_term, 'solver', 'volterra_coefficient', &
      'it is for solver.volterra_order = 2'), &
      unread_t([0, 0, 0], of_paper_scheme, 'solver', 'form quadrature', &
      "it is for scheme = 'adams_bashforth'"), &
      unread_t([paper, 0, 0], 0, 'impact', 'gravity', &
      "adams_bashforth marches the paper's wave equation, without a weight")]

   integer :: l
   !> Whether no row of the tables excludes a feature for a method, shape (methods, features)
   logical, parameter :: solved(*, *) = reshape([((.not. (any(refusals%feature == l .and. &
      (refusals%by(1) == k .or. refusals%by(2) == k .or. refusals%by(3) == k)) &
      .or. any(own_rules%feature == l .and. own_rules%method == k)), &
      k=1, size(methods)), l=1, size(features))], [size(methods), size(features)])

contains

   !> Whether a method solves a feature
   pure function solves(method, feature)
      !> Its place in `methods`
      integer, intent(in) :: method
      !> Place of the feature, one of the `of_*` constants
      integer, intent(in) :: feature
      logical :: solves

      solves = solved(method, feature)
   end function solves

   !> Whether a method reads a key
   pure function reads(method, group, key)
      !> Its place in `methods`
      integer, intent(in) :: method
      character(len=*), intent(in) :: group, key
      logical :: reads

      logical :: has(size(features))

      has = .true.
      has(of_paper_scheme) = method == paper
      has(of_second_term) = solves(method, of_second_term)
      reads = why_unread(group, key, method, has) == ''
   end function reads

   !> Refuse what the method, or another feature, excludes
   subroutine refuse_features(has, error)
      !> The method in use and the features, true where there are, shape (size(features))
      logical, intent(in) :: has(:)
      !> Error of code `error_input`, unallocated if there is nothing to refuse
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j

      do i = 1, size(refusals)
         if (.not. has(refusals(i)%feature)) cycle
         do j = 1, size(refusals(i)%by)
            if (refusals(i)%by(j) == 0) exit
            if (.not. has(refusals(i)%by(j))) cycle
            call raise(error, error_input, trim(refusals(i)%message), trim(refusals(i)%about))
            return
         end do
      end do
   end subroutine refuse_features

   !> Method in use: the one requested. `auto` is the method that alone solves one of the features,
   !> or else the first of ive, direct and coupled that solves all
   pure function method_in_use(method, scheme, has) result(place)
      !> Method requested, one of `method_choices`
      character(len=*), intent(in) :: method
      !> Scheme of the direct method requested
      character(len=*), intent(in) :: scheme
      !> The features, shape (size(features))
      logical, intent(in) :: has(:)
      !> Place in `methods`
      integer :: place

      integer :: candidates(3), feature, i
      logical :: can(3), solved(3)

      candidates = [ive, merge(direct, paper, scheme == 'product'), coupled]
      place = candidates(2)
      if (method /= 'auto') then
         i = findloc(methods == method, .true., dim=1)
         if (i > 0 .and. i /= direct) place = i
         return
      end if
      ! each point of a sweep asks: the table is searched for the features that it has
      solved = .true.
      do feature = size(methods) + 1, size(features)
         if (.not. has(feature)) cycle
         can = [(solves(candidates(i), feature), i=1, size(candidates))]
         solved = solved .and. can
         if (count(can) /= 1) cycle
         place = candidates(findloc(can, .true., dim=1))
         return
      end do
      if (any(solved)) place = candidates(findloc(solved, .true., dim=1))
   end function method_in_use

   !> Name of the method in use, as a case has it
   pure function method_for(method, scheme, has) result(name)
      !> Method requested, one of `method_choices`
      character(len=*), intent(in) :: method
      !> Scheme of the direct method requested
      character(len=*), intent(in) :: scheme
      !> The features, shape (size(features))
      logical, intent(in) :: has(:)
      !> One of `method_choices` but auto
      character(len=7) :: name

      integer :: place

      place = method_in_use(method, scheme, has)
      name = methods(merge(direct, place, place == paper))
   end function method_for

   !> Reason why a key is not read
   pure function why_unread(group, key, method, has) result(reason)
      character(len=*), intent(in) :: group, key
      !> Place of the method in use
      integer, intent(in) :: method
      !> The features, shape (size(features))
      logical, intent(in) :: has(:)
      !> In words; blank if it is
      character(len=len(unread%reason)) :: reason

      integer :: i, without

      reason = ''
      do i = 1, size(unread)
         if (unread(i)%group /= group .or. .not. contains_word(unread(i)%keys, key)) cycle
         without = unread(i)%without
         if (without > 0) then
            if (has(without)) cycle
         else if (all(unread(i)%by /= method)) then
            cycle
         end if
         reason = unread(i)%reason
         return
      end do
   end function why_unread

end module vcor_solver_features
