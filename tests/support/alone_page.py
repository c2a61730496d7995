"""The page without a service, as one file."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect
from rkm04_tools import static_pages
from wasm_build import build_wasm


def write_alone(folder: Path) -> Path:
    """Write it into a folder; return the file."""
    with pytest.MonkeyPatch.context() as patch:
        host = build_wasm().parents[1] / "host"
        patch.setenv("RKM04_BUILD", os.environ.get("RKM04_BUILD", str(host)))
        static_pages.write(folder)
    return folder / "index.html"


def write(page: Page, text: str) -> None:
    """Put a text in the place of the shown program."""
    page.locator(".cm-content").click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.insert_text(text)


def forget(page: Page) -> None:
    """Empty the memories of all four motors."""
    page.locator("#motors label").first.click()
    page.locator("#reset").click()
    page.wait_for_timeout(600)  # the second press must not follow at once
    page.locator("#reset").click()
    expect(page.locator("#log .log-item").first).to_have_attribute("data-message", "reset")


def steps(page: Page) -> int:
    """The live position of the first motor."""
    return int(re.sub(r"\D", "", page.locator("#position-1").inner_text()))


def hold(page: Page, farthest: int) -> None:
    """Hold the button on which the motor runs forth, until it moves."""
    page.locator("#commission").evaluate("(panel) => (panel.open = true)")
    page.locator("#commission-confirm").check()
    for name, value in (("start", "500"), ("speed", "2000"), ("farthest", str(farthest))):
        page.locator(f"#commission-{name}").fill(value)
    expect(page.locator("#jog-forth")).to_be_enabled()
    page.locator("#jog-forth").scroll_into_view_if_needed()
    box = page.locator("#jog-forth").bounding_box()
    assert box
    page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.mouse.down()
    expect(page.locator("#state-1")).to_contain_text("moves")
