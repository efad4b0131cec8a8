!> Which methods solve an impact: the one place where verification asks
module vcor_verify_methods
   use vcor_solver, only : method_for
   use vcor_case_case, only : case_t
   implicit none
   private

   public :: methods_for, method_of_case

contains

   !> The methods that solve an impact: both, for every material
   pure function methods_for() result(methods)
      !> Methods, shape (2), ive first
      character(len=6) :: methods(2)

      methods = [character(len=6) :: 'ive', 'direct']
   end function methods_for

   !> The method that a case is solved by
   function method_of_case(case) result(method)
      !> A validated case
      type(case_t), intent(in) :: case
      !> ive or direct
      character(len=:), allocatable :: method

      character(len=:), allocatable :: wanted, scheme

      call case%get('solver', 'method', wanted)
      call case%get('solver', 'scheme', scheme)
      method = method_for(wanted, scheme)
   end function method_of_case

end module vcor_verify_methods
