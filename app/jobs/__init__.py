"""What is computed beside the page: runs, verification, envelopes, what dominates, a damping table."""
