"""Tab "Tune": the best setting of the method in hand, or the Pareto fronts of all networks."""
