"""A scenario carried out: inputs made once, a driver for each fidelity, runs, metrics, results."""
