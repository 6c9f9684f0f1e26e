"""Display settings of a visitor: everything that changes the view of a run, nothing of the run."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from navcore.engine.run import Run, in_places
from navcore.quantities import ERRORS, LIMITED, QUANTITIES, STATISTICS, VECTORS
from navcore.scenario.model import Scenario
from schuler_bench.plots import style
from schuler_bench.plots.effective import SHOWN
from schuler_bench.plots.envelope import BandKind
from schuler_bench.plots.legend import State, after

FIRST_TRANSFER = "phi/dv_r"
OBJECTIVES = ("tilt_rms", "velocity_rms", "position_rms", "heading_rms", "settling_s")
"""Quantities for which the page tunes a method."""
SWEPT = tuple(key for key in LIMITED if QUANTITIES[key].kind is not None and "run" in QUANTITIES[key].names)
"""Quantities of a run that are swept."""
AXES = ("tilt_rms", "velocity_rms", "settling_s", "log_tilt", "overshoot")
"""Quantities on the axes of the Pareto fronts."""

CURVES: dict[str, tuple[str, ...]] = {
    "overview": ("tilt", "velocity", "phi_e", "position"),
    "all": ("phi_e", "dve", "phi_n", "dvn", "phi_u", "position"),
    "attitude": ("tilt", "phi_e", "phi_n", "phi_u"),
    "velocity": ("velocity", "dve", "dvn"),
    "position": ("position", "dlat", "dlon"),
    "verification": (),
}
"""Groups of error curves; the keys of `navcore.quantities.ERRORS` and `VECTORS` in each.

The lengths of tilt and velocity error come first: limits are about them and drawn in their plots.
"""

TO_LOG = ("ve_log", "vn_log")
"""Velocity minus log, east and north: what the spectrum shows of a run on a ship's own INS beside errors."""
_MOST_NAMES = 60


def _one_of(names: Collection[str]) -> AfterValidator:
    def check(id: str) -> str:
        if id not in names:
            raise ValueError(f"must be one of {', '.join(names)}")
        return id

    return AfterValidator(check)


def _is_of_curves(text: str) -> str:
    keys = {error.key for error in (*ERRORS, *VECTORS)}
    if text not in CURVES and not keys.issuperset(text.split(",")):
        raise ValueError(f"must be one of {', '.join(CURVES)}, or of {', '.join(sorted(keys))} with commas")
    return text


