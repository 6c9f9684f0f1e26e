"""``schuler tune``: the best setting of a method under requirements."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional, UseAppendAction, arg

from navcore.foundation.errors import Fault, InputError
from navcore.quantities import OBJECTIVES, TUNED
from schuler_bench.cli.terminal import emit_result, say


@dataclass(frozen=True)
class TuneCommand:
    """Find the parameters of a method that make an objective least while requirements are kept.

    Attributes
    ----------
    scenario : str
        Name of a preset, or a TOML file.
    objective : str
        What to make small: a quantity, or a sum, tilt_rms + 0.5*velocity_rms.
    vary : tuple of str
        A number of a method, e.g. method.1.network.sigma, or with a range method.1.network.sigma=1e-4:0.1.
    require : tuple of str
        A limit, e.g. 'settling_s<=3600' or 'tilt_rms<=5arcsec'.
    worst_of : tuple of str
        A further scenario in which the same method counts too: the worst of all is made small.
    over : str or None
        Study (a name or a file) laid over the scenario: the worst of its points is made small.
    no_default_limits : bool
        Search without the limits on settling and growth that count where none is given.
    no_confirm : bool
        Do not run the present setting and the proposal on 32 seeds.
    along : bool
        Over the scenario's run, in place of the steady state at rest.
    set : tuple of str
        Override one field of the scenario first.
    out : Path or None
        File for the scenario with the best setting.
    json : bool
        Print one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")]
    objective: Annotated[
        str,
        arg(
            metavar="NAME",
            help=f"What to make small: {', '.join(OBJECTIVES)}, or a sum, tilt_rms + 0.5*velocity_rms.",
        ),
    ]
    vary: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="FIELD[=LOW:HIGH]")] = ()
    require: Annotated[
        UseAppendAction[tuple[str, ...]],
        arg(
            metavar="NAME<=VALUE",
            help=f"A limit, e.g. settling_s<=3600 or tilt_rms<=5arcsec, of one of {', '.join(TUNED)}.",
        ),
    ] = ()
    worst_of: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="SCENARIO")] = ()
    over: Annotated[str | None, arg(metavar="STUDY")] = None
    no_default_limits: bool = False
    no_confirm: bool = False
    along: bool = False
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    out: Annotated[Path | None, arg(metavar="FILE")] = None
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Search and print; 3 when it was stopped."""
        from navcore.design.tune import tune
        from navcore.foundation.out import writing
        from navcore.scenario.file import load, to_toml
        from navcore.study.file import load as load_study
        from navcore.study.robust_tune import tune_over
        from schuler_bench.cli.design_text import tune_text
        from schuler_bench.cli.progress import working

        scenario = load(self.scenario, self.set)
        search = partial(tune, scenario, worst_of=[load(other) for other in self.worst_of])
        if self.over is not None:
            if self.worst_of:
                raise InputError(Fault("", "--over", self.over, "does not go with --worst-of"))
            search = partial(tune_over, scenario, load_study(self.over))
        with working("tuning", self.quiet) as (progress, stopped):
            result = search(
                self.objective,
                self.vary,
                self.require,
                along=self.along,
                default_limits=not self.no_default_limits,
                confirm=not self.no_confirm,
                progress=progress,
                cancelled=stopped,
            )
        if self.out is not None:
            with writing(self.out):
                self.out.write_text(to_toml(result.scenario), encoding="utf-8")
        emit_result(self.json, result.as_dict(), lambda: tune_text(self.objective, result))
        if result.stopped:
            say(f"{self.scenario}: stopped; this is the best so far")
        return 3 if result.stopped else 0
