!> Measured moduli that a material is identified from, and what a model misses of them
!>
!> Moduli run over decades and are measured to so many percent of themselves, so what counts is the
!> logarithm of model over data. For small misfits that is the relative misfit; of a noise of 1 %
!> it makes a bias of 5e-5, half of what relative misfits make.
module vcor_fit_samples
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: samples_t, moduli_of

   !> Samples of E(t), or of E' and E'' over the angular frequency
   type :: samples_t
      !> Whether they are storage and loss moduli over frequency
      logical :: dynamic = .false.
      !> Times [s], or angular frequencies [rad/s], increasing, > 0, shape (points)
      real(wp), allocatable :: at(:)
      !> Relaxation or storage moduli [Pa], > 0, shape (points)
      real(wp), allocatable :: modulus(:)
      !> Loss moduli [Pa], > 0, shape (points); of relaxation data shape (0)
      real(wp), allocatable :: loss(:)
      !> Lines of keys that the head of the file gives for the &material group; may be unallocated
      character(len=:), allocatable :: keys
   contains
      procedure :: count => count_moduli
      procedure :: first_time
      procedure :: last_time
      procedure :: all => all_moduli
   end type samples_t

contains

   !> Number of moduli, that of the residuals of a fit
   pure function count_moduli(self) result(n)
      class(samples_t), intent(in) :: self
      integer :: n

      n = size(self%modulus) + size(self%loss)
   end function count_moduli

   !> Time from which on the samples say something: of frequencies the reciprocal of the largest
   pure function first_time(self) result(time)
      class(samples_t), intent(in) :: self
      !> Time [s]
      real(wp) :: time

      time = self%at(1)
      if (self%dynamic) time = 1.0_wp/self%at(size(self%at))
   end function first_time

   !> Time up to which the samples say something: of frequencies the reciprocal of the smallest
   pure function last_time(self) result(time)
      class(samples_t), intent(in) :: self
      !> Time [s]
      real(wp) :: time

      time = self%at(size(self%at))
      if (self%dynamic) time = 1.0_wp/self%at(1)
   end function last_time

   !> All moduli as one list: relaxation, or storage and then loss
   pure function all_moduli(self) result(moduli)
      class(samples_t), intent(in) :: self
      !> The moduli [Pa], shape (count)
      real(wp) :: moduli(size(self%modulus) + size(self%loss))

      moduli(:size(self%modulus)) = self%modulus
      moduli(size(self%modulus) + 1:) = self%loss
   end function all_moduli

   !> Moduli of a material where there are samples
   pure function moduli_of(material, samples) result(moduli)
      class(material_t), intent(in) :: material
      type(samples_t), intent(in) :: samples
      !> Relaxation moduli, or storage and then loss moduli [Pa], shape (count)
      real(wp) :: moduli(samples%count())

      complex(wp) :: complex_moduli(size(samples%loss))

      if (samples%dynamic) then
         complex_moduli = material%complex_modulus(cmplx(0.0_wp, samples%at, wp))
         moduli(:size(samples%at)) = real(complex_moduli, wp)
         moduli(size(samples%at) + 1:) = aimag(complex_moduli)
      else
         moduli = material%relaxation(samples%at)
      end if
   end function moduli_of

end module vcor_fit_samples
