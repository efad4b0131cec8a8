!> Tuning constants of the materials and the solvers
!>
!> `benchmarks/tuning.py` varies each constant, and counts instructions per impact and reference
!> impacts that miss their accuracy. Unless a comment gives another reason, a constant has the value
!> of least cost without a miss. Each is guarded: `benchmarks/tuning.py --spoil` names a factor,
!> mostly 0.03 or 30, and a test that fails with it.
module vcor_tuning
   use vcor_kinds, only : wp
   implicit none
   public

   ! Sums of exponentials for continuous spectra

   !> Rate over that of the window below which exp(-l t) is treated as 1 - l t + ..
   real(wp), parameter :: slow_run = 0.5_wp
   !> Distance in ln(l) from the peak beyond which the spectrum is a power of the rate, on the slow
   !> and on the fast side; fast rates matter less
   real(wp), parameter :: below_peak = 4.0_wp
   real(wp), parameter :: above_peak = 1.0_wp
   !> Lowest accuracy with which a sum is built
   real(wp), parameter :: loosest_sum = 1.0e-2_wp
   !> Share of the last node in the dashpot, over the accuracy, above which what is beyond is added
   real(wp), parameter :: negligible_tail = 1.0e-3_wp
   !> Refinements for spectra with features at unknown rates, and how much farther out in ln(l) the
   !> slow and the fast end begin with each
   integer, parameter :: most_runs = 3
   real(wp), parameter :: farther_below = 3.0_wp
   real(wp), parameter :: farther_above = 5.0_wp
   !> Share of the relative error of the integral that counts for the impact: fast parts of a
   !> modulus act through their integral
   real(wp), parameter :: share_of_integral = 0.3_wp

   ! Sums of exponentials with moduli of either sign

   !> Slowest and fastest rate of the regular grid, over that of the window, and the logarithm of
   !> the ratio of two neighbours
   real(wp), parameter :: slowest_rate = 0.2_wp
   real(wp), parameter :: fast_rate = 1.0e7_wp
   real(wp), parameter :: rate_spacing = 0.15_wp
   !> Beyond it a coarser grid up to this rate, for moduli such as t^-a: lumping all rates above l
   !> leaves an error of l^(a - 2)
   real(wp), parameter :: fastest_rate = 1.0e10_wp
   real(wp), parameter :: wide_spacing = 0.3_wp
   !> Samples per rate; the first sample over the inverse of the fastest rate
   integer, parameter :: samples_per_rate = 3
   real(wp), parameter :: earliest_sample = 0.3_wp
   !> Part of the window from which errors count in full; before, by this power of the time. With a
   !> higher power the sum may become negative there, with a lower one t^-a takes digits from the
   !> rest
   real(wp), parameter :: full_weight = 0.03_wp
   real(wp), parameter :: weight_power = 1.5_wp
   !> Factor from the error of the integral to that of an impact, measured
   real(wp), parameter :: integral_felt = 3.0_wp
   !> Error per sum of the moduli, estimated and for choosing the number of rates: moduli of
   !> opposite sign lose digits, and so do the eigenvectors of the panels; 4e-15 was measured, more
   !> for receding contact
   real(wp), parameter :: digits_lost = 2.0e-14_wp
   real(wp), parameter :: most_digits_lost = 1.0e-12_wp

   ! Sums of exponentials for data

   !> Largest rate times the first time, smallest rate times the last. With a wider range the sum
   !> departs further from the modulus outside the data, for digits that no data have: for t^-0.5
   !> these give a misfit of 2e-5 and 2.7 times the first modulus at t = 0; with 2 and 0.5 it is
   !> 1e-3 and 2.1
   real(wp), parameter :: fastest_of_data = 4.0_wp
   real(wp), parameter :: slowest_of_data = 0.25_wp
   !> Rates per decade of the first grid: for t^-0.5 the misfit is 5e-4 with 2, 2e-5 with 3 and 4
   real(wp), parameter :: rates_per_decade = 3.0_wp
   !> Refinements of the grid: the rates are then known to 0.3 %, and merging two of them costs 1e-6
   integer, parameter :: most_refinements = 8
   !> Misfit that is good enough: the default accuracy of the COR
   real(wp), parameter :: good_misfit = 1.0e-6_wp
   !> Factor by which a refinement must reduce the residual times the square of the number of terms:
   !> for a continuous spectrum, doubling the terms keeps halving the residual
   real(wp), parameter :: least_gain = 0.7_wp
   !> Largest growth of the misfit by all merging
   real(wp), parameter :: merging_loss = 1.25_wp
   !> Samples of the data per decade; the first grid has three terms per decade
   real(wp), parameter :: samples_per_decade = 20.0_wp

   ! All solvers

   !> Accuracy for which the lengths of panels below are given
   real(wp), parameter :: usual_accuracy = 1.0e-8_wp
   !> Lowest accuracy used internally: a lower one saves next to nothing, and crude panels could not
   !> be told from wrong ones
   real(wp), parameter :: loosest_accuracy = 1.0e-6_wp

   ! Sums of exponentials in an impact

   !> Share of the accuracy to which the kernel is approximated
   real(wp), parameter :: kernel_share = 0.01_wp
   !> The same for the memory of a plate, which carries only a part of the motion
   real(wp), parameter :: plate_share = 0.1_wp
   !> Error of the coefficients of restitution per relative error of the kernel
   real(wp), parameter :: error_of_kernel = 0.3_wp
   !> Window of a sum over the expected contact time, and its growth if the contact lasts longer
   real(wp), parameter :: window_margin = 2.0_wp
   real(wp), parameter :: window_growth = 20.0_wp

   ! Newton's method

   !> Maximum iterations
   integer, parameter :: most_iterations = 40
   !> Correction of the end of a receding contact, over the panel, that may be rounding, and over
   !> the previous correction, that no longer falls: nearly fluid contacts find no end otherwise
   real(wp), parameter :: noticeable_time = 1.0e-7_wp
   real(wp), parameter :: no_better = 0.25_wp
   !> Largest correction of the length of the last panel of a receding contact, relative: without it
   !> five of 601 impacts of a rigid sphere on a layer of rubber find no end
   real(wp), parameter :: farthest_closing = 0.4_wp
   !> Error of a position that later steps correct
   real(wp), parameter :: roughly = 1.0e-3_wp
   !> Error that Newton's method may leave, over the accuracy: of a panel; of a panel solved with
   !> the Jacobian of another, and of the condition of a rebound
   real(wp), parameter :: newton_tolerance = 1.0e-5_wp
   real(wp), parameter :: near_tolerance = 3.0e-3_wp
   !> Relative correction up to which the Jacobian is kept: it then contracts tenfold
   real(wp), parameter :: newton_close = 0.05_wp
   !> Contraction above which the Jacobian is computed again
   real(wp), parameter :: slowest_contraction = 0.2_wp
   !> Rounding in a correction of the condition, over the largest condition
   real(wp), parameter :: rounding_of_condition = 1.0e-9_wp
   !> Largest theta at which the polynomials of a panel are a guess of t1 in the next: they diverge
   real(wp), parameter :: farthest_rebound = 1.2_wp

   ! First panel: its length in x = sqrt(t), over the square root of the expected contact time

   !> Relaxation rate times time scale above which a mode relaxes within a panel
   real(wp), parameter :: fast = 3.0_wp
   !> Length if the kernel relaxes within the panel, and if it does not, at the usual accuracy
   real(wp), parameter :: first_short = 0.25_wp
   real(wp), parameter :: first_slow = 0.34_wp
   !> Exponents of the accuracy in these lengths
   real(wp), parameter :: first_growth_fast = 0.025_wp
   real(wp), parameter :: first_growth_slow = 0.084_wp
   !> Length with which an impact takes three panels, if none is halved, and length for two panels
   real(wp), parameter :: first_three = 0.35_wp
   real(wp), parameter :: first_longest = 0.48_wp
   !> Factor of `first_slow` for a receding contact: the approach takes two panels
   real(wp), parameter :: first_receding = 1.1_wp
   !> Exponent of the accuracy for a receding contact, whose rebound also depends on the solution
   !> between the ends of the panels
   real(wp), parameter :: first_receding_growth = 0.1_wp
   !> Error of a rebound due to the polynomials of the first panel for x^(2 n), over the distance of
   !> 2 n from the nearest integer: 2e-5 for x^2.4
   real(wp), parameter :: branch_error = 5.0e-5_wp
   !> With a continuous spectrum: the error due to the first panel, and the factor by which each
   !> halving reduces it
   real(wp), parameter :: levels_error = 3.3e-7_wp
   real(wp), parameter :: levels_base = 16.0_wp
   !> Length over `reach`, the nominal length of the first step, below which steps grow in any case
   real(wp), parameter :: owed_length = 0.6_wp

   ! Acceptance of a panel

   !> Maximum number of panels, including refused ones, of a contact and of a rebound
   integer, parameter :: most_panels = 20000
   integer, parameter :: most_rebound_panels = 400
   !> Share of the accuracy allowed for the error of one panel
   real(wp), parameter :: panel_share = 1.2_wp
   !> The same for the first panel on a frozen plate
   real(wp), parameter :: first_drift = 0.1_wp
   !> Largest ratio of the error to the allowed error that is accepted if the error is inherited
   real(wp), parameter :: tolerable = 4.0_wp
   !> Largest ratio of the length of a panel to that of the one before
   real(wp), parameter :: longest_growth = 3.0_wp
   !> Error allowed for the largest force, over the accuracy, and for the force elsewhere, over that
   real(wp), parameter :: peak_share = 10.0_wp
   real(wp), parameter :: force_share = 1.0e3_wp
   !> Rounding in the force of stiff internal variables and dashpots, over the largest force: it
   !> must not stop nearly fluid contacts (tests/cli/test_results.py)
   real(wp), parameter :: rounding_of_force = 1.0e-12_wp
   !> Difference of the contact times of the two solutions that is allowed: over the accuracy, for
   !> one panel up to the end with a continuous spectrum, and at least
   real(wp), parameter :: time_share_continuous = 1.5_wp
   real(wp), parameter :: best_time = 1.0e-9_wp
   !> Error of a rebound over the difference of the two solutions inside a panel, measured, and the
   !> share of the accuracy allowed for it
   real(wp), parameter :: inner_felt = 5.0e-3_wp
   real(wp), parameter :: inner_allowed = 0.3_wp

   ! End of the contact

   !> Share of the accuracy allowed for the time of the end, and the share of this for the square of
   !> the distance to the zero of a force that is linear there
   real(wp), parameter :: landing_share = 0.1_wp
   real(wp), parameter :: share_of_square = 1.0e-2_wp
   !> Indentation at the end over the largest one below which the end is not smooth, and the weight
   !> there of what the panel adds to the difference of the forces
   real(wp), parameter :: shallow_end = 0.01_wp
   real(wp), parameter :: shallow_factor = 100.0_wp
   !> Indentation at the end of the last panel over that at its start below which the branch point
   !> of u is near: one more stage only halves the error there; elsewhere it reduces it by a factor
   !> `usually_better` at least
   real(wp), parameter :: next_to_branch = 0.05_wp
   real(wp), parameter :: usually_better = 10.0_wp
   !> Share of the time to a refused end that the next panel takes
   real(wp), parameter :: cut_at_end = 0.65_wp
   !> Maximum number of panels before an end next to a branch point is tried again
   real(wp), parameter :: most_ahead = 6.0_wp

   ! Estimate of the error

   !> Difference of the solution to its companion over its error, and the exponent by which this
   !> falls for accuracies lower than the usual one
   real(wp), parameter :: better = 3.0_wp
   real(wp), parameter :: better_power = 0.2_wp
   !> What panels add to the difference may cancel. The largest addition counts, but only up to this
   !> share of the accuracy, below which an overestimate misleads nobody
   real(wp), parameter :: harmless = 0.1_wp
   !> Rounding in the indentation of a sphere in contact under its weight, over its fall without it
   real(wp), parameter :: rounding_of_fall = 7.0e-15_wp
   !> Rounding per panel, mostly from the eigenvectors of the integration matrices
   real(wp), parameter :: rounding_per_panel = 5.0e-13_wp

   ! Maxima

   !> Error of the position of the largest indentation by polynomials, where Newton's method starts
   real(wp), parameter :: peak_guess = 1.0e-8_wp
   !> Error of the position of a maximum; the maximum feels its square
   real(wp), parameter :: peak_position = 1.0e-6_wp
   !> Factor by which the force is at least more accurate than that of the companion
   real(wp), parameter :: force_better = 3.0_wp
   !> For a maximum at the end of a panel: difference to the force of the companion, over the
   !> accuracy, above which it is computed again even if the improvement has changed it little. With
   !> fractional kernels the difference is 60 times the error
   real(wp), parameter :: force_unsure = 40.0_wp

   ! Rebound: times are over that of the approach

   !> Duration and rate of t1, initial guesses
   real(wp), parameter :: expected_rebound = 1.0_wp
   real(wp), parameter :: first_rate = -1.2_wp
   !> First panel: if the kernel relaxes within it, if it does not, and with continuous spectra of
   !> contact and plate; exponent of the accuracy
   real(wp), parameter :: rebound_fast = 0.50_wp
   real(wp), parameter :: rebound_slow = 0.58_wp
   real(wp), parameter :: rebound_hereditary = 0.36_wp
   real(wp), parameter :: rebound_growth = 0.12_wp
   !> Last panel, likewise, and with a continuous spectrum of the contact alone
   real(wp), parameter :: end_fast = 0.54_wp
   real(wp), parameter :: end_slow = 0.48_wp
   real(wp), parameter :: end_continuous = 0.27_wp
   real(wp), parameter :: end_hereditary = 0.1_wp
   real(wp), parameter :: end_growth = 0.12_wp
   real(wp), parameter :: end_hereditary_growth = 0.3_wp
   !> Shares of the remaining time that a panel takes, and margin for the last panel
   real(wp), parameter :: smallest_share = 0.45_wp
   real(wp), parameter :: largest_share = 0.67_wp
   real(wp), parameter :: margin_of_rest = 0.95_wp
   !> A refused panel is cut to this share of its length at most, aiming at this error over the
   !> allowed one; order with which the error of the last panel falls at least
   real(wp), parameter :: cut_least = 0.8_wp
   real(wp), parameter :: aim = 0.3_wp
   real(wp), parameter :: order_at_end = 3.0_wp
   !> Attempts at the end after which an inherited error is accepted
   integer, parameter :: enough_closings = 5
   !> Error allowed for the time of the end, over the accuracy
   real(wp), parameter :: closest_end = 0.1_wp
   !> Extrapolated t1 at the end that counts as zero, over that at the start of the last panel
   real(wp), parameter :: close_to_zero = 0.3_wp
   !> Share of the second derivative of t1 that its extrapolation by a parabola keeps
   real(wp), parameter :: bend_kept = 0.6_wp
   !> Slowest fall of t1 in a guess, and the time after the vertex for which it holds
   real(wp), parameter :: slowest_fall = 0.5_wp
   real(wp), parameter :: near_vertex = 0.1_wp
   !> Largest share of the distance to the largest indentation by which t1 is corrected
   real(wp), parameter :: closest_to_vertex = 0.9_wp
   !> exp(-this) is negligible
   real(wp), parameter :: gone = 42.0_wp
   !> Part of a panel in which t1 rises, from its start, that is short enough to be certain
   real(wp), parameter :: sure_growth = 0.1_wp

   ! Product integration

   !> Steps of the first run per contact time of an elastic impact, and the largest factor by which
   !> a fast glassy modulus shortens them
   integer, parameter :: first_steps = 64
   real(wp), parameter :: least_part = 32.0_wp
   !> Maximum number of steps: more take seconds for the sums
   integer, parameter :: most_for_all = 60000
   !> Multiplications of the springs of a contact that grows again after which a run is given up:
   !> they take seconds
   real(wp), parameter :: most_work = 3.0e9_wp
   !> Smallest error of `cor` over that of `cor_sphere`
   real(wp), parameter :: cancelled = 0.1_wp
   !> Error allowed for the largest force, over the accuracy
   real(wp), parameter :: share_of_force = 10.0_wp
   !> Share of the approach that the last step of a rebound may cover
   real(wp), parameter :: last_part = 0.125_wp
   !> Decay rate times step above which trapezoids are used: Adams-Moulton is stable up to 6
   real(wp), parameter :: stiff_step = 2.0_wp
   !> Steps from t = 0 in which the rate of the drift is no parabola, and over which kernels are
   !> integrated in parts
   integer, parameter :: near_drift = 16
   integer, parameter :: near_kernel = 16
   !> Error of the rule of a step for alpha' of a frozen plate, over the rise of alpha, above which
   !> the step does not resolve it
   real(wp), parameter :: unresolved_rise = 0.1_wp

end module vcor_tuning
