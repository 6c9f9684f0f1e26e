"""``python -m tools.moving [SCENARIO] [--out FILE]``: what the moving part of a report weighs and takes.

Writes the report, opens it in Chromium as a file, moves each slider to and fro, and prints the report's size
and the times of the steps of a slider, picture included. ``--slow 4`` makes the processor four times slower,
as that of a phone.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

from navcore.questions.report import ReportQuestion
from navcore.scenario.file import load
from tools.chromium import launched

_MOVES = 30
_MOVE = """async moves => {
  const root = document.getElementById("sb-moving");
  for (const input of root.querySelectorAll("input[type=range]")) {
    const low = Number(input.min), high = Number(input.max);
    for (let k = 0; k < moves; k++) {
      input.value = low + ((high - low) * k) / moves;
      input.dispatchEvent(new Event("input"));
      await new Promise(requestAnimationFrame);
    }
  }
  return root.moving.steps;
}"""


def measured(file: Path, slow: float = 1.0) -> np.ndarray:
    """Return the times of slider steps in a report, ms.

    Parameters
    ----------
    file : Path
        The report.
    slow : float
        How many times slower the processor is made.
    """
    with launched() as browser:
        page = browser.new_page()
        if slow != 1.0:
            page.context.new_cdp_session(page).send("Emulation.setCPUThrottlingRate", {"rate": slow})
        page.goto(file.as_uri())
        page.locator("#sb-moving canvas").first.wait_for()
        return np.array(page.evaluate(_MOVE, _MOVES))


def main() -> None:
    """Carry out the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scenario", nargs="?", default="liu-networks")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--slow", type=float, default=1.0)
    given = parser.parse_args()
    limit = ["requirement.0.quantity=position_cep50_m", "requirement.0.at_most=1 nmi"]
    asked = ReportQuestion.ask({"scenario": load(given.scenario, limit), "seeds": 8})
    with tempfile.TemporaryDirectory() as folder:
        file = given.out or Path(folder) / "report.html"
        (text,) = asked.texts(asked.answer()).values()
        file.write_text(text, "utf-8")
        print(f"report: {file.stat().st_size / 1e6:.3g} MB")
        steps = measured(file.resolve(), given.slow)
    median, late = np.percentile(steps, [50.0, 95.0])
    print(f"{len(steps)} steps of sliders: median {median:.2f} ms, 95 % within {late:.2f} ms")


if __name__ == "__main__":
    main()
