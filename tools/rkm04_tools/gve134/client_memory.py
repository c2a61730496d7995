"""`memory`: the 256 bytes that a unit keeps without power."""

from __future__ import annotations

import re
import sys
from argparse import Namespace

from rkm04_tools.bar import Bar
from rkm04_tools.client_base import count_of, tell
from rkm04_tools.failure import DONE, NOT_SO, Failure, finished_or_absent, writing_failed
from rkm04_tools.gve134.client_base import require_good, unit_of
from rkm04_tools.gve134.unit import MEMORY_BYTES, WORD_BYTES, Unit
from rkm04_tools.source import STANDARD_INPUT, named, read_text

ROW_BYTES = 16
FILE_BYTES_MAX = 100_000
LINE = re.compile(r"([0-9A-Fa-f]{2}):((?:[ \t]+[0-9A-Fa-f]{2})+)")
READS = {"byte": "ER", "word": "EUR", "float": "EFR"}
WRITES = {"byte": "EW", "word": "EUW", "float": "EFW"}
HEAD = "; memory of a GVE134: place: bytes, all hexadecimal\n"
END = "; end of the memory\n"
"""A backup that begins with the one and does not end with the other was cut off."""


def run_get(options: Namespace) -> int:
    """Print what stands at a place."""
    step = 1 if options.kind == "byte" else WORD_BYTES
    first = _place(options.place)
    if options.count < 1:
        raise Failure(f"memory: --count {options.count}: write 1 or more")
    if first + step * options.count > MEMORY_BYTES:
        raise Failure(f"memory: {options.count} from {first:02X} do not fit; it ends at FF")
    with unit_of(options) as unit:
        places = range(first, first + step * options.count, step)
        values = {
            f"{place:02X}": unit.order(f"{READS[options.kind]}{place:02X}").values
            for place in places
        }
    text = "\n".join(f"{place}: {value}" for place, value in values.items())
    return tell(options, {"kind": options.kind, "values": values}, text)


def run_set(options: Namespace) -> int:
    """Write to a place, and read it back."""
    place = f"{_place(options.place):02X}"
    command = f"{WRITES[options.kind]}{place},{options.value}"
    require_good(command, f"memory set {options.place}")
    with unit_of(options) as unit:
        unit.order(command, f"memory {place}: not written")
        found = unit.order(f"{READS[options.kind]}{place}").values
    if not _same(options.kind, options.value, found):
        raise Failure(f"memory {place}: {options.value} was written, and reads as {found}", NOT_SO)
    return tell(options, {"place": place, "value": found}, f"{place}: {found}")


def _same(kind: str, written: str, found: str) -> bool:
    """Whether a value has been kept; a float as the nearest one that there is."""
    if kind != "float":
        return int(written, 16) == int(found, 16)
    return abs(float(written) - float(found)) <= abs(float(written)) * 2**-23 + 1e-44


def run_backup(options: Namespace) -> int:
    """Write all bytes to a file."""
    with unit_of(options) as unit, Bar("reading") as bar:
        content = _read_all(unit, bar)
    text = HEAD + "".join(
        f"{place:02X}: {content[place : place + ROW_BYTES].hex(' ').upper()}\n"
        for place in range(0, MEMORY_BYTES, ROW_BYTES)
    )
    text += END
    path = named(options.file)
    if options.file == STANDARD_INPUT:
        sys.stdout.write(text)
        return DONE
    try:
        with finished_or_absent(path) as part:
            part.write_text(text, encoding="ascii")
    except OSError as error:
        raise writing_failed(path, error) from None
    answer = {"file": str(path), "bytes": MEMORY_BYTES}
    return tell(options, answer, f"{path}: {MEMORY_BYTES} bytes saved")


