"""The page in Debian's headless Chromium; without it these tests are skipped."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fake_unit import FakeLine, FakeUnit
from playwright.sync_api import Browser, Page, expect, sync_playwright
from service_page import Service, ServicePage, free_port, shown
from tab import PATIENCE_SECONDS, opened_tab, visited

CHROMIUM = Path("/usr/bin/chromium-headless-shell")


@pytest.fixture(scope="package")
def browser() -> Iterator[Browser]:
    """Not for the session: its event loop would be in the way of the tests after these."""
    if not CHROMIUM.exists():
        pytest.skip(f"{CHROMIUM} is not there: install Debian's package {CHROMIUM.name}")
    expect.set_options(timeout=PATIENCE_SECONDS * 1000)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@contextlib.contextmanager
def running() -> Iterator[Service]:
    service = Service()
    try:
        yield service
    finally:
        service.end()


@pytest.fixture(scope="session")
def service() -> Iterator[Service]:
    """One for all tests that leave it as they found it."""
    with running() as service:
        yield service


@pytest.fixture
def own_service() -> Iterator[Service]:
    """One that may be disconnected or ended."""
    with running() as service:
        yield service


@pytest.fixture(scope="module")
def tab(browser: Browser) -> Iterator[Page]:
    """For one test after the other."""
    with opened_tab(browser) as tab:
        yield tab


@pytest.fixture
def page(tab: Page, service: Service) -> Iterator[ServicePage]:
    with visited(ServicePage, tab, service.url) as page:
        yield page
        if page.has_acted:
            page.calm()


@pytest.fixture
def own_page(tab: Page, own_service: Service) -> Iterator[ServicePage]:
    with visited(ServicePage, tab, own_service.url) as page:
        yield page


NODE, OTHER = 3, 5
"""Of the units on a line of the test's own."""


@pytest.fixture(scope="session")
def lines_service() -> Iterator[Service]:
    """One that may be connected to any line."""
    with running() as service:
        yield service


@pytest.fixture
def unit() -> FakeUnit:
    return FakeUnit(NODE)


@pytest.fixture(scope="session")
def line_port() -> int:
    """One for all lines: a page keeps units in mind that it has seen on other ones."""
    return free_port()


@pytest.fixture
def line(unit: FakeUnit, line_port: int) -> Iterator[FakeLine]:
    line = FakeLine(unit, FakeUnit(OTHER), port=line_port)
    yield line
    line.close()


@pytest.fixture
def reopen(line: FakeLine, unit: FakeUnit, line_port: int) -> Iterator[Callable[[], FakeLine]]:
    """Bring a line back that the test has closed, at the same port."""
    opened: list[FakeLine] = []

    def begin() -> FakeLine:
        opened.append(FakeLine(unit, FakeUnit(OTHER), port=line_port))
        return opened[-1]

    yield begin
    for each in opened:
        each.close()


@pytest.fixture(scope="module")
def open_page(browser: Browser, lines_service: Service) -> Iterator[ServicePage]:
    """One page for many tests, since it takes a second to be drawn."""
    with shown(browser, lines_service.url, waits=False) as page:
        yield page


@pytest.fixture
def lines_page(
    open_page: ServicePage, line: FakeLine, unit: FakeUnit, reopen: Callable[[], FakeLine]
) -> Iterator[ServicePage]:
    """The page, connected to the unit of the test's own line; at the end all have stopped."""
    open_page.connect(line.port, NODE)
    open_page.ready()
    open_page.sent.clear()
    yield open_page
    line.units |= {NODE: unit, OTHER: FakeUnit(OTHER)}
    unit.status = b""
    open_page.connect(line.port, NODE)
    open_page.stopped()
    open_page.page.locator("#connect").click()
    expect(open_page.page.locator("#port")).to_be_enabled()
    assert open_page.faults == []
