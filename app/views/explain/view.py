"""The panel that explains the selected control; app/views/learn/learn.js asks for it.

The words, unit and range are the field's own (`navcore.foundation.parameters.quantity`); the equation and its
source come from ``assets/explain.toml``, by the field's place in the scenario, or from the registry entry
(network, motion, policy, switching) that the field belongs to.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import lru_cache

from navcore.damping import KINDS
from navcore.foundation.assets import asset_path
from navcore.foundation.parameters import Parameters, extra_of
from navcore.foundation.text import Text
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.networks import NETWORKS
from navcore.scenario.model import Scenario
from schuler_bench.bridge.controls import control_with
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.shell.view import Frame, Tab, View
from schuler_bench.views.learn.lessons import formula_html

_REGISTRIES: Mapping[str, Mapping[str, type[Parameters]]] = {
    "network": NETWORKS,
    "policy": POLICIES,
    "switching": SWITCHINGS,
    "motion": MOTIONS,
}


@dataclass(frozen=True)
class Explanation:
    """Explanation of a field, beside its help.

    Attributes
    ----------
    latex : str
        Its equation; empty when none says more than the words.
    source : str
        Paper and equation, or section of the product's own physics.
    says : str
        A sentence more than the field's help.
    """

    latex: str = ""
    source: str = ""
    says: str = ""


@lru_cache(maxsize=1)
def explanations() -> dict[str, Explanation]:
    """All explanations by their pattern, in the file's order."""
    data = tomllib.loads(asset_path("explain.toml").read_text(encoding="utf-8"))
    return {pattern: Explanation(**entry) for pattern, entry in data.items()}


def key_of(path: Path, scenario: Scenario) -> str:
    """Name of a field in ``assets/explain.toml``.

    Examples
    --------
    >>> from navcore.scenario.model import Scenario
    >>> key_of(("method", 0, "network", "sigma"), Scenario())
    'network.none.sigma'
    >>> key_of(("imu", "gyro_bias_dph", 1), Scenario())
    'imu.gyro_bias_dph'
    """
    names = [str(step) for step in path if not isinstance(step, int)]
    block, last = names[0], names[-1]
    if block != "method" or len(path) < 4:
        kind = scenario.motion.kind if block == "motion" and last != "kind" else ""
        return ".".join([block, kind, *names[1:]] if kind else names)
    part = names[1]
    if last == "id" or part in (*KINDS, "gyrocompass"):
        return f"{part}.{last}"
    catalogue = "network" if part == "azimuth" else part
    return ".".join([catalogue, getattr(scenario.method[int(path[1])], part).id, *names[2:]])


def explanation(key: str) -> Explanation | None:
    """Explanation of a field: of ``assets/explain.toml`` if it names the field's entry, else the entry's own.

    The first pattern that fits counts. Patterns for all entries of a registry, such as ``motion.*``, come
    last. None where nothing fits.
    """
    fits = [pattern for pattern in explanations() if fnmatchcase(key, pattern)]
    block, _, rest = key.partition(".")
    id, _, field = rest.partition(".")
    entry = _REGISTRIES.get(block, {}).get(id)
    if entry is not None and not any(pattern.startswith(f"{block}.{id}.") for pattern in fits):
        own = _of_entry(entry, field)
        if own is not None:
            return own
    return explanations()[fits[0]] if fits else None


def _of_entry(entry: type[Parameters], field: str) -> Explanation | None:
    """Explanation that a registry entry brings: of the field, else its class's source."""
    info = entry.model_fields.get(field)
    extra = {} if info is None else extra_of(info)
    source = extra.get("source") or getattr(entry, "source", "")
    return Explanation(latex=extra.get("latex", ""), source=source) if source else None


def explain_html(spec: FieldSpec, scenario: Scenario) -> str:
    """HTML of the explanation of a field's control."""
    return told_html(spec.label, spec.hint, explanation(key_of(spec.path, scenario)))


def told_html(label: str, hint: str, more: Explanation | None = None) -> str:
    """HTML of an explanation: heading, words, equation, source."""
    parts = [
        Text("<h2>{label:html}</h2>", label=label),
        Text("<p>{hint:html}</p>", hint=hint) if hint else "",
    ]
    if more is not None:
        parts += [
            Text("<p>{says:html}</p>", says=more.says) if more.says else "",
            *(formula_html(part, block=True) for part in more.latex.split(r"\qquad") if part.strip()),
            Text('<p class="sb-source">Source: {source:html}</p>', source=more.source) if more.source else "",
        ]
    return Text.joined("", parts)


COMMAND = "explain"
"""``explain ID``: the control with that id in the page."""
_NONE_YET = Text(
    "Point at a control, or put the focus on it, and press E or F1, or press the ? beside its name."
)


class ExplainView(View):
    """Answers the command `COMMAND`."""

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._count = 0
        title = Text("Explain the control under the pointer")
        frame.commands.register(COMMAND, self.explain, title, "E", watcher=True)

    def build(self, tab: Tab) -> None:
        """Make the place of the explanation."""
        with tab:
            self._html = self.frame.gui.add_html("", order=4)

    def explain(self, id: str) -> None:
        """Explain the control with this id; say how to ask when there is none."""
        with self.session.lock:
            content = self._content(id.strip())
            self._count += 1
            # No div: what a hidden div holds is for scripts, and stays English
            # (schuler_bench.languages.markup).
            self._html.content = Text(
                '<section id="sb-explained" hidden data-count="{count}">{content}</section>',
                count=self._count,
                content=content,
            )

    def _content(self, id: str) -> str:
        control = next((c for c in self.frame.controls() if id in c.ids), None)
        if control is not None:
            return explain_html(control.spec, self.session.scenario)
        handle = control_with(self.frame.gui, id)
        label = getattr(handle, "label", None)
        if label is None:
            return told_html(Text("Explain"), _NONE_YET)
        return told_html(str(label), str(getattr(handle, "hint", None) or Text("Press it and see.")))


VIEW = ExplainView
