"""Result of a simulation."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import count
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from navcore.analysis import Loop
from navcore.analysis.whole_system import WholeSystem
from navcore.engine.spans import Span
from navcore.foundation.drawing import drawn, handed_over
from navcore.foundation.text import Text
from navcore.mechanization.recorder import Recorder
from navcore.networks.base import LinearNetwork
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.sampling import Sampling

if TYPE_CHECKING:
    import pyarrow

_DAMPED, _XI = 1, 2
RECORDED_PLACE = -1
"""Place of an INS as it was recorded, beside the methods of a scenario."""
Status = Literal["ok", "diverged", "stopped"]
ENDINGS: dict[Status, str] = {"diverged": Text("diverged"), "stopped": Text("stopped")}
"""How a method ended that did not reach the end, in words."""


@dataclass(frozen=True)
class PlotSeries:
    """Error curves at plot resolution that keep every extreme.

    Attributes
    ----------
    t_s : ndarray, shape (m,)
        Common time axis, s; two points a bin when steps were gathered into bins.
    values : ndarray, shape (m, 8)
        The quantities of `navcore.quantities.NAMES`, rad, m/s, m.
    """

    t_s: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class LawInForce:
    """Action of the damping law, over the output rows.

    Attributes
    ----------
    damped_share : float
        Part of the rows at which the loop was damped, 0..1.
    xi_min, xi_mean, xi_max : float or None
        Damping coefficient in force at those rows; None when there are none.
    """

    damped_share: float
    xi_min: float | None
    xi_mean: float | None
    xi_max: float | None


@dataclass(frozen=True)
class MethodRun:
    """One method's result.

    Attributes
    ----------
    method : Method
        As configured.
    network : LinearNetwork
        Its H(s) at the site; of a policy that re-tunes it, at the mean coefficient in force.
    loop : Loop
        Closed-loop analysis of one channel.
    whole : WholeSystem
        Both channels, heading and latitude at the site.
    status : {"ok", "diverged", "stopped"}
        How the run ended.
    reason : str
        Why it did not end well, with the time; empty when ok.
    warnings : tuple of str
        In plain words.
    t_s : ndarray, shape (m,)
        Times of the output rows that were reached, s.
    rows : ndarray, shape (m, 10)
        Eight quantities (`navcore.quantities.NAMES`), damped (0/1), xi.
    errors : dict
        Statistics on the mechanization's own steps: quantity -> mean, std, rms, max_abs, final.
    plot : PlotSeries
        Curves for the screen.
    law_series : ndarray, shape (m, 4)
        At the output rows: the policy's wish (0/1), damped (0/1), xi in force, what the policy measured.
    navigation : ndarray, shape (m, 11), or None
        The navigation solution of a strapdown run, columns
        `navcore.mechanization.strapdown.records.NAVIGATION`.
    sigma : ndarray, shape (m, 7), or None
        Standard deviations that a Kalman filter, or a recorded INS, gives its own errors at the output rows,
        for the first seven of `navcore.quantities.NAMES`; None for every other method.
    growth_per_s : float or None
        Fastest growth of the whole system as the law is sampled, of one channel with the `channel` fidelity,
        1/s; None where no closed loop stands for the method.
    heading_settling_s : float
        Settling of the heading by its azimuth loop, s; infinite where nothing holds it.
    spans : tuple of Span
        The whole run, and from each ``from_h`` of the scenario's requirements on; in order.
    output : ndarray, shape (m, 5), or None
        Of a run on ``[ins]``: the damped output at the output rows, `navcore.engine.against.OUTPUT`.
    moved : ndarray, shape (m, 7), or None
        With it: damped minus recorded, the first seven of `navcore.quantities.NAMES`.
    place : int
        By which pictures know the method, and from which its colour follows (`in_places`).
    """

    method: Method
    network: LinearNetwork
    loop: Loop
    whole: WholeSystem
    status: Status
    reason: str
    warnings: tuple[str, ...]
    t_s: np.ndarray
    rows: np.ndarray
    errors: dict[str, dict[str, float]]
    plot: PlotSeries
    law_series: np.ndarray
    navigation: np.ndarray | None = None
    sigma: np.ndarray | None = None
    growth_per_s: float | None = None
    heading_settling_s: float = math.inf
    spans: tuple[Span, ...] = ()
    output: np.ndarray | None = None
    moved: np.ndarray | None = None
    place: int = 0

    def __repr__(self) -> str:
        """Name and status."""
        return f"<MethodRun {self.method.name!r}: {self.status}>"

    @cached_property
    def fingerprint(self) -> bytes:
        """Digest of curves and output rows: equal results have equal ones."""
        hashed = hashlib.blake2b(self.plot.values.tobytes(), digest_size=16)
        hashed.update(self.rows.tobytes())
        return hashed.digest()

    @property
    def law_in_force(self) -> LawInForce:
        """How much of the run was damped, and how hard, over the output rows."""
        damped = self.law_series[:, _DAMPED] > 0.5
        if not np.any(damped):
            return LawInForce(0.0, None, None, None)
        xi = self.law_series[damped, _XI]
        share = float(np.mean(damped))
        return LawInForce(share, float(np.min(xi)), float(np.mean(xi)), float(np.max(xi)))


@dataclass(frozen=True)
class Against:
    """What the errors of a run on ``[ins]`` are.

    Attributes
    ----------
    what : {"truth", "recorded"}
        Damped minus reference, or damped minus recorded.
    epochs : int
        Epochs of the reference over which statistics are formed; 0 without one.
    not_known : tuple of str
        Errors of which the reference says nothing.
    recorded : MethodRun or None
        The INS as it was recorded, against the reference.
    to_log : ndarray, shape (m, 2)
        Velocity as recorded minus log at the output rows, E and N, m/s; NaN where the log is silent.
    """

    what: Literal["truth", "recorded"]
    epochs: int = 0
    not_known: tuple[str, ...] = ()
    recorded: MethodRun | None = None
    to_log: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))


def in_places(methods: Iterable[MethodRun], places: Iterable[int] | None = None) -> tuple[MethodRun, ...]:
    """Give each method its place; without ``places`` that in the scenario."""
    pairs = zip(methods, count() if places is None else places, strict=False)
    return tuple(each if each.place == place else replace(each, place=place) for each, place in pairs)


@dataclass(frozen=True)
class Run:
    """Results of all methods of a scenario on the same truth and sensors.

    Attributes
    ----------
    scenario : Scenario
        Complete, resolved.
    methods : tuple of MethodRun
        In the scenario's order.
    t_s : ndarray, shape (m,)
        Times of all output rows, s.
    truth : ndarray, shape (m, 15)
        True motion at the output rows, columns of `navcore.motion.truth`.
    warnings : tuple of str
        About the scenario as a whole (recorded data, say).
    elapsed_s : float
        Wall time of the simulation, s.
    sampling : Sampling or None
        Rates of a strapdown run.
    scenario_sha256 : str
        `navcore.scenario.file.scenario_hash`, taken when the run was made: its recordings may go later.
    against : Against or None
        Of a run on ``[ins]``: what its errors are.
    """

    scenario: Scenario
    methods: tuple[MethodRun, ...]
    t_s: np.ndarray
    truth: np.ndarray
    warnings: tuple[str, ...]
    elapsed_s: float
    sampling: Sampling | None = None
    scenario_sha256: str = ""
    against: Against | None = None

    def __repr__(self) -> str:
        """One line: what was run, and the status of each method."""
        settings = self.scenario.run
        states = ", ".join(f"{m.method.name!r}: {m.status}" for m in self.methods)
        return f"<Run {self.scenario.title!r}, {settings.fidelity}, {settings.duration_h:g} h; {states}>"

    def _repr_html_(self) -> str:
        """Tables of ``schuler run``, for a notebook."""
        return drawn("run_tables", self)

    @property
    def lines(self) -> tuple[MethodRun, ...]:
        """All that tables and files show: an INS as it was recorded stands before the methods."""
        recorded = None if self.against is None else self.against.recorded
        return self.methods if recorded is None else (recorded, *self.methods)

    @property
    def with_recorded(self) -> Run:
        """The same run, an INS as it was recorded among its methods, as tables and curves show it."""
        lines = self.lines
        return self if len(lines) == len(self.methods) else replace(self, methods=lines)

    @property
    def computed_on(self) -> str:
        """Which states metrics and plots cover, in words."""
        if self.against is not None and self.against.what == "truth":
            return Text("{epochs} epochs of the reference", epochs=self.against.epochs)
        if self.sampling is None:
            return Text("every step of the mechanization, {step_s:g} s", step_s=self.scenario.run.step_s)
        rates = self.sampling
        return Text(
            "states every {record_step_s:g} s (every {record_every} steps of the "
            "mechanization at {rate_hz:g} Hz)",
            record_step_s=rates.record_step_s,
            record_every=rates.record_every,
            rate_hz=rates.rate_hz,
        )

    @property
    def status(self) -> Status:
        """Worst status of the methods."""
        states = {m.status for m in self.methods}
        return "stopped" if "stopped" in states else "diverged" if "diverged" in states else "ok"

    def figure(self, name: str = "errors", **options: Any) -> Any:
        """Draw what the page shows of a run, for a notebook.

        Parameters
        ----------
        name : {"errors", "switching", "spectrum", "bode", "nyquist", "poles", "step"}
            What is drawn.
        **options
            Of that figure: ``group`` of the errors ("Overview", "Attitude", "Velocity", "Position"), ``key``
            of the spectrum ("dve"), ``transfer_id`` of the Bode plots ("phi/dv_r").

        Returns
        -------
        plotly.graph_objects.Figure

        Raises
        ------
        InputError
            There is no figure of this name, or nothing that it could show.
        """
        return drawn("run_figure", self, name, **options)

    def paper_figure(
        self,
        name: str = "errors",
        width_mm: float | None = None,
        height_mm: float | None = None,
        **options: Any,
    ) -> Any:
        """Draw the same for a paper, as a `matplotlib.figure.Figure` with curves that differ in their dashes.

        Parameters
        ----------
        name, **options
            As of `figure`.
        width_mm, height_mm : float, optional
            Of the picture, 40..400 mm; by default 88 wide, one column of a journal, and 180 where panels
            stand side by side; as high as its panels need.

        Raises
        ------
        InputError
            As `figure`; matplotlib is not installed, or a size is out of its range.
        """
        return drawn("run_paper_figure", self, name, width_mm, height_mm, **options)

    def to_latex(self) -> str:
        """Return the tables of ``schuler run`` as LaTeX, each a ``tabular`` with the rules of booktabs.

        Every answer of the bench gives its tables so: ``answer.latex()``.
        """
        return drawn("run_latex", self)

    def to_arrow(self) -> pyarrow.Table:
        """Return the output rows of all methods as a `pyarrow.Table`, columns as of ``--out``, SI."""
        return handed_over("to_arrow", self)

    def to_pandas(self) -> Any:
        """Return the output rows as a `pandas.DataFrame`; raises `InputError` without pandas."""
        return handed_over("to_pandas", self)

    def to_xarray(self) -> Any:
        """Return them as an `xarray.Dataset` over method and time; raises `InputError` without xarray."""
        return handed_over("to_xarray", self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the output rows into one file.

        Parameters
        ----------
        path : path
            Ends with ``.mat`` (a structure for each method, with names that MATLAB takes), ``.parquet`` or
            ``.csv``.

        Raises
        ------
        InputError
            It ends otherwise, or cannot be written.
        """
        handed_over("save", self, path)


