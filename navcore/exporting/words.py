"""Words of the targets, which are no names in an exported program."""

RESERVED = frozenset(
    (
        "False None True abs and as assert async at atan2 auto await break case catch char class const "
        "continue cos def default del do double elif else elseif end enum eps except exp extern fabs "
        "finally float floor fmax fmin for from function gamma global goto hypot if import in inf inline "
        "int is isfinite j0 j1 k lambda long main math max min nonlocal not np or otherwise out parfor "
        "pass persistent pi raise register remainder restrict return s self short signed sin sizeof spmd "
        "sqrt static step_out struct switch tan time try typedef union unsigned void volatile while with "
        "y0 y1 yield "
    ).split()
)
"""Words of C, MATLAB and Python, and names that the printers use themselves."""
