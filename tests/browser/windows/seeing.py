"""Looks at the page as a person does: what is there, whole and uncovered, and in which language it speaks."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from tests.browser.test_page_language import left_out

if TYPE_CHECKING:
    from playwright.sync_api import Locator

    from tests.browser.driver import Bench

CHINESE = re.compile("[\u4e00-\u9fff]")
PATIENCE_S = 20.0

# What keeps a person from seeing an element; empty: it is seen. Where its panel scrolls, it is scrolled to
# first, and what lets the pointer through is asked for as if it did not.
_HIDDEN = """element => {
  const outside = (box, frame) => box.left < frame.left - 1.5 || box.top < frame.top - 1.5
    || box.right > frame.right + 1.5 || box.bottom > frame.bottom + 1.5;
  const told = box => [box.left, box.top, box.right, box.bottom].map(Math.round).join();
  const frames = [];
  for (let at = element.parentElement; at; at = at.parentElement) {
    const {overflowX, overflowY} = getComputedStyle(at);
    if (overflowX === 'visible' && overflowY === 'visible') continue;
    const frame = at.getBoundingClientRect(), box = element.getBoundingClientRect();
    if (['auto', 'scroll'].includes(overflowY)) {
      const [above, below] = [frame.top - box.top, box.bottom - frame.bottom];
      if (below > 0) at.scrollTop += Math.min(below, -above) + 2;
      else if (above > 0) at.scrollTop -= above + 2;
    }
    frames.push(at);
  }
  const box = element.getBoundingClientRect();
  const shown = element.checkVisibility({visibilityProperty: true, opacityProperty: true});
  if (!shown || box.width < 2 || box.height < 2) return 'it is not shown';
  const all = {left: 0, top: 0, right: innerWidth, bottom: innerHeight};
  if (outside(box, all)) return `it leaves the window: ${told(box)}`;
  const frame = frames.find(each => outside(box, each.getBoundingClientRect()));
  if (frame) return `${told(box)} is cut by ${frame.className} ${told(frame.getBoundingClientRect())}`;
  for (const part of [element, ...element.querySelectorAll('*')]) {
    const typed = part.tagName === 'INPUT';
    const written = typed || [...part.childNodes].some(n => n.nodeType === 3 && n.data.trim() !== '');
    const clips = typed || getComputedStyle(part).overflowX !== 'visible';
    if (written && clips && !part.readOnly && part.clientWidth > 2 && part.scrollWidth > part.clientWidth + 1)
      return `its text is cut: ${part.value ?? part.textContent}`;
  }
  const through = getComputedStyle(element).pointerEvents === 'none';
  const kept = element.style.pointerEvents;
  if (through) element.style.pointerEvents = 'auto';
  const whole = element.closest('.mantine-Input-wrapper') ?? element; // a box has parts over its ends
  const over = [[.5, .5], [.2, .2], [.8, .2], [.2, .8], [.8, .8]]
    .map(([x, y]) => document.elementFromPoint(box.left + x * box.width, box.top + y * box.height))
    .find(top => top === null || !(whole.contains(top) || top.contains(element)));
  if (through) element.style.pointerEvents = kept;
  return over === undefined ? '' : `it is covered by ${over?.outerHTML.slice(0, 120)}`;
}"""


def see(bench: Bench, found: Locator) -> Locator:
    """Wait until what is found first can be seen: in the window, not cut, not covered; return it."""
    first, why = found.first, "nothing is there"
    for _ in range(round(PATIENCE_S / 0.05)):
        why = first.evaluate(_HIDDEN) if first.count() else why
        if not why:
            return first
        bench.page.wait_for_timeout(50)
    raise AssertionError(f"{found}: {why}")


def read(bench: Bench, found: Locator) -> str:
    """Text of what is found first, once it can be seen; in the language of the page."""
    text = see(bench, found).inner_text()
    speaks(bench, text)
    return text


def speaks(bench: Bench, text: str) -> None:
    """Let a text be in the language of the page; names, fields and symbols stay as they are written."""
    if bench.language == "en":
        assert not CHINESE.search(text), text
        return
    english = left_out(line.strip() for line in re.split(r"[\n\t]", text))
    assert not english, english
