"""A machine file: reading, checking and writing it.

What is not understood is refused as a whole, so that saving a machine never drops a part of it. The
rules are in the schema, which the page has been made with, too.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

from rkm04_tools.failure import (
    NOT_SO,
    Failure,
    finished_or_absent,
    reading_failed,
    writing_failed,
)
from rkm04_tools.machine.words import problem
from rkm04_tools.messages import MOTORS
from rkm04_tools.source import Source, named
from rkm04_tools.tree import ROOT

FORMAT, VERSION = "rkm04-machine", 1
FILE_BYTES_MAX = 2_000_000
"""Four programs, notes and inputs of the greatest length; a larger file is no machine."""
PROBLEMS_MAX = 20
GVE134_AXES = "xyza"
"""The axes of motors 1 to 4."""
SCHEMA = ROOT / "tools" / "service_page" / "src" / "machine.schema.json"


@dataclass(frozen=True)
class Motor:
    """A motor of a machine. `steps_per_unit` is None where nothing is said of a unit."""

    number: int
    name: str
    program: str
    unit: str
    """mm, degree, or step."""
    steps_per_unit: float | None
    position_min_steps: int | None
    position_max_steps: int | None
    speed_max_steps_per_s: int | None

    @property
    def title(self) -> str:
        """Number and name."""
        return f"motor {self.number}{f' ({self.name})' if self.name else ''}"


@dataclass(frozen=True)
class Machine:
    """A machine that has passed the schema. `file` is what the user called it."""

    file: str
    content: dict[str, Any]

    @property
    def name(self) -> str:
        """What people call it."""
        return str(self.content["name"])

    @property
    def inputs(self) -> str:
        """What the inputs do in a simulation; empty: nothing."""
        return str(self.content.get("inputs", ""))

    @property
    def motors(self) -> list[Motor]:
        """All four."""
        return [
            _motor(number, told)
            for number, told in zip(MOTORS, self.content["motors"], strict=True)
        ]

    def source(self, motor: Motor) -> Source:
        """The program of a motor, by a name that tells where it stands."""
        return Source(f"{self.file}: motor {motor.number}", motor.program)


def read_machine(name: str | Path) -> Machine:
    """Read a machine file; the first thing that is wrong with it is raised."""
    path = named(str(name))
    content = parse_machine(bytes_of(path), str(path))
    return Machine(str(path), content)


def parse_machine(data: bytes, file: str) -> dict[str, Any]:
    """The content of a machine file; all that is wrong with it is raised, in one line."""
    content = _parsed(data, file)
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise Failure(f'{file}: is not a machine file: it lacks "format": "{FORMAT}"', NOT_SO)
    _require_version(content.get("version"), file)
    found = problems(content)
    if found:
        more = f"; and {len(found) - PROBLEMS_MAX} more" if len(found) > PROBLEMS_MAX else ""
        raise Failure(f"{file}: {'; '.join(found[:PROBLEMS_MAX])}{more}", NOT_SO)
    return content


def problems(content: dict[str, Any]) -> list[str]:
    """All that is wrong with a content, in words."""
    found = [problem(error) for error in _validator().iter_errors(content)]
    return sorted(set(found)) or list(_crossed(content))


def write_machine(content: dict[str, Any], path: Path) -> None:
    """Write a new machine file, whole or not at all."""
    found = problems(content)
    if found:
        raise Failure(f"{path}: {'; '.join(found)}; nothing was written", NOT_SO)
    if path.exists():
        raise Failure(f"{path}: is there already; choose another name")
    text = json.dumps(content, ensure_ascii=False, indent=2) + "\n"
    try:
        with finished_or_absent(path) as part:
            part.write_text(text, encoding="utf-8", newline="\n")
    except OSError as error:
        raise writing_failed(path, error) from None


def _motor(number: int, told: dict[str, Any]) -> Motor:
    limits = told.get("limits", {})
    unit = next((u for u in ("mm", "degree") if f"steps_per_{u}" in told), "step")
    return Motor(
        number,
        told.get("name", ""),
        told["program"],
        unit,
        told.get(f"steps_per_{unit}"),
        limits.get("position_min_steps"),
        limits.get("position_max_steps"),
        limits.get("speed_max_steps_per_s"),
    )


def bytes_of(path: Path) -> bytes:
    """What is in a machine file."""
    try:
        with path.open("rb") as file:
            data = file.read(FILE_BYTES_MAX + 1)
    except OSError as error:
        raise reading_failed(path, error) from None
    if len(data) > FILE_BYTES_MAX:
        raise Failure(f"{path}: larger than {FILE_BYTES_MAX} bytes, so it is not a machine file")
    return data


def _parsed(data: bytes, file: str) -> Any:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise Failure(f"{file}: is not UTF-8, so it is not a machine file", NOT_SO) from None
    try:
        content = json.loads(text, object_pairs_hook=_once, parse_constant=_refuse)
        json.dumps(content, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        what = f"{error.msg[0].lower()}{error.msg[1:]}"
        raise Failure(
            f"{file}:{error.lineno}:{error.colno}: is not JSON ({what}); was it cut off?", NOT_SO
        ) from None
    except (ValueError, RecursionError) as error:
        what = "it is nested too deep" if isinstance(error, RecursionError) else _plain(error)
        raise Failure(f"{file}: is not a machine file: {what}", NOT_SO) from None
    return content


def _plain(error: ValueError) -> str:
    if isinstance(error, UnicodeEncodeError):
        return "a text has half a character"
    return "a number has too many digits" if "digits" in str(error) else str(error)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Of two values by one name one would be lost."""
    names = [name for name, _ in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f'"{twice}" stands there twice')
    return dict(pairs)


