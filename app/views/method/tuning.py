"""In the tab "Method", below an adaptive policy: find its table for this scenario (Sun's double loop)."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from navcore.design.sun_settings import TuningSettings
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.text import Text
from navcore.questions.adapt import AdaptQuestion
from navcore.scenario.method import Method
from schuler_bench.editing import form
from schuler_bench.editing.form import FieldSpec
from schuler_bench.plots import style
from schuler_bench.shell import notices
from schuler_bench.shell.control import Control, Section
from schuler_bench.shell.searching import SearchControls, reveal, show_html
from schuler_bench.shell.view import Frame, Tab
from schuler_bench.views.method.tuned import table_html

FIND, STOP, USE = Text("Find the table for this scenario"), Text("Stop the search"), Text("Use this table")
_TITLE = Text("Table by Sun's double loop")
_SHOWN = ("smallest", "largest", "step", "error", "drift_tau_s", "realisations")
_LABELS = {"step": Text("coefficient step"), "realisations": Text("drifts averaged")}
_TOLD = Text(
    "Runs this scenario with every damping ratio, and takes for each velocity difference the one with "
    "the least integral of the squared velocity errors (Sun 8)."
)


class TuningPanel:
    """Settings, button, progress, and the table that came out.

    Parameters
    ----------
    frame : Frame
        Of the page.
    tab : context manager
        Where it stands.
    order : float
        Place in the tab.
    """

    def __init__(self, frame: Frame, tab: Tab, order: float) -> None:
        gui = frame.gui
        self._client, self._session, self._network = frame.client, frame.session, None
        self._tuner = frame.session.searches.asking["adapt"]
        self._fields: dict[str, Any] = {}
        with tab:
            self._folder = gui.add_folder(_TITLE, order=order, expand_by_default=False)
        self._folder.visible = False
        self._section = Section(gui, self._folder, self._edit, 0.0)
        with self._folder:
            gui.add_html(notices.small(_TOLD), order=-1.0)
            self._controls = SearchControls(gui, self._tuner, self._find, (FIND, STOP), _TOLD, order=20.0)
            self._found = gui.add_html("", visible=False, order=23.0)
            self._use = gui.add_button(
                USE, visible=False, order=24.0, hint=Text("One step of undo takes it back.")
            )
        self._use.on_click(lambda _: self._take())

    def show(self) -> None:
        """Show how far the search is, or what it gave, where the method's policy has a table."""
        tuner, scenario, index = self._tuner, self._session.scenario, self._session.selected
        method = scenario.method[index]
        wanted = tunable(method)
        reveal((self._folder, wanted))
        if not wanted:
            return
        self._network = method.network
        settings = self._settings()
        values: dict[form.Path, Any] = {("tuning", name): getattr(settings, name) for name in _SHOWN}
        self._section.show(_specs(settings), values, None)
        running, result = self._controls.follow(), tuner.result
        reveal((self._use, not running and result is not None))
        html = notices.note(tuner.words, "warning")
        if result is not None and tuner.asked is not None:
            if tuner.asked.scenario != scenario:
                html += notices.note(
                    [Text("Found for the scenario as it was before: find it anew.")], "warning"
                )
            html += table_html(
                result, style.method_color(self._session.display.colored(scenario)[method.name])
            )
        show_html(self._found, html)

    def _settings(self) -> TuningSettings:
        """Settings as entered, for the network at hand."""
        return TuningSettings.model_validate(self._fields | {"network": self._network})

    def _find(self) -> None:
        with self._session.lock:
            scenario = self._session.scenario
        self._tuner.begin(AdaptQuestion(scenario=scenario, loop=self._settings()))

    def _take(self) -> None:
        """Give the method the table that was found."""
        from navcore.design.sun import with_table

        session = self._session
        with session.lock:
            result = self._tuner.result
            if result is None:
                return
            try:
                changed = with_table(session.scenario, result, session.selected)
                session.change(changed, None, name=Text("damping table found"))
            except InputError as error:
                notices.tell(self._client, Text("The table cannot be used"), notices.fault_lines(error))

    def _edit(self, control: Control, by_slider: bool) -> None:
        name, entered = str(control.spec.path[-1]), control.take(by_slider)
        data = self._fields | {name: entered, "network": self._network}
        try:
            value = control.read(entered)
            value = int(value) if control.spec.kind == "integer" else value
            data[name] = value
            TuningSettings.model_validate(data)
        except InputError as error:
            self._refuse(control, error.faults)
            return
        except ValidationError as error:
            self._refuse(control, faults_from(error, TuningSettings, data, ""))
            return
        except ValueError as error:  # text that is no number
            self._refuse(control, [Fault("", "", entered, str(error))])
            return
        control.follow(value)
        self._fields[name] = value
        control.say("")

    def _refuse(self, control: Control, faults: Iterable[Fault]) -> None:
        kept = f"{self._fields.get(str(control.spec.path[-1]), '')}"
        control.refuse([notices.refusal(fault, kept) for fault in faults])


def tunable(method: Method) -> bool:
    """Whether a method has a damping table."""
    return method.policy.id == "adaptive" and not method.undamped


def _specs(settings: TuningSettings) -> list[FieldSpec]:
    by_name = {str(spec.path[-1]): spec for spec in form.fields(TuningSettings, ("tuning",))}
    names = [n for n in _SHOWN if n in by_name and (settings.error == "drift" or n not in _SHOWN[4:])]
    return [replace(by_name[n], label=_LABELS.get(n, by_name[n].label)) for n in names]
