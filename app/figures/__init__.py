"""Run -> figure data: pure functions without viser, without physics of their own."""
