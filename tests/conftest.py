"""Fixtures that every folder of tests shares."""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings
from hypothesis.internal.conjecture import providers

from navcore.foundation.kernel_cache import cache_folder
from tools.chromium import FLAGS, find_chromium
from tools.compile_time import Uncounted
from tools.fonts import NARROW, one_font

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

REPO_ROOT = Path(__file__).resolve().parent.parent

# The same examples on every run: a failure on one machine is a failure on all. Unless told, Hypothesis draws
# from the constants of all loaded modules too, which every edit and every choice of tests changes.
settings.register_profile("schuler", deadline=None, derandomize=True, database=None)
settings.load_profile("schuler")
providers._get_local_constants = lambda: providers._local_constants


def pytest_configure() -> None:
    """Let all workers, and what a test starts with another HOME, use the kernels already compiled."""
    os.environ.setdefault("SCHULER_CACHE_DIR", str(cache_folder().parent))
    os.environ.setdefault("MPLBACKEND", "Agg")
    Uncounted().listen()
    # What a dashboard that a test starts keeps is not the user's.
    os.environ["XDG_STATE_HOME"] = tempfile.mkdtemp(prefix="schuler-tests-")
    atexit.register(shutil.rmtree, os.environ["XDG_STATE_HOME"], ignore_errors=True)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave the sweeps to `make nightly`, and where asked for what is slow to `make test SLOW=yes`."""
    later = {"nightly"} if not os.environ.get("SCHULER_NIGHTLY") else set[str]()
    later |= {"slow"} if os.environ.get("SCHULER_QUICK") else set()
    left_out = [item for item in items if any(map(item.get_closest_marker, later))]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]


@pytest.fixture(scope="session")
def repo_root() -> Path:
    """Top folder of the checkout."""
    return REPO_ROOT


@pytest.fixture(scope="session")
def chromium() -> Path:
    """Executable of a Chromium."""
    path = find_chromium()
    if path is None:
        pytest.skip("no Chromium here (SCHULER_CHROMIUM names one; `make test` installs one where it can)")
    return path


@pytest.fixture(scope="session")
def browser(chromium: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """One headless browser for the whole session; where it can be, all its texts are in one font."""
    from playwright.sync_api import sync_playwright

    env = one_font(NARROW, tmp_path_factory.mktemp("font")) | os.environ
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=chromium, args=list(FLAGS), env=env)
        yield launched
        launched.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """Page of a visitor of its own: cookies and storage are empty."""
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    yield context.new_page()
    context.close()
