!> The public interface of the library: all that a program needs to describe impacts, solve one or
!> many of them and write the results. Each name is documented where it is declared,
!> and used once in tests/unit/test_library.f90
module vcor
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_inputs, only : inputs_t
   use vcor_case_printed, only : case_text
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_error, only : error_file, error_input, error_numerical, error_t, error_usage
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_eq1, pair_series
   use vcor_impact_law, only : contact_law_t, new_contact_law
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_body, only : new_beam, new_block, new_panel, new_rod, support_cantilever, &
      support_clamped, support_free, support_supported
   use vcor_impact_face, only : base_bonded, base_free, base_half_space, base_sliding, face_t, &
      new_face
   use vcor_impact_structure, only : new_structure, structure_t
   use vcor_impact_target, only : new_plate, new_target, target_t, waves_constant, &
      waves_frozen, waves_hereditary, waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : contact_lasting, contact_resting, contact_separated, &
      contact_sticking, trajectory_t
   use vcor_io_case_reader, only : override, read_case, read_case_text
   use vcor_io_csv, only : write_csv
   use vcor_io_data_file, only : read_data
   use vcor_io_hdf5, only : write_hdf5
   use vcor_io_results, only : history_table, summary_table
   use vcor_io_table, only : table_t
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_mittag_leffler, only : mittag_leffler_t, new_mittag_leffler
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_material_table, only : new_tabulated, tabulated_t
   use vcor_material_type, only : material_t
   use vcor_solver, only : new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_sweep_points, only : failures_t, new_sweep, solve_sweep, sweep_t
   use vcor_sweep_quantity, only : summary_t
   use vcor_version, only : version
   implicit none
   private

   public :: wp, version
   ! errors and their codes
   public :: error_t, error_usage, error_input, error_file, error_numerical
   ! materials
   public :: material_t, prony_t, power_law_t, cerf_t, mittag_leffler_t, tabulated_t
   public :: new_rigid, new_elastic, new_sls, new_prony, new_power_law, new_cerf
   public :: new_mittag_leffler, new_tabulated
   ! an impact
   public :: contact_modulus_t, new_contact_modulus, pair_eq1, pair_series
   public :: target_t, new_plate, waves_none, waves_constant, waves_relaxing, waves_frozen
   public :: waves_hereditary
   public :: new_target, structure_t, new_structure, new_block, new_beam, new_rod, new_panel
   public :: support_supported, support_clamped, support_cantilever, support_free
   public :: face_t, new_face, base_half_space, base_free, base_bonded, base_sliding
   public :: impact_t, new_impact, contact_law_t, new_contact_law
   ! its solution
   public :: solve_impact, outcome_t, solver_settings_t, trajectory_t, solver_t, new_solver
   public :: contact_separated, contact_lasting, contact_sticking, contact_resting
   ! cases
   public :: case_t, read_case, read_case_text, override, read_data
   public :: validate, case_text, inputs_t, problem_t, problem_of_case
   ! sweeps
   public :: sweep_t, new_sweep, solve_sweep, summary_t, failures_t
   ! results
   public :: table_t, summary_table, history_table, write_csv, write_hdf5

end module vcor
