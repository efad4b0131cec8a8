!> Constants that tune the sums of exponentials, marked as those of `vcor_solver_tuning` are
module vcor_material_tuning
   use vcor_kinds, only : wp
   implicit none
   public

   ! Continuous spectra

   !> Where exp(-l t) becomes 1 - l t + .., as l times the window
   real(wp), parameter :: slow_run = 0.5_wp ! tested
   !> ln of the rate of the peak over those below which, and of those over it above which, the
   !> spectrum is a power of the rate; what is fast counts less
   real(wp), parameter :: below_peak = 4.0_wp ! tested
   real(wp), parameter :: above_peak = 1.0_wp ! tested
   !> Accuracy of the loosest sum
   real(wp), parameter :: loosest_sum = 1.0e-2_wp ! tested
   !> What the last node adds to the dashpot, over the dashpot and the accuracy
   real(wp), parameter :: negligible_tail = 1.0e-3_wp ! tested
   !> Refinements of a spectrum that has its features where it pleases, and how much farther out the
   !> runs to slow and to fast rates begin with each, as ln of the rate
   integer, parameter :: most_runs = 3 ! tested
   real(wp), parameter :: farther_below = 3.0_wp ! tested
   real(wp), parameter :: farther_above = 5.0_wp ! tested
   !> What the impact feels of the error of the integral: it is that which the fast part of a
   !> modulus acts through
   real(wp), parameter :: share_of_integral = 0.3_wp ! tested

   ! Moduli of either sign

   !> Slowest rate over that of the window, and the fastest that counts one by one; logarithm of the
   !> ratio of two
   real(wp), parameter :: slowest_rate = 0.2_wp ! tested
   real(wp), parameter :: fast_rate = 1.0e7_wp ! tested
   real(wp), parameter :: rate_spacing = 0.15_wp ! tested
   !> Beyond, a modulus such as t^-a takes rates up to 1e10: what is lumped above rate l leaves an
   !> error of l^(a - 2)
   real(wp), parameter :: fastest_rate = 1.0e10_wp ! tested
   real(wp), parameter :: wide_spacing = 0.3_wp ! tested
   !> Samples per rate; the first one over the time of the fastest rate
   integer, parameter :: samples_per_rate = 3 ! tested
   real(wp), parameter :: earliest_sample = 0.3_wp ! tested
   !> Part of the window from which on errors count in full, before by a power of the time: with a
   !> higher one the sum may become negative there, with a lower one t^-a takes digits from the rest
   real(wp), parameter :: full_weight = 0.03_wp ! tested
   real(wp), parameter :: weight_power = 1.5_wp ! tested
   !> How much faster the term is that has decayed by the first sample
   real(wp), parameter :: faster_term = 1.0e3_wp ! tested
   !> What an impact feels of the error of the integral at most: measured
   real(wp), parameter :: integral_felt = 3.0_wp ! tested
   !> What a unit of the moduli costs: moduli of opposite signs cost digits, and so do the
   !> eigenvectors of the panels; 4e-15 were measured, more where the contact recedes
   real(wp), parameter :: digits_lost = 2.0e-14_wp ! tested
   real(wp), parameter :: most_digits_lost = 1.0e-12_wp ! tested

   ! Data

   !> Largest rate times the first, smallest rate times the last time. Wider, and the sum runs
   !> further away from the modulus outside of the data for digits that no data have: for t^-0.5
   !> these give a misfit of 2e-5 and at t = 0 2.7 times the first modulus; 2 and 0.5 1e-3 and 2.1
   real(wp), parameter :: fastest_of_data = 4.0_wp ! tested
   real(wp), parameter :: slowest_of_data = 0.25_wp ! tested
   !> Rates per decade of the first grid: for t^-0.5 2 give a misfit of 5e-4, 3 and 4 2e-5
   real(wp), parameter :: rates_per_decade = 3.0_wp ! tested
   !> Times the grid is refined: the rates are then known to 0.3 %, and the merging of two of them
   !> costs 1e-6
   integer, parameter :: most_refinements = 8 ! tested
   !> Misfit that is good enough: the default accuracy of the restitution
   real(wp), parameter :: good_misfit = 1.0e-6_wp ! tested
   !> A refinement must reduce the residual times the square of the number of terms to this part:
   !> where the spectrum is continuous, twice the terms halve the residual for ever
   real(wp), parameter :: least_gain = 0.7_wp ! tested
   !> All mergers may increase the misfit by this factor
   real(wp), parameter :: merging_loss = 1.25_wp ! tested
   !> Samples of data per decade, for a sum whose terms are three to the decade
   real(wp), parameter :: samples_per_decade = 20.0_wp ! tested

end module vcor_material_tuning
