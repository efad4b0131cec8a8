!> The program vcor: the coefficient of restitution of viscoelastic impacts
program vcor_main
   use, intrinsic :: iso_c_binding, only : c_int
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_cli, only : argument_t, get_arguments, parse, request_t, sum_of_words
   use vcor_app_driver, only : complain, execute
   use vcor_app_signals, only : prepare_signals
   use vcor_error, only : error_t, error_usage, raise
   use vcor_sweep_mpi, only : differs, join_ranks, leave_ranks, share_error
   implicit none

   interface
      !> Leave the process with an exit code and without the words of `stop`
      subroutine c_exit(code) bind(c, name='exit')
         import :: c_int
         !> Exit code
         integer(c_int), intent(in), value :: code
      end subroutine c_exit
   end interface

   type(argument_t), allocatable :: words(:)
   type(request_t) :: request
   type(error_t), allocatable :: error

   call join_ranks()
   call prepare_signals()
   call get_arguments(words)
   call parse(words, request, error)
   call share_error(error)
   if (.not. allocated(error)) then
      ! they would wait for each other
      if (differs(sum_of_words(words))) call raise(error, error_usage, &
         'not all ranks have the same command line, expected the same words after vcor')
   end if
   if (.not. allocated(error)) call execute(request, error)
   call share_error(error)
   if (allocated(error)) then
      call complain(error)
      flush (error_unit)
   end if
   call leave_ranks()
   if (allocated(error)) then
      call c_exit(int(error%code, c_int))
   end if
end program vcor_main