def run_restore(options: Namespace) -> int:
    """Write the bytes of a file that differ, and tell which the unit has not kept."""
    wanted = read_file(options.file)
    written: list[int] = []
    failed: list[int] = []
    with unit_of(options) as unit, Bar("restoring") as bar:
        content = _read_all(unit, bar)
        differ = [place for place, value in wanted.items() if content[place] != value]
        try:
            for done, place in enumerate(differ):
                bar.show(done, len(differ))
                kept = unit.write_byte(place, wanted[place])
                (written if kept else failed).append(place)
        except BaseException as error:
            bar.clear()
            told = f"{len(written)} of {count_of(len(differ), 'byte')} were written before this"
            if isinstance(error, Failure):
                raise Failure(f"{error}; {told}", error.status) from None
            print(f"gve134: {told}", file=sys.stderr)
            raise
    answer = {
        "file": options.file,
        "bytes": len(wanted),
        "written": [f"{place:02X}" for place in written],
        "failed": [f"{place:02X}" for place in failed],
    }
    text = f"{options.file}: {count_of(len(written), 'byte')} written, the others were so already"
    lines = [f"{place:02X}: NOT KEPT: {wanted[place]:02X} was written" for place in failed]
    tell(options, answer, "\n".join([text, *lines]))
    return NOT_SO if failed else DONE


def run_diff(options: Namespace) -> int:
    """Tell where a file and the memory differ."""
    wanted = read_file(options.file)
    with unit_of(options) as unit, Bar("reading") as bar:
        content = _read_all(unit, bar)
    differ = {place: value for place, value in wanted.items() if content[place] != value}
    rows = [
        {"place": f"{place:02X}", "file": f"{value:02X}", "unit": f"{content[place]:02X}"}
        for place, value in differ.items()
    ]
    lines = [f"{row['place']}: file {row['file']}, unit {row['unit']}" for row in rows]
    same = f"{options.file}: all of its {count_of(len(wanted), 'byte')} are in the memory"
    tell(options, {"file": options.file, "differ": rows}, "\n".join(lines) or same)
    return NOT_SO if rows else DONE


def read_file(name: str) -> dict[int, int]:
    """The bytes of a backup, by place."""
    source = read_text(name, FILE_BYTES_MAX, "so it is no backup", "a backup of the memory")
    content: dict[int, int] = {}
    for number, line in enumerate(source.text.splitlines(), 1):
        text = line.partition(";")[0].strip()
        if not text:
            continue
        match = LINE.fullmatch(text)
        where = f"{source.name}:{number}"
        if not match:
            raise Failure(f"{where}: write a place, a colon and bytes, as in 10: FF 0A", NOT_SO)
        for place, value in enumerate(match[2].split(), int(match[1], 16)):
            if place >= MEMORY_BYTES or place in content:
                what = "is past the end FF" if place >= MEMORY_BYTES else "is there twice"
                raise Failure(f"{where}: place {place:02X} {what}", NOT_SO)
            content[place] = int(value, 16)
    if _is_cut_off(source.text, len(content)):
        raise Failure(
            f"{source.name}: this backup was cut off, it has {len(content)} of {MEMORY_BYTES} "
            "bytes and no end; nothing was done with it; take another one",
            NOT_SO,
        )
    if not content:
        raise Failure(f"{source.name}: has no bytes; memory backup writes such a file", NOT_SO)
    return content


def _is_cut_off(text: str, count: int) -> bool:
    """Of a backup as it is written here; other files have what places they want."""
    lines = text.splitlines()
    whole = count == MEMORY_BYTES or END.strip() in lines
    return bool(lines) and lines[0] == HEAD.strip() and not whole


def _read_all(unit: Unit, bar: Bar) -> bytes:
    content = b""
    while len(content) < MEMORY_BYTES:
        bar.show(len(content), MEMORY_BYTES)
        content += unit.read_memory(len(content), ROW_BYTES)
    return content


def _place(text: str) -> int:
    if not re.fullmatch(r"[0-9A-Fa-f]{1,2}", text):
        raise Failure(f"memory {text}: write a place in hexadecimal, 00 to FF")
    return int(text, 16)
