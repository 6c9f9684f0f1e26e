"""Deng 2019: accuracy of the compass alignment, and the network form against the feedback form."""

from typing import Any

import numpy as np

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.units import DEG, DEG_PER_HOUR
from navcore.mechanization.recorder import DV_E, DV_N, PHI_E, PHI_N
from tools.papers.claim import Claim, Exhibit, Table, at_most, number, order_of
from tools.papers.deng_errors import CELLS_1, WORDS
from tools.papers.estimate import rms_estimate
from tools.papers.measure import attitude_error, mean_and_interval, rms
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.search_deng import ALIGNMENT_SEARCH

PRESET = "deng-static"
SEEDS, FORM_SEEDS = range(1, 97), range(1, 21)
PRINTED = {"pitch": 0.0056, "roll": 0.0073, "heading": 0.0468}
"""Size of the mean errors of table 1, deg."""
FORMS = ("feedback", "network")


def aligned(runs: Runs) -> np.ndarray:
    """Errors of pitch, roll, heading right after the alignment, deg, shape (seeds, 3)."""

    def make() -> np.ndarray:
        free = scenario_of(PRESET).canonical()["method"][:1]
        found = []
        for seed in SEEDS:
            overrides = (f"run.seed={seed}", "run.duration_h=0.01")
            run = simulate(scenario_of(PRESET, overrides, method=free))
            found.append(attitude_error(run, run.methods[0])[0] / DEG)
        return np.array(found)

    return runs.keep("deng aligned", make)


def heading_of_drift() -> float:
    """Heading error that a drift of the east gyro of 0.02 deg/h leaves, deg."""
    scenario = scenario_of(PRESET)
    return 0.02 * DEG_PER_HOUR / (EARTH_RATE * np.cos(scenario.site.lat_deg * DEG)) / DEG


def forms(runs: Runs, seed: int) -> Run:
    """Both forms with sigma = 0.0088 at rest, a log with 0.1 m/s standing and its noise."""

    def make() -> Run:
        methods: list[dict[str, Any]] = [
            {
                "name": form,
                "damping": "external",
                "network": {"id": "compass", "sigma": 0.0088, "xi": 0.707, "realisation": form},
            }
            for form in FORMS
        ]
        return simulate(
            scenario_of(PRESET, (f"run.seed={seed}", "reference.bias_mps=[0.1,0.1]"), method=methods)
        )

    return runs.keep(("deng forms", seed), make)


def of_form(runs: Runs, form: str, columns: tuple[int, int]) -> np.ndarray:
    """RMS of both components together of one form, with each of the seeds, SI."""
    return np.array([rms(method(forms(runs, seed), form).rows[:, columns]) for seed in FORM_SEEDS])


def tilt_difference(runs: Runs) -> np.ndarray:
    """RMS of the difference of the two forms' tilts over that of the tilt, with each of the seeds."""
    found = []
    for seed in FORM_SEEDS:
        one, other = (method(forms(runs, seed), form).rows[:, [PHI_E, PHI_N]] for form in FORMS)
        found.append(rms(one - other) / rms(one))
    return np.array(found)


def _alignment_table(runs: Runs) -> Table:
    found = aligned(runs)
    rows = tuple(
        (name, number(value), mean_and_interval(found[:, i]), number(float(np.std(found[:, i], ddof=1))))
        for i, (name, value) in enumerate(PRINTED.items())
    )
    caption = f"Attitude error after the alignment, deg, {len(SEEDS)} seeds:"
    return Table(caption, ("angle", "paper: size of the mean", "mean +- 95 %", "standard deviation"), rows)


def _form_table(runs: Runs) -> Table:
    rows = []
    for form in FORMS:
        tilt = of_form(runs, form, (PHI_E, PHI_N)) / DEG * 3600.0
        velocity = of_form(runs, form, (DV_E, DV_N))
        rows.append((form, mean_and_interval(tilt), mean_and_interval(velocity)))
    return Table(
        f"Both forms with a standing error of the log of 0.1 m/s, mean over {len(FORM_SEEDS)} seeds +- 95 %:",
        ("form", "tilt of an axis, arcsec", "velocity of an axis, m/s"),
        tuple(rows),
    )


ALIGNMENT = Exhibit(
    name="deng-alignment",
    title="Section III: accuracy of the alignment; section II: the two forms of the network",
    presets=(PRESET,),
    setting="Table 1 starts from a coarse and a compass alignment of 600 s, and so do the runs here; the "
    "parameters are not printed (here 60 s coarse by the turning gravity vector, then the compass loop: 120 "
    "s level with sigma = 0.03, 420 s with azimuth, sigma = 0.008), nor are the signs of the sensor errors "
    "(here +, -, + of gyros x, y, z). The size of the paper's mean errors is compared with the RMS over the "
    "seeds of the error at the end of the alignment.",
    claims=(
        *(
            Claim(
                f"alignment leaves a {name} error of the size of table 1's mean: RMS over the seeds",
                number(value),
                order_of(value, 3.0),
                lambda runs, i=i: rms_estimate(aligned(runs)[:, i]),
                "deg",
                kind="fitted" if name == "heading" else "direction only",
                quote=f"{WORDS[i]} {CELLS_1[i]}",
                note="The gyros' random walk of 0.006 deg/sqrt(h) alone scatters the heading by {scatter} "
                "deg, and 0.02 deg/h on an east gyro adds {drift} deg. The paper's 0.0468 deg is one "
                "alignment; of ours {fewer} % are as good."
                if name == "heading"
                else "",
                facts={
                    "scatter": lambda runs: float(np.std(aligned(runs)[:, 2], ddof=1)),
                    "drift": lambda runs: heading_of_drift(),
                    "fewer": lambda runs: 100.0 * float(np.mean(np.abs(aligned(runs)[:, 2]) <= 0.0468)),
                },
            )
            for i, (name, value) in enumerate(PRINTED.items())
        ),
        Claim(
            "the damping network and the compass-alignment network are equivalent: RMS difference of their "
            "tilts over the tilt",
            "the same",
            at_most(0.02),
            tilt_difference,
            kind="predicted",
            quote="it can be found that the two damping networks are equivalent",
            note="They are not equivalent in velocity: the feedback form pulls V_c onto the log, the network "
            "form does not touch it (table).",
        ),
    ),
    tables=(_alignment_table, _form_table),
    search=ALIGNMENT_SEARCH,
)
