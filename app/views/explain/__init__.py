"""The panel that explains the control in hand."""
