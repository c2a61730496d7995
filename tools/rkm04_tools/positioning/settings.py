"""`settings`: get, set, back up, restore and compare."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Callable, Iterable
from typing import Any

from rkm04_tools.client_base import count_of, tell
from rkm04_tools.doubt import Doubt, in_doubt
from rkm04_tools.failure import DONE, NOT_SO, Failure, finished_or_absent, writing_failed
from rkm04_tools.positioning.listing import Place, places
from rkm04_tools.positioning.table import AXES, Register, registers, values_text
from rkm04_tools.positioning.unit import LAYOUT, Unit, setting
from rkm04_tools.source import STANDARD_INPUT, named, read_text

FORMAT = "positioning settings"
FORMAT_VERSION = 1
FILE_BYTES_MAX = 100_000
UNIT_PART = "unit"
UNWRITTEN = "nothing was written; "
AGAIN = "do it once more when the unit answers; settings get and settings diff tell what there is"
STEPS_PER_UM_MAX, UM_PER_STEP_MAX = 500, 10_000

Opened = Callable[[Namespace], Unit]
Values = dict[str, dict[str, int]]
"""Settings by name, of the unit and of axis1 to axis4."""


def stored_places() -> list[Place]:
    """All settings of a unit."""
    return [place for place in places() if place.register.is_setting]


def part_of(axis: int) -> str:
    """The name of a part of the file."""
    return f"axis{axis}" if axis else UNIT_PART


def read_all(unit: Unit) -> Values:
    """All settings of a unit."""
    unit.require_known()
    found: Values = {}
    for axis in range(AXES + 1):
        own = [place for place in stored_places() if place.axis == axis]
        first = own[0].number
        words = unit.wire.read(first, own[-1].number + own[-1].register.words - first)
        found[part_of(axis)] = {
            p.register.name: p.register.of_words(words[p.number - first :][: p.register.words])
            for p in own
        }
    return found


def run_get(options: Namespace, opened: Opened) -> int:
    """Print settings."""
    rows = [setting(name) for name in options.names]
    with opened(options) as unit:
        unit.axis(options.axis)
        if rows:
            found = {row.name: unit.get(row.name, options.axis) for row in rows}
        else:
            everything = read_all(unit)
            found = everything[UNIT_PART] | everything[part_of(options.axis)]
    text = "\n".join(f"{name:<14}{_text(registers()[name], v)}" for name, v in found.items())
    return tell(options, {"axis": options.axis, "settings": found}, text)


def _text(row: Register, value: int) -> str:
    return f"{value:>11}  {row.unit}".rstrip()


def run_set(options: Namespace, opened: Opened) -> int:
    """Write settings."""
    values: dict[str, int] = {}
    for each in options.values:
        name, equals, text = each.partition("=")
        row = setting(name)
        if not equals or not text.removeprefix("-").isdecimal() or not row.takes(int(text)):
            raise Failure(f"{each}: write {row.name}=VALUE, with a VALUE of {values_text(row)}")
        if row.name in values:
            raise Failure(f"{row.name} is there twice; give it once")
        values[row.name] = int(text)
    with in_doubt(Doubt()) as doubt, opened(options) as unit:
        require_free(unit, _concerned(values, options))
        write(unit, _by_part(values, unit.axis(options.axis).number), read_all(unit), doubt)
        if options.store:
            _store(unit, doubt)
    text = ", ".join(f"{name} is {value}" for name, value in values.items())
    note = "" if options.store else "; not stored (--store)"
    answer = {"axis": options.axis, "settings": values, "stored": options.store}
    return tell(options, answer, f"{text}{note}")


def _concerned(values: dict[str, int], options: Namespace) -> Iterable[int]:
    """The axes that must be free: all of them for STORE and for settings of the unit."""
    of_unit = any(registers()[name].scope == "U" for name in values)
    return range(1, AXES + 1) if options.store or of_unit else [options.axis]


def _by_part(values: dict[str, int], axis: int) -> Values:
    parts: Values = {}
    for name, value in values.items():
        part = part_of(axis if registers()[name].scope == "A" else 0)
        parts.setdefault(part, {})[name] = value
    return parts


def _store(unit: Unit, doubt: Doubt) -> None:
    doubt.about(
        "whether the settings are stored", "positioning status tells whether they are as stored",
        "all of them are written",
    )  # fmt: skip
    unit.store()


def run_backup(options: Namespace, opened: Opened) -> int:
    """Write all settings to a file."""
    with opened(options) as unit:
        found = read_all(unit)
    text = text_of(found)
    if options.file == STANDARD_INPUT:
        print(text, end="")
        return DONE
    path = named(options.file)
    try:
        with finished_or_absent(path) as part:
            part.write_text(text, encoding="ascii")
    except OSError as error:
        raise writing_failed(path, error) from None
    number = sum(map(len, found.values()))
    return tell(options, {"file": str(path), "settings": number}, f"{path}: {number} settings")


def text_of(values: Values) -> str:
    """The file that keeps all settings."""
    content = {"format": FORMAT, "version": FORMAT_VERSION, "layout": LAYOUT, "settings": values}
    return f"{json.dumps(content, indent=2)}\n"


def run_restore(options: Namespace, opened: Opened) -> int:
    """Write the settings of a file that differ."""
    wanted = read_file(options.file, UNWRITTEN)
    with in_doubt(Doubt()) as doubt, opened(options) as unit:
        found = read_all(unit)
        require_free(unit)
        differ = _differ(wanted, found)
        write(unit, wanted, found, doubt)
        if left := _differ(wanted, read_all(unit)):
            raise Failure(f"{len(left)} settings read otherwise than written", NOT_SO)
        if options.store:
            _store(unit, doubt)
    note = "" if options.store else "; not stored (--store)"
    answer = {"file": options.file, "written": differ, "stored": options.store}
    text = f"{options.file}: {count_of(len(differ), 'setting')} written, the others were so already"
    return tell(options, answer, text + note)


def write(unit: Unit, wanted: Values, found: Values, doubt: Doubt | None = None) -> None:
    """Write those parts in which a setting is not as it was found, each in one request.

    A part is written whole or not at all, and read back.
    """
    doubt = doubt or Doubt()
    changes = {axis: _changed(axis, wanted, found) for axis in range(AXES + 1)}
    written: list[str] = []
    for axis, own in changes.items():
        if own:
            doubt.about(f"whether the settings of {part_of(axis)} were written", AGAIN)
            doubt.done = _written(written)
            unit.set_many(own, axis)
            written.append(part_of(axis))
    doubt.about("whether all settings are as wanted", AGAIN, _written(written))


def _written(parts: list[str]) -> str:
    return f"written: {', '.join(parts) or 'no other part'}; nothing is stored"


def _changed(axis: int, wanted: Values, found: Values) -> dict[str, int]:
    """The whole part, if something of it differs."""
    before = found[part_of(axis)]
    own = before | wanted.get(part_of(axis), {})
    if own == before:
        return {}
    if axis:
        steps, um = own["STEPS"], own["MICROMETRES"]
        if steps > STEPS_PER_UM_MAX * um or um > UM_PER_STEP_MAX * steps:
            raise Failure(
                f"axis {axis}: {steps} STEPS in {um} MICROMETRES: the quotient is "
                f"1/{UM_PER_STEP_MAX} to {STEPS_PER_UM_MAX}; nothing was written", NOT_SO,
            )  # fmt: skip
    return own


def require_free(unit: Unit, axes: Iterable[int] = range(1, AXES + 1)) -> None:
    """Refuse to write where an axis is taken or moves."""
    for axis in axes:
        state = unit.axis(axis).read()
        if state.is_taken or state.moves:
            raise Failure(
                f"axis {axis} is {state.words}, and settings wait for it; reset comes first", NOT_SO
            )


def run_diff(options: Namespace, opened: Opened) -> int:
    """Tell where a file and the unit differ."""
    wanted = read_file(options.file)
    with opened(options) as unit:
        differ = _differ(wanted, read_all(unit))
    lines = [f"{d['part']} {d['name']}: file {d['file']}, unit {d['unit']}" for d in differ]
    same = f"{options.file}: the unit is set so"
    tell(options, {"file": options.file, "differ": differ}, "\n".join(lines) or same)
    return NOT_SO if differ else DONE


def _differ(wanted: Values, found: Values) -> list[dict[str, Any]]:
    return [
        {"part": part, "name": name, "file": value, "unit": found[part][name]}
        for part, own in wanted.items()
        for name, value in own.items()
        if found[part][name] != value
    ]


def read_file(name: str, note: str = "") -> Values:
    """The settings of a backup: all of them, each in its range, or a Failure."""
    source = read_text(name, FILE_BYTES_MAX, "so it is no backup", "a backup of the settings")
    return read_values(source.text, source.name, note)


def read_values(text: str, where: str, note: str = UNWRITTEN) -> Values:
    """The settings of the text of a backup. `note`: what is told with a complaint."""
    try:
        return _values_of(text)
    except _Damaged as damage:
        why = f"{where}: {damage}; {note}settings backup makes such a file"
        raise Failure(why, NOT_SO) from None


class _Damaged(ValueError):
    """Why a file is no backup."""


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object whose names differ: of two values nobody knows which one is meant."""
    names = [name for name, _ in pairs]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise _Damaged(f"{twice[0]} is there twice")
    return dict(pairs)


def _values_of(text: str) -> Values:
    try:
        content = json.loads(text, object_pairs_hook=_once)
    except _Damaged:
        raise
    except (ValueError, RecursionError):
        raise _Damaged("it is no JSON") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise _Damaged("it is of another kind")
    if (content.get("version"), content.get("layout")) != (FORMAT_VERSION, LAYOUT):
        raise _Damaged("it is of another version of the unit or of this tool")
    values = content.get("settings")
    known = {part_of(axis): {} for axis in range(AXES + 1)}  # type: dict[str, dict[str, Register]]
    for place in stored_places():
        known[part_of(place.axis)][place.register.name] = place.register
    if not isinstance(values, dict) or values.keys() != known.keys():
        raise _Damaged(f"it must have {', '.join(known)}")
    for part, rows in known.items():
        own = values[part]
        if not isinstance(own, dict) or own.keys() != rows.keys():
            raise _Damaged(f"{part} does not have just its settings")
        for row in rows.values():
            value = own[row.name]
            if type(value) is not int or not row.takes(value):
                raise _Damaged(f"{row.name} of {part} has no value of its range")
    return values