def plot_series(recorder: Recorder, step_s: float) -> PlotSeries:
    """Turn a recorder's bins into curves: minimum and maximum of each bin in the order in which they came."""
    states = int(recorder.cursor["count"])
    width = recorder.bin_width
    bins = -(-states // width)
    low, high = recorder.bin_low[:bins], recorder.bin_high[:bins]
    if width == 1:
        return PlotSeries(np.arange(bins) * step_s, low.copy())
    rising = recorder.bin_order[:bins] == 1
    values = np.empty((2 * bins, low.shape[1]))
    values[0::2] = np.where(rising, low, high)
    values[1::2] = np.where(rising, high, low)
    start = np.arange(bins) * width
    length = np.minimum(width, states - start)
    t = np.empty(2 * bins)
    t[0::2] = (start + 0.25 * (length - 1)) * step_s
    t[1::2] = (start + 0.75 * (length - 1)) * step_s
    points = 2 * bins - int(length[-1] == 1)
    return PlotSeries(t[:points], values[:points])


def statistics(recorder: Recorder) -> dict[str, dict[str, float]]:
    """Mean, standard deviation, RMS, largest magnitude and last value of each quantity over all states."""
    from navcore.mechanization.recorder import FINAL, MAX_ABS, NAMES, SUM, SUM_SQUARES

    count = max(int(recorder.cursor["count"]), 1)
    out: dict[str, dict[str, float]] = {}
    for name, row in zip(NAMES, recorder.stats, strict=True):
        mean, square = row[SUM] / count, row[SUM_SQUARES] / count
        out[name] = {
            "mean": float(mean),
            "std": float(np.sqrt(max(square - mean * mean, 0.0))),
            "rms": float(np.sqrt(square)),
            "max_abs": float(row[MAX_ABS]),
            "final": float(row[FINAL]),
        }
    return out
