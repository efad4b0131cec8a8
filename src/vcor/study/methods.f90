!> Which methods solve an impact: the one place where verification asks
module vcor_study_methods
   use vcor_impact_problem, only : impact_t
   use vcor_solver, only : method_for
   use vcor_study_case, only : case_t
   implicit none
   private

   public :: methods_for, method_of_case

contains

   !> The methods that solve an impact: where `auto` takes the internal variables both do, elsewhere
   !> direct alone
   pure function methods_for(impact) result(methods)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Methods, shape (1) or (2), ive first
      character(len=6), allocatable :: methods(:)

      if (method_for(impact, 'auto', 'product') == 'ive') then
         methods = [character(len=6) :: 'ive', 'direct']
      else
         methods = [character(len=6) :: 'direct']
      end if
   end function methods_for

   !> The method that a case is solved by
   function method_of_case(case, impact) result(method)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Its impact
      type(impact_t), intent(in) :: impact
      !> ive or direct
      character(len=:), allocatable :: method

      character(len=:), allocatable :: wanted, scheme

      call case%get('solver', 'method', wanted)
      call case%get('solver', 'scheme', scheme)
      method = method_for(impact, wanted, scheme)
   end function method_of_case

end module vcor_study_methods
