!> Tuning constants of the materials and the solvers
!>
!> Each states its reason. Those of the internal variables, ive_*, are the control of its
!> march
module vcor_tuning
   use vcor_kinds, only : wp
   implicit none
   public

   ! Iterations that end when a correction is rounding

   !> Their bound, for numbers that are not finite: Newton's method takes a dozen, the bisection
   !> that safeguards it some sixty
   integer, parameter :: most_iterations = 200

   ! Sums of exponentials for continuous spectra

   !> Power of the accuracy by which the rule for a spectrum with features at unknown rates is made
   !> finer: with 1.5 and 2 the sum has 1.2 and 1.5 times as many terms as it needs
   real(wp), parameter :: spectrum_finer = 1.3_wp
   !> Number of terms beyond which it is made no finer for the memory of a plate: they take 20 ms
   integer, parameter :: spectrum_most = 20000

   ! Sums of exponentials with moduli of either sign

   !> Logarithm of the ratio of two neighbouring rates: with 0.2 errors of 290 random pairs grow
   !> tenfold
   real(wp), parameter :: pair_spacing = 0.15_wp
   !> Rate over that of the window above which a few cover many decades: 1e7 makes 13 % more terms,
   !> with 1e5 errors of those pairs grow tenfold
   real(wp), parameter :: pair_fast = 1.0e6_wp
   !> Part of a column that does not depend on those before it, over the first one, below which it
   !> is left out: with 1e-11 the sum for two standard linear solids is off by 8e-10 (2e-11); with
   !> 1e-13 large moduli lose digits, and six of 72 impacts with pairs of rough tables do not come
   !> to their end (two)
   real(wp), parameter :: pair_independent = 1.0e-12_wp

   ! Sums of exponentials for data

   !> Largest rate times the first time; its inverse is the smallest rate times the last. With a
   !> wider range the sum departs further from the modulus outside the data, for digits that no data
   !> have: for t^-0.5 it gives a misfit of 2e-5 and 2.7 times the first modulus at t = 0; with 2 it
   !> is 1e-3 and 2.1
   real(wp), parameter :: table_fastest = 4.0_wp
   !> Rates per decade of the first grid: for t^-0.5 the misfit is 5e-4 with 2, 2e-5 with 3 and 4
   real(wp), parameter :: table_rates = 3.0_wp
   !> Misfit that is good enough: the default accuracy of the COR
   real(wp), parameter :: table_misfit = 1.0e-6_wp

   ! All sums of exponentials

   !> Samples per rate to which moduli are fitted: with 3 a power law as a table takes more terms,
   !> and errors of three of 72 impacts with pairs of tables are twice to four times what is stated
   integer, parameter :: sum_samples = 4
   !> Number of exponentials beyond which one with moduli of either sign is fitted: each takes 1 us
   !> per impact; fitting a hundred takes 6 ms if the factors are not yet made
   integer, parameter :: sum_most = 400
   !> Share of the accuracy to which the kernel of the contact and the memory of a plate are
   !> approximated: ten times it saves 13 % of the terms, but no time, as more sums are made again
   real(wp), parameter :: sum_share = 0.01_wp
   !> Window of a sum over the expected contact time; contacts that last longer are marched again
   real(wp), parameter :: sum_window = 2.0_wp

   ! Internal variables

   !> Lowest accuracy used internally: a lower one saves hardly any time, and crude panels could not
   !> be told from wrong ones
   real(wp), parameter :: ive_loosest = 1.0e-6_wp
   !> Share of the accuracy that a panel may add to the difference of the two solutions: with what
   !> is stated at least (`ive_harmless`) it is half a unit of the last digit asked for
   real(wp), parameter :: ive_share = 0.4_wp
   !> Duration of the first panel over the expected contact time and the power of the tolerance by
   !> which the rule converges: at the usual accuracy of 1e-8 an eighth of the time. With its
   !> double, in sqrt(t), and one more panel it makes an impact
   real(wp), parameter :: ive_first = 0.457_wp
   !> Impulse of the modes that settle within the first panel, over what a panel may add to the
   !> difference: it is this many times the error, or more
   real(wp), parameter :: ive_settling = 100.0_wp
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
   !> Largest share of the way to the end of the contact, a branch point, that a panel takes before
   !> the last one: each is then twice as long as the next
   real(wp), parameter :: ive_part = 0.67_wp
   !> What panels add to the difference may cancel: the sum of the amounts counts, up to this share
   !> of the accuracy, below which an overestimate does no harm
   real(wp), parameter :: ive_harmless = 0.1_wp
   !> Rounding per panel, mostly from the eigenvectors of the integration matrices
   real(wp), parameter :: ive_rounding_per_panel = 5.0e-13_wp

   ! Product integration

   !> Steps of the first run per contact time of an elastic impact: with 64 one more of 3,648
   !> impacts is off by more than the 1e-6 asked for
   integer, parameter :: direct_first_steps = 128
   !> Multiplications after which a run is given up: they take seconds
   real(wp), parameter :: direct_most_work = 3.0e9_wp
   !> Error allowed for the largest force, over the accuracy: with 1 runs take a fifth longer
   real(wp), parameter :: direct_force = 10.0_wp
   !> Steps from t = 0 over which kernels are integrated in parts
   integer, parameter :: direct_near = 16

end module vcor_tuning
