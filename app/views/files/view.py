"""Tab "Files": upload of recordings and scenarios, download of the scenario and its numbers."""

from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.session.shown import Shown
from schuler_bench.session.uploads import LARGEST_FILE, MIB, Upload
from schuler_bench.shell import notices
from schuler_bench.shell.opening import METRICS, SCENARIO
from schuler_bench.shell.view import MENU, Frame, Tab, View
from schuler_bench.views.files.columns import Columns
from schuler_bench.views.files.live import LivePart
from schuler_bench.views.files.own_ins import OwnIns

_ASIDE = Text(
    "What was kept of this session, exactly as it was: this version of the program cannot read it, or not "
    "all of it. It stays on the server as well."
)
_UNNAMED = Text("columns still to be named")


class FilesView(View):
    """Upload and download."""

    title = Text("Files")
    place = "edit"
    tab = MENU
    asks = ("damp",)

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._columns = Columns(frame, self._mark)
        self._own = OwnIns(frame)
        self._live = LivePart(frame)
        add, opening = frame.commands.register, frame.opening
        add("save", lambda _: opening.give_file(SCENARIO), Text("Save the scenario (TOML)"), "Ctrl+S")
        add("save-numbers", lambda _: opening.give_file(METRICS), Text("Save the numbers (JSON)"))
        upload = Text("Open a scenario or a recording")
        add("open", lambda _: frame.commands.ask_page("upload", ""), upload, "Ctrl+O")

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui, opening = self.frame.gui, self.frame.opening
        with tab:
            self._live.build(-1)
            gui.add_html(notices.heading(Text("Run on recordings")), order=0)
            kinds = Text(
                "Speed log, track and heading: NMEA 0183, CSV, Parquet, MAT or npz, one file "
                "after the other, at most {largest_file:.0f} MiB each. A recorded IMU (PSINS "
                "or a table) runs as full strapdown. A scenario (.toml) is opened. What the columns "
                "of a table mean is guessed; it can be changed below.",
                largest_file=LARGEST_FILE / MIB,
            )
            gui.add_html(notices.small(kinds), order=1)
            self._upload = upload = gui.add_upload_button(Text("Upload a file"), hint=kinds, order=2)
            self._list = gui.add_html("", order=3)
            self._use = gui.add_button(Text("Run on these files"), order=4, visible=False)
            self._forget = gui.add_button(Text("Remove the files"), color="gray", order=5, visible=False)
            self._columns.build(6)
            self._own.build(7)
            gui.add_html(notices.heading(Text("Save")), order=10)
            save = [
                gui.add_button(Text("Download {name}", name=name), color="gray", order=11)
                for name in (SCENARIO, METRICS)
            ]
            aside = self.session.keeping.aside
            if aside:
                gui.add_html(notices.heading(Text("Kept, but not readable")), order=20)
                gui.add_html(notices.small(_ASIDE), order=21)
            for number, one in enumerate(aside):
                label = Text("Download {name}", name=one.name)
                button = gui.add_button(label, color="gray", hint=Text(one.why), order=22)
                button.on_click(lambda _, number=number: opening.give_aside(number))
        upload.on_upload(lambda event: opening.take_file(event.target.value.name, event.target.value.content))
        self._use.on_click(lambda _: opening.use_files())
        self._forget.on_click(lambda _: opening.forget_files())
        for button, name in zip(save, (SCENARIO, METRICS), strict=True):
            button.on_click(lambda _, name=name: opening.give_file(name))

    def follow_scenario(self) -> None:
        """List the uploaded files and what they hold."""
        uploads = self.session.uploads
        self._list.content = Text.joined("", (_entry(name, upload) for name, upload in uploads.files.items()))
        self._forget.visible = bool(uploads.files)
        self._use.visible = any(not upload.faults for upload in uploads.files.values())
        self._columns.follow()
        self._own.follow()
        self._mark()

    def draw(self, found: Shown) -> None:
        """Say what damping would have changed, of a run on a ship's own INS."""
        self._own.draw(found.run)

    def close(self) -> None:
        """The browser has gone."""
        self._live.close()

    def _mark(self) -> None:
        """Give the button that comes next the colour of the main one: a file, its columns or the run."""
        runs, waits = self._use.visible, self._columns.waits
        self._upload.color = "gray" if runs or waits else None
        self._use.color = "gray" if waits else None


def _entry(name: str, upload: Upload) -> str:
    text = "\n".join(line.removeprefix("  ") for line in upload.text)
    return Text(
        '<details class="sb-file" style="margin:0 10px 8px;font-size:13px;color:{ink}">'
        "<summary><b>{name:html}</b> <span style='color:{muted}'>{kind:html}{sorted:html}</span></summary>"
        '<div style="white-space:pre-wrap;margin-top:4px;color:{muted}">{text:html}</div>'
        "{note}</details>",
        ink=style.INK,
        name=name,
        muted=style.MUTED,
        kind=upload.kind or _UNNAMED,
        sorted="".join((": ", ", ".join(sorted(upload.quantities)))) if upload.quantities else "",
        text=text,
        note=notices.note(upload.warnings, "warning"),
    )


VIEW = FilesView
