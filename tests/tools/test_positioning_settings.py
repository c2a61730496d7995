"""`positioning settings` against `serve`: nothing is written of a file that is damaged."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from served import Served

Tool = Callable[..., Any]
Serve = Callable[..., Served]


def test_settings_are_saved_compared_and_restored(
    pos_call: Callable[..., str], positioning: Tool, tmp_path: Path
):
    file = tmp_path / "unit.json"
    pos_call("settings", "backup", file)
    pos_call("settings", "set", "STEPS=3", "MICROMETRES=7", "SOFT_MIN=-5", "--axis", "2")

    differ = positioning("settings", "diff", file)
    assert differ.status == 1
    assert differ.out.splitlines() == [
        "axis2 STEPS: file 1, unit 3",
        "axis2 MICROMETRES: file 10, unit 7",
        "axis2 SOFT_MIN: file 0, unit -5",
    ]
    assert "3 settings written" in pos_call("settings", "restore", file)
    assert "the unit is set so" in pos_call("settings", "diff", file)
    assert pos_call("settings", "get", "STEPS", "--axis", "2").split() == ["STEPS", "1", "steps"]


def test_only_store_keeps_settings(positioning: Tool, pos_serve: Serve, tmp_path: Path):
    flash = tmp_path / "unit.flash"
    for value, found, options in [(20, 0, []), (30, 0, ["--store"]), (40, 30, [])]:
        served = pos_serve("--flash", flash)
        port = ["--port", served.place]
        told = positioning("settings", "get", "BACKLASH", "--json", *port).json
        assert told["settings"] == {"BACKLASH": found}
        assert positioning("settings", "set", f"BACKLASH={value}", *options, *port).status == 0
        served.end()


def damaged(content: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Files that must not be taken, and why."""
    text = json.dumps(content)
    yield text[:-3], "it is no JSON"
    yield "[]", "it is of another kind"
    yield text.replace("positioning settings", "memory"), "it is of another kind"
    yield text.replace('"layout": 1', '"layout": 2'), "another version"
    yield text.replace('"axis4"', '"axis5"'), "it must have"
    yield text.replace('"BACKLASH"', '"BACKLESS"', 1), "does not have just its settings"
    yield text.replace('"BACKLASH": 0', '"BACKLASH": 70000', 1), "no value of its range"
    yield text.replace('"BACKLASH": 0', '"BACKLASH": true', 1), "no value of its range"
    yield text.replace('"RATE": 192', '"RATE": 193'), "no value of its range"


def test_a_damaged_file_writes_nothing(
    pos_call: Callable[..., str], positioning: Tool, tmp_path: Path
):
    file = tmp_path / "unit.json"
    pos_call("settings", "backup", file)
    pos_call("settings", "set", "BACKLASH=5")

    for text, why in list(damaged(json.loads(file.read_text()))):
        file.write_text(text)
        result = positioning("settings", "restore", file)
        assert result.status == 1
        assert why in result.complaint
    assert pos_call("settings", "get", "BACKLASH").split()[1] == "5"


def test_nothing_is_restored_while_an_axis_is_taken(
    pos_call: Callable[..., str], positioning: Tool, tmp_path: Path
):
    file = tmp_path / "unit.json"
    pos_call("settings", "backup", file)
    pos_call("settings", "set", "BACKLASH=5")
    pos_call("init", "--axis", "3")

    assert "reset comes first" in positioning("settings", "restore", file).complaint
    assert pos_call("settings", "get", "BACKLASH").split()[1] == "5"
