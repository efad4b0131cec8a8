!> Threads, without OpenMP one
module vcor_sweep_threads
!$ use omp_lib, only : omp_get_max_threads
   implicit none
   private

   public :: default_threads, most_threads

   !> Most threads that can be asked for
   integer, parameter :: most_threads = 1024

contains

   !> Threads where none are asked for: the cores that the process may use, or what the environment
   !> variable OMP_NUM_THREADS says
   function default_threads() result(threads)
      !> Number, at least 1
      integer :: threads

      threads = 1
!$    threads = min(omp_get_max_threads(), most_threads)
   end function default_threads

end module vcor_sweep_threads
