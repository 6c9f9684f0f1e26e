"""The pictures of README and docs, made from the real page: ``python -m tools.tour`` (``make tour``).

Drives the dashboard in headless Chromium as a visitor would and writes ``docs/tour.webp``, 20 seconds with
captions, ``docs/dashboard.png``, ``docs/upload.png`` and ``docs/export.png``.
"""

import io
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont
from playwright.sync_api import Page

from schuler_bench.serve import open_dashboard
from tests.browser.driver import Bench
from tests.browser.patience import THROTTLE_MS
from tools.chromium import launched

DOCS = Path(__file__).resolve().parents[1] / "docs"
TOUR, STILL, UPLOAD = DOCS / "tour.webp", DOCS / "dashboard.png", DOCS / "upload.png"
EXPORT = DOCS / "export.png"
RECORDINGS = DOCS.parent / "assets" / "recordings"
WIDTH, HEIGHT, CAPTION_PX = 1280, 720, 52
LARGEST_BYTES = 3_000_000
_QUALITIES = (82, 70, 60, 50, 40)


def rest(page: Page, wait_ms: int = 900) -> None:
    """Let the 3D view and the plots come to rest before a picture is taken, and tooltips close."""
    page.mouse.move(0.35 * WIDTH, 0.9 * HEIGHT)
    page.wait_for_timeout(wait_ms)


