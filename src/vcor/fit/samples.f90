!> Measured moduli from which a material is identified
!>
!> Moduli range over decades and have relative errors, so a fit minimises the logarithms of model
!> over data. For small misfits these are the relative misfits; with noise of 1 % they give a bias
!> of 5e-5, half of that of relative misfits.
module vcor_fit_samples
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: samples_t, moduli_of

   !> Samples of E(t), or of E' and E'' over the angular frequency
   type :: samples_t
      !> Whether they are storage and loss moduli over angular frequency
      logical :: dynamic = .false.
      !> Times [s], or angular frequencies [rad/s], increasing, > 0, shape (points)
      real(wp), allocatable :: at(:)
      !> Relaxation or storage moduli [Pa], > 0, shape (points)
      real(wp), allocatable :: modulus(:)
      !> Loss moduli [Pa], > 0, shape (points); shape (0) for relaxation data
      real(wp), allocatable :: loss(:)
      !> Lines of keys in the head of the file for the &material group; may be unallocated
      character(len=:), allocatable :: keys
   contains
      procedure :: count => count_moduli
      procedure :: first_time
      procedure :: last_time
      procedure :: all => all_moduli
   end type samples_t

contains

   !> Number of moduli, which is that of the residuals of a fit
   pure function count_moduli(self) result(n)
      class(samples_t), intent(in) :: self
      integer :: n

      n = size(self%modulus) + size(self%loss)
   end function count_moduli

   !> First time of the samples; for frequencies the reciprocal of the largest
   pure function first_time(self) result(time)
      class(samples_t), intent(in) :: self
      !> Time [s]
      real(wp) :: time

      time = self%at(1)
      if (self%dynamic) time = 1.0_wp/self%at(size(self%at))
   end function first_time

   !> Last time of the samples; for frequencies the reciprocal of the smallest
   pure function last_time(self) result(time)
      class(samples_t), intent(in) :: self
      !> Time [s]
      real(wp) :: time

      time = self%at(size(self%at))
      if (self%dynamic) time = 1.0_wp/self%at(1)
   end function last_time

   !> All moduli in one list: relaxation, or storage and then loss
   pure function all_moduli(self) result(moduli)
      class(samples_t), intent(in) :: self
      !> The moduli [Pa], shape (count)
      real(wp) :: moduli(size(self%modulus) + size(self%loss))

      moduli(:size(self%modulus)) = self%modulus
      moduli(size(self%modulus) + 1:) = self%loss
   end function all_moduli

   !> Moduli of a material at the samples
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
