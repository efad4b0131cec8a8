!> One case solved with other models: how much each choice of a model changes the restitution
module vcor_verify_models
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : find_group
   use vcor_case_cause, only : explain
   use vcor_case_inputs, only : inputs_t, of_plate, of_target, target_block, &
      target_none, target_plate, target_rod
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_case_reader, only : read_inputs, waves_of
   use vcor_impact_contact, only : pair_eq1, pair_series
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_shape, only : shapes
   use vcor_impact_target, only : waves_hereditary
   use vcor_kinds, only : pi, wp
   use vcor_material, only : material_t, new_material
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_solver, only : solve_impact
   use vcor_words, only : contains_word, list_of_words, longest_name
   implicit none
   private

   public :: model_t, solve_models, solve_exact, has_exact_contact, differ

   !> The case with one plate model, one contact law and one pair
   type :: model_t
      character(len=10) :: waves = ''
      character(len=9) :: law = ''
      character(len=6) :: pair = ''
      !> Whether it is the combination of the case
      logical :: given = .false.
      !> Whether the plate is taken as a half space, without its thickness
      logical :: is_half_space = .false.
      !> With a structure: what is solved, share of the modes that is kept, and whether the
      !> structure has no ends
      character(len=10) :: label = ''
      real(wp) :: share = 1.0_wp
      logical :: is_infinite = .false.
      !> Reason why there is no outcome, one line; unallocated if there is one
      character(len=:), allocatable :: failure
      type(outcome_t) :: outcome
   end type model_t

