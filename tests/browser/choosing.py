"""Tabs, and the chips of the methods above their parameters."""

from collections.abc import Callable

from playwright.sync_api import Locator, Page


class Choosing:
    """What `tests.browser.driver.Bench` does with tabs and chips."""

    page: Page
    said: Callable[[str], str]
    settle: Callable[[], None]
    heard: Callable[[], None]

    def tab(self, *names: str) -> None:
        """Bring tabs to the front; wait until the page holds what they show."""
        for name in names:
            title = self.said(name)
            tab = self.page.get_by_role("tab", name=title, exact=True, include_hidden=True)
            if tab.get_attribute("aria-selected") == "true":
                continue
            if tab.is_visible():
                tab.click()
            else:
                self.page.locator(".sb-more-tabs").select_option(label=title)
            self.heard()

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
