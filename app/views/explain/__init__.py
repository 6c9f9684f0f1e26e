"""The panel that explains the selected control."""
