"""The output of a ship's INS as it comes: listening, damping beside it, and sending it on."""
