"""The version of the bench: navcore, the page and the command have one."""

__version__ = "0.1.0"
