"""Zha 2019, equations 8 and 9: the tilt that K1 and K2 leave, and why K3 is there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from navcore.foundation.units import ARCSEC, DEG_PER_HOUR
from navcore.mechanization.recorder import PHI_E
from tools.papers.claim import Claim, Exhibit, Table, about, at_most, number
from tools.papers.measure import hours
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PRESET = "zha-gains"
DRIFT_DPH, BIAS_UG = 0.01, 100.0
BIASED = f"imu.accel_bias_ug=[0,{BIAS_UG},0]"
"""A bias of the north accelerometer."""
WITHOUT_K3, WITH_K3 = ("K1", "K1, K2"), "K1, K2, K3"


def left(runs: Runs, name: str, *overrides: str) -> float:
    """Tilt at the end of the preset, rad."""
    return float(method(runs(PRESET, *overrides), name).rows[-1, PHI_E])


def zha_8(runs: Runs, name: str) -> float:
    """Size of the steady tilt of a drift by (Zha 8), rad."""
    scenario = runs(PRESET).scenario
    network = next(one["network"] for one in scenario.canonical()["method"] if one["name"] == name)
    gain = network["k1"] / ((1.0 + network["k2"]) * scenario.omega_s**2)
    return gain * DRIFT_DPH * DEG_PER_HOUR


def _of_bias(runs: Runs) -> float:
    """What a bias of the accelerometer adds to the tilt with K3, over -nabla/g (Zha 9)."""
    added = left(runs, WITH_K3, BIASED) - left(runs, WITH_K3)
    return added / -(BIAS_UG * 1e-6)


def _table(runs: Runs) -> Table:
    rows = []
    for name in (*WITHOUT_K3, WITH_K3):
        by_formula = number(zha_8(runs, name) / ARCSEC) if name != WITH_K3 else "0"
        values = (left(runs, name) / ARCSEC, (left(runs, name, BIASED) - left(runs, name)) / ARCSEC)
        rows.append((name, by_formula, *(number(value) for value in values)))
    head = ("gains", "(8), arcsec", "tilt from 0.01 deg/h, arcsec", f"from {BIAS_UG:g} ug, arcsec")
    return Table("Tilt that stays after 4 h:", head, tuple(rows))


def _draw(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    for i, found in enumerate(runs(PRESET).methods):
        curve(axes, hours(found), found.rows[:, PHI_E] / ARCSEC, found.method.name, i)
    panel(axes, "0.01 deg/h on the east gyro", "time, h", "phi_E, arcsec")


GAINS = Exhibit(
    name="zha-eq-8",
    title="Equations 6 to 9: the gains one after the other",
    presets=(PRESET,),
    setting="One channel, 0.01 deg/h on the east gyro, 4 h; K1 alone is chosen for a damping ratio of 0.7, "
    "K2 and K3 are printed in 4.1. For (9) the north accelerometer gets 100 ug as well. Nothing is random.",
    claims=(
        *(
            Claim(
                f"(8): the drift leaves a steady tilt of K1/((1+K2) omega_s^2) times itself, {name}: ours "
                f"over it",
                "1",
                about(1.0, 0.01),
                lambda runs, name=name: abs(left(runs, name)) / zha_8(runs, name),
                kind="predicted",
                digits=4,
                quote="可得系统姿态的稳态误差",
            )
            for name in WITHOUT_K3
        ),
        Claim(
            "K3 is there to take this steady tilt out: tilt after 4 h with K3 over that without",
            "suppressed",
            at_most(0.01),
            lambda runs: abs(left(runs, WITH_K3) / left(runs, WITHOUT_K3[1])),
            kind="predicted",
            quote="为有效抑制系统稳态误差,在系统回路中加入积分环节 ... 系统姿态的稳态误差得到抑制",
        ),
        Claim(
            "(9): with K3 the accelerometer alone decides the steady tilt, -nabla/g: ours over it",
            "1",
            about(1.0, 0.01),
            _of_bias,
            kind="predicted",
            digits=4,
            quote="系统姿态精度取决于加速度计的零偏",
        ),
    ),
    tables=(_table,),
    draw=_draw,
)
