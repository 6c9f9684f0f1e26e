"""Plugin of pytest: the contract of every class that a file registers, a test for each check.

``pytest --schuler-plugin mine.py``; with a package of your own, whose entry point registers the classes,
``pytest --schuler-methods``. pytest finds the plugin where the program is installed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from navcore.extending.added import Added

    Checks = Iterator[tuple[str, Callable[[], object]]]

_FILES, _METHODS = "--schuler-plugin", "--schuler-methods"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options."""
    group = parser.getgroup("schuler", "methods of Schuler Bench")
    group.addoption(
        _FILES,
        action="append",
        default=[],
        metavar="FILE",
        help="hold the classes that this file registers against the contract of the program",
    )
    group.addoption(
        _METHODS,
        action="store_true",
        help="do so with the classes of all installed packages (entry points schuler_bench.methods)",
    )


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(
    session: pytest.Session, config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Add a test for each check of each class, behind the tests that pytest has found."""
    files: list[str] = config.getoption(_FILES) or []
    if not files and not config.getoption(_METHODS):
        return
    from navcore.extending.added import ADDED
    from navcore.extending.plugins import load_file, load_plugins

    faults = list(load_plugins())
    before = [] if config.getoption(_METHODS) else [one.thing for one in ADDED]
    for name in files:
        faults += load_file(name)
    if faults:
        raise pytest.UsageError("\n".join(str(fault) for fault in faults))
    for one in ADDED:
        if not any(one.thing is thing for thing in before):
            for what, check in checks_of(one):
                item = _Check.from_parent(session, name=f"{one.what} {one.name}: {what}", check=check)
                items.append(item)


class _Check(pytest.Item):
    """One check of one class."""

    def __init__(self, *, check: Callable[[], object], **given: Any) -> None:
        super().__init__(**given)
        self._check = check

    def runtest(self) -> None:
        """Make the check."""
        self._check()

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Say what is wrong in a line; of anything but a check that fails, the whole way to it."""
        if excinfo.errisinstance(AssertionError):
            return f"{self.name}\n{excinfo.value}"
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[str, None, str]:
        """Name the check."""
        return "schuler", None, self.name


def checks_of(added: Added) -> Checks:
    """Yield the checks of something that was registered, each with what it says.

    Parameters
    ----------
    added : Added
        Of `navcore.extending.added.ADDED`.
    """
    of_kind = _OF_KIND.get(added.what)
    if of_kind is not None:
        yield from of_kind(added.name, added.thing)


def _entry(part: str) -> Callable[[str, Any], Checks]:
    def of(name: str, model: Any) -> Checks:
        from schuler_bench.contract import checks

        yield "every field is told", lambda: checks.fields_are_told(model, checks.NAMED_BY[part])
        yield (
            "stands in guide, schema and page",
            lambda: checks.stands_in_guide_schema_and_form(part, name, model),
        )
        yield from _scenarios(part, name)
        if part == "network":
            yield "its statements agree with H(s)", lambda: checks.network_of(model(**{"id": name}))
            yield "its alternatives follow", lambda: checks.alternatives_follow(model(**{"id": name}))
        elif part == "motion":
            yield "its truth is consistent", lambda: checks.truth_is_consistent(model(kind=name))
            yield (
                "its truth does not depend on the grid",
                lambda: checks.truth_does_not_depend_on_the_grid(model(kind=name)),
            )
            yield "it says how fast it is", lambda: checks.frequencies_name_fields(model(kind=name))

    return of


def _scenarios(part: str, name: str, **fields: Any) -> Checks:
    from schuler_bench.contract import checks

    def scenario(fidelity: str = "error_model") -> Any:
        return scenario_with(part, name, fidelity, **fields)

    yield "it survives being written and read", lambda: checks.survives_being_written(scenario())
    for fidelity in ("error_model", "strapdown"):
        yield f"it runs: {fidelity}", lambda fidelity=fidelity: checks.runs(scenario(fidelity))


def scenario_with(part: str, name: str, fidelity: str = "error_model", **fields: Any) -> Any:
    """Return a short scenario in which an entry stands, with its defaults.

    Parameters
    ----------
    part : {"network", "policy", "switching", "motion", "damping", "imu", "reference"}
        Block in which it stands.
    name : str
        Its id, or kind; of a sensor error nothing.
    fidelity : {"error_model", "strapdown"}
        Of the run.
    **fields
        Values of a sensor error.
    """
    from navcore.damping import KINDS
    from navcore.scenario.model import Scenario

    method: dict[str, Any] = {"damping": "external", "network": {"id": "complementary"}}
    data: dict[str, Any] = {
        "run": {"duration_h": 0.02, "fidelity": fidelity, "output_step_s": 1.0, "step_s": 0.5},
        "imu": {"gyro_bias_dph": [0.01, 0.01, 0.01]},
        "reference": {"kind": "log"},
        "method": [method],
    }
    if part == "damping":
        data["method"] = [
            {"damping": name, **({"network": method["network"]} if KINDS[name].uses_network else {})}
        ]
    elif part == "motion":
        data["motion"] = {"kind": name}
    elif part in ("imu", "reference"):
        data[part] |= fields
    else:
        method[part] = {"id": name}
    return Scenario.parse(data)


def _damping(name: str, thing: Any) -> Checks:
    from schuler_bench.contract import checks

    settings = thing if hasattr(thing, "model_fields") else thing.settings
    if settings is not None:
        yield "every field is told", lambda: checks.fields_are_told(settings)
    yield from _scenarios("damping", name)


def _term(block: str) -> Callable[[str, Any], Checks]:
    def of(name: str, model: Any) -> Checks:
        from navcore.foundation.parameters import extra_of
        from schuler_bench.contract import checks

        yield "every field is told", lambda: checks.fields_are_told(model)
        fields = {}
        for field, info in model.model_fields.items():
            slider = extra_of(info).get("slider")
            if slider is not None and isinstance(info.default, float):
                fields[field] = 0.5 * sum(slider)
        yield from _scenarios(block, "", **fields)

    return of


def _format(name: str, thing: Any) -> Checks:
    from schuler_bench.contract import checks

    yield "it takes no file of another format", lambda: checks.takes_no_other_file(thing)


_OF_KIND: dict[str, Callable[[str, Any], Checks]] = {
    "network": _entry("network"),
    "policy": _entry("policy"),
    "switching method": _entry("switching"),
    "motion": _entry("motion"),
    "law": _damping,
    "kind of damping": _damping,
    "sensor error": _term("imu"),
    "log error": _term("reference"),
    "import format": _format,
}
