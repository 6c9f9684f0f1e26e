"""Tabs and their modes, and the chips of the methods above their parameters."""

from collections.abc import Callable

from playwright.sync_api import Locator, Page

from schuler_bench.shell.tabs import Standing, standings
from schuler_bench.views import load


def standing(name: str) -> Standing | None:
    """Where the view of this title stands, if there is one."""
    return next((one for one in standings(load()) if one.title == name), None)


class Choosing:
    """What `tests.browser.driver.Bench` does with tabs and chips."""

    page: Page
    said: Callable[[str], str]
    settle: Callable[[], None]
    heard: Callable[[], None]

    def tab(self, *names: str) -> None:
        """Bring views to the front, each by its tab and its mode or by the menu; wait for what they show."""
        for name in names:
            tab = self.tab_of(name)
            if tab.get_attribute("aria-selected") != "true":
                self._go(name, tab)
                self.heard()
            if (one := standing(name)) is not None and one.fold:
                head = self.page.locator(f"[data-sb-fold='{name}'] > [aria-expanded]")
                if head.get_attribute("aria-expanded") == "false":
                    head.click()

    def tab_of(self, name: str) -> Locator:
        """viser's tab of a view, by the view's title: of the views of one tab the strip shows one."""
        one = standing(name)
        title = one.tab if one is not None and one.fold else name
        return self.page.get_by_role("tab", include_hidden=True).filter(
            has=self.page.get_by_text(self.said(title), exact=True)
        )

    @property
    def views(self) -> list[str]:
        """Titles of the views that the page has now, those of the menu last."""
        there = [one for one in standings(load()) if self.tab_of(one.title).count() > 0]
        return [one.title for one in sorted(there, key=lambda one: not one.tab)]

    def _go(self, name: str, tab: Locator) -> None:
        if tab.is_visible():
            tab.click()
            return
        one = standing(name)
        assert one is not None, f"no view has the title {name!r}"
        if not one.tab:
            self.page.get_by_role("button", name=self.said("Menu"), exact=True).click()
            self.page.locator(f".sb-links [data-command='tab {name}']").click()
            return
        whole = self.page.get_by_role("tab", name=self.said(one.tab), exact=True)
        if whole.get_attribute("aria-selected") != "true":
            whole.click()
        mode = self.page.locator(".sb-modes").get_by_role("radio", name=self.said(one.mode), exact=True)
        if mode.get_attribute("aria-checked") != "true":
            mode.click()

    def wait_for_front(self, name: str) -> None:
        """Wait until a view is in front, or the tab of which it is a fold."""
        one = standing(name)
        name = one.tab if one is not None and one.fold else name
        front = "title => [...document.querySelectorAll('[role=tab][aria-selected=true]')]"
        self.page.wait_for_function(f"{front}.some(tab => tab.textContent === title)", arg=self.said(name))

    def chip(self, method: str) -> Locator:
        """The chip of a method, whose press lets the controls edit it."""
        chip = self.page.locator(".sb-chip").filter(has=self.page.get_by_text(method, exact=True))
        return chip.locator("button[aria-pressed]")

    def edit(self, method: str) -> None:
        """Let the controls edit a method, and wait until what follows is shown."""
        self.chip(method).click()
        self.settle()

    @property
    def edited(self) -> str:
        """Name of the method that the controls edit."""
        return self.page.locator(".sb-chip button[aria-pressed=true]").inner_text()

    def menu(self, entry: str) -> Locator:
        """Open the menu of the edited method, if it is closed; return one of its buttons."""
        menu = self.page.locator("details.sb-menu")
        if menu.get_attribute("open") is None:
            menu.locator("summary").click()
        return menu.get_by_role("button", name=self.said(entry), exact=True)
