"""From a parameter model's field to a control, and from a moved control to a new, checked scenario."""
