"""The page without a service, as one file."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from playwright.sync_api import Page
from rkm04_tools.service import static
from wasm_build import build_wasm


def write_alone(folder: Path) -> Path:
    """Write it into a folder; return the file."""
    with pytest.MonkeyPatch.context() as patch:
        host = build_wasm().parents[1] / "host"
        patch.setenv("RKM04_BUILD", os.environ.get("RKM04_BUILD", str(host)))
        static.write(folder)
    return folder / "index.html"


def write(page: Page, text: str) -> None:
    """Put a text in the place of the shown program."""
    page.locator(".cm-content").click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.insert_text(text)


def steps(page: Page) -> int:
    """The live position of the first motor."""
    return int(re.sub(r"\D", "", page.locator("#position-1").inner_text()))
