"""Recordings in budget, floor and tuning: a recorded log has its fitted error, else there is no floor."""

from typing import NamedTuple

from navcore.fitting.recorded import can_fit, fit_of, reference_of
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario


class Modelled(NamedTuple):
    """A scenario as a stochastic model sees it.

    Attributes
    ----------
    scenario : Scenario
        With a simulated log that errs as the recorded one, where its error can be fitted.
    notes : tuple of str
        What the recordings count as.
    no_floor : str
        Why there is no floor; empty where every recording has a model.
    """

    scenario: Scenario
    notes: tuple[str, ...] = ()
    no_floor: str = ""


def modelled(scenario: Scenario) -> Modelled:
    """Give a recorded log the error that is fitted to it.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    """
    if scenario.on_ins:  # every setting is run on the recording itself
        return Modelled(scenario, no_floor=Text("ins.file: the sensors stay inside the INS"))
    notes, reasons = [], []
    if scenario.reference.kind == "file":
        scenario, note, reason = _with_log(scenario)
        notes.append(note)
        reasons.append(reason)
    if scenario.imu.file is not None:
        reasons.append(Text("imu.file: nothing says how a recorded IMU errs"))
        notes.append(Text("imu.file: a recorded IMU has no stochastic model and counts as free of error"))
    return Modelled(scenario, tuple(notes), Text.joined("; ", filter(None, reasons)) if any(reasons) else "")


def _with_log(scenario: Scenario) -> tuple[Scenario, str, str]:
    """Scenario with a simulated log, what it counts as, and why there is no floor."""
    if can_fit(scenario):
        try:
            fit = fit_of(scenario).fit
        except InputError as error:
            why = error.faults[0].allowed
        else:
            note = Text(
                "reference.file: the recorded log counts with its fitted error (schuler fit): "
                "noise {noise:.3g} m/s, drift {drift:.3g} m/s over {tau_s:.3g} s",
                noise=fit.noise.value,
                drift=fit.drift.value,
                tau_s=fit.drift_tau_s.value,
            )
            kept = {name: getattr(scenario.reference, name) for name in ("event", "outage", "min_speed_mps")}
            told = reference_of(fit).model_copy(update=kept)
            return scenario.model_copy(update={"reference": told}), note, ""
    else:
        why = Text("no track was recorded with it")
    note = Text("reference.file: the error of the recorded log counts as 0: {why}", why=why)
    reason = Text("reference.file: nothing says how the recorded log errs ({why})", why=why)
    return scenario, note, reason
