"""Tab "Scenario": the scenario as TOML."""
