"""Which tests judge the changes of which room.

Only tests that run within the process: what starts another would compile every kernel of the changed tree.
"""

ROOMS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "law": (
        ("test_control_*", "test_noticed_kernels", "test_scenario_guide"),
        ("test_history", "test_tuning", "test_sun_table_1", "test_network_values", "test_error_batch"),
    ),
    "mechanization": (
        (
            "test_error_model", "test_noticed_kernels", "test_strapdown_kernel", "test_kalman_method",
            "test_error_batch", "test_signs_and_sizes",
        ),
        (
            "test_scenario_guide", "test_strapdown_*", "test_control_twin", "test_control_strapdown",
            "test_averaging_*", "test_alignment", "test_results", "test_paper_figures",
            "test_presets_golden",
        ),
    ),
    "sensors": (
        ("test_imu*", "test_noise", "test_reference_*"),
        (
            "test_scenario_guide", "test_recorded_*", "test_strapdown_simulation",
            "test_sources", "test_signs_and_sizes", "test_recordings", "test_presets_golden",
        ),
    ),
    "analysis": (
        (
            "test_loop_*", "test_whole_system*", "test_network_report",
            "test_network_values",
        ),
        (
            "test_network_*", "test_pages", "test_placing", "test_any_network", "test_figures_poles",
            "test_figures_frequency", "test_liu_networks", "test_theory",
        ),
    ),
    "design": (
        ("test_design_*", "test_noticed_faults", "test_worst", "test_worst_values", "test_suffice"),
        (
            "test_dominance", "test_robust", "test_robust_tune", "test_tuning", "test_sun_table_1",
            "test_specification_limits", "test_run_verdicts", "test_judged_extremes", "test_filter_loop",
            "test_log_reading_budget", "test_passing_current", "test_recorded_start", "test_figures_tuned",
            "test_whole_system_under_way",
        ),
    ),
    "engine": (
        ("test_own_ins*", "test_results", "test_verification", "test_run_verdicts", "test_damped_recording"),
        (
            "test_recorded_start", "test_handed_over", "test_error_batch", "test_requirements",
            "test_specification_limits", "test_side_by_side", "test_refused_methods", "test_strapdown_*",
            "test_kalman_method", "test_voyage", "test_history", "test_gyrocompass_clauses",
            "test_input_notices", "test_noticed_faults", "test_files_out", "test_alignment",
        ),
    ),
    "damping": (
        ("test_damping*", "test_noticed_faults", "test_kalman_method", "test_whole_damping"),
        (
            "test_scenario", "test_scenario_guide", "test_refused_methods", "test_own_ins_faults",
            "test_averaging_scenario", "test_filter_loop", "test_questions",
        ),
    ),
    "exporting": (("test_export_*",), ("test_diagram", "test_notation")),
    "averaging": (("test_averaging_*",), ("test_presets_golden", "test_signs_and_sizes")),
    "io": (
        ("test_io_*", "test_damped_recording"),
        (
            "test_check_*", "test_clocks", "test_log_clock", "test_suspects", "test_stretches",
            "test_stream_rates", "test_plausible", "test_planted_faults", "test_numbers", "test_recordings",
        ),
    ),
}  # fmt: skip
"""Tests of each room of navcore, as patterns of modules: those that are run first, and the others."""

INTERPRETED: dict[str, tuple[str, ...]] = {
    "law": ("test_control_*", "test_history", "test_noticed_kernels"),
    "mechanization": (
        "test_strapdown_kernel", "test_error_model", "test_strapdown_batch", "test_alignment",
        "test_noticed_kernels",
    ),
    "sensors": ("test_imu*", "test_noise", "test_reference_*"),
    "averaging": ("test_averaging_*",),
}  # fmt: skip
"""Tests that judge a changed kernel first, run as Python: to compile it and its callers takes minutes."""

LEFT_OUT = ("test_kernel_cache", "test_cli")
"""Tests that start another process."""
