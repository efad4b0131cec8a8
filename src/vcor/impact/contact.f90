!> Contact modulus E'(t) of two bodies, Eq. (1) of Green's paper
module vcor_impact_contact
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_pair, only : first_sample, new_signed_fit, signed_fit_t, &
      sum_with_elastic
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_prony, only : new_elastic, prony_t
   use vcor_material_in_series, only : new_in_series
   use vcor_material_type, only : material_t
   use vcor_numeric_quadrature, only : endpoint_rule, fourier_rule, gauss_nodes, graded_rule
   implicit none
   private

   public :: contact_modulus_t, new_contact_modulus
   public :: pair_eq1, pair_series

   !> Two viscoelastic bodies combine by their moduli at the same time, Eq. (1) of the paper
   integer, parameter :: pair_eq1 = 0
   !> Two bodies in series, whose compliances add in the Laplace domain: exact
   integer, parameter :: pair_series = 1

   !> E'(t) = E'_a E'_b/(E'_a + E'_b) with E'_i = E_i/(1 - nu_i^2), as in the paper a function of
   !> time. If one body is rigid, or both have the same material or are elastic, it is a multiple of
   !> one modulus, with all its closed forms (Cases 1 to 4 of the paper's Section III). Two bodies
   !> in series are one material. All other combinations are a pair. What nothing has built has the
   !> modulus NaN
   type :: contact_modulus_t
      private
      !> Whether the two bodies are in series
      logical :: series = .false.
      !> The only material, or the first of a pair
      class(material_t), allocatable :: first
      !> The second material of a pair, otherwise unallocated
      class(material_t), allocatable :: second
      !> Factor of the first modulus [-]
      real(wp) :: first_factor = 1.0_wp
      !> Factor of the second modulus [-]
      real(wp) :: second_factor = 1.0_wp
      !> The pair as a sum of exponentials for all times, to twelve digits; unallocated if there is
      !> none
      type(exponential_sum_t), allocatable :: terms
      !> Nodes on (0, 1) for the integral of a pair without `terms`, shape (n)
      real(wp), allocatable :: node(:)
      !> Weights of the nodes, shape (n)
      real(wp), allocatable :: weight(:)
      !> Rules for the Fourier integrals of a pair, shape (n)
      real(wp), dimension(:), allocatable :: sine_node, sine_weight, cosine_node, cosine_weight
      !> Fits sums of exponentials to a pair; unallocated if no fit is needed
      type(signed_fit_t), allocatable :: fit
   contains
      procedure :: is_built
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
      procedure :: mean_integral
      procedure :: step_integrals
      procedure :: dynamic_modulus
      procedure :: glassy
      procedure :: rubbery
      procedure :: viscosity
      procedure :: exponentials
   end type contact_modulus_t

contains

   !> Combine the materials of sphere and plate
   pure subroutine new_contact_modulus(self, sphere, plate, same, error, pair)
      !> Contact modulus; `fit`, the most expensive part, is kept if there was one
      type(contact_modulus_t), intent(inout) :: self
      class(material_t), intent(in) :: sphere
      class(material_t), intent(in) :: plate
      !> Whether both bodies have the same modulus
      logical, intent(in) :: same
      type(error_t), allocatable, intent(out) :: error
      !> One of the `pair_*` constants; absent: pair_eq1
      integer, intent(in), optional :: pair

      ! a pair is smooth in the logarithm of time between these parts of the upper limit; the part
      ! before the first is a millionth
      real(wp), parameter :: factor = 10.0_wp**0.5_wp
      integer, parameter :: parts = 12
      ! error of a sum that holds for all times
      real(wp), parameter :: finest = 1.0e-12_wp
      integer :: i
      real(wp), parameter :: ends(0:parts) = [(factor**(i - parts), i=0, parts)]
      type(prony_t) :: elastic
      type(signed_fit_t), allocatable :: fit
      real(wp) :: a, b
      logical :: series, is_found

      call move_alloc(self%fit, fit)
      call clear(self)
      series = .false.
      if (present(pair)) then
         series = pair == pair_series
         if (.not. (series .or. pair == pair_eq1)) call raise(error, error_input, &
            'unknown kind of pair, expected pair_eq1 or pair_series', about='pair')
         if (allocated(error)) return
      end if
      if (.not. (sphere%is_built() .and. plate%is_built())) then
         call raise(error, error_input, 'a material is empty: no procedure new_... has built it')
      else if (sphere%rigid .and. plate%rigid) then
         call raise(error, error_input, &
            'sphere and plate are both rigid, expected one that deforms', about='material')
      else if (sphere%rigid) then
         allocate (self%first, source=plate)
         self%first_factor = plate%plane_strain_factor()
      else if (plate%rigid) then
         allocate (self%first, source=sphere)
         self%first_factor = sphere%plane_strain_factor()
      else if (same) then
         allocate (self%first, source=sphere)
         self%first_factor = 0.5_wp*sphere%plane_strain_factor()
      else if (sphere%elastic() .and. plate%elastic()) then
         a = sphere%glassy()*sphere%plane_strain_factor()
         b = plate%glassy()*plate%plane_strain_factor()
         call new_elastic(elastic, a*(b/(a + b)), error)
         if (allocated(error)) return
         allocate (self%first, source=elastic)
      else if (series) then
         self%series = .true.
         call new_in_series(self%first, sphere, sphere%plane_strain_factor(), plate, &
            plate%plane_strain_factor(), error)
      else if (max(sphere%viscosity, plate%viscosity) > 0.0_wp) then
         call raise(error, error_input, 'a material with a viscosity has no meaning in Eq. (1) ' &
            //'with another deformable material: make one body rigid or both of one material, ' &
            //"or use contact.pair = 'series'", about='pair viscosity')
      else
         allocate (self%first, source=sphere)
         allocate (self%second, source=plate)
         self%first_factor = sphere%plane_strain_factor()
         self%second_factor = plate%plane_strain_factor()
         call graded_rule(ends, self%node, self%weight)
         call fourier_rule(self%sine_node, self%sine_weight, self%cosine_node, self%cosine_weight)
         if (expands(self)) then
            allocate (self%terms)
            call expand_pair(self, sqrt(huge(1.0_wp)), finest, self%terms, is_found)
            if (.not. is_found) deallocate (self%terms)
         else
            if (.not. allocated(fit)) then
               allocate (fit)
               call new_signed_fit(fit)
            end if
            call move_alloc(fit, self%fit)
         end if
      end if
   end subroutine new_contact_modulus

   !> Reset a contact modulus
   pure subroutine clear(self)
      type(contact_modulus_t), intent(out) :: self
   end subroutine clear

   !> Whether the contact modulus has been built
   elemental function is_built(self)
      class(contact_modulus_t), intent(in) :: self
      logical :: is_built

      is_built = allocated(self%first)
   end function is_built

   !> Whether one body of a pair is elastic and the other one a sum of exponentials
   pure function expands(self) result(yes)
      !> Contact modulus of a pair
      type(contact_modulus_t), intent(in) :: self
      logical :: yes

      yes = self%first%elastic() .and. self%second%discrete &
         .or. self%second%elastic() .and. self%first%discrete
   end function expands

   !> Contact modulus E'(t) at t > 0, Eq. (1)
   elemental function relaxation(self, t) result(value)
      class(contact_modulus_t), intent(in) :: self
      !> Time [s], t >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: value

      value = unset
      if (allocated(self%first)) value = self%first_factor*self%first%relaxation(t)
      if (allocated(self%second)) &
         value = combined(value, self%second_factor*self%second%relaxation(t))
   end function relaxation

   !> Modulus of two bodies by Eq. (1); either may be infinite or zero
   elemental function combined(one, other) result(modulus)
      !> Modulus of the first body [Pa], >= 0
      real(wp), intent(in) :: one
      !> Modulus of the second body [Pa], >= 0
      real(wp), intent(in) :: other
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = min(one, other)
      if (modulus > 0.0_wp .and. modulus <= huge(modulus)) &
         modulus = modulus/(1.0_wp + modulus/max(one, other))
   end function combined

   !> Rate of the contact modulus at t > 0: E'^2 (E_a'/E_a^2 + E_b'/E_b^2)
   elemental function rate(self, t) result(value)
      class(contact_modulus_t), intent(in) :: self
      !> Time [s], t > 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      real(wp) :: a, b

      value = unset
      if (allocated(self%second)) then
         a = self%first_factor*self%first%relaxation(t)
         b = self%second_factor*self%second%relaxation(t)
         value = (self%first_factor*self%first%rate(t)*(b/(a + b))**2 &
            + self%second_factor*self%second%rate(t)*(a/(a + b))**2)
      else if (allocated(self%first)) then
         value = self%first_factor*self%first%rate(t)
      end if
   end function rate

   !> Integral of E' from 0 to t without the dashpot; for a pair by quadrature
   elemental function integral(self, t) result(value)
      class(contact_modulus_t), intent(in) :: self
      !> Upper limit [s], >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      value = unset
      if (allocated(self%terms)) then
         value = self%terms%integral(t)
      else if (allocated(self%second)) then
         value = t*sum(self%weight*self%relaxation(t*self%node))
      else if (allocated(self%first)) then
         value = self%first_factor*self%first%integral(t)
      end if
   end function integral

   !> Mean over (0, t) of the integral of E' from 0, without the dashpot. Integration by parts makes
   !> it the integral of (1 - x/t) E'(x), a single sum for a pair
   pure function mean_integral(self, t) result(value)
      class(contact_modulus_t), intent(in) :: self
      !> Time [s], > 0
      real(wp), intent(in) :: t
      !> Mean [Pa s]
      real(wp) :: value

      real(wp), allocatable :: node(:), weight(:)

      if (allocated(self%second)) then
         value = t*sum(self%weight*(1.0_wp - self%node)*self%relaxation(t*self%node))
      else
         ! the modulus may be singular, but its integral is not
         call endpoint_rule(node, weight)
         value = sum(weight*self%integral(t*node))
      end if
   end function mean_integral

   !> Integrals of E' over the steps from i dt to (i + 1) dt, i = 0 .. n - 1, without the dashpot
   pure function step_integrals(self, dt, n) result(value)
      class(contact_modulus_t), intent(in) :: self
      !> Length of the steps [s], > 0
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: n
      !> Integrals [Pa s], shape (0:n-1)
      real(wp) :: value(0:n - 1)

      ! the branch point of the kernel is at least one step away from all steps but the first: eight
      ! Gauss nodes have an error of 5.8^-16 there
      integer, parameter :: order = 8
      real(wp) :: node(order), weight(order), upper, lower
      integer :: i

      value = unset
      if (allocated(self%second)) then
         value(0) = self%integral(dt)
         call gauss_nodes(node, weight)
         do i = 1, n - 1
            value(i) = dt*sum(weight*self%relaxation(dt*(real(i, wp) + node)))
         end do
      else if (allocated(self%first)) then
         lower = 0.0_wp
         do i = 0, n - 1
            upper = self%first%integral(dt*real(i + 1, wp))
            value(i) = self%first_factor*(upper - lower)
            lower = upper
         end do
      end if
   end function step_integrals

   !> Storage and loss modulus of the contact, Eq. (7); for a pair from the transform of E'(t),
   !> E*(omega) = E_r + omega int_0^inf (E'(t) - E_r) (sin(omega t) + i cos(omega t)) dt
   pure function dynamic_modulus(self, omega) result(modulus)
      class(contact_modulus_t), intent(in) :: self
      !> Frequency [rad/s], > 0
      real(wp), intent(in) :: omega
      !> Storage + i loss [Pa]
      complex(wp) :: modulus

      real(wp) :: rubbery_modulus, storage, loss

      modulus = self%rubbery()
      if (allocated(self%terms)) then
         modulus = self%terms%complex_modulus(cmplx(0.0_wp, omega, wp))
      else if (allocated(self%second)) then
         rubbery_modulus = self%rubbery()
         storage = rubbery_modulus &
            + sum(self%sine_weight*(self%relaxation(self%sine_node/omega) - rubbery_modulus))
         loss = sum(self%cosine_weight &
            *(self%relaxation(self%cosine_node/omega) - rubbery_modulus))
         modulus = cmplx(storage, loss, wp)
      else if (allocated(self%first)) then
         modulus = self%first_factor*self%first%complex_modulus(cmplx(0.0_wp, omega, wp))
      end if
   end function dynamic_modulus

   !> Glassy contact modulus E'(0), infinite for a singular kernel
   pure function glassy(self) result(modulus)
      class(contact_modulus_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = unset
      if (allocated(self%first)) modulus = self%first_factor*self%first%glassy()
      if (allocated(self%second)) &
         modulus = combined(modulus, self%second_factor*self%second%glassy())
   end function glassy

   !> Rubbery contact modulus E'(infinity)
   pure function rubbery(self) result(modulus)
      class(contact_modulus_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = unset
      if (allocated(self%first)) modulus = self%first_factor*self%first%rubbery()
      if (allocated(self%second)) &
         modulus = combined(modulus, self%second_factor*self%second%rubbery())
   end function rubbery

   !> Viscosity of the dashpot in parallel with the contact modulus
   pure function viscosity(self)
      class(contact_modulus_t), intent(in) :: self
      !> Viscosity [Pa s]
      real(wp) :: viscosity

      viscosity = 0.0_wp
      if (allocated(self%first) .and. .not. allocated(self%second)) &
         viscosity = self%first_factor*self%first%viscosity
   end function viscosity

   !> The contact modulus as a sum of exponentials
   pure subroutine exponentials(self, window, accuracy, terms)
      class(contact_modulus_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      !> The sum; `terms%error` is its estimated relative error
      type(exponential_sum_t), intent(out) :: terms

      type(exponential_sum_t) :: one
      logical :: is_found
      integer :: n

      if (allocated(self%second)) then
         call expand_pair(self, window, accuracy, terms, is_found)
         if (.not. is_found) call fit_values(terms)
      else
         call self%first%exponentials(window, accuracy, terms)
         call terms%scale(self%first_factor)
         ! the spectrum may have peaks that the rule does not resolve
         if (self%series .and. .not. self%first%discrete .and. terms%error > accuracy) then
            call fit_values(one)
            ! the fastest term stands for all relaxation before the first sample; the integral gives
            ! it
            n = size(one%rates)
            if (n > 0) one%moduli(n) = one%moduli(n) + one%rates(n) &
               *(self%integral(first_sample*window) &
               - one%integral(first_sample*window))
            one%viscosity = self%viscosity()
            if (one%error < terms%error) terms = one
         end if
      end if

   contains

      !> Fit a sum to the values of the modulus
      pure subroutine fit_values(terms)
         type(exponential_sum_t), intent(out) :: terms

         type(signed_fit_t) :: other

         if (allocated(self%fit)) then
            call self%fit%fit(window, self%relaxation(window*self%fit%time), terms)
         else
            ! rare: the expansion is too long, or the rule does not resolve the spectrum
            call new_signed_fit(other)
            call other%fit(window, self%relaxation(window*other%time), terms)
         end if
      end subroutine fit_values
   end subroutine exponentials

   !> Expand a pair of an elastic body and a sum of exponentials in powers of its relaxing part
   pure subroutine expand_pair(self, window, accuracy, terms, is_found)
      !> Contact modulus of a pair
      class(contact_modulus_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(exponential_sum_t), intent(out) :: terms
      !> Whether it is such a pair and the sum is short enough
      logical, intent(out) :: is_found

      ! accuracy of the expansion over that requested, since digits cost little: with 1, 18 of 371
      ! random impacts change, by up to 11 stated errors; lower bound by rounding
      real(wp), parameter :: finer = 1.0e-2_wp, finest = 1.0e-13_wp
      type(exponential_sum_t) :: other
      real(wp) :: elastic

      is_found = .false.
      if (self%first%elastic() .and. self%second%discrete) then
         elastic = self%first_factor*self%first%glassy()
         call self%second%exponentials(window, accuracy, other)
         call other%scale(self%second_factor)
      else if (self%second%elastic() .and. self%first%discrete) then
         elastic = self%second_factor*self%second%glassy()
         call self%first%exponentials(window, accuracy, other)
         call other%scale(self%first_factor)
      else
         return
      end if
      call sum_with_elastic(elastic, other, window, max(finer*accuracy, finest), terms, is_found)
   end subroutine expand_pair

end module vcor_impact_contact
