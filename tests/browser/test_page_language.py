"""The page in Chinese: nothing that is seen or read aloud is left in English."""

import pytest
from playwright.sync_api import Locator

from navcore.scenario.file import load
from schuler_bench.views.learn.lessons import lessons
from tests.browser.driver import SIZES, Bench
from tests.browser.windows.seeing import left_out

REFUSED = (
    ("junk.txt", bytes(range(256)) * 9),
    ("log.csv", b"time_s,speed_mps\n1,2\n2,x\n"),
    ("wrong.toml", b"title = 3\n[run]\nduration_h = -1\n"),
)
STILL = load("zha-fast")
DIVERGES = load("zha-fast", ["method.2.network.sigma=1.0"])


class Reader:
    """A visitor who reads Chinese, and notes what is seen or read aloud.

    Parameters
    ----------
    bench : Bench
        The page.
    """

    def __init__(self, bench: Bench) -> None:
        self.bench, self.page = bench, bench.page
        self.seen: set[str] = set()

    def look(self) -> None:
        """Note all texts that the page shows now."""
        self.seen |= set(self.page.evaluate("look.seen"))

    def ask(self, *words: str) -> None:
        """Let the page carry out a command, and look at what comes of it."""
        self.page.evaluate("words => schuler.command(...words)", list(words))
        self.bench.settle()
        self.look()

    def dialog(self, *words: str) -> Locator:
        """Look at the dialog that a command opens."""
        self.page.evaluate("words => schuler.command(...words)", list(words))
        dialog = self.page.locator("dialog[open]")
        dialog.wait_for()
        self.look()
        return dialog

    def close(self) -> None:
        """Close what is open over the page."""
        self.page.keyboard.press("Escape")
        self.page.locator("dialog[open], .sb-tour, .mantine-Spotlight-search").first.wait_for(
            state="detached"
        )

    def judge(self) -> None:
        """Let nothing seen so far be English; forget it."""
        found, self.seen = left_out(self.seen), set()
        assert not found, "\n".join(found)
        assert self.bench.faults == []


@pytest.fixture
def reader(chinese: Bench) -> Reader:
    """A visitor with a Chinese page, on a ship under way."""
    chinese.size = SIZES[0]
    chinese.clean()
    chinese.reset("sikuliaq-like", "Method", selected=2)
    return Reader(chinese)


def test_what_is_left_out_is_found() -> None:
    assert left_out({"Undo", "撤销", "classic2", "φE (arcsec)", "3.3 h", "自 that error"}) == [
        "Undo",
        "自 that error",
    ]


def test_every_tab(reader: Reader) -> None:
    for name in reader.bench.views:
        reader.bench.tab(name)
        reader.bench.settle()
        reader.look()
    assert len(reader.seen) > 400
    reader.judge()


def test_dialogs_and_the_palette(reader: Reader) -> None:
    page, bench = reader.page, reader.bench
    for name in ("start", "scenarios", "networks", "keys", "share", "share-view"):
        reader.dialog(name)
        reader.close()
    page.keyboard.press("Control+k")
    search = page.get_by_placeholder(bench.said("Search commands..."))
    search.wait_for()
    reader.look()
    search.fill("xyzzy")
    page.get_by_text(bench.said("No matching commands...")).wait_for()
    reader.look()
    page.keyboard.press("Escape")
    search.wait_for(state="detached")
    for id in ("", bench.id("network.zeta"), bench.box_id("network")):
        reader.ask("explain", id)
        page.wait_for_timeout(150)  # the panel asks for its text ten times a second
        reader.look()
    page.locator(".sb-explain .sb-close").click()
    reader.judge()


@pytest.mark.slow
def test_what_is_refused_and_what_is_told(reader: Reader) -> None:
    page, bench = reader.page, reader.bench
    bench.box("network.zeta").fill("-7")
    page.locator(".sb-note:visible").first.wait_for()
    reader.look()
    bench.type("network.zeta", "0.4")
    # a unit behind a number: the control is found, whatever it is called
    bench.tab("Run")
    bench.box("run.duration_h").press("Control+a")
    page.keyboard.type("540 min")
    reader.look()
    page.keyboard.press("Enter")
    # on a slow machine a run of 540 h has begun before the unit is typed
    bench.wait_until(lambda: bench.session.scenario.run.duration_h == 9.0)
    bench.settle()
    bench.tab("Compare")
    reader.ask("pin")
    bench.tab("Method")
    bench.type("network.zeta", "0.6")
    for command in ("flip", "flip", "reset-all", "reset-all"):
        reader.ask(command)
    bench.notice("Nothing has been changed")
    bench.tab("Metrics")
    reader.look()
    bench.close_notices()
    bench.tab("Files")
    for name, content in REFUSED:
        bench.upload({"name": name, "mimeType": "text/plain", "buffer": content})
        if name.endswith(".csv"):  # a table: its map is offered beside what is wrong with it
            page.locator(".sb-note:visible").filter(has_text="log.csv").first.wait_for()
        else:
            bench.notice("The file cannot be used; nothing was changed")
        reader.look()
        bench.close_notices()
    reader.judge()


@pytest.mark.slow
def test_a_verification_and_a_run_that_diverges(reader: Reader) -> None:
    bench = reader.bench
    bench.put(load("sikuliaq-like", ["run.duration_h=1.0"]), "Errors", "Metrics", selected=2)
    reader.ask("verify")
    bench.wait_until(lambda: bench.session.verifier.result is not None, 120.0)
    bench.settle()
    reader.look()
    bench.tab("Method", "Errors")
    bench.press("network.zeta")
    reader.look()
    for scenario in (DIVERGES, STILL):
        bench.put(scenario, origin="zha-fast")
        for tab in ("Errors", "Metrics", "Design", "Tune"):
            bench.tab(tab)
            reader.look()
    reader.judge()


@pytest.mark.parametrize(
    "number",
    [
        pytest.param(n, marks=pytest.mark.nightly if n else (), id=lesson.id)
        for n, lesson in enumerate(lessons())
    ],
)
def test_a_lesson(reader: Reader, number: int) -> None:
    reader.bench.tab("Learn")
    reader.ask("lesson", f"open {number}")
    for step in lessons()[number].steps:
        if step.question is not None:
            reader.ask("lesson", "show")
            for given in ("0", "1", "x"):
                reader.ask("lesson", f"answer {given}")
        reader.ask("lesson", "next")
    reader.judge()


@pytest.mark.slow
def test_presenting_and_presentation_size(reader: Reader) -> None:
    bench, page = reader.bench, reader.page
    watcher = Bench(page.context.new_page(), bench.url, bench.sessions)
    reader.ask("present")
    reader.seen |= set(watcher.open(f"s/{bench.session_id}/").page.evaluate("look.seen"))
    reader.look()
    watcher.page.close()
    reader.ask("present")
    bench.show(size="presentation")
    page.wait_for_selector("#sb-size", state="attached")
    reader.look()
    reader.judge()
