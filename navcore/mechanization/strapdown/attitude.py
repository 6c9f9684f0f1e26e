"""Attitude in the forms a strapdown run needs: quaternion, angles, and the misalignment phi. Compiled."""

import math

from navcore.foundation.compiled import inlined


@inlined
def quaternion_of(pitch, roll, heading):
    """Quaternion body -> navigation of C_b^n = Rz(-heading) Rx(pitch) Ry(roll); angles in rad."""
    sp, cp = math.sin(0.5 * pitch), math.cos(0.5 * pitch)
    sr, cr = math.sin(0.5 * roll), math.cos(0.5 * roll)
    sh, ch = -math.sin(0.5 * heading), math.cos(0.5 * heading)
    # Rx(pitch) Ry(roll), then Rz(-heading) from the left
    a0, a1, a2, a3 = cp * cr, sp * cr, cp * sr, sp * sr
    return ch * a0 - sh * a3, ch * a1 - sh * a2, ch * a2 + sh * a1, ch * a3 + sh * a0


@inlined
def angles_of(q0, q1, q2, q3):
    """Pitch, roll and heading (0..2 pi) of a quaternion, rad."""
    pitch = math.asin(min(1.0, max(-1.0, 2.0 * (q2 * q3 + q0 * q1))))
    roll = math.atan2(2.0 * (q0 * q2 - q1 * q3), 1.0 - 2.0 * (q1 * q1 + q2 * q2))
    return pitch, roll, heading_of(q0, q1, q2, q3)


@inlined
def heading_of(q0, q1, q2, q3):
    """Heading of a quaternion, 0..2 pi rad."""
    heading = math.atan2(2.0 * (q1 * q2 - q0 * q3), 1.0 - 2.0 * (q1 * q1 + q3 * q3))
    return heading if heading >= 0.0 else heading + 2.0 * math.pi


@inlined
def misalignment(q0, q1, q2, q3, t0, t1, t2, t3):
    """Rotation vector phi of C~ = exp(-[phi x]) C from the computed quaternion q and the true one t, rad.

    For small angles C~ = (I - [phi x]) C, the phi-angle of theory.md section 1.
    """
    s = q0 * t0 + q1 * t1 + q2 * t2 + q3 * t3
    x = -q0 * t1 + q1 * t0 - q2 * t3 + q3 * t2
    y = -q0 * t2 + q1 * t3 + q2 * t0 - q3 * t1
    z = -q0 * t3 - q1 * t2 + q2 * t1 + q3 * t0
    n = math.sqrt(x * x + y * y + z * z)
    sign = -1.0 if s >= 0.0 else 1.0
    scale = 2.0 * sign if n < 1e-9 else 2.0 * sign * math.atan2(n, abs(s)) / n
    return scale * x, scale * y, scale * z
