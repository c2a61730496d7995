"""What a stage may not include does not compile: with its own compile command it is not found."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = "tests/system/example"

# A header, and a stage that may include it: so that what is not found below is there at all.
FOUND = {
    "axis.h": "rkm04/interpreter",
    "gve_command.h": "gve134/line",
    "gve_float.h": "gve134/command",
    "gve_guards.h": "gve134/queue",
    "gve_outputs.h": "gve134",
    "gve_queue.h": "gve134",
    "gve_speeds.h": "gve134/queue",
    "group.h": "gve134/queue",
    "interpreter.h": "rkm04/messages",
    "interpreter_shared.h": "rkm04",
    "io.h": "rkm04/interpreter",
    "messages.h": "rkm04",
    "motion_plan.h": "engine/axis",
    "program_memory.h": "rkm04/interpreter",
    "rkm04.h": "rkm04",
    "step_channel.h": "engine/motion",
    "store.h": "rkm04/messages",
}


@pytest.fixture(scope="module")
def folders(build_folder: None) -> dict[str, list[str]]:
    """The include folders of each stage, by its folder in firmware/; and of all else."""
    commands = Path(os.environ["RKM04_BUILD"]) / "compile_commands.json"
    found = {}
    for command in json.loads(commands.read_text(encoding="utf-8")):
        source = Path(command["file"])
        if source.is_relative_to(ROOT) and not source.name.startswith("test_"):
            stage = source.parent.relative_to(ROOT).as_posix().removeprefix("firmware/")
            found[stage] = [each for each in shlex.split(command["command"]) if each[:2] == "-I"]
    return found


def complaint(folders: list[str], header: str) -> str:
    command = ["gcc", "-std=c11", "-fsyntax-only", *folders, "-x", "c", "-"]
    line = f'#include "{header}"\n'
    return subprocess.run(command, input=line, capture_output=True, text=True, check=False).stderr


@pytest.mark.parametrize("header", FOUND)
def test_a_stage_finds_the_headers_of_the_stage_below(
    folders: dict[str, list[str]], header: str
) -> None:
    assert complaint(folders[FOUND[header]], header) == ""


@pytest.mark.parametrize(
    ("stage", "header"),
    [
        ("engine/step", "motion_plan.h"),  # against the flow of data
        ("engine/motion", "axis.h"),
        ("rkm04/program", "interpreter.h"),
        ("rkm04/interpreter", "messages.h"),
        ("rkm04/interpreter", "step_channel.h"),  # a stage two below
        ("rkm04/interpreter", "motion_plan.h"),
        ("rkm04", "step_channel.h"),
        (EXAMPLE, "motion_plan.h"),
        (EXAMPLE, "step_channel.h"),
        ("rkm04/messages", "axis.h"),  # what the interpreter has for itself
        ("rkm04/messages", "motion_plan.h"),
        ("rkm04/messages", "io.h"),
        ("engine/step", "rkm04.h"),  # a unit, from what all units share
        ("engine/axis", "interpreter.h"),
        ("engine/axis", "io.h"),
        ("gve134/command", "gve_line.h"),
        ("gve134/line", "gve_float.h"),
        ("gve134/command", "store.h"),
        ("gve134/line", "link_receiver.h"),
        ("gve134/speeds", "gve_queue.h"),
        ("gve134/guards", "gve_queue.h"),
        ("gve134/guards", "io.h"),
        ("gve134/outputs", "gve_queue.h"),
        ("gve134/queue", "gve_outputs.h"),
        ("gve134/queue", "gve_line.h"),
        ("gve134", "group.h"),
        ("engine/group", "gve_queue.h"),
        ("rkm04", "gve_queue.h"),
        ("rkm04", "gve_line.h"),
        ("io", "interpreter_shared.h"),
        ("store", "program_memory.h"),
    ],
)
def test_a_stage_does_not_find_what_it_may_not_include(
    folders: dict[str, list[str]], stage: str, header: str
) -> None:
    assert f"{header}: No such file" in complaint(folders[stage], header)
