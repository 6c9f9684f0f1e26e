"""Names a control of the page by its key in the scenario file: a test does not depend on its label."""

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from pydantic import BaseModel

from navcore.averaging.parameters import Averaging
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.networks import NETWORKS
from navcore.scenario.blocks import RunSettings, SiteSettings
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference
from schuler_bench.editing import form
from schuler_bench.editing.choices import choice_words
from schuler_bench.editing.form import FieldSpec
from schuler_bench.shell.control import EXACT

_CHOOSERS = ("alignment", "damping", "motion", "network", "policy", "reference", "switching")
"""Names of the choosers of a kind, each by its label."""


def words_of(name: str, value: Any) -> Any:
    """What the control of a field shows for a value."""
    offered = isinstance(value, str) and (name in _CHOOSERS or name in _specs())
    return str(choice_words(value)) if offered else value


def slider_labels(name: str) -> list[str]:
    """Labels under which a page may show the slider of a field, or its only control.

    Parameters
    ----------
    name : str
        Key of the field without the number of its method, such as ``network.xi`` or ``imu.gyro_bias_dph.2``;
        what is no key stands for the label of a control that has none.
    """
    return list(dict.fromkeys(spec.label for spec in _specs().get(name, ()))) or [name]


def box_labels(name: str) -> list[str]:
    """The same for its box: that of the exact value beside a slider."""
    found = (spec.label + EXACT * (spec.slider is not None) for spec in _specs().get(name, ()))
    return list(dict.fromkeys(found)) or [name]


def label_of(name: str) -> str:
    """The only label of a field's slider, for a key such as ``network.zeta``."""
    (label,) = slider_labels(name)
    return label


@lru_cache(maxsize=1)
def _specs() -> dict[str, list[FieldSpec]]:
    found: dict[str, list[FieldSpec]] = {}
    for block, model in _blocks():
        for spec in form.fields(model, (block,)):
            found.setdefault(".".join(map(str, spec.path)), []).append(spec)
    return found


def _blocks() -> Iterator[tuple[str, type[BaseModel]]]:
    yield from (("run", RunSettings), ("site", SiteSettings), ("imu", Imu), ("reference", Reference))
    yield from (("initial_error", InitialError), ("method", Method), ("averaging", Averaging))
    for block, members in (
        ("network", NETWORKS),
        ("policy", POLICIES),
        ("switching", SWITCHINGS),
        ("motion", MOTIONS),
    ):
        yield from ((block, model) for model in members.values())
