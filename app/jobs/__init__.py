"""Work beside the page: runs, verification, envelopes, what dominates, a damping table."""
