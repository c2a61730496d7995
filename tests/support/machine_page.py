"""Machine files in the page of RKM04: opened, and saved."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from playwright.sync_api import FilePayload, expect
from rkm04_tools.machine.machine import parse_machine
from service_page import ServicePage

FEED = "{ feed, žlutý }\r\n\\ C100 O03\r\nF400 R\r\n"
CLAMP = "\\ C100 F50 R"
INPUTS = "# the door\n500,3,1\n"


def content(**more: Any) -> dict[str, Any]:
    limits = {"position_max_steps": 60_000, "speed_max_steps_per_s": 1000}
    return {
        "format": "rkm04-machine",
        "version": 1,
        "name": "Podavač",
        "notes": "grease it",
        "motors": [
            {"name": "feed", "program": FEED, "steps_per_mm": 200.5, "limits": limits},
            {"program": CLAMP},
            {"program": "{ nothing yet }"},
            {"program": ""},
        ],
        "inputs": INPUTS,
        "input_names": {"3": "door"},
        "output_names": {"1": "lamp"},
        **more,
    }


def open_bytes(page: ServicePage, data: bytes, name: str = "a.rkm") -> None:
    file: FilePayload = {"name": name, "mimeType": "application/json", "buffer": data}
    page.page.locator("#machine-file").set_input_files(file)


def open_machine(page: ServicePage, told: dict[str, Any]) -> None:
    open_bytes(page, json.dumps(told).encode())
    expect(page.page.locator("#machine-shown")).to_have_text(told["name"])


def save(page: ServicePage) -> tuple[str, dict[str, Any]]:
    """Save the machine; return name and content of the file."""
    page.page.evaluate("() => { delete window.showSaveFilePicker; }")
    with page.page.expect_download() as download:
        page.page.locator("#machine-save").click()
    data = Path(download.value.path()).read_bytes()
    return download.value.suggested_filename, parse_machine(data, "saved")
