"""The worst that a log can do whose error is bounded, and the log that does it (theory.md 21)."""
