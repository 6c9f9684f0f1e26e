"""Tab "Tune": the best setting of the selected method, or the Pareto fronts of all networks."""
