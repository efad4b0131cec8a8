!> The mechanics of a case as its keys have them: features, method in use, and what has no effect
module vcor_case_mechanics
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : find_group
   use vcor_kinds, only : wp
   use vcor_solver_features, only : features, method_for, method_in_use, of_body, of_boltzmann, &
      of_bounces, of_eq1, of_frozen_plate, of_ghost, of_gravity, of_hereditary_plate, of_layer, &
      of_paper_scheme, of_receding, of_relaxing_plate, of_second_term, of_structure, of_thin_plate
   implicit none
   private

   public :: features_of_case, method_of, place_of_method, has_body, why_no_pair

contains

   !> Features of the impact of a case, except for a viscosity, on which no choice depends
   pure function features_of_case(case) result(has)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: case
      !> Shape (size(features))
      logical :: has(size(features))

      real(wp) :: gravity
      character(len=:), allocatable :: base, law, pair, scheme, waves
      integer :: bounces, order

      call case%get('plate', 'base', base)
      call case%get('impact', 'bounces', bounces)
      call case%get('plate', 'waves', waves)
      call case%get('contact', 'law', law)
      call case%get('contact', 'pair', pair)
      call case%get('solver', 'scheme', scheme)
      call case%get('solver', 'volterra_order', order)
      has = .false.
      call case%get('solver', 'continue_after_separation', has(of_ghost))
      has(of_second_term) = order == 2
      has(of_bounces) = bounces > 1
      has(of_paper_scheme) = scheme /= 'product'
      has(of_boltzmann) = law == 'boltzmann'
      has(of_receding) = law == 'receding'
      has(of_eq1) = pair == 'eq1' .and. why_no_pair(case) == ''
      gravity = case%number(case%address('impact', 'gravity'))
      if (.not. ieee_is_nan(gravity)) has(of_gravity) = gravity > 0.0_wp
      has(of_structure) = case%count('target') > 0
      ! a rigid plate has neither waves nor a layer
      if (model_of(case, 'plate') == 'rigid') return
      has(of_body) = waves == 'body'
      has(of_hereditary_plate) = waves == 'hereditary'
      has(of_frozen_plate) = waves == 'frozen'
      has(of_relaxing_plate) = waves == 'relaxing'
      has(of_thin_plate) = waves /= 'none' .and. .not. has(of_body)
      has(of_layer) = base /= 'free'
   end function features_of_case

   !> Features of a case without those that its numbers leave without an effect: the impact does not
   !> have them, and no method is chosen for them
   pure function effective_features(case) result(has)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: case
      !> Shape (size(features))
      logical :: has(size(features))

      has = features_of_case(case)
      if (abs(case%number(case%address('solver', 'volterra_coefficient'))) <= 0.0_wp) &
         has(of_second_term) = .false.
      if (has(of_frozen_plate)) has(of_frozen_plate) = plate_relaxes(case)
   end function effective_features

   !> Whether the modulus of the plate depends on time
   pure function plate_relaxes(case) result(relaxes)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: case
      logical :: relaxes

      real(wp), allocatable :: moduli(:)
      real(wp) :: alpha, beta
      integer :: item

      relaxes = .true.
      item = case%material_of('plate')
      select case (model_of(case, 'plate'))
      case ('elastic')
         relaxes = .false.
      case ('prony')
         call case%get('material', 'moduli', moduli, item)
         relaxes = size(moduli) > 0
      case ('sls')
         alpha = case%number(case%address('material', 'alpha', item))
         beta = case%number(case%address('material', 'beta', item))
         if (.not. (ieee_is_nan(alpha) .or. ieee_is_nan(beta))) relaxes = alpha < beta
      case default
         continue
      end select
   end function plate_relaxes

   !> Method in use
   pure function method_of(case) result(name)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: case
      !> ive, direct or coupled
      character(len=7) :: name

      character(len=:), allocatable :: method, scheme

      call case%get('solver', 'method', method)
      call case%get('solver', 'scheme', scheme)
      name = method_for(method, scheme, effective_features(case))
   end function method_of

   !> Place of the method in use in the table of `vcor_solver_features`
   pure function place_of_method(case) result(place)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: case
      integer :: place

      character(len=:), allocatable :: method, scheme

      call case%get('solver', 'method', method)
      call case%get('solver', 'scheme', scheme)
      place = method_in_use(method, scheme, effective_features(case))
   end function place_of_method

   !> Whether the impact has waves in a plate of any thickness
   pure function has_body(case)
      !> A case whose plate has a material
      type(case_t), intent(in) :: case
      logical :: has_body

      logical :: has(size(features))

      has = features_of_case(case)
      has_body = has(of_body)
   end function has_body

   !> Reason why the rule for pairs does not matter
   pure function why_no_pair(case) result(reason)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: case
      !> The reason; empty if it does
      character(len=:), allocatable :: reason

      character(len=:), allocatable :: sphere, plate

      sphere = model_of(case, 'sphere')
      plate = model_of(case, 'plate')
      reason = ''
      if (sphere == 'rigid') then
         reason = 'the sphere is rigid'
      else if (plate == 'rigid') then
         reason = 'the plate is rigid'
      else if (case%material_of('sphere') == case%material_of('plate')) then
         reason = 'sphere and plate are of one material'
      else if (sphere == 'elastic' .and. plate == 'elastic') then
         reason = 'sphere and plate are elastic'
      end if
   end function why_no_pair

   !> Model of the material of a body
   pure function model_of(case, body) result(model)
      type(case_t), intent(in) :: case
      !> sphere or plate
      character(len=*), intent(in) :: body
      !> Its model
      character(len=:), allocatable :: model

      model = case%model(find_group('material'), case%material_of(body))
   end function model_of

end module vcor_case_mechanics