contains

   !> Solve a case with every plate model and both contact laws, then all of it with the other pair
   !> if that makes a difference. Waves in a plate of any thickness have one law and one pair. A
   !> plate without half thickness or density has only the model `none`
   subroutine solve_models(case, models)
      !> A validated case
      type(case_t), intent(in) :: case
      !> The combinations
      type(model_t), allocatable, intent(out) :: models(:)

      character(len=*), parameter :: plates(5) = [character(len=10) :: 'none', 'constant', &
         'relaxing', 'frozen', 'hereditary']
      character(len=*), parameter :: laws(2) = [character(len=9) :: 'boltzmann', 'receding']
      type(model_t) :: all(2*size(plates)*size(laws) + 2)
      type(problem_t) :: problem
      type(error_t), allocatable :: error
      character(len=:), allocatable :: waves, law, pair, base
      logical :: exists, has_law
      integer :: i, j, k, n, half

      call case%get('plate', 'waves', waves)
      call case%get('contact', 'law', law)
      call case%get('contact', 'pair', pair)
      call case%get('plate', 'base', base)
      if (case%count('target') > 0) then
         call solve_structures(case, models)
         return
      end if
      n = 0
      call problem_of_case(problem, case, error)
      has_law = problem%reading%has(case%address('contact', 'law'))
      do k = 1, merge(2, 1, problem%reading%has(case%address('contact', 'pair')))
         half = n
         do i = 1, size(plates)
            do j = 1, merge(size(laws), 1, has_law)
               associate (model => all(n + 1))
                  model = model_t(plates(i), laws(j), pair, &
                     plates(i) == waves .and. laws(j) == law .and. k == 1)
                  call solve_model(case, model, exists)
                  exists = exists .or. plates(i) == waves .or. j > 1 &
                     .or. (base == 'free' .and. case%has_thickness())
               end associate
               if (.not. exists) exit
               n = n + 1
            end do
         end do
         pair = trim(merge('series', 'eq1   ', pair == 'eq1'))
      end do
      if (half > 0) then
         if (.not. any(differ(all(:half)%outcome, all(half + 1:n)%outcome))) n = half
      end if
      if (case%has_second_sphere() .and. waves /= 'body') then
         allocate (models, source=all(:n))
         return
      end if
      ! of any thickness, and the limit of a thick plate
      do i = 1, merge(2, 1, case%has_thickness())
         ! a flat punch does not recede
         if (has_law) law = 'receding'
         all(n + 1) = model_t('body', law, 'series', waves == 'body' .and. i == 1)
         all(n + 1)%is_half_space = i == 2
         call solve_model(case, all(n + 1), exists)
         if (exists .or. waves == 'body') n = n + 1
      end do
      allocate (models, source=all(:n))
   end subroutine solve_models

   !> Solve a case with a structure by both laws, and with half of its modes and without its ends
   subroutine solve_structures(case, models)
      !> A validated case
      type(case_t), intent(in) :: case
      !> The combinations
      type(model_t), allocatable, intent(out) :: models(:)

      character(len=*), parameter :: laws(2) = [character(len=9) :: 'boltzmann', 'receding']
      type(model_t) :: all(4)
      character(len=:), allocatable :: body, law, pair
      logical :: exists
      integer :: i, n

      call case%get('contact', 'law', law)
      call case%get('contact', 'pair', pair)
      call case%get('target', 'body', body)
      n = 0
      do i = 1, size(laws)
         n = n + 1
         all(n) = model_t('none', laws(i), pair, law == laws(i), label='structure')
         call solve_model(case, all(n), exists)
      end do
      if (.not. differ(all(1)%outcome, all(2)%outcome)) then
         if (all(2)%given) all(1) = all(2)
         n = 1
      end if
      if (body /= 'block') then
         n = n + 1
         all(n) = model_t('none', law, pair, label='half_modes', share=0.5_wp)
         call solve_model(case, all(n), exists)
         if (.not. exists) n = n - 1
      end if
      if (body == 'block' .or. body == 'plate' .or. body == 'rod') then
         n = n + 1
         all(n) = model_t('none', law, pair, label='infinite', is_infinite=.true.)
         call solve_model(case, all(n), exists)
         if (.not. exists) n = n - 1
      end if
      allocate (models, source=all(:n))
   end subroutine solve_structures

   !> Remove the ends of a structure: a plate without edges, a rod without an end, which is a
   !> dashpot, and a block that does not move
   subroutine remove_ends(inputs, error)
      type(inputs_t), intent(inout) :: inputs
      !> Why that cannot be; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      ! mass of what moves with the dashpot, over that of the sphere: it changes the restitution by
      ! as much
      real(wp), parameter :: light = 1.0e-6_wp
      class(material_t), allocatable :: material

      associate (target => inputs%target)
         select case (target%body)
         case (target_plate)
            if (inputs%item(of_target) /= inputs%item(of_plate)) then
               call raise(error, error_input, 'the plate is not of the material of its surface')
               return
            end if
            inputs%half_thickness = 0.5_wp*inputs%target_thickness()
            inputs%waves = waves_hereditary
            target%body = target_none
         case (target_rod)
            call new_material(material, inputs%material(of_target), error)
            if (allocated(error)) return
            if (.not. material%elastic()) then
               call raise(error, error_input, 'a rod that relaxes is no dashpot')
               return
            end if
            target%body = target_block
            target%damping = 0.25_wp*pi*target%diameter**2*sqrt(material%density() &
               *material%glassy())
            target%mass = light*inputs%striking_mass(material%density())
            target%stiffness = 0.0_wp
         case default
            target%body = target_none
         end select
      end associate
   end subroutine remove_ends

   !> Whether two outcomes differ in restitution by more than their errors, or only one has any. One
   !> of contact and plate solved as one has that of the sphere only
   elemental function differ(a, b)
      type(outcome_t), intent(in) :: a, b
      logical :: differ

      ! a failed solution has NaN, whose comparison traps in a debug build
      differ = a%status /= b%status .or. (ieee_is_nan(a%cor) .neqv. ieee_is_nan(b%cor))
      if (differ .or. ieee_is_nan(a%cor)) return
      if (a%is_coupled() .or. b%is_coupled()) then
         differ = abs(a%cor_sphere - b%cor_sphere) > a%cor_sphere_error + b%cor_sphere_error
      else
         differ = abs(a%cor - b%cor) > a%cor_error + b%cor_error
      end if
   end function differ

   !> Solve a case with other models
   subroutine solve_model(case, model, valid)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Combination; on return with its outcome or failure
      type(model_t), intent(inout) :: model
      !> Whether the combination describes an impact
      logical, intent(out) :: valid

      type(inputs_t) :: inputs
      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call read_inputs(case, inputs, problem%reading, error)
      if (.not. allocated(error)) then
         if (inputs%material(of_plate)%model /= 'rigid') inputs%waves = waves_of(trim(model%waves))
         inputs%waves_are_chosen = .false.
         inputs%receding = model%law == 'receding' .and. shapes(inputs%shape)%recedes
         if (problem%reading%has(case%address('contact', 'pair'))) &
            inputs%pair = merge(pair_series, pair_eq1, model%pair == 'series')
         inputs%settings%method = 'auto'
         inputs%settings%scheme = 'product'
         inputs%settings%ghost = .false.
         inputs%settings%bounces = 1
         if (model%is_half_space) inputs%half_thickness = 0.0_wp
         inputs%target%share = model%share
         if (model%is_infinite) call remove_ends(inputs, error)
         ! an accuracy for internal variables may be out of reach of the coupled contact
         if (model%waves == 'body') inputs%settings%accuracy = 0.0_wp
         if (.not. allocated(error)) call problem%build(inputs, error)
         if (allocated(error)) then
            call forget_choices(error)
            call explain(case, error)
         end if
      end if
      valid = .not. allocated(error)
      if (valid) call solve_impact(problem%solver, problem%impact, trajectory, model%outcome, error)
      if (allocated(error)) then
         model%failure = error%message
         ! a number whose error is out of bounds is discarded
         model%outcome = outcome_t()
      end if
   end subroutine solve_model

   !> Whether law and pair of a structure change nothing: they are exact, or the contact is elastic
   function has_exact_contact(case) result(yes)
      type(case_t), intent(in) :: case
      logical :: yes

      character(len=*), parameter :: bodies(2) = ['sphere', 'plate ']
      character(len=:), allocatable :: law, pair
      logical :: is_elastic(2)
      integer :: i

      call case%get('contact', 'law', law)
      call case%get('contact', 'pair', pair)
      do i = 1, size(bodies)
         is_elastic(i) = any(case%model(find_group('material'), &
            case%material_of(trim(bodies(i)))) == [character(len=7) :: 'rigid', 'elastic'])
      end do
      yes = all(is_elastic) .or. law == 'receding' .and. (pair == 'series' .or. any(is_elastic))
   end function has_exact_contact

   !> Solve the impact of a case with the exact mechanics; with a structure only the contact is
   subroutine solve_exact(case, outcome, exact, is_shown)
      type(case_t), intent(in) :: case
      type(outcome_t), intent(in) :: outcome
      !> Outcome with the exact mechanics
      type(model_t), intent(out) :: exact
      !> Whether it differs from the given outcome, or does not exist
      logical, intent(out) :: is_shown

      character(len=:), allocatable :: waves
      logical :: is_valid

      call case%get('plate', 'waves', waves)
      is_shown = .false.
      if (waves == 'body' .and. outcome%is_coupled()) return
      exact = model_t(waves, 'receding', 'series')
      if (case%count('target') > 0) then
         exact%outcome = outcome
         if (has_exact_contact(case)) return
      else if (.not. case%has_second_sphere()) then
         exact%waves = 'body'
      end if
      call solve_model(case, exact, is_valid)
      if (.not. is_valid .and. waves == 'none' .and. .not. case%has_thickness()) then
         ! a half space without density has no waves
         exact = model_t(waves, 'receding', 'series')
         call solve_model(case, exact, is_valid)
      end if
      is_shown = allocated(exact%failure)
      if (.not. is_shown) is_shown = differ(outcome, exact%outcome)
   end subroutine solve_exact

   !> Remove from an error the keys that the combination replaces: the case has other values
   pure subroutine forget_choices(error)
      type(error_t), intent(inout) :: error

      character(len=*), parameter :: replaced = &
         'waves law pair method scheme continue_after_separation'
      character(len=longest_name), allocatable :: names(:)
      character(len=:), allocatable :: left
      integer :: i

      if (.not. allocated(error%about)) return
      allocate (names, source=list_of_words(error%about))
      left = ''
      do i = 1, size(names)
         if (.not. contains_word(replaced, trim(names(i)))) left = left//' '//trim(names(i))
      end do
      error%about = trim(adjustl(left))
      if (left == '') deallocate (error%about)
   end subroutine forget_choices

end module vcor_verify_models
