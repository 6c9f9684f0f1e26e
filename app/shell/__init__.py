"""The frame of a page: layout, commands, controls and their editing, messages; knows no view by name."""
