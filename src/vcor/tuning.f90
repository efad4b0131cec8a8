!> Tuning constants of the materials and the solvers
!>
!> Each states its reason. Those of the internal variables, ive_*, are the control of its
!> march
module vcor_tuning
   use vcor_kinds, only : wp
   implicit none
   public

   ! Sums of exponentials for continuous spectra

   !> Rate over that of the window below which exp(-l t) is treated as 1 - l t + ..
   real(wp), parameter :: spectrum_slow = 0.5_wp
   !> Distance in ln(l) from the peak beyond which the spectrum is a power of the rate, on the slow
   !> and on the fast side; fast rates matter less
   real(wp), parameter :: spectrum_below = 4.0_wp
   real(wp), parameter :: spectrum_above = 1.0_wp
   !> Lowest accuracy with which a sum is built
   real(wp), parameter :: spectrum_loosest = 1.0e-2_wp
   !> Share of the first node in the constant and of the last one in the dashpot, over the accuracy,
   !> above which what is beyond is added
   real(wp), parameter :: spectrum_tail = 1.0e-3_wp
   !> Refinements for spectra with features at unknown rates, and how much farther out in ln(l) the
   !> slow and the fast end begin with each
   integer, parameter :: spectrum_runs = 3
   real(wp), parameter :: spectrum_farther_below = 3.0_wp
   real(wp), parameter :: spectrum_farther_above = 5.0_wp
   !> Share of the relative error of the integral that counts for the impact: fast parts of a
   !> modulus act through their integral
   real(wp), parameter :: spectrum_integral = 0.3_wp

   ! Sums of exponentials with moduli of either sign

   !> Slowest and fastest rate of the regular grid, over that of the window, and the logarithm of
   !> the ratio of two neighbours
   real(wp), parameter :: pair_slowest = 0.2_wp
   real(wp), parameter :: pair_fast = 1.0e7_wp
   real(wp), parameter :: pair_spacing = 0.15_wp
   !> Beyond it a grid of half as many rates up to this one, for moduli such as t^-a: lumping all
   !> rates above l leaves an error of l^(a - 2)
   real(wp), parameter :: pair_fastest = 1.0e10_wp
   !> Samples per rate; the first sample over the inverse of the fastest rate
   integer, parameter :: pair_samples = 3
   real(wp), parameter :: pair_earliest = 0.3_wp
   !> Part of the window from which errors count in full; before, by this power of the time. With a
   !> higher power the sum may become negative there, with a lower one t^-a takes digits from the
   !> rest
   real(wp), parameter :: pair_full_weight = 0.03_wp
   real(wp), parameter :: pair_power = 1.5_wp
   !> Factor from the error of the integral to that of an impact, measured
   real(wp), parameter :: pair_integral = 3.0_wp
   !> Error per sum of the moduli, estimated and for choosing the number of rates: moduli of
   !> opposite sign lose digits, and so do the eigenvectors of the panels; 4e-15 was measured, more
   !> for receding contact
   real(wp), parameter :: pair_digits = 2.0e-14_wp
   real(wp), parameter :: pair_most_digits = 1.0e-12_wp

   ! Sums of exponentials for data

   !> Largest rate times the first time; its inverse is the smallest rate times the last. With a
   !> wider range the sum departs further from the modulus outside the data, for digits that no data
   !> have: for t^-0.5 it gives a misfit of 2e-5 and 2.7 times the first modulus at t = 0; with 2 it
   !> is 1e-3 and 2.1
   real(wp), parameter :: table_fastest = 4.0_wp
   !> Rates per decade of the first grid: for t^-0.5 the misfit is 5e-4 with 2, 2e-5 with 3 and 4
   real(wp), parameter :: table_rates = 3.0_wp
   !> Refinements of the grid: the rates are then known to 0.3 %, and merging two of them costs 1e-6
   integer, parameter :: table_refinements = 8
   !> Misfit that is good enough: the default accuracy of the COR
   real(wp), parameter :: table_misfit = 1.0e-6_wp
   !> Factor by which a refinement must reduce the residual times the square of the number of terms:
   !> for a continuous spectrum, doubling the terms keeps halving the residual
   real(wp), parameter :: table_gain = 0.7_wp
   !> Largest growth of the misfit by all merging
   real(wp), parameter :: table_loss = 1.25_wp
   !> Samples of the data per decade; the first grid has three terms per decade
   real(wp), parameter :: table_samples = 20.0_wp

   ! Sums of exponentials in an impact

   !> Share of the accuracy to which the kernel of the contact and the memory of a plate are
   !> approximated
   real(wp), parameter :: sum_share = 0.01_wp
   !> Error of the coefficients of restitution per relative error of the kernel
   real(wp), parameter :: sum_error = 0.3_wp
   !> Window of a sum over the expected contact time, and its growth if the contact lasts longer
   real(wp), parameter :: sum_window = 2.0_wp
   real(wp), parameter :: sum_growth = 20.0_wp

   ! Internal variables

   !> Lowest accuracy used internally: a lower one saves next to nothing, and crude panels could not
   !> be told from wrong ones
   real(wp), parameter :: ive_loosest = 1.0e-6_wp
   !> Share of the accuracy that a panel may add to the difference of the two solutions: with what
   !> is stated at least (`ive_harmless`) it is half a unit of the last digit asked for
   real(wp), parameter :: ive_share = 0.4_wp
   !> Duration of the first panel over the expected contact time: with its double, in sqrt(t), and
   !> one more panel it makes an impact
   real(wp), parameter :: ive_first = 0.1225_wp
   !> Accuracy for which lengths are given; they grow with the order of the rule
   real(wp), parameter :: ive_usual = 1.0e-8_wp
   !> With a continuous spectrum, accuracy below which the first panel is shorter. With a fifteenth
   !> of it the largest force misses the accuracy in one of nine impacts, and the march is repeated
   real(wp), parameter :: ive_continuous = 5.0e-6_wp
   !> Controller: safety, largest growth and smallest cut of a length
   real(wp), parameter :: ive_safety = 0.9_wp
   real(wp), parameter :: ive_growth = 1.5_wp
   real(wp), parameter :: ive_cut = 0.2_wp
   !> Largest excess of a panel that is accepted if a shorter one was no better
   real(wp), parameter :: ive_tolerable = 4.0_wp
   !> Newton's method: error left in x over the tolerance of a panel, which is then no part of it
   !> that counts; contraction above which the Jacobian is computed again, which contracts by about
   !> the size of the correction before
   real(wp), parameter :: ive_leftover = 1.0e-3_wp
   real(wp), parameter :: ive_contraction = 0.2_wp
   !> Rounding in the indentation of a sphere in contact under its weight, over its fall without it
   real(wp), parameter :: ive_rounding_of_fall = 7.0e-15_wp
   !> Rounding in forces and conditions of stiff modes and dashpots, relative
   real(wp), parameter :: ive_rounding = 1.0e-9_wp
   !> Number of times that an end is refused for its errors, which it may not be able to lose: with
   !> a spring of next to nothing few digits of its time are known at any length of the panel
   integer, parameter :: ive_ends = 5
   !> Largest share of the way to the end of the contact, a branch point, that a panel takes before
   !> the last one: each is then twice as long as the next
   real(wp), parameter :: ive_part = 0.67_wp
   !> What panels add to the difference may cancel: the sum of the amounts counts, up to this share
   !> of the accuracy, below which an overestimate misleads nobody
   real(wp), parameter :: ive_harmless = 0.1_wp
   !> Rounding per panel, mostly from the eigenvectors of the integration matrices
   real(wp), parameter :: ive_rounding_per_panel = 5.0e-13_wp

   ! Product integration

   !> Steps of the first run per contact time of an elastic impact, and the largest factor by which
   !> a fast glassy modulus shortens them
   integer, parameter :: direct_first_steps = 64
   real(wp), parameter :: direct_least_part = 32.0_wp
   !> Maximum number of steps: more take seconds for the sums
   integer, parameter :: direct_most_steps = 60000
   !> Multiplications of the springs of a contact that grows again after which a run is given up:
   !> they take seconds
   real(wp), parameter :: direct_most_work = 3.0e9_wp
   !> Smallest error of `cor` over that of `cor_sphere`
   real(wp), parameter :: direct_cancelled = 0.1_wp
   !> Error allowed for the largest force, over the accuracy
   real(wp), parameter :: direct_force = 10.0_wp
   !> Share of the approach that the last step of a rebound may cover
   real(wp), parameter :: direct_last_part = 0.125_wp
   !> Decay rate times step above which trapezoids are used: Adams-Moulton is stable up to 6
   real(wp), parameter :: direct_stiff = 2.0_wp
   !> Steps from t = 0 in which the rate of the drift is no parabola, and over which kernels are
   !> integrated in parts
   integer, parameter :: direct_near = 16
   !> Error of the rule of a step for alpha' of a frozen plate, over the rise of alpha, above which
   !> the step does not resolve it
   real(wp), parameter :: direct_unresolved = 0.1_wp

end module vcor_tuning
