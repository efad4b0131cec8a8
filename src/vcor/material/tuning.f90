!> Tuning constants of the sums of exponentials, marked like those of `vcor_solver_tuning`
module vcor_material_tuning
   use vcor_kinds, only : wp
   implicit none
   public

   ! Continuous spectra

   !> Rate over that of the window below which exp(-l t) is treated as 1 - l t + ..
   real(wp), parameter :: slow_run = 0.5_wp ! tested
   !> Distance in ln(l) from the peak beyond which the spectrum is a power of the rate, on the slow
   !> and on the fast side; fast rates matter less
   real(wp), parameter :: below_peak = 4.0_wp ! tested
   real(wp), parameter :: above_peak = 1.0_wp ! tested
   !> Lowest accuracy with which a sum is built
   real(wp), parameter :: loosest_sum = 1.0e-2_wp ! tested
   !> Share of the last node in the dashpot, over the accuracy, above which what is beyond is added
   real(wp), parameter :: negligible_tail = 1.0e-3_wp ! tested
   !> Refinements for spectra with features at unknown rates, and how much farther out in ln(l) the
   !> slow and the fast end begin with each
   integer, parameter :: most_runs = 3 ! tested
   real(wp), parameter :: farther_below = 3.0_wp ! tested
   real(wp), parameter :: farther_above = 5.0_wp ! tested
   !> Share of the relative error of the integral that counts for the impact: fast parts of a
   !> modulus act through their integral
   real(wp), parameter :: share_of_integral = 0.3_wp ! tested

   ! Moduli of either sign

   !> Slowest and fastest rate of the regular grid, over that of the window, and the logarithm of
   !> the ratio of two neighbours
   real(wp), parameter :: slowest_rate = 0.2_wp ! tested
   real(wp), parameter :: fast_rate = 1.0e7_wp ! tested
   real(wp), parameter :: rate_spacing = 0.15_wp ! tested
   !> Beyond it a coarser grid up to this rate, for moduli such as t^-a: lumping all rates above l
   !> leaves an error of l^(a - 2)
   real(wp), parameter :: fastest_rate = 1.0e10_wp ! tested
   real(wp), parameter :: wide_spacing = 0.3_wp ! tested
   !> Samples per rate; the first sample over the inverse of the fastest rate
   integer, parameter :: samples_per_rate = 3 ! tested
   real(wp), parameter :: earliest_sample = 0.3_wp ! tested
   !> Part of the window from which errors count in full; before, by this power of the time. With a
   !> higher power the sum may become negative there, with a lower one t^-a takes digits from the
   !> rest
   real(wp), parameter :: full_weight = 0.03_wp ! tested
   real(wp), parameter :: weight_power = 1.5_wp ! tested
   !> Rate of the term that has decayed by the first sample, over the fastest rate
   real(wp), parameter :: faster_term = 1.0e3_wp ! tested
   !> Factor from the error of the integral to that of an impact, measured
   real(wp), parameter :: integral_felt = 3.0_wp ! tested
   !> Error per sum of the moduli, estimated and for choosing the number of rates: moduli of
   !> opposite sign lose digits, and so do the eigenvectors of the panels; 4e-15 was measured, more
   !> for receding contact
   real(wp), parameter :: digits_lost = 2.0e-14_wp ! tested
   real(wp), parameter :: most_digits_lost = 1.0e-12_wp ! tested

   ! Data

   !> Largest rate times the first time, smallest rate times the last. With a wider range the sum
   !> departs further from the modulus outside the data, for digits that no data have: for t^-0.5
   !> these give a misfit of 2e-5 and 2.7 times the first modulus at t = 0; with 2 and 0.5 it is
   !> 1e-3 and 2.1
   real(wp), parameter :: fastest_of_data = 4.0_wp ! tested
   real(wp), parameter :: slowest_of_data = 0.25_wp ! tested
   !> Rates per decade of the first grid: for t^-0.5 the misfit is 5e-4 with 2, 2e-5 with 3 and 4
   real(wp), parameter :: rates_per_decade = 3.0_wp ! tested
   !> Refinements of the grid: the rates are then known to 0.3 %, and merging two of them costs 1e-6
   integer, parameter :: most_refinements = 8 ! tested
   !> Misfit that is good enough: the default accuracy of the COR
   real(wp), parameter :: good_misfit = 1.0e-6_wp ! tested
   !> Factor by which a refinement must reduce the residual times the square of the number of terms:
   !> for a continuous spectrum, doubling the terms keeps halving the residual
   real(wp), parameter :: least_gain = 0.7_wp ! tested
   !> Largest growth of the misfit by all merging
   real(wp), parameter :: merging_loss = 1.25_wp ! tested
   !> Samples of the data per decade; the first grid has three terms per decade
   real(wp), parameter :: samples_per_decade = 20.0_wp ! tested

end module vcor_material_tuning
