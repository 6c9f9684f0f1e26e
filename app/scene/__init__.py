"""The trajectory in 3D: what is drawn, from where it is seen, and at what time."""
