"""What programs would do: they run on the simulator, and the page gets the curves."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools import child, host
from rkm04_tools.check import Checked, check_source
from rkm04_tools.host import stored
from rkm04_tools.report import Run
from rkm04_tools.service.trouble import BadRequest, Superseded
from rkm04_tools.source import Source

REAL_SECONDS = 0.5
"""What a simulation may take; only programs that never wait need more for a minute."""
TIMEOUT_SECONDS = 10.0
SECONDS_MAX = 100_000
POINTS_MIN, POINTS_MAX = 24, 100_000
INPUTS_MAX = 10_000
MS_MAX = 1_000_000_000
TOGETHER_MAX = 2


@dataclass(frozen=True)
class Wanted:
    """What is to be drawn. `part` is the part of the time, in seconds, that points are for."""

    programs: Mapping[int, str]
    inputs: list[tuple[float, int, int]]
    seconds: float = 60.0
    points: int = 2000
    part: tuple[float, float] | None = None
    page: str = ""


def read_wanted(body: Mapping[str, Any]) -> Wanted:
    """Read what a page asks for."""
    programs = body.get("programs")
    if not isinstance(programs, dict) or not programs:
        raise BadRequest('no programs; write {"programs": {"1": "F100 R"}}')
    for motor, text in programs.items():
        if motor not in ("1", "2", "3", "4") or not isinstance(text, str):
            raise BadRequest(f'"{motor}" has no program; give the motors "1" to "4" a text each')
    seconds = _number(body, "seconds", 60.0, 1e-6, SECONDS_MAX)
    points = int(_number(body, "points", 2000, POINTS_MIN, POINTS_MAX))
    page = body.get("page", "")
    if not isinstance(page, str):
        raise BadRequest("page is no text; leave it out")
    texts = {int(motor): text for motor, text in sorted(programs.items())}
    return Wanted(texts, _inputs(body.get("inputs")), seconds, points, _part(body), page)


class Curves:
    """Makes curves; a newer one for the same page ends the one in work."""

    def __init__(self) -> None:
        self._running: dict[str, asyncio.Task[dict[str, Any]]] = {}
        self._turns = asyncio.Semaphore(TOGETHER_MAX)

    async def make(self, wanted: Wanted) -> dict[str, Any]:
        """Return the curves; Superseded if there is no need for them any more."""
        task = asyncio.create_task(self._make_in_turn(wanted))
        if wanted.page:
            if older := self._running.get(wanted.page):
                older.cancel()
            self._running[wanted.page] = task
        try:
            return await task
        except asyncio.CancelledError:
            own = asyncio.current_task()
            if own and own.cancelling():
                raise
            raise Superseded from None
        finally:
            if self._running.get(wanted.page) is task:
                del self._running[wanted.page]

    async def _make_in_turn(self, wanted: Wanted) -> dict[str, Any]:
        async with self._turns:
            checked = await asyncio.to_thread(_checked, wanted)
            for motor, each in checked.items():
                if not each.is_good:
                    first = each.diagnostics[0]
                    where = f"motor {motor}, line {first.place.line}, column {first.place.column}"
                    return _refusal(f"{where}: {first.message}")
            with TemporaryDirectory(prefix="rkm04-curve-") as folder:
                return await _simulate(wanted, checked, Path(folder))


def _checked(wanted: Wanted) -> dict[int, Checked]:
    return {m: check_source(Source(f"motor {m}", text)) for m, text in wanted.programs.items()}


async def _simulate(wanted: Wanted, checked: dict[int, Checked], folder: Path) -> dict[str, Any]:
    curve = folder / "curve.json"
    arguments = _arguments(wanted, checked, folder, curve)
    pipe = asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(
        str(host.program_path()), "sim", *arguments,
        stdin=asyncio.subprocess.DEVNULL, stdout=pipe, stderr=pipe, env=child.bound(),
    )  # fmt: skip
    try:
        out, complaint = await asyncio.wait_for(process.communicate(), TIMEOUT_SECONDS)
    except TimeoutError:
        return _refusal("the simulation takes too long; ask for fewer seconds")
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
    if process.returncode != 0:
        line = complaint.decode(errors="replace").strip().rpartition("\n")[2]
        line = line.removeprefix(f"{host.PROGRAM}: ").replace(f"{folder}/", "")
        return _refusal(line or "the simulator has failed; this is a fault of the tool")
    return _answer(json.loads(out), json.loads(curve.read_bytes()), checked)


def _arguments(wanted: Wanted, checked: dict[int, Checked], folder: Path, curve: Path) -> list[str]:
    arguments = ["--for", _decimal(wanted.seconds), "--real", str(REAL_SECONDS)]
    arguments += ["--curve", str(curve), "--points", str(wanted.points)]
    if wanted.part:
        arguments += ["--from", _decimal(wanted.part[0]), "--to", _decimal(wanted.part[1])]
    for motor, each in checked.items():
        program = folder / f"{motor}.rks"
        program.write_bytes(each.source.message)
        arguments += ["--motor", f"{motor}={program}"]
    if wanted.inputs:
        inputs = folder / "inputs.csv"
        rows = [f"{_decimal(ms)},{number},{level}\n" for ms, number, level in wanted.inputs]
        inputs.write_text("".join(rows), encoding="ascii")
        arguments += ["--inputs", str(inputs)]
    return arguments


def _answer(
    told: dict[str, Any], curve: dict[str, Any], checked: dict[int, Checked]
) -> dict[str, Any]:
    """Join the summary and the lines, for the motors that have a program."""
    lines = {line["motor"]: line for line in curve["motors"]}
    motors = {}
    for each in told["motors"]:
        motor = each["motor"]
        if motor in checked:
            motors[str(motor)] = _motor(lines[motor], Run(each, checked[motor]))
    return {
        "seconds": told["seconds"],
        "ended": told["ended"] == "idle",
        "cut": told["ended"] == "real",
        "motors": motors,
        "outputs": curve["outputs"],
        "outputs_cut": curve["outputs_cut"],
        "error": None,
    }


def _motor(line: dict[str, Any], run: Run) -> dict[str, Any]:
    place = run.place
    where = {"line": place.line, "column": place.column} if place else None
    ordinal_of = _ordinals(run)
    return {
        "t": line["t"],
        "speed": line["speed"],
        "position": line["position"],
        "before": line["before"],
        "steps": line["steps"],
        "command": ordinal_of(line["command"]),
        "commands": [[at, ordinal_of(place)] for at, place in line["commands"]],
        "commands_cut": line["commands_cut"],
        "moves": run.told["moves"],
        "pulses": run.told["pulses"],
        "peak": run.told["peak_speed"],
        "state": run.told["state"],
        "state_text": run.state,
        "error": run.error or None,
        "place": where,
        "overflow": run.told["overflow"],
    }


def _ordinals(run: Run) -> Callable[[int], int]:
    """Places in the program of those in the memory, where `[` and `]` may stand around it."""
    first = 1 if run.told["held"] else 0
    last = len(stored(run.checked.parsed.commands))
    return lambda place: min(max(place - first, 0), last)


def _refusal(error: str) -> dict[str, Any]:
    return {
        "seconds": 0.0,
        "ended": False,
        "cut": False,
        "motors": {},
        "outputs": [],
        "outputs_cut": None,
        "error": error,
    }


def _inputs(rows: Any) -> list[tuple[float, int, int]]:
    if rows is None:
        return []
    if not isinstance(rows, list) or len(rows) > INPUTS_MAX:
        raise BadRequest(f"inputs is no list; write up to {INPUTS_MAX} of [ms, input, level]")
    return [_input(row) for row in rows]


def _input(row: Any) -> tuple[float, int, int]:
    if isinstance(row, list) and len(row) == 3 and all(map(_is_number, row)):
        ms, number, level = row
        if 0 <= ms <= MS_MAX and number in range(1, 9) and level in (0, 1):
            return float(ms), int(number), int(level)
    shown = json.dumps(row)[:60]
    raise BadRequest(f"{shown} is no input; write [ms, 1 to 8, 0 or 1], as in [350.5, 3, 1]")


def _part(body: Mapping[str, Any]) -> tuple[float, float] | None:
    part = body.get("range")
    if part is None:
        return None
    if isinstance(part, list) and len(part) == 2 and all(map(_is_number, part)):
        first, last = max(0.0, float(part[0])), float(part[1])
        if first <= last <= SECONDS_MAX:
            return first, last
    raise BadRequest("range is no part of the time; write [from, to] in seconds")


def _number(body: Mapping[str, Any], name: str, default: float, least: float, most: float) -> float:
    value = body.get(name, default)
    if not _is_number(value) or not least <= value <= most:
        raise BadRequest(f"{name} is not possible; write {least:g} to {most:g}")
    return float(value)


def _is_number(value: Any) -> bool:
    """Whether a value is a number of a size that can be meant; NaN is not."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e18


def _decimal(value: float) -> str:
    return f"{value:.6f}"
