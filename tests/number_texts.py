"""Texts that a person may give for a number, and what each of them means: every door takes this table."""

import math

NARROW, NO_BREAK, THIN = "\u202f", "\u00a0", "\u2009"

MEANT: dict[str, float] = {
    "-0.02": -0.02,
    "\u22120.02": -0.02,  # the minus sign that plots write
    "\u20130.02": -0.02,  # the en dash that word processors write
    "\uff0d0.02": -0.02,
    "1e-3": 1e-3,
    "2E-4": 2e-4,
    "1e\u22123": 1e-3,
    "1e+03": 1e3,
    "1·10^-3": 1e-3,
    "1×10⁻³": 1e-3,
    "1.5 × 10^(−3)": 1.5e-3,
    "2x10**-3": 2e-3,
    "10⁻³": 1e-3,
    "-10^-3": -1e-3,
    "0,02": 0.02,
    "-0,02": -0.02,
    "\u22120,02": -0.02,
    "0,234": 0.234,
    "1234,567": 1234.567,
    ",5": 0.5,
    f"1{NARROW}234,5": 1234.5,
    f"1{NO_BREAK}234,5": 1234.5,
    f"1{THIN}234,5": 1234.5,
    f"-1{NARROW}234{NARROW}567": -1234567.0,
    f"0.123{THIN}456{THIN}7": 0.1234567,
    f"1{NARROW}234,567": 1234.567,
    "1.234,5": 1234.5,
    "1,234.5": 1234.5,
    "1,234,567": 1234567.0,
    "1.234.567": 1234567.0,
    "1'234.5": 1234.5,
    "1’234": 1234.0,
    "1.234": 1.234,
    "1_000": 1000.0,
    "+5": 5.0,
    ".5": 0.5,
    "5.": 5.0,
    "007": 7.0,
    "١٢": 12.0,
    "١٢٫٥": 12.5,
    "１２．５": 12.5,
    "\u200e-5": -5.0,
    '"0.02"': 0.02,
    "“0.02”": 0.02,
    "„0,02“": 0.02,
    "«0.02»": 0.02,
    "  5  ": 5.0,
    f"{NO_BREAK}5\t": 5.0,
    "5\n": 5.0,
    "0e-999": 0.0,
}  # fmt: skip
"""Text -> the number it means."""
REFUSED: dict[str, str] = {
    "1,234": "may mean 1.234 or 1234",
    "-1,234": "may mean 1.234 or 1234",
    "1,234e3": "may mean",
    "inf": "finite",
    "-Infinity": "finite",
    "nan": "finite",
    "1e999": "finite",
    "1e-999": "too small",
    "5\n6": "must be a number",
} | dict.fromkeys(
    (
        "", "   ", "12abc", "abc", "--5", "+-5", "5-", "(5)", "- 5", "1e", "1e3.5", "e5", "1 e5", "0x10",
        "1__0", "_1", "1._5", "5,", ".", ",", "-", "1 234,5", "1 2", f"1{NARROW}23", "12,34,567", "1.2.3",
        "1.2,3,4", "1.234,567.8", "0.02\u2033", "0.02'", "\u20140.02", "\u00ad5", "5%", "½", "²", "1×10-3",
        "1d-3", "true", "5; 6", "9" * 2000,
    ),
    "must be a number",
)  # fmt: skip
"""Text -> a part of what is said of it."""
WITH_UNIT: dict[str, tuple[str, float]] = {
    "30 min": ("h", 0.5),
    "0,5 h": ("h", 0.5),
    "5 °/h": ("°/h", 5.0),
    f"5{NO_BREAK}°/h": ("°/h", 5.0),
    "\u22120,02°/h": ("°/h", -0.02),
    "1e-3 deg/h": ("°/h", 1e-3),
    "2 kn": ("kn", 2.0),
    "2kn": ("kn", 2.0),
    "1×10⁻³ °/h": ("°/h", 1e-3),
    "30′": ("°", 0.5),
    "30'": ("°", 0.5),
    f"1{NARROW}800 s": ("h", 0.5),
    "“2 kn”": ("kn", 2.0),
}
"""Text with a unit -> the field's unit, and the value in it."""


def same(value: float, meant: float) -> bool:
    """Whether a value is the one that is meant, but for rounding."""
    return math.isclose(value, meant, rel_tol=1e-13, abs_tol=0.0)
