"""How much of the window the plots' frames fill: ``python -m tools.paint.share [WIDTHxHEIGHT ...]``."""

import sys

from playwright.sync_api import Page

from schuler_bench.serve import open_dashboard
from tests.browser.driver import Bench
from tools.chromium import launched

WINDOWS = ("1920x1080", "1366x768", "1280x720", "1180x820", "2560x1440")
FRAMES = """() => [...document.querySelectorAll('.js-plotly-plot, .uplot')]
  .filter(each => each.checkVisibility())
  .map(each => each.getBoundingClientRect())
  .map(({left, right, top, bottom}) =>
    [Math.min(right, innerWidth) - Math.max(left, 0), Math.min(bottom, innerHeight) - Math.max(top, 0)])
  .filter(([width, height]) => width > 1 && height > 1)"""
"""Widths and heights of the frames of the plots in view, as far as they lie in the window, CSS px."""


def share(page: Page) -> float:
    """Part of the window that the frames of the plots in view fill."""
    width, height = page.evaluate("() => [innerWidth, innerHeight]")
    return sum(across * down for across, down in page.evaluate(FRAMES)) / (width * height)


def main(windows: list[str]) -> None:
    """Print the share in each window, and the frames."""
    server, dashboard = open_dashboard(port=0)
    with launched() as browser:
        page = browser.new_context(viewport={"width": 1920, "height": 1080}).new_page()
        bench = Bench(page, server.url, dashboard.sessions).open()
        for window in windows:
            width, height = map(int, window.split("x"))
            bench.resize((width, height))
            page.wait_for_function("look.drawn")
            page.wait_for_timeout(2000)  # the plots grow to fill their panels
            frames = ", ".join(f"{across:.0f} x {down:.0f}" for across, down in page.evaluate(FRAMES))
            print(f"{window}: {100.0 * share(page):.1f} % ({frames})", flush=True)
    server.stop()
    dashboard.close()


if __name__ == "__main__":
    main(sys.argv[1:] or list(WINDOWS))