def _refuse(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number")


def _require_version(version: Any, file: str) -> None:
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise Failure(f'{file}: lacks "version": {VERSION}', NOT_SO)
    if version > VERSION:
        raise Failure(
            f"{file}: was written by later tools (format {version}, and these know {VERSION}); "
            f"take the later tools; nothing was changed",
            NOT_SO,
        )


@cache
def _validator() -> Any:
    """Imported only here: most commands do not need it."""
    from jsonschema import Draft202012Validator

    return Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))


def _crossed(content: dict[str, Any]) -> list[str]:
    """What a schema cannot say."""
    found = []
    for number, told in zip(MOTORS, content["motors"], strict=True):
        motor = _motor(number, told)
        low, high = motor.position_min_steps, motor.position_max_steps
        if low is not None and high is not None and low > high:
            found.append(
                f"motor {number}, limits: position_min_steps {low} is above "
                f"position_max_steps {high}"
            )
    for letter, axis in content.get("gve134", {}).get("axes", {}).items():
        number = GVE134_AXES.index(letter) + 1
        found += _crossed_axis(letter, axis, _motor(number, content["motors"][number - 1]))
    return found


def _crossed_axis(letter: str, axis: dict[str, Any], motor: Motor) -> list[str]:
    """What an axis of a GVE134 unit says that its motor, or another part of it, does not allow."""
    found = []
    where, limits = f"gve134, axes, {letter}", f"of motor {motor.number}, limits"
    speed, most = axis["speed_steps_per_s"], motor.speed_max_steps_per_s
    if most is not None and speed > most:
        found.append(
            f"{where}: speed_steps_per_s {speed} is above speed_max_steps_per_s {most} {limits}"
        )
    homing = axis.get("homing")
    if homing is None:
        return found
    if homing["way_steps"] == 0:
        found.append(f"{where}, homing: way_steps 0 leads to no switch")
    for name in ("speed_steps_per_s", "back_speed_steps_per_s"):
        if homing[name] > speed:
            found.append(
                f"{where}, homing: {name} {homing[name]} is above speed_steps_per_s {speed} "
                f"of axis {letter}"
            )
    return found
