!> Constants that tune the solvers
!>
!> `benchmarks/tuning.py` varies each of them, counts instructions per impact and misses of the
!> reference impacts, and runs the tests; where a comment names no other reason, a constant stands
!> where it costs least without a miss. What came out stands behind each:
!>
!> - tested: trades time against accuracy; spoilt, it makes a test fail, mostly `test_impacts`
!> - time: trades time only
module vcor_solver_tuning
   use vcor_kinds, only : wp
   implicit none
   public

   !> The accuracy that lengths of panels are given for
   real(wp), parameter :: usual_accuracy = 1.0e-8_wp ! tested
   !> Loosest accuracy that is worked to: less would save next to nothing, and one cannot tell
   !> panels that are crude from those that are wrong
   real(wp), parameter :: loosest_accuracy = 1.0e-6_wp ! tested

   ! Sums of exponentials

   !> Share of the accuracy that the kernel is approximated to
   real(wp), parameter :: kernel_share = 0.01_wp ! tested
   !> The same of the memory of a plate, which takes a part of the motion only
   real(wp), parameter :: plate_share = 0.1_wp ! tested
   !> Error of the coefficients of restitution per relative error of the kernel
   real(wp), parameter :: error_of_kernel = 0.3_wp ! tested
   !> Time that a sum holds over the expected contact time, and the factor by which it grows where
   !> the contact outlasts it
   real(wp), parameter :: window_margin = 2.0_wp ! tested
   real(wp), parameter :: window_growth = 20.0_wp ! time
   !> The factor where the plate is a layer, whose sum is the better the tighter the window is
   real(wp), parameter :: layer_growth = 2.0_wp ! tested
   !> Time of the largest force over the window before which it is none: the sum of a layer has no
   !> rates for so short a time
   real(wp), parameter :: layer_start = 1.0e-3_wp ! tested
   !> Accuracy of `cor` on a layer where none is asked for, or one that product integration does not
   !> reach: the velocity of its face at the end is another matter than the sphere's
   real(wp), parameter :: layer_reach = 3.0e-4_wp ! tested
   !> Accuracy that an impact on a layer is worked to at best: what rings is not to be resolved
   real(wp), parameter :: layer_accuracy = 1.0e-7_wp ! tested
   !> What the motion feels of the misfit of echoes, measured: most where a layer is soft, elastic
   !> and as thick as the footprint is wide
   real(wp), parameter :: error_of_echo = 20.0_wp ! tested
   !> What the velocity of its face at the end feels of the misfit, measured between sums of other
   !> rates: most where the force ends as s^1.5
   real(wp), parameter :: error_of_layer = 1.0e3_wp ! tested

   ! Newton's method

   !> Maximum iterations
   integer, parameter :: most_iterations = 40 ! tested
   !> Correction of the end of a receding contact over the panel that may be rounding, and over the
   !> one before that no longer falls: nearly fluid contacts find no end otherwise
   real(wp), parameter :: noticeable_time = 1.0e-7_wp ! tested
   real(wp), parameter :: no_better = 0.25_wp ! tested
   !> No correction of the last panel of a receding contact goes farther than this, over its length:
   !> five of 601 impacts of a rigid sphere on a layer of rubber find no end without
   real(wp), parameter :: farthest_closing = 0.4_wp ! tested
   !> Error of a position that what follows mends
   real(wp), parameter :: roughly = 1.0e-3_wp ! time
   !> What it may leave of an error over the accuracy: of a panel; of one that is solved with the
   !> Jacobian of another, and of the condition of a rebound
   real(wp), parameter :: newton_tolerance = 1.0e-5_wp ! tested
   real(wp), parameter :: near_tolerance = 3.0e-3_wp ! tested
   !> Correction over the solution after which the Jacobian is kept: it contracts tenfold then
   real(wp), parameter :: newton_close = 0.05_wp ! tested
   !> Contraction that makes a new Jacobian
   real(wp), parameter :: slowest_contraction = 0.2_wp ! tested
   !> What rounding leaves of a correction of the condition, over the largest one
   real(wp), parameter :: rounding_of_condition = 1.0e-9_wp ! tested
   !> End of the use of the polynomials of a panel in a guess at t1 in the next one: they run away
   real(wp), parameter :: farthest_rebound = 1.2_wp ! tested

   ! First panel, in x over the square root of the expected contact time

   !> Relaxation rate over that of the contact that makes it relax within a panel
   real(wp), parameter :: fast = 3.0_wp ! tested
   !> Where the kernel relaxes within the panel, and where it does not, at the usual accuracy
   real(wp), parameter :: first_short = 0.25_wp ! tested
   real(wp), parameter :: first_slow = 0.34_wp ! tested
   !> Powers of the accuracy
   real(wp), parameter :: first_growth_fast = 0.025_wp ! tested
   real(wp), parameter :: first_growth_slow = 0.084_wp ! tested
   !> With this one three panels make an impact, where nothing is halved; with this one two
   real(wp), parameter :: first_three = 0.35_wp ! tested
   real(wp), parameter :: first_longest = 0.48_wp ! time
   !> Over `first_slow` where the contact recedes: two panels make the approach
   real(wp), parameter :: first_receding = 1.1_wp ! tested
   !> Power of the accuracy where the contact recedes: the rebound feels the solution between the
   !> ends of the panels, too
   real(wp), parameter :: first_receding_growth = 0.1_wp ! tested
   !> What a rebound feels of the error of the polynomials of the first panel for x^(2 n), 2e-5 for
   !> x^2.4, over the distance of 2 n from the next integer
   real(wp), parameter :: branch_error = 5.0e-5_wp ! tested
   !> With a continuous spectrum what the first panel adds to the error falls by `levels_base` with
   !> each halving from `levels_error` on
   real(wp), parameter :: levels_error = 3.3e-7_wp ! tested
   real(wp), parameter :: levels_base = 16.0_wp ! tested
   !> Length over that the first step was meant to have, below which a step grows in any case
   real(wp), parameter :: owed_length = 0.6_wp ! tested

   ! Acceptance of a panel

   !> Panels, refused ones included, after which a contact is given up, and a rebound
   integer, parameter :: most_panels = 20000 ! tested
   integer, parameter :: most_rebound_panels = 400 ! tested
   !> Share of the accuracy that the error of one panel may use up
   real(wp), parameter :: panel_share = 1.2_wp ! tested
   !> The same for the first panel on a frozen plate
   real(wp), parameter :: first_drift = 0.1_wp ! tested
   !> Error over what it may be that can be put up with if it is inherited
   real(wp), parameter :: tolerable = 4.0_wp ! tested
   !> A panel is longer than the one before by this factor at most
   real(wp), parameter :: longest_growth = 3.0_wp ! tested
   !> Error of the largest force over the accuracy, and of the force elsewhere over that
   real(wp), parameter :: peak_share = 10.0_wp ! tested
   real(wp), parameter :: force_share = 1.0e3_wp ! tested
   !> What rounding leaves in the force of stiff internal variables and dashpots, over the largest
   !> one: it is not to stop the march of nearly fluid contacts (tests/cli/test_results.py)
   real(wp), parameter :: rounding_of_force = 1.0e-12_wp ! tested
   !> Difference of the contact times over the accuracy that is let pass with a continuous spectrum
   !> in one panel up to the end, and the least one
   real(wp), parameter :: time_share_continuous = 1.5_wp ! time
   real(wp), parameter :: best_time = 1.0e-9_wp ! tested
   !> What a rebound feels of the difference of the two solutions inside a panel, measured, and the
   !> share of the accuracy that it may have
   real(wp), parameter :: inner_felt = 5.0e-3_wp ! tested
   real(wp), parameter :: inner_allowed = 0.3_wp ! tested

   ! End of the contact

   !> Share of the accuracy that the time of the end may have, and the share of that of the square
   !> of the distance to the zero of a force that is linear there
   real(wp), parameter :: landing_share = 0.1_wp ! tested
   real(wp), parameter :: share_of_square = 1.0e-2_wp ! tested
   !> Indentation at the end over the largest one below which it is no smooth end, and what the
   !> difference that the panel adds to the forces counts there
   real(wp), parameter :: shallow_end = 0.01_wp ! tested
   real(wp), parameter :: shallow_factor = 100.0_wp ! tested
   !> Indentation at the end of the last panel over that at its start that is next to the branch
   !> point of u: from one number of stages to the next the error falls by half only, elsewhere by
   !> `usually_better` at least
   real(wp), parameter :: next_to_branch = 0.05_wp ! tested
   real(wp), parameter :: usually_better = 10.0_wp ! tested
   !> The panel before an end that was refused comes this close to it
   real(wp), parameter :: cut_at_end = 0.65_wp ! tested
   !> The most panels that lead to an end next to a branch point before it is tried again
   real(wp), parameter :: most_ahead = 6.0_wp ! tested

   ! Estimate of the error

   !> Difference of the solution to its companion over its error, and its power where less than the
   !> usual accuracy is asked for
   real(wp), parameter :: better = 3.0_wp ! tested
   real(wp), parameter :: better_power = 0.2_wp ! tested
   !> What one panel adds to the difference may cancel in the next ones: it counts, but only up to
   !> this share of the accuracy, below which an estimate that is too large misleads nobody
   real(wp), parameter :: harmless = 0.1_wp ! tested
   !> What rounding may add per panel, mostly through the eigenvectors of the integration matrices
   real(wp), parameter :: rounding_per_panel = 5.0e-13_wp ! tested

   ! Maxima

   !> Error of the position of the largest indentation, by polynomials, that it is looked for from
   real(wp), parameter :: peak_guess = 1.0e-8_wp ! tested
   !> Error of the position of a maximum: its square is what the maximum feels
   real(wp), parameter :: peak_position = 1.0e-6_wp ! tested
   !> The force is better than that of the companion by this factor at least
   real(wp), parameter :: force_better = 3.0_wp ! tested
   !> Difference of the largest force, at the end of a panel, to that of the companion, over the
   !> accuracy, from which on it is solved anew although its improvement has changed little: with
   !> fractional kernels it is 60 times the error
   real(wp), parameter :: force_unsure = 40.0_wp ! tested

   ! Rebound: times over that of the approach

   !> Duration, and rate of t1, to begin with
   real(wp), parameter :: expected_rebound = 1.0_wp ! tested
   real(wp), parameter :: first_rate = -1.2_wp ! time
   !> First panel where the kernel relaxes within it, where it does not, where the spectra of
   !> contact and plate are continuous; power of the accuracy
   real(wp), parameter :: rebound_fast = 0.50_wp ! time
   real(wp), parameter :: rebound_slow = 0.58_wp ! time
   real(wp), parameter :: rebound_hereditary = 0.36_wp ! time
   real(wp), parameter :: rebound_growth = 0.12_wp ! time
   !> Last panel likewise, and with a continuous spectrum of the contact
   real(wp), parameter :: end_fast = 0.54_wp ! time
   real(wp), parameter :: end_slow = 0.48_wp ! tested
   real(wp), parameter :: end_continuous = 0.27_wp ! time
   real(wp), parameter :: end_hereditary = 0.1_wp ! time
   real(wp), parameter :: end_growth = 0.12_wp ! tested
   real(wp), parameter :: end_hereditary_growth = 0.3_wp ! time
   !> Share of the rest that a panel takes, and what is left of the rest for the last panel
   real(wp), parameter :: smallest_share = 0.45_wp ! time
   real(wp), parameter :: largest_share = 0.67_wp ! time
   real(wp), parameter :: margin_of_rest = 0.95_wp ! tested
   !> A refused panel is cut to this share of its length at most, aiming at this error over what is
   !> allowed, which falls with this order of the last panel at least
   real(wp), parameter :: cut_least = 0.8_wp ! time
   real(wp), parameter :: aim = 0.3_wp ! tested
   real(wp), parameter :: order_at_end = 3.0_wp ! tested
   !> How often the end is tried before an error that is inherited is put up with
   integer, parameter :: enough_closings = 5 ! tested
   !> Error of the time of the end over the accuracy
   real(wp), parameter :: closest_end = 0.1_wp ! tested
   !> t1 at the end, extrapolated, over that at the start of the last panel, that is zero
   real(wp), parameter :: close_to_zero = 0.3_wp ! tested
   !> What is left of the rate of t1' where a parabola goes on
   real(wp), parameter :: bend_kept = 0.6_wp ! time
   !> Of what t1 falls, as a guess, and for how long
   real(wp), parameter :: slowest_fall = 0.5_wp ! tested
   real(wp), parameter :: near_vertex = 0.1_wp ! tested
   !> Share of the way to the largest indentation that a correction of t1 goes at most
   real(wp), parameter :: closest_to_vertex = 0.9_wp ! tested
   !> exp(-this) is nothing
   real(wp), parameter :: gone = 42.0_wp ! time
   !> Part of a panel in which t1 rises, from its start, that is short enough to be sure of that
   real(wp), parameter :: sure_growth = 0.1_wp ! tested

   ! Product integration

   !> Steps of the first run in the contact time of an elastic impact, and the least part of that
   !> time that a fast glassy modulus may make of it
   integer, parameter :: first_steps = 64 ! tested
   real(wp), parameter :: least_part = 32.0_wp ! tested
   !> A run of more steps is given up: its sums take seconds, or the compliance of a layer does
   integer, parameter :: most_for_all = 60000 ! tested
   integer, parameter :: most_for_layers = 8000 ! tested
   !> Steps beyond which the face of a layer is not followed for the sake of `cor` alone
   integer, parameter :: enough_steps = 1000 ! tested
   !> Least error of `cor` over that of `cor_sphere`
   real(wp), parameter :: cancelled = 0.1_wp ! tested
   !> Error of the largest force over the accuracy
   real(wp), parameter :: share_of_force = 10.0_wp ! tested
   !> Part of the approach that the last step of a rebound may take back
   real(wp), parameter :: last_part = 0.125_wp ! tested
   !> Decay rate times the step from which on trapezoids are used: Adams and Moulton's rule is
   !> stable up to 6
   real(wp), parameter :: stiff_step = 2.0_wp ! tested
   !> Steps next to t = 0 on which the rate of the drift is no parabola, and over which kernels are
   !> integrated in parts
   integer, parameter :: near_drift = 16 ! tested
   integer, parameter :: near_kernel = 16 ! tested
   !> What the rule over a step makes of alpha' of a frozen plate may be off by, over the rise of
   !> alpha in the step: beyond, the step does not resolve it
   real(wp), parameter :: unresolved_rise = 0.1_wp ! tested
   !> Share of the changes of a layer's weights after the last one that is added to the first ones;
   !> the root of its inverse is what errors of the compliance grow by in the last ones
   real(wp), parameter :: aliased = 1.0e-6_wp ! tested
   !> Distance of the exponent from an integer that is none: the force is smooth at first
   real(wp), parameter :: next_to_integer = 1.0e-3_wp ! tested

end module vcor_solver_tuning
