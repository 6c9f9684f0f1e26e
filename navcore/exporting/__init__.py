"""The law of a method for a navigation computer, with the vectors that prove it."""
