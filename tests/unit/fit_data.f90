!> Data that materials are identified from in the tests, with noise or without
module fit_data
   use vcor_error, only : error_t
   use vcor_fit, only : estimate_t, samples_t
   use vcor_fit_samples, only : moduli_of
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   implicit none
   private

   public :: truth, sampled, sampled_model, parameter_of, draw, begin_noise, spoil
   public :: exact, noise, runs, most_misses, models, none, state

   !> What is asked of exact data
   real(wp), parameter :: exact = 1.0e-8_wp
   !> Relative noise of the data
   real(wp), parameter :: noise = 0.01_wp
   !> Runs with noise, and how many may miss three standard errors
   integer, parameter :: runs = 100, most_misses = 5
   !> The models with a few parameters
   character(len=*), parameter :: models(4) = [character(len=14) :: 'sls', 'power_law', 'cerf', &
      'mittag_leffler']
   !> No parameter is given
   type(estimate_t), parameter :: none(0) = [estimate_t ::]
   !> State of the generator of noise
   real(wp) :: state = 0.0_wp

contains

   !> A material of each model, with the numbers of the paper or close to them
   function truth(model) result(data)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> The material
      type(material_data_t) :: data

      data%name = 'truth'
      data%model = model
      call data%set('glassy_modulus', 15.0e6_wp)
      call data%set('alpha', 300.0_wp)
      call data%set('beta', merge(700.0_wp, 1200.0_wp, model == 'cerf'))
      call data%set('equilibrium_modulus', 2.28e6_wp)
      call data%set('relaxing_modulus', 676.5e6_wp)
      call data%set('coefficient', 8.85e5_wp)
      call data%set('exponent', merge(0.62_wp, 0.5_wp, model == 'mittag_leffler'))
      call data%set('time', 2.0e-6_wp)
      call data%set_list('moduli', [20.181e6_wp, 38.204e6_wp, 87.344e6_wp])
      call data%set_list('rates', [972.0_wp, 6426.0_wp, 34221.0_wp])
   end function truth

   !> Samples of a material
   function sampled(data, first, last, n, dynamic) result(samples)
      !> The material
      type(material_data_t), intent(in) :: data
      !> First time [s]
      real(wp), intent(in) :: first
      !> Last time [s]
      real(wp), intent(in) :: last
      !> Number of points
      integer, intent(in) :: n
      !> Whether storage and loss modulus are wanted
      logical, intent(in) :: dynamic
      !> The samples
      type(samples_t) :: samples

      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      real(wp) :: all((1 + merge(1, 0, dynamic))*n)
      integer :: k

      call new_material(material, data, error)
      samples%dynamic = dynamic
      allocate (samples%at(n), samples%modulus(n), samples%loss(size(all) - n))
      samples%at = first*(last/first)**[(real(k, wp)/real(n - 1, wp), k=0, n - 1)]
      if (dynamic) samples%at = 1.0_wp/samples%at(n:1:-1)
      all = moduli_of(material, samples)
      samples%modulus = all(:n)
      samples%loss = all(n + 1:)
   end function sampled

   !> Samples of a material of a model, over the decades in which it relaxes
   function sampled_model(model, dynamic) result(samples)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Whether storage and loss modulus are wanted
      logical, intent(in) :: dynamic
      !> The samples
      type(samples_t) :: samples

      if (model == 'sls') then
         samples = sampled(truth(model), 1.0e-5_wp, 1.0e-2_wp, 41, dynamic)
      else
         samples = sampled(truth(model), 1.0e-9_wp, 1.0e-1_wp, 41, dynamic)
      end if
   end function sampled_model

   !> A parameter of a material by its name
   function parameter_of(data, name) result(value)
      !> The material
      type(material_data_t), intent(in) :: data
      !> Name of the parameter
      character(len=*), intent(in) :: name
      !> Its value
      real(wp) :: value

      value = data%number(name)
   end function parameter_of

   !> Numbers of a normal distribution (Box and Muller), from a multiplicative generator (Lehmer)
   subroutine draw(numbers)
      !> The numbers
      real(wp), intent(out) :: numbers(:)

      real(wp), parameter :: two_pi = 6.283185307179586_wp
      real(wp), parameter :: multiplier = 16807.0_wp, modulus = 2147483647.0_wp
      real(wp) :: uniform(2)
      integer :: k, m

      do k = 1, size(numbers)
         do m = 1, 2
            state = mod(multiplier*state, modulus)
            uniform(m) = state/modulus
         end do
         numbers(k) = sqrt(-2.0_wp*log(uniform(1)))*cos(two_pi*uniform(2))
      end do
   end subroutine draw

   !> Begin a run
   subroutine begin_noise(run)
      !> Its number
      integer, intent(in) :: run

      real(wp) :: unused(10)

      state = real(1000 + run, wp)
      ! the first numbers of seeds that are close together are close together too
      call draw(unused)
   end subroutine begin_noise

   !> Put noise on samples
   subroutine spoil(samples, times)
      !> The samples
      type(samples_t), intent(inout) :: samples
      !> How many times the usual noise; absent: 1
      real(wp), intent(in), optional :: times

      real(wp) :: numbers(size(samples%at)), part

      part = noise
      if (present(times)) part = times*noise
      call draw(numbers)
      samples%modulus = samples%modulus*(1.0_wp + part*numbers)
      if (.not. samples%dynamic) return
      call draw(numbers)
      samples%loss = samples%loss*(1.0_wp + part*numbers)
   end subroutine spoil

end module fit_data
