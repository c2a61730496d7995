"""The page in Debian's Chromium; without it these tests are skipped."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect, sync_playwright
from service_page import PATIENCE_SECONDS, Service, ServicePage, shown

CHROMIUM = Path("/usr/bin/chromium")


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Not for the session: its event loop would be in the way of the tests behind these."""
    if not CHROMIUM.exists():
        pytest.skip(f"{CHROMIUM} is not there: install Debian's package chromium")
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


@pytest.fixture
def page(browser: Browser, service: Service) -> Iterator[ServicePage]:
    with shown(browser, service.url) as page:
        yield page
        page.calm()


@pytest.fixture
def own_page(browser: Browser, own_service: Service) -> Iterator[ServicePage]:
    with shown(browser, own_service.url) as page:
        yield page