class Display(BaseModel):
    """Choices of how a session's pictures look; saved with the session.

    Attributes
    ----------
    transfer : str
        What the frequency side shows: a key of `schuler_bench.plots.effective.SHOWN`.
    discrete : bool
        The measured gain and phase of the running filters are drawn on H.
    optimal : bool
        The optimal network for the scenario's sensors is drawn beside H.
    poles : str
        Whose poles the tab "Poles" shows: one level channel's, the azimuth network's, the whole system's.
    locus : str
        Parameter of the network (or azimuth network) over which the root locus is drawn; "": none.
    exaggeration : float or None
        Of the errors in 3D; None: chosen to fit.
    angle, length, speed, time : str
        Unit of the plots over time and of the tables; "auto": what fits the numbers.
    scale : str
        Axis of the errors over time.
    envelope : str
        Bands behind the error curves: one standard deviation by covariance, over 20 seeds, or none.
    curves : str
        What the tab "Errors" shows: a group of `CURVES`, or keys of `navcore.quantities.ERRORS` and
        `VECTORS` with commas between them, as a lesson chooses.
    spectrum : str
        Error whose spectrum is shown: a key of `navcore.quantities.ERRORS`, or of `TO_LOG`.
    baseline : int or None
        Pin with which numbers are compared; None: the first one.
    legend : tuple of (str, str)
        Curves that are not simply shown: key (a method's name, or a pin's label) and state.
    pins_by : str
        Column by which the table of pins is sorted, with a minus sign for the other way round.
    delta : str
        Which number of each error is compared with the baseline's.
    window : str
        What the errors in the table are measured over: the whole run, what follows
        the settling, or some hours.
    window_from_h, window_to_h : float
        Those hours; None: to the end.
    flipped : bool
        The baseline is shown in the place of the present run.
    theme : str
        Colours of the whole page; "opposite": dark where the system is light, and light where it is dark.
    size : str
        Of type and lines; "presentation": readable from the back of a room, with few controls.
    large : str
        What has the most room: the plots, or the 3D view while one presents or a lesson is about it; a page
        may still let both change places.
    budget : str
        What the tab "Design" shows: the methods that meet the limits, or the error budget, of the steady
        state of one level channel or of the whole run.
    search_over : str
        Where designs and tuned settings must hold: in the scenario, or at the worst point of the tab
        Study's study.
    objective : str
        What a method is tuned for: one of `OBJECTIVES`.
    default_limits : bool
        The search keeps limits on settling and growth where none are given.
    beyond_sliders : bool
        The search goes beyond the sliders, to all that the fields allow.
    search : str
        What the tab "Tune" looks for: the best setting of one method, or the Pareto fronts of all networks.
    front_x, front_y : str
        Objectives on the axes of the Pareto fronts: of `AXES`.
    swept : str
        Quantity that the tab "Sweep" shows: of `SWEPT`.
    study : str
        What the tab "Study" carries out: a listed study, "uploaded", or "" for the scenario itself.
    study_x, study_y : str
        What is varied of the scenario itself.
    study_seeds : int
        Runs at each of its points.
    study_metric, study_method : str
        What of the results is shown; where they do not have it, the first of theirs.
    study_shows : str
        As pictures, or as tables with the worst runs.
    asked : str
        Question that the tab "Ask" shows; "": the first.
    given : tuple of (str, str)
        Values of fields that a page has set there: ``question.field``, and the value as JSON.
    lesson : str
        Id of the open lesson; "": none.
    places : tuple of (str, int)
        Names of methods, the present ones first, and their places in the palette (`style.places`).
    lesson_step, lesson_shown : int
        Its step, and how often "Show me" was pressed: pages that watch follow both.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    transfer: Annotated[str, _one_of(SHOWN)] = FIRST_TRANSFER
    discrete: bool = False
    optimal: bool = False
    poles: Literal["channel", "azimuth", "whole"] = "channel"
    locus: Annotated[str, Field(max_length=40)] = ""
    exaggeration: Annotated[float | None, Field(gt=0.0, le=1e6)] = None
    angle: Literal["auto", "arcsec", "arcmin", "deg"] = "auto"
    length: Literal["auto", "m", "km", "nmi"] = "auto"
    speed: Literal["auto", "m/s", "kn"] = "auto"
    time: Literal["auto", "min", "h"] = "auto"
    scale: Literal["linear", "log"] = "linear"
    envelope: BandKind = "none"
    curves: Annotated[str, AfterValidator(_is_of_curves)] = "overview"
    spectrum: Annotated[str, _one_of([*(error.key for error in ERRORS), *TO_LOG])] = "dve"
    baseline: Annotated[int | None, Field(ge=1)] = None
    legend: Annotated[
        tuple[tuple[Annotated[str, Field(max_length=300)], State], ...], Field(max_length=60)
    ] = ()
    pins_by: Annotated[str, Field(pattern=r"^-?[a-z]{1,20}$")] = "pinned"
    delta: Annotated[str, _one_of(STATISTICS)] = "rms"
    window: Literal["whole", "settled", "hours"] = "whole"
    window_from_h: Annotated[float, Field(ge=0.0, le=1e5)] = 0.0
    window_to_h: Annotated[float | None, Field(ge=0.0, le=1e5)] = None
    flipped: bool = False
    theme: Literal["system", "opposite", "light", "dark"] = "system"
    size: Literal["normal", "presentation"] = "normal"
    large: Literal["plots", "view"] = "plots"
    budget: Literal["limits", "steady", "run"] = "limits"
    search_over: Literal["scenario", "study"] = "scenario"
    objective: Annotated[str, _one_of(OBJECTIVES)] = "tilt_rms"
    default_limits: bool = True
    beyond_sliders: bool = False
    search: Literal["setting", "fronts"] = "setting"
    front_x: Annotated[str, _one_of(AXES)] = "tilt_rms"
    front_y: Annotated[str, _one_of(AXES)] = "velocity_rms"
    swept: Annotated[str, _one_of(SWEPT)] = "tilt_rms_arcsec"
    study: Annotated[str, Field(max_length=80)] = ""
    study_x: Annotated[str, Field(max_length=80)] = "latitude"
    study_y: Annotated[str, Field(max_length=80)] = "log_bias"
    study_seeds: Annotated[int, Field(ge=1, le=200)] = 10
    study_metric: Annotated[str, _one_of((*SWEPT, "met"))] = "tilt_rms_arcsec"
    study_method: Annotated[str, Field(max_length=300)] = ""
    study_shows: Literal["pictures", "tables"] = "pictures"
    asked: Annotated[str, Field(max_length=40)] = ""
    given: Annotated[
        tuple[tuple[Annotated[str, Field(max_length=80)], Annotated[str, Field(max_length=1000)]], ...],
        Field(max_length=60),
    ] = ()
    lesson: Annotated[str, Field(max_length=255)] = ""
    lesson_step: Annotated[int, Field(ge=0, le=1000)] = 0
    lesson_shown: Annotated[int, Field(ge=0)] = 0
    places: Annotated[
        tuple[tuple[Annotated[str, Field(max_length=60)], Annotated[int, Field(ge=0, le=99)]], ...],
        Field(max_length=_MOST_NAMES),
    ] = ()

    @property
    def chosen_curves(self) -> tuple[str, ...]:
        """Keys of the error curves that are shown; none where a verification is."""
        return CURVES[self.curves] if self.curves in CURVES else tuple(self.curves.split(","))

    @property
    def enlarged(self) -> bool:
        """Whether the page is in presentation size."""
        return self.size == "presentation"

    def state_of(self, key: str) -> State:
        """How a curve is shown."""
        return dict(self.legend).get(key, "shown")

    def clicked(self, key: str) -> tuple[tuple[str, State], ...]:
        """`legend` after a click on a curve's entry: the last 60 choices count."""
        return self._with_state(key, after(self.state_of(key)))

    def looked(self, key: str) -> tuple[tuple[str, State], ...]:
        """`legend` after a click on a curve's eye, which hides it or shows it again."""
        return self._with_state(key, "shown" if self.state_of(key) == "hidden" else "hidden")

    def _with_state(self, key: str, state: State) -> tuple[tuple[str, State], ...]:
        others = tuple(entry for entry in self.legend if entry[0] != key)
        return others if state == "shown" else (*others[-59:], (key, state))

    def colored(self, scenario: Scenario) -> dict[str, int]:
        """Names of a scenario's methods, and their places in the palette."""
        return style.places((method.name for method in scenario.method), self.places)

    def knowing(self, scenario: Scenario) -> Display:
        """Give a copy that keeps the places of a scenario's methods."""
        kept = dict(self.places) | (found := self.colored(scenario))
        places = sorted(kept.items(), key=lambda one: one[0] not in found)
        return self.model_copy(update={"places": tuple(places[:_MOST_NAMES])})

    def placed(self, run: Run) -> Run:
        """Give the methods of a run their places in the palette."""
        return replace(run, methods=in_places(run.methods, self.colored(run.scenario).values()))

    def with_(self, **changes: object) -> Display:
        """Give a checked copy with other choices; raises `pydantic.ValidationError`."""
        return Display.model_validate(self.model_dump() | changes)
