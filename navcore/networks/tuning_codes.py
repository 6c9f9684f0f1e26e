"""Codes by which the running law knows a network that it can re-tune; 0 is none."""

COMPLEMENTARY, POLE2, UNITY2 = 1, 2, 3