@dataclass
class Film:
    """Frames with captions.

    Parameters
    ----------
    page : playwright Page
        What is filmed.
    """

    page: Page
    frames: list[Image.Image] = field(default_factory=list)
    lasts_ms: list[int] = field(default_factory=list)
    caption: str = ""

    def shoot(self, lasts_ms: int, caption: str = "", *, rest_ms: int = 900) -> None:
        """Take a frame of the page at rest, with a caption (the last one, when none is given)."""
        if rest_ms:
            rest(self.page, rest_ms)
        self.caption = caption or self.caption
        shot = Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")
        frame = Image.new("RGB", (WIDTH, HEIGHT), "#0b2a44")
        frame.paste(shot, (0, 0))
        drawn = ImageDraw.Draw(frame)
        place = (WIDTH // 2, HEIGHT - CAPTION_PX // 2)
        drawn.text(place, self.caption, font=_font(25), fill="white", anchor="mm")
        self.frames.append(frame)
        self.lasts_ms.append(lasts_ms)

    def save(self, path: Path) -> int:
        """Write an animated WebP, small enough for a README; return its size in bytes."""
        for quality in _QUALITIES:
            first, *others = self.frames
            first.save(
                path,
                save_all=True,
                append_images=others,
                duration=self.lasts_ms,
                loop=0,
                quality=quality,
                method=6,
                minimize_size=False,
            )
            if path.stat().st_size <= LARGEST_BYTES:
                break
        return path.stat().st_size


def _font(size: int) -> ImageFont.FreeTypeFont:
    import matplotlib

    return ImageFont.truetype(Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf", size)


def film(bench: Bench, take: Film) -> None:
    """Scenes of the tour: preset, slider, pin, poles, strapdown, lesson, dark page."""
    page = bench.page
    for part in (_preset, _slider, _pin, _poles, _verify, _lesson):
        part(bench, take)
        bench.settle()
        bench.close_notices()
    page.locator("body").press("d")
    page.wait_for_selector("#sb-theme[data-theme=opposite]", state="attached")
    take.shoot(1800, "Press D in a dim room, ? for the keys, Ctrl+K for everything")


def _preset(bench: Bench, take: Film) -> None:
    bench.tab("Method", "Errors")
    take.shoot(2000, "Schuler Bench: design and judge the damping of an inertial navigator")
    bench.box("scenario").click()
    bench.page.get_by_role("option", name="zha-external", exact=True).hover()
    take.shoot(1200, "Choose a preset: the figures and tables of five papers", rest_ms=0)
    before = bench.run
    bench.page.get_by_role("option", name="zha-external", exact=True).click()
    bench.wait_for_run(before)
    bench.page.locator("#sb-strip .sb-edit", has_text="fast (compass)").click()
    bench.settle()
    bench.tab("Errors")
    take.shoot(1500)


def _slider(bench: Bench, take: Film) -> None:
    for step in range(5):
        _slide(bench, "ArrowLeft")
        take.shoot(
            1000 if step == 4 else 350, "Move a slider: loop, curves and track answer at once", rest_ms=500
        )


def _pin(bench: Bench, take: Film) -> None:
    bench.page.locator("body").press("p")
    while not len(bench.session.pins.all):
        bench.page.wait_for_timeout(THROTTLE_MS)
    for step in range(4):
        _slide(bench, "ArrowRight")
        take.shoot(
            1100 if step == 3 else 350, "Pin a run and compare: dashed is what you pinned", rest_ms=500
        )


def _slide(bench: Bench, key: str) -> None:
    """Move a slider a good way by keys, and let the last run of it be shown."""
    for _ in range(8):
        bench.slider("network.sigma").press(key)
    bench.page.wait_for_timeout(4 * THROTTLE_MS)
    bench.press("network.sigma", key)


def _poles(bench: Bench, take: Film) -> None:
    bench.tab("Poles")
    bench.plotly()
    take.shoot(1900, "Poles, root locus, Nyquist: place a pole and get its parameters")


def _verify(bench: Bench, take: Film) -> None:
    bench.tab("Errors")
    button = bench.page.get_by_role("button", name="Verify with full strapdown")
    button.focus()
    take.shoot(1100, "Verify: the full nonlinear strapdown on the same noise, dashed")
    button.click()
    bench.page.locator(".sb-note:visible", has_text="Verified.").wait_for(timeout=120_000)
    bench.close_notices()
    take.shoot(2000, rest_ms=2000)


def _lesson(bench: Bench, take: Film) -> None:
    page = bench.page
    for pin in bench.session.pins.all:
        bench.session.pins.remove(pin.id)
    bench.tab("Learn")
    page.locator("[data-command='lesson open 0']").click()
    page.locator(".sb-lesson h3").wait_for()
    page.locator("[data-command='lesson show']").click()
    page.locator("[data-command='lesson show'].sb-quiet").wait_for()
    bench.settle()
    page.locator("[data-command='lesson next']").click()
    page.get_by_label("Your answer").fill("84.5")
    page.get_by_label("Your answer").scroll_into_view_if_needed()
    take.shoot(1600, "Learn: each lesson drives the page and asks about it")
    page.keyboard.press("Enter")
    page.locator(".sb-question[data-right=true]").wait_for()
    page.locator("[data-command='lesson next']").scroll_into_view_if_needed()
    take.shoot(1700)


def still(bench: Bench) -> None:
    """The README's one picture: the page as a new visitor sees it."""
    bench.tab("Method", "Frequency", "Errors")
    rest(bench.page, 3000)
    bench.page.screenshot(path=STILL)


def upload(bench: Bench) -> None:
    """Take the picture of docs/import.md: a track and a log from elsewhere, whose columns the user names."""
    bench.tab("Files", "Frequency", "Errors")
    rows = (RECORDINGS / "sikuliaq-log.csv").read_text().splitlines()[2:]
    log = "".join(f"{cells[0]};{cells[1]}\n" for cells in (row.split(",") for row in rows))
    bench.upload(RECORDINGS / "sikuliaq-track.csv")
    bench.notice("sikuliaq-track.csv: ")
    table = f"utc;fahrt\n{log}".encode()
    bench.upload({"name": "bridge-log.csv", "mimeType": "text/csv", "buffer": table})
    bench.notice("bridge-log.csv is kept")
    for label, choice in (("column", "fahrt"), ("means", "speed through water"), ("unit", "kn")):
        bench.choose(label, choice)
    with bench.next_run():
        bench.button("Read by these columns").click()
    bench.close_notices()
    bench.button("Upload a file").evaluate("button => button.scrollIntoView({block: 'center'})")
    rest(bench.page)
    bench.page.screenshot(path=UPLOAD, clip={"x": 0, "y": 104, "width": 325, "height": 976})


def on_a_page(size: tuple[int, int], act: Callable[[Bench], None]) -> None:
    """Open the dashboard in a window of this size, do something on it, and close both."""
    server, dashboard = open_dashboard(port=0)
    try:
        with launched() as browser:
            page = browser.new_page(viewport={"width": size[0], "height": size[1]})
            act(Bench(page, server.url, dashboard.sessions).open(query="?start=no"))
    finally:
        server.stop()
        dashboard.close()


def make_tour(bench: Bench) -> None:
    """Film the tour and write it."""
    take = Film(bench.page)
    film(bench, take)
    size = take.save(TOUR)
    print(f"{TOUR.name}: {len(take.frames)} pictures, {sum(take.lasts_ms) / 1e3:.1f} s, {size / 1e6:.2f} MB")


def export(bench: Bench) -> None:
    """Take a picture of the equations of a method, and of the form of its export."""
    page = bench.page
    bench.reset("zha-external", "Method", "Frequency", "Errors", selected=2)
    page.get_by_text("Equations with these numbers").click()
    page.get_by_text("Law for a navigation computer").click()
    page.get_by_role("button", name="Download (ZIP)").scroll_into_view_if_needed()
    rest(page)
    page.screenshot(path=EXPORT, clip={"x": 0, "y": 104, "width": 325, "height": 976})
    print(f"{EXPORT}: {EXPORT.stat().st_size / 1e6:.2f} MB")


def main() -> None:
    """Make all pictures."""
    on_a_page((1920, 1080), still)
    on_a_page((1920, 1080), upload)
    on_a_page((1920, 1080), export)
    on_a_page((WIDTH, HEIGHT - CAPTION_PX), make_tour)


if __name__ == "__main__":
    main()
