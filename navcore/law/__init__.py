"""The damping law, once for every fidelity: policy (when) -> switching (how) -> correction (what)."""
