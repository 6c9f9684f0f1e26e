"""Tab "Compare": pinned runs beside the present one."""
