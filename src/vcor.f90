!> The public interface of the library: everything a program needs, re-exported
module vcor
   use vcor_error, only : code_meanings, code_names, error_file, error_input, error_internal, &
      error_numerical, error_t, error_usage, raise
   use vcor_figure_build, only : build_figure, figure_kinds => kinds, legend_t, read_result, &
      result_t, usual_kind
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_eq1, pair_series
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_plate, only : new_plate, plate_t, waves_constant, waves_frozen, &
      waves_hereditary, waves_none, waves_relaxing
   use vcor_impact_law, only : contact_law_t, new_contact_law
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : contact_lasting, contact_separated, contact_sticking, &
      trajectory_t
   use vcor_io_case_reader, only : override, read_case, read_case_text
   use vcor_io_checkpoint, only : attach, checkpoint_t, create_checkpoint, open_checkpoint
   use vcor_io_checkpoint_points, only : read_points, read_results
   use vcor_io_csv, only : write_csv, write_rows
   use vcor_io_data_file, only : data_file, read_data
   use vcor_io_drawing, only : draw, split_path
   use vcor_io_figure, only : figure_t
   use vcor_io_file, only : move_file, remove_all_scratch, stderr_is_terminal, write_file, &
      write_stdout, write_terminal
   use vcor_io_gnuplot, only : figure_formats => formats
   use vcor_io_hdf5, only : remark_t, write_hdf5
   use vcor_io_identity, only : check_same, identity_of, identity_t, number_of, read_csv_identity, &
      read_identity, remarks_of
   use vcor_io_moduli_tables, only : moduli_tables
   use vcor_text, only : integer_text, printable, real_text
   use vcor_io_path, only : anything_at, check_plain, directory_exists, file_exists, join_path, &
      make_directory, plain_file_exists, quoted_path, same_file
   use vcor_case_real, only : read_real
   use vcor_io_results, only : history_table, summary_table, write_summary
   use vcor_io_table, only : place_in_table, table_t
   use vcor_io_sample_file, only : read_samples, reading_t, standard_input
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_fit, only : fit_material, fit_models, fit_t, fixable_parameters, parameter_t, &
      samples_t, state_bound, state_fixed, state_free, unseen_earlier, unseen_later
   use vcor_material_mittag_leffler, only : mittag_leffler_t, new_mittag_leffler
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_material_table, only : new_tabulated, tabulated_t
   use vcor_solver, only : default_accuracy, method_for, new_solver, solve_impact, &
      solver_settings_t, solver_t
   use vcor_case_axes, only : new_grid
   use vcor_case_build, only : build_impact, build_material, build_solver
   use vcor_case_case, only : case_t
   use vcor_verify_comparison, only : compare
   use vcor_verify_attempt, only : attempt_t
   use vcor_verify_judge, only : error_of_best, is_honest
   use vcor_verify_comparison_type, only : attempt_case, attempt_count, attempt_first, &
      attempt_halved, attempt_refined, compared_t, comparison_t
   use vcor_sweep_failures, only : failure_t, failures_t
   use vcor_case_grid, only : axis_t, grid_t
   use vcor_case_identified, only : material_text, put_material
   use vcor_case_catalogue, only : catalogue, group_t, groups, key_t, kind_name, range_text, &
      & text_key
   use vcor_verify_models, only : model_t, solve_models
   use vcor_study_moduli, only : compute_moduli, curves_t, loss_tangent, moduli_t, &
      sampled_times, time_range_t
   use vcor_sweep_mpi, only : differs, join_ranks, largest, leave_ranks, rank_count, &
      share_error, this_rank
   use vcor_case_name, only : control_in, name_flaw
   use vcor_nearest, only : nearest_name, suggestion
   use vcor_sweep_part, only : new_part, part_t
   use vcor_case_path, only : material_names
   use vcor_sweep_points, only : default_threads, monitor_t, most_threads, solve_points
   use vcor_sweep_quantity, only : history_quantities, point_failed, point_invalid, &
      point_pending, quantities, quantity_names, quantity_t, quantity_value, status_name, &
      status_t, statuses
   use vcor_study_reliance, only : find_reliance, reliance_t, solve_case
   use vcor_sweep_summary, only : new_summary, row_of, summary_t
   use vcor_sweep_sweep, only : new_sweep, single_impact, solve_point, sweep_t, worker_t
   use vcor_case_unread, only : refuse_unread
   use vcor_io_units, only : frequency_units, modulus_units, time_units
   use vcor_verify_table, only : build_law, law_count, verify_law
   use vcor_verify_row, only : law_t, row_t, verdict_t
   use vcor_version, only : version
   implicit none
   private

   public :: wp, version
   public :: error_t, raise
   public :: error_internal, error_usage, error_input, error_file, error_numerical
   public :: code_names, code_meanings
   public :: material_t, material_data_t, new_material
   public :: prony_t, power_law_t, cerf_t, mittag_leffler_t, tabulated_t
   public :: new_rigid, new_elastic, new_sls, new_prony, new_power_law, new_cerf
   public :: new_mittag_leffler, new_tabulated
   public :: contact_modulus_t, new_contact_modulus, pair_eq1, pair_series
   public :: plate_t, new_plate, waves_none, waves_constant, waves_relaxing, waves_frozen
   public :: waves_hereditary
   public :: impact_t, new_impact, contact_law_t, new_contact_law
   public :: solver_t, solver_settings_t, new_solver, solve_impact, method_for, default_accuracy
   public :: trajectory_t, contact_separated, contact_lasting, contact_sticking
   public :: outcome_t, evaluate
   public :: case_t, read_case, read_case_text, override, refuse_unread, read_data, data_file
   public :: build_impact, build_material, build_solver
   public :: quantity_t, quantities, history_quantities, quantity_names, quantity_value
   public :: status_t, statuses, status_name
   public :: axis_t, grid_t, sweep_t, new_sweep, single_impact, worker_t, solve_point, solve_points
   public :: summary_t, new_summary, row_of, failure_t, failures_t, point_invalid, point_failed
   public :: point_pending
   public :: default_threads, most_threads
   public :: law_t, row_t, verdict_t, law_count, build_law, verify_law
   public :: comparison_t, attempt_t, compared_t, compare, is_honest, error_of_best
   public :: attempt_count, attempt_case, attempt_first, attempt_refined, attempt_halved
   public :: model_t, solve_models
   public :: key_t, group_t, catalogue, groups, range_text, kind_name, text_key
   public :: table_t, summary_table, history_table, write_csv, write_hdf5
   public :: place_in_table, write_rows
   public :: part_t, new_part, monitor_t, new_grid
   public :: join_ranks, leave_ranks, this_rank, rank_count, share_error, largest, differs
   public :: identity_t, identity_of, read_identity, read_csv_identity, remarks_of, check_same
   public :: number_of, checkpoint_t, create_checkpoint, open_checkpoint, attach, read_points, &
      read_results
   public :: remark_t, write_summary
   public :: samples_t, reading_t, read_samples, standard_input, fit_t, parameter_t, fit_material
   public :: fit_models, fixable_parameters, state_free, state_fixed, state_bound
   public :: unseen_earlier, unseen_later
   public :: material_text, put_material, reliance_t, find_reliance, solve_case
   public :: sampled_times, time_units, frequency_units, modulus_units
   public :: moduli_t, curves_t, time_range_t, compute_moduli, loss_tangent, moduli_tables
   public :: result_t, legend_t, figure_t, figure_kinds, figure_formats
   public :: read_result, usual_kind, build_figure, draw
   public :: write_stdout, write_file, make_directory, join_path, split_path, same_file
   public :: file_exists, directory_exists, plain_file_exists, quoted_path
   public :: anything_at, check_plain, move_file, remove_all_scratch
   public :: stderr_is_terminal, write_terminal
   public :: control_in, name_flaw
   public :: real_text, integer_text, printable, nearest_name, suggestion, read_real
   public :: material_names

end module vcor
