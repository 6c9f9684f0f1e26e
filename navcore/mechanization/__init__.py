"""Mechanizations: what an inertial navigation system makes of its sensors, with the damping law inside the loop."""
