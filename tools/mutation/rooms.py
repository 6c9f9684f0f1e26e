"""Which tests judge the changes of which room.

Only tests that run within the process: what starts another would compile every kernel of the changed tree.
"""

ROOMS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "law": (
        ("test_control_*", "test_scenario_guide"),
        ("test_history", "test_tuning", "test_sun_table_1", "test_network_values"),
    ),
    "mechanization": (
        (
            "test_error_model", "test_strapdown_kernel", "test_kalman_method",
            "test_signs_and_sizes",
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
}  # fmt: skip
"""Tests of each room of navcore, as patterns of modules: those that are run first, and the others."""

INTERPRETED: dict[str, tuple[str, ...]] = {
    "law": ("test_control_*", "test_history"),
    "mechanization": ("test_strapdown_kernel", "test_error_model", "test_strapdown_batch", "test_alignment"),
    "sensors": ("test_imu*", "test_noise", "test_reference_*"),
    "analysis": (),
}  # fmt: skip
"""Tests that judge a changed kernel first, run as Python: to compile it and its callers takes minutes."""

LEFT_OUT = ("test_kernel_cache", "test_cli")
"""Tests that start another process."""
