"""All texts that a page can show: from Python, from scripts, from lessons, explanations and presets."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

from navcore.foundation.assets import asset_path
from schuler_bench.views import load
from tools.translating import python, scripts
from tools.translating.python import Text, pieces

ROOT = Path(__file__).parents[2]
_NOT_ON_THE_PAGE = tuple(
    """
    app/cli app/bench app/languages app/bridge app/jobs/cluster.py
    app/workers.py app/logs.py app/serve.py app/memory.py app/__main__.py app/http/access.py
    app/http/address.py app/http/site.py app/http/front.py app/http/metrics.py
    app/http/page.py app/http/ids.py app/http/places.py app/http/server.py app/session/database.py
    app/jobs/scheduler.py navcore/__init__.py navcore/warm.py navcore/design/form.py
    navcore/scenario/guide.py navcore/scenario/schema_file.py navcore/foundation/guarded.py
    navcore/foundation/kernel_cache.py navcore/foundation/kernel_digest.py
    navcore/foundation/kernel_files.py
    navcore/foundation/registry.py navcore/design/sun.py navcore/design/sun_settings.py
    navcore/analysis/report.py navcore/analysis/network_table.py navcore/analysis/python_control.py
    navcore/io/column_names.py
    """.split()
)
"""Python files whose texts are for a terminal, a report, a log or a file."""


_OF_VISER = (
    "Software WebGL rendering detected",
    "WebGL is running in software mode, not on your GPU. Performance may be degraded. "
    "If this is unexpected, check that hardware acceleration is enabled in your browser settings.",
    "About Viser",
    "Collapse panel area",
    "Expand panel area",
    "Edit props for {0}",
    "Nothing found...",
    "No matching commands...",
    "Uploading {0} ({1})",
    "Uploading...",
    "Search commands...",
    "Adaptive",
)
"""Texts of viser's own page."""
_OF_SCRIPTS = ("play",)
"""Words of our scripts that look like code."""
_SYMBOLS = frozenset({"starboard"})
"""Element names that stay as they are."""


def texts() -> list[Text]:
    """Every text once, in a fixed order."""
    found: dict[str, Text] = {}
    for text in (*_python(), *script_texts(), *_assets(), *_fields()):
        if text.key not in found or text.prose > found[text.key].prose:
            found[text.key] = text
    return list(found.values())


def _python() -> Iterator[Text]:
    for package in ("app", "navcore"):
        for path in sorted((ROOT / package).rglob("*.py")):
            name = path.relative_to(ROOT).as_posix()
            if not name.startswith(_NOT_ON_THE_PAGE):
                yield from python.texts_in(path, name)


def script_texts() -> Iterator[Text]:
    """Texts that scripts write: their own, viser's, and those that reach the 3D view and legends as data."""
    for path in sorted((ROOT / "app").rglob("*.js")):
        name = path.relative_to(ROOT).as_posix()
        if not name.startswith("app/languages") and not name.endswith(".min.js"):
            yield from scripts.texts_in(path, name)
    for key in (*_OF_VISER, *_OF_SCRIPTS):
        yield Text(key, "viser")
    as_data = [*sorted((ROOT / "app" / "views" / "scene").glob("*.py")), ROOT / "app" / "plots" / "legend.py"]
    for path in as_data:
        yield from python.texts_in(path, path.relative_to(ROOT).as_posix())


def _assets() -> Iterator[Text]:
    from navcore.quantities.known import ledger
    from navcore.scenario.file import load, presets
    from schuler_bench.views.learn.lessons import lessons, to_html

    for entry, fields in tomllib.loads(asset_path("explain.toml").read_text(encoding="utf-8")).items():
        for name in ("says", "source"):
            yield from pieces(fields.get(name, ""), f"explain.toml: {entry}", prose=name == "says")
    for entry in ledger():
        if entry.by == "oracle":
            yield Text(entry.source, "ledger.json", prose=True)
    for name in presets():
        scenario = load(name)
        yield from pieces(scenario.title, f"presets/{name}.toml")
        yield from pieces(scenario.source, f"presets/{name}.toml", prose=False)
    for lesson in lessons():
        where = f"lessons/{lesson.id}.md"
        yield from pieces(f"<p>{lesson.title}</p><p>{lesson.about}</p>", where)
        for name in ("title", "source"):
            yield from pieces(str(lesson.scenario.get(name, "")), where, prose=False)
        for step in lesson.steps:
            yield from pieces(f"<p>{step.title}</p>{to_html(step.text, None)}", where)
            choices = () if step.question is None else step.question.choices
            conditions = () if step.task is None else step.task.conditions
            for asked in filter(None, (step.question, step.sketch, step.task)):
                for text in (asked.ask, asked.why):
                    yield from pieces(to_html(text, None), where)
            for choice in (*choices, *conditions):
                yield from pieces(to_html(choice.say, None), where)
        for line in (*lesson.goals, *lesson.misconceptions):
            yield from pieces(to_html(line, None), where)


def _fields() -> Iterator[Text]:
    """Labels of the controls, a field's own or its name, names of a vector's elements, and choices."""
    from navcore.foundation.parameters import Parameters, extra_of
    from schuler_bench.editing import form

    load()  # so that all models are there
    for kind in _models(Parameters):
        for name, info in kind.model_fields.items():
            extra, where = extra_of(info), f"{kind.__module__}:{kind.__name__}"
            if extra.get("hidden"):  # no control, see navcore.questions.base.option
                continue
            for label in (form.plain_label(name, info), *extra.get("elements", ())):
                if re.search("[a-z]{3,}", label) and label not in _SYMBOLS:
                    yield Text(label, where, prose=re.search("[a-z]{4,}", label) is not None)
            for choice in (*form.choices_of(info), name.replace("_", " ")):
                yield Text(choice, where, prose=False)


def _models(base: type) -> Iterator[type]:
    """Models of the program; those that a test has made are no texts of a page."""
    for kind in base.__subclasses__():
        if kind.__module__.startswith(("schuler_bench.", "navcore.")):
            yield kind
        yield from _models(kind)
