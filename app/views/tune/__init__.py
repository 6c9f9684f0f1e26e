"""Tab "Tune": the best setting of the method in hand, proposed beside the present one."""
