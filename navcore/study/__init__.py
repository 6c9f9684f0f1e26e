"""Studies: one scenario over many settings and seeds, in parts that a later command can go on with."""
