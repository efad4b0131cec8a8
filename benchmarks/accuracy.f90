!> What accuracy costs, and what internal variables cost
!>
!>     accuracy FOLDER
!>
!> writes three tables. FOLDER/accuracy.csv: time and true error of the paper's impacts over the
!> accuracy asked for. FOLDER/modes.csv: time over the number of terms of a Prony series.
!> FOLDER/models.csv: time of the exact models compared with the paper's. A method
!> that cannot do an impact, or takes longer than half a second for it, has no row
program accuracy
   use, intrinsic :: iso_fortran_env, only : error_unit, output_unit
   use vcor, only : case_t, error_t, override, read_case, read_case_text, wp
   use vcor_benchmark_reference, only : reference_cor
   use vcor_benchmark_stopwatch, only : measure, measurement_t, seconds, stop_on
   use vcor_number, only : real_text
   implicit none

   !> Longest time of an impact [s]
   real(wp), parameter :: patience = 0.5_wp
   !> The impacts
   character(len=*), parameter :: names(4) = [character(len=16) :: 'sls', 'butyl_prony', &
      'butyl_cerf', 'butyl_power_law']
   character(len=512) :: folder

   if (command_argument_count() /= 1) then
      write (error_unit, '(a)') 'usage: accuracy FOLDER'
      error stop
   end if
   call get_command_argument(1, folder)
   call write_accuracy(trim(folder)//'/accuracy.csv')
   call write_modes(trim(folder)//'/modes.csv')
   call write_models(trim(folder)//'/models.csv')

contains

   !> Time and error over the accuracy asked for
   subroutine write_accuracy(path)
      !> The file
      character(len=*), intent(in) :: path

      character(len=*), parameter :: methods(2) = [character(len=6) :: 'ive', 'direct']
      type(case_t) :: case
      type(measurement_t) :: measurement
      type(error_t), allocatable :: error
      character(len=40) :: setting
      real(wp) :: reference, start
      integer :: unit, name, method, decade

      open (newunit=unit, file=path, status='replace', action='write')
      write (unit, '(a)') 'problem,method,accuracy,error,estimate,microseconds,spread,steps'
      do name = 1, size(names)
         reference = reference_cor(trim(names(name))//'_v10')
         do method = 1, size(methods)
            call read_case(case, 'examples/paper/'//trim(names(name))//'.nml', error)
            call stop_on(error)
            call override(case, 'solver.method='//trim(methods(method)), error)
            call stop_on(error)
            do decade = 2, 11
               write (setting, '(a, i0)') 'solver.accuracy=1e-', decade
               call override(case, trim(setting), error)
               call stop_on(error)
               start = seconds()
               call measure(case, measurement, error, untimed=.true.)
               ! the method cannot do this impact, or not with this accuracy
               if (allocated(error)) exit
               if (seconds() - start > patience) exit
               call measure(case, measurement, error)
               call stop_on(error)
               write (unit, '(a, i0, 2(a, es8.2), a, f0.2, a, f5.3, a, i0)') &
                  trim(names(name))//','//trim(methods(method))//',1e-', decade, ',', &
                  abs(measurement%outcome%cor - reference), ',', measurement%outcome%cor_error, &
                  ',', measurement%time, ',', measurement%spread, ',', measurement%outcome%steps
               flush (unit)
            end do
         end do
      end do
      close (unit)
      write (output_unit, '(a)') 'written '//path
   end subroutine write_accuracy

   !> Time over the number of modes, with the default accuracy. The series stand for one spectrum,
   !> E_k ~ rate^(1/4) over the same five decades, and have the same sum of moduli
   subroutine write_modes(path)
      !> The file
      character(len=*), intent(in) :: path

      type(case_t) :: case
      type(measurement_t) :: measurement
      type(error_t), allocatable :: error
      integer :: unit, power

      open (newunit=unit, file=path, status='replace', action='write')
      write (unit, '(a)') 'modes,microseconds,spread,steps,cor,estimate'
      do power = 0, 8
         call read_case_text(case, prony_case(2**power), 'modes', error)
         call stop_on(error)
         call measure(case, measurement, error)
         call stop_on(error)
         write (unit, '(i0, a, f0.2, a, f5.3, a, i0, a, f9.7, a, es8.2)') 2**power, ',', &
            measurement%time, ',', measurement%spread, ',', measurement%outcome%steps, ',', &
            measurement%outcome%cor, ',', measurement%outcome%cor_error
      end do
      close (unit)
      write (output_unit, '(a)') 'written '//path
   end subroutine write_modes

   !> Time of the impacts by the paper's model and by the exact ones, with the default accuracy
   subroutine write_models(path)
      !> The file
      character(len=*), intent(in) :: path

      character(len=*), parameter :: waves(2) = [character(len=10) :: 'relaxing', 'hereditary']
      character(len=*), parameter :: laws(2) = [character(len=9) :: 'boltzmann', 'receding']
      type(case_t) :: case
      type(measurement_t) :: measurement
      type(error_t), allocatable :: error
      integer :: unit, name, i, j

      open (newunit=unit, file=path, status='replace', action='write')
      write (unit, '(a)') 'problem,waves,law,microseconds,spread,steps,cor,estimate'
      do name = 1, size(names)
         call read_case(case, 'examples/paper/'//trim(names(name))//'.nml', error)
         call stop_on(error)
         do i = 1, size(waves)
            do j = 1, size(laws)
               call override(case, 'plate.waves='//trim(waves(i)), error)
               call stop_on(error)
               call override(case, 'contact.law='//trim(laws(j)), error)
               call stop_on(error)
               call measure(case, measurement, error)
               call stop_on(error)
               write (unit, '(a, f0.2, a, f5.3, a, i0, a, f9.7, a, es8.2)') trim(names(name)) &
                  //','//trim(waves(i))//','//trim(laws(j))//',', measurement%time, ',', &
                  measurement%spread, ',', measurement%outcome%steps, ',', &
                  measurement%outcome%cor, ',', measurement%outcome%cor_error
               flush (unit)
            end do
         end do
      end do
      close (unit)
      write (output_unit, '(a)') 'written '//path
   end subroutine write_models

   !> The case with n modes
   function prony_case(n) result(text)
      !> Number of modes
      integer, intent(in) :: n
      !> The case file
      character(len=:), allocatable :: text

      real(wp), parameter :: slowest = 1.0e1_wp, decades = 5.0_wp, total = 100.0e6_wp
      character(len=*), parameter :: lf = new_line('a')
      real(wp) :: rates(n), moduli(n)
      integer :: k

      ! midpoints of n equal parts of the spectrum, so that one mode is in the middle
      rates = [(slowest*10.0_wp**(decades*(k - 0.5_wp)/n), k = 1, n)]
      moduli = rates**0.25_wp
      moduli = total*moduli/sum(moduli)
      text = "&impact velocity = 10.0 /"//lf &
         //"&sphere radius = 0.01, material = 'steel' /"//lf &
         //"&plate half_thickness = 0.02, material = 'polymer' /"//lf &
         //"&material name = 'steel', model = 'rigid', density = 7800.0 /"//lf &
         //"&material"//lf//"name = 'polymer'"//lf//"model = 'prony'"//lf//"density = 1100.0"//lf &
         //"poisson_ratio = 0.5"//lf//"equilibrium_modulus = 5.0e6"//lf//"moduli ="//lf
      do k = 1, n
         text = text//real_text(moduli(k))//lf
      end do
      text = text//"rates ="//lf
      do k = 1, n
         text = text//real_text(rates(k))//lf
      end do
      text = text//"/"//lf
   end function prony_case

end program accuracy
