"""Mechanizations: what a navigation system makes of its sensors, with the damping law inside the loop."""
