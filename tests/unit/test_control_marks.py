"""A number that a scenario leaves out is marked below its box: it looked like a 0."""

from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

from navcore.sensors.imu import Imu
from schuler_bench.editing.form import fields
from schuler_bench.shell.control import Section


def gui() -> Any:
    """Give widgets that hold what they are given."""

    def add(*given: Any, **more: Any) -> Any:
        held = given[1] if len(given) > 1 else (given[0] if given else more.get("initial_value"))
        return SimpleNamespace(value=held, content=held, on_update=lambda _: None, visible=True)

    return SimpleNamespace(
        add_slider=lambda label, low, high, step, value, **_: add(label, value),
        add_text=add,
        add_html=add,
    )


def test_a_number_that_is_not_given_is_marked_and_a_zero_is_not() -> None:
    specs = [spec for spec in fields(Imu, ("imu",)) if spec.path[-1] == "gyro_bias_std_dph"]
    (path,) = (spec.path for spec in specs)
    section = Section(gui(), nullcontext(), lambda *_: None, 0.0)
    section.show(specs, {path: None}, None, {path: "not given"})
    note = section.controls[path]._note
    assert note.visible and "not given" in note.content
    section.controls[path].refuse(["too large"])
    assert "too large" in note.content
    section.controls[path].say("")
    assert "not given" in note.content
    section.show(specs, {path: 0.0}, None, {})
    assert not note.visible and note.content == ""
