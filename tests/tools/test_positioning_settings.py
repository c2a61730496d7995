"""`positioning settings` against `serve`: nothing is written of a file that is damaged."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from served import Served

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_SECONDS = 15.0
WRITE_MULTIPLE = 16

Tool = Callable[..., Any]
Serve = Callable[..., Served]


def test_a_setting_that_is_given_twice_is_refused_and_nothing_is_written(
    pos_call: Callable[..., str], positioning: Tool
):
    result = positioning("settings", "set", "BACKLASH=5", "BACKLASH=6")

    assert result.status == 2
    assert "BACKLASH is there twice" in result.complaint
    assert pos_call("settings", "get", "BACKLASH").split()[:2] == ["BACKLASH", "0"]


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
    yield text.replace('"RATE": 192', '"RATE": 192, "RATE": 96'), "RATE is there twice"
    content["settings"]["axis1"]["BACKLASH"] = 6
    content["settings"]["axis4"]["STEPS"] = 5001
    yield json.dumps(content), "axis 4: 5001 STEPS in 10 MICROMETRES"


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
        assert "nothing was written" in result.complaint
    assert pos_call("settings", "get", "BACKLASH").split()[1] == "5"


def test_diff_of_a_damaged_file_speaks_of_no_writing(
    positioning: Tool, pos_call: Callable[..., str], tmp_path: Path
):
    (tmp_path / "unit.json").write_text("[]")
    pos_call("status")

    told = positioning("settings", "diff", tmp_path / "unit.json").complaint
    assert "it is of another kind; settings backup makes such a file" in told


def test_nothing_is_restored_while_an_axis_is_taken(
    pos_call: Callable[..., str], positioning: Tool, tmp_path: Path
):
    file = tmp_path / "unit.json"
    pos_call("settings", "backup", file)
    pos_call("settings", "set", "BACKLASH=5")
    pos_call("init", "--axis", "3")

    assert "reset comes first" in positioning("settings", "restore", file).complaint
    assert pos_call("settings", "get", "BACKLASH").split()[1] == "5"


def test_nothing_is_set_where_an_axis_that_a_part_concerns_is_taken(
    pos_call: Callable[..., str], positioning: Tool
):
    pos_call("init", "--axis", "3")

    for arguments in (["BACKLASH=5", "WATCHDOG=100"], ["BACKLASH=5", "--store"]):
        assert "axis 3 is TAKEN" in positioning("settings", "set", *arguments).complaint
        assert pos_call("settings", "get", "BACKLASH").split()[1] == "0"
    assert "BACKLASH is 5" in pos_call("settings", "set", "BACKLASH=5")


def test_a_value_that_is_not_taken_is_told_with_its_range(
    pos_call: Callable[..., str], positioning: Tool
):
    pos_call("status")
    for wrong, status, why in [
        ("WATCHDOG=9", 2, "with a VALUE of 0, or 10 to 60000"),
        ("RATE=100", 2, "with a VALUE of 96, 192, 384, 576 or 1152"),
        ("SOFT_MIN=2147483648", 2, "with a VALUE of -2147483648 to 2147483647"),
        (
            "MICROMETRES=20000",
            1,
            "axis 1: 1 STEPS in 20000 MICROMETRES: the quotient is 1/10000 to",
        ),
    ]:
        result = positioning("settings", "set", "BACKLASH=5", wrong)
        assert result.status == status
        assert why in result.complaint
        assert pos_call("settings", "get", "BACKLASH").split()[1] == "0"


class Dying:
    """A line to a unit that falls silent at the n-th request that writes several registers."""

    def __init__(self, place: str, after: int) -> None:
        host, _, number = place.removeprefix("socket://").rpartition(":")
        self._unit = (host, int(number))
        self._left = after
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.place = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"
        self.is_silent = threading.Event()
        threading.Thread(target=self._run, daemon=True).start()

    def close(self) -> None:
        self._listener.close()

    def _run(self) -> None:
        with (
            suppress(OSError),
            self._listener.accept()[0] as client,
            socket.create_connection(self._unit) as unit,
        ):
            unit.settimeout(0.2)
            while asked := client.recv(1000):
                self._left -= asked[1] == WRITE_MULTIPLE
                if self._left < 0:
                    self.is_silent.set()
                    continue
                unit.sendall(asked)
                with suppress(TimeoutError):
                    while answer := unit.recv(1000):
                        client.sendall(answer)


def mixed(pos_call: Callable[..., str], tmp_path: Path) -> Path:
    """A backup that differs from the unit in two axes."""
    file = tmp_path / "unit.json"
    for axis in (1, 3):
        pos_call("settings", "set", "BACKLASH=5", "SOFT_MAX=7", "--axis", axis)
    pos_call("settings", "backup", file)
    for axis in (1, 3):
        pos_call("settings", "set", "BACKLASH=0", "SOFT_MAX=0", "--axis", axis)
    return file


def test_a_restore_that_the_line_cuts_off_tells_what_was_written(
    pos_call: Callable[..., str], positioning: Tool, tmp_path: Path
):
    file = mixed(pos_call, tmp_path)
    with closing(Dying(os.environ["POSITIONING_PORT"], after=1)) as line:
        result = positioning("settings", "restore", file, "--store", "--port", line.place)

    assert result.status == 3
    assert "NOT CONFIRMED: whether the settings of axis3 were written: " in result.complaint
    assert "; written: axis1; nothing is stored; do it once more" in result.complaint
    assert positioning("settings", "diff", file).out.splitlines() == [
        "axis3 BACKLASH: file 5, unit 0", "axis3 SOFT_MAX: file 7, unit 0",
    ]  # fmt: skip


def test_a_store_that_is_cut_off_is_not_known(pos_call: Callable[..., str], positioning: Tool):
    pos_call("status")
    with closing(Dying(os.environ["POSITIONING_PORT"], after=1)) as line:
        result = positioning("settings", "set", "BACKLASH=5", "--store", "--port", line.place)

    assert result.status == 3
    assert "NOT CONFIRMED: whether the settings are stored: " in result.complaint
    assert "; all of them are written; positioning status" in result.complaint


def test_ctrl_c_in_a_restore_tells_what_was_written(pos_call: Callable[..., str], tmp_path: Path):
    file = mixed(pos_call, tmp_path)
    with closing(Dying(os.environ["POSITIONING_PORT"], after=1)) as line:
        command = [sys.executable, "-P", "-m", "rkm04_tools.positioning", "settings", "restore"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
        process = subprocess.Popen(
            [*command, str(file), "--port", line.place],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
        )  # fmt: skip
        try:
            assert line.is_silent.wait(PATIENCE_SECONDS)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=PATIENCE_SECONDS)
        finally:
            process.kill()
            process.communicate()

    assert (process.returncode, out) == (130, "")
    assert "whether the settings of axis3 were written: interrupted; written: axis1" in err


def test_the_readme_tells_how_to_try_damaged_settings(
    positioning: Tool, pos_serve: Serve, tmp_path: Path
):
    readme = (ROOT / "tools/rkm04_tools/positioning/README.md").read_text("utf-8")
    example = readme.partition("## Damaged settings")[2].partition("```python\n")[2]
    served = pos_serve("--flash", "unit.flash")
    positioning("settings", "set", "BACKLASH=5", "--store", "--port", served.place)
    served.end()

    subprocess.run([sys.executable, "-c", example.partition("```")[0]], cwd=tmp_path, check=True)
    port = ("--port", pos_serve("--flash", "unit.flash").place)
    assert "THE STORED SETTINGS ARE DAMAGED" in positioning("status", *port).out
    assert "error 14" in positioning("move", "1", *port).complaint
