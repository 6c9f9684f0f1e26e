"""Each point of the page as a person meets it: in three windows and in both languages (points.toml)."""
