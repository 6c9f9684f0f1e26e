"""How a scenario of each fidelity is carried out: `linear` (channel, error_model) and `strapdown`.

Both make the environment once, run every method on it with the same damping law, and give the same `Run`.
"""
