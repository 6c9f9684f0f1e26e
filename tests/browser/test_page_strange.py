"""The page in strange surroundings: a browser that translates it, a frame in which no script may run."""

from typing import Any

from playwright.sync_api import Browser

from schuler_bench.http.server import DashboardServer

# As Google's translation does: each text goes into two elements, once it is there and when it changes.
TRANSLATE = """() => {
  const wrap = () => {
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const found = [];
    while (texts.nextNode()) found.push(texts.currentNode);
    for (const text of found) {
      const holder = text.parentElement;
      const kept = "script, style, textarea, font, [translate=no], svg, .uplot";
      if (!text.data.trim() || holder === null || holder.closest(kept)) continue;
      const [outer, inner] = [document.createElement("font"), document.createElement("font")];
      inner.textContent = text.data;
      outer.append(inner);
      text.replaceWith(outer);
    }
  };
  wrap();
  window.translating = setInterval(wrap, 50);
  return document.querySelectorAll("font").length;
}"""


def test_a_translated_page_goes_on(another: Any) -> None:
    bench = another(1920, 1080).open(query="?fixedDpr=0.25&start=no&tab=Method")
    bench.reset("zha-fast", "Frequency", "Errors", "Method", selected=2)
    page = bench.page
    page.locator(".sb-handle:visible").first.wait_for()
    told = page.locator(".sb-handle:visible .sb-handle-tip").first.text_content()
    assert page.evaluate(TRANSLATE) > 50
    for _ in range(3):
        bench.press("network.xi")
    bench.wait_until(
        lambda: page.locator(".sb-handle:visible .sb-handle-tip").first.text_content() != told, 10.0
    )
    bench.box("network.xi").fill("0,5")
    bench.wait_until(lambda: bench.session.scenario.method[2].network.xi == 0.5, 10.0)
    bench.settle()
    bench.tab("Step")
    page.evaluate("clearInterval(window.translating)")
    assert bench.faults == []


def test_a_frame_without_scripts_says_why_it_is_blank(
    browser: Browser, dashboard: tuple[DashboardServer, Any]
) -> None:
    page = browser.new_page()
    page.route("**/static/*.js", lambda route: route.abort())
    page.goto(dashboard[0].url)
    note = page.locator("#sb-blank")
    assert not note.is_visible()  # a page that is only loading says nothing
    page.evaluate("() => document.getAnimations().forEach(each => each.finish())")
    assert note.is_visible() and "allow-same-origin" in note.inner_text()
    assert note.get_by_role("link").get_attribute("target") == "_blank"
    page.unroute("**/static/*.js")
    page.goto(f"{dashboard[0].url}?start=no")
    page.wait_for_selector("[role=tab]")
    page.evaluate(
        "() => document.getAnimations().forEach(each => each.playState === 'finished' || each.finish())"
    )
    assert not note.is_visible()
    page.close()
