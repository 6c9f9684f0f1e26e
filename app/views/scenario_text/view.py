"""Tab "Scenario": the scenario of the run as TOML, as it can be saved."""

from navcore.foundation.text import Text
from schuler_bench.session.shown import Shown
from schuler_bench.session.uploads import with_plain_names
from schuler_bench.shell.view import MENU, PictureView, Tab


class ScenarioTextView(PictureView[str]):
    """The text alone."""

    title = Text("Scenario")
    place = "upper"
    tab = MENU
    look_for = Text("The scenario as a file: what the command line and a colleague need to repeat this run.")

    def build(self, tab: Tab) -> None:
        """Make the place of the text."""
        with tab:
            self._text = self.frame.gui.add_html("")

    def picture(self, found: Shown) -> str:
        """Write the scenario, HTML."""
        from navcore.scenario.file import to_toml

        return Text(
            '<pre style="margin:4px 12px;font-size:12px;line-height:1.4;white-space:pre-wrap">'
            "{to_toml:html}</pre>",
            to_toml=to_toml(with_plain_names(found.run.scenario)),
        )

    def show(self, picture: str) -> None:
        """Show the text."""
        self._text.content = picture


VIEW = ScenarioTextView
