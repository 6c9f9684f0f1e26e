"""The page of a report, as HTML."""

from collections.abc import Iterator

from navcore.foundation.answers import assumptions
from navcore.foundation.text import Text, quoted
from navcore.foundation.version import __version__
from navcore.questions.report import Case, Told, matrix_table
from navcore.questions.run import Ran
from navcore.scenario.file import scenario_hash, to_toml
from navcore.scenario.method import Method
from navcore.scenario.provenance import source_of
from navcore.scenario.stochastic import drawn_as_zero
from schuler_bench.plots import style
from schuler_bench.plots.limits import requirement_words
from schuler_bench.plots.paper import paper, section
from schuler_bench.session.uploads import with_plain_names
from schuler_bench.views.diagram.blocks import State, diagram
from schuler_bench.views.diagram.svg import diagram_svg
from schuler_bench.views.requirements.report_moving import moving_section
from schuler_bench.views.requirements.report_plots import error_svgs

_QUESTION = Text("Which methods meet which limits, and what do the verdicts rest on?")


def page(told: Told) -> str:
    """Make the page: matrix, methods, budget, worst case, assumptions, plots, sliders and the scenario."""
    scenario = told.scenario
    title = scenario.title or Text("Verification report")
    moving, script = moving_section(scenario)
    parts = [
        Text("<header><h1>{title:html}</h1>{about}</header>", title=title, about=_about(told)),
        section(Text("Verification matrix"), *map(_matrix, (one for one in told.cases if one.rows))),
        section(Text("Methods"), *_methods(told)),
        section(Text("Error budget by source"), _answer(told.budget, told, Text("budget"))),
        section(Text("Worst case of the log"), _answer(told.worst, told, Text("worst case"))),
        section(Text("What was assumed"), _assumed(told)),
        section(Text("Plots"), *(_figure(svg) for svg in error_svgs(told.cases[0].run))),
        section(Text("Sliders"), moving),
        section(Text("Numbers of the run"), _table(Ran(told.cases[0].run, told.cases[0].shares).html())),
        section(
            Text("Scenario"),
            Text("<pre>{toml:html}</pre>", toml=to_toml(with_plain_names(scenario))),
        ),
    ]
    return paper("en", quoted(title), str(Text.joined("", parts)), script)


def _about(told: Told) -> str:
    scenario = told.scenario
    lines = {
        Text("Question"): quoted(_QUESTION),
        Text("Scenario"): quoted(source_of(scenario) or scenario.title or "-"),
        "SHA-256": Text("<code>{digest}</code>", digest=scenario_hash(scenario)),
        Text("Program"): Text("Schuler Bench {version}", version=__version__),
        Text("Seeds"): _seeds(told),
        Text("Limits"): Text.joined("; ", (quoted(requirement_words(one)) for one in scenario.requirement)),
        Text("Clauses"): quoted(told.clauses),
    }
    rows = (
        Text("<dt>{name}</dt><dd>{value}</dd>", name=name, value=value)
        for name, value in lines.items()
        if value
    )
    return Text("<dl>{rows}</dl>", rows=Text.joined("", rows))


def _seeds(told: Told) -> str:
    first = told.scenario.run.seed
    return Text(
        "{count}, from {first} to {last}, each with its own noise and constants",
        count=told.seeds,
        first=first,
        last=first + told.seeds - 1,
    )


def _matrix(case: Case) -> str:
    head = Text("<h3>{title:html}</h3>", title=case.title) if case.title else ""
    said = Text("<p>{text:html}</p>", text=case.text) if case.text else ""
    return Text(
        '{head}{said}<div class="table sb-matrix">{table}</div>',
        head=head,
        said=said,
        table=matrix_table(case.rows).html(),
    )


def _methods(told: Told) -> list[str]:
    """Parameters and block diagram of each method."""
    made = []
    scenario = told.scenario
    for place, method in enumerate(told.cases[0].run.methods):
        svg = diagram_svg(diagram(scenario, place), style.method_color(method.place), State(), commands=False)
        words, name = "; ".join(_settings(scenario.method[place])), method.method.name
        made.append(
            Text(
                '<figure class="sb-block"><figcaption>{name:html}</figcaption>'
                "<p><code>{words:html}</code></p>{svg}</figure>",
                name=name,
                words=words,
                svg=svg,
            )
        )
    return made


def _settings(method: Method) -> Iterator[str]:
    """Fields of a method, block by block."""
    yield f"damping = {method.damping}"
    for block, held in method.model_dump(exclude_none=True).items():
        if not isinstance(held, dict) or not method.kind.uses_network:
            continue
        name = held.get("id", "")
        fields = ", ".join(f"{field} = {value}" for field, value in held.items() if field != "id")
        if name not in ("none", "hard", "constant"):
            yield f"{block}: {', '.join(part for part in (name, fields) if part)}"


def _answer(answer: object, told: Told, name: str) -> str:
    """Tables of an answer; why there is none."""
    html = getattr(answer, "html", None)
    if html is not None:
        return _table(html())
    reasons = (reason for part, reason in told.left_out if part == name)
    reason = Text.joined("; ", reasons) or Text("not computed")
    return Text("<p>{reason:html}</p>", reason=reason)


def _assumed(told: Told) -> str:
    """Say what was taken as 0, and warn of what the runs warn of."""
    from navcore.design.stated import assumed_zero

    said = [*assumptions(assumed_zero(told.scenario))]
    if zero := drawn_as_zero(told.scenario):
        fields = ", ".join(zero)
        said.append(
            Text("drawn as 0 in the run, though a standard deviation is given: {fields}", fields=fields)
        )
    for case in told.cases:
        warnings = list(case.run.warnings)
        for method in case.run.methods:
            name = method.method.name
            warnings += (Text("{name}: {text}", name=name, text=text) for text in method.warnings)
        before = f"{case.title}: " if case.title else ""
        said += (f"{before}{text}" for text in warnings)
    items = (Text("<li>{text:html}</li>", text=text) for text in said)
    return Text("<ul>{items}</ul>", items=Text.joined("", items)) if said else Text("<p>Nothing.</p>")


def _table(html: str) -> str:
    return Text('<div class="table">{html}</div>', html=html)


def _figure(svg: str) -> str:
    return Text("<figure>{svg}</figure>", svg=svg)
