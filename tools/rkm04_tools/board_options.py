"""`board options`: shows the option bytes of a board's part and sets the level of its brown-out
reset, which the firmware never does by itself: at a level above its supply a part never starts."""

from __future__ import annotations

import json
import re
import shlex
import sys
from argparse import ArgumentParser, Namespace

from rkm04_tools import board
from rkm04_tools.board_part import openocd
from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.typed import forget_typed

STATUS, CONTROL, KEYS = "0x40023c0c", "0x40023c14", "0x40023c08"
"""FLASH_SR, FLASH_OPTCR and FLASH_OPTKEYR (RM0090 3.9)."""
KEY_1, KEY_2 = "0x08192a3b", "0x4c5d6e7f"
LOCK, START, LEVEL_MASK, LEVEL_PLACE = 1, 2, 0xC, 2
UNPROTECTED = 0xAA
BUSY = 1 << 16
DELIVERED = 0x0FFFAAED
WRITE_MS = 1000

OFF = "off"
BITS = {"3": 0, "2": 1, "1": 2, OFF: 3}
VOLTS = {
    "3": ("2.75 to 2.88", "2.85 to 2.97"),
    "2": ("2.44 to 2.56", "2.53 to 2.63"),
    "1": ("2.13 to 2.24", "2.23 to 2.33"),
}
"""DS8626: held in reset below the first, started at the second."""
RISING_MAX_MV = {"3": 2970, "2": 2630, "1": 2330, OFF: 0}

QUESTION = "Are the motors unpowered, and shall it be written? [y/N] "
NOTE = "The part restarts, its pins float meanwhile; the level is in force from the next power-on."


def add_arguments(command: ArgumentParser) -> None:
    command.add_argument("--level", choices=list(BITS), help="of the brown-out reset (the board's)")
    command.add_argument("--yes", action="store_true",
                         help="the motors are unpowered: write without asking")  # fmt: skip
    command.add_argument("--probe", metavar="NAME", default="stlink",
                         help="openocd's interface script")  # fmt: skip
    command.add_argument("--dry-run", action="store_true",
                         help="show the commands only, as for a part as delivered")  # fmt: skip


def level_text(control: int) -> str:
    """The level in FLASH_OPTCR, in words."""
    bits = (control & LEVEL_MASK) >> LEVEL_PLACE
    name = next(level for level, code in BITS.items() if code == bits)
    if name == OFF:
        return "off, as delivered: the part runs on below what it is specified for"
    held, starts = VOLTS[name]
    return f"level {name}: held in reset below {held} V, starts at {starts} V"


def wanted_level(name: str, level: str | None) -> str:
    """The level asked for, or the board's; never one at which the board might not start."""
    values = board.header_of(name).values
    chosen = level or values["BOARD_BROWN_OUT_LEVEL"].rstrip("U")
    supply_mv = int(values["BOARD_SUPPLY_MIN_MV"].rstrip("U"))
    if RISING_MAX_MV[chosen] > supply_mv:
        raise Failure(
            f"level {chosen} starts a part at up to {RISING_MAX_MV[chosen] / 1000:.2f} V, and the "
            f"supply of {name} may be {supply_mv / 1000:.2f} V: it might never start again",
            NOT_SO,
        )
    return chosen


def look_command(probe: str) -> list[str]:
    """Reads the option bytes, without stopping the unit."""
    return openocd(probe, f"mdw {CONTROL}")


def write_command(probe: str, control: int) -> list[str]:
    """The sequence of RM0090 3.6.3, a reset, and what the part has read of them."""
    return openocd(
        probe, "reset halt", f"mww {KEYS} {KEY_1}", f"mww {KEYS} {KEY_2}",
        f"mww {CONTROL} {control:#010x}", f"mww {CONTROL} {control | START:#010x}",
        f"sleep {WRITE_MS}", f"mdw {STATUS}", f"mww {CONTROL} {control | LOCK:#010x}",
        "reset halt", f"mdw {CONTROL}", "reset run",
    )  # fmt: skip


def word_at(address: str, said: str) -> int:
    """A word that OpenOCD has shown; the last time."""
    words = re.findall(rf"^{address}:\s+([0-9a-f]{{8}})\b", said, re.MULTILINE)
    if not words:
        print(said)
        raise Failure("openocd has not read the option bytes, see above", NOT_SO)
    return int(words[-1], 16)


def new_control(old: int, level: str) -> int:
    """FLASH_OPTCR with another level, unlocked, and all else as it is."""
    if old >> 8 & 0xFF != UNPROTECTED:
        raise Failure(
            f"the option bytes are {old:08x}: the part is protected, or was not read rightly; "
            "nothing was written", NOT_SO,
        )  # fmt: skip
    return old & ~(LEVEL_MASK | LOCK | START) | BITS[level] << LEVEL_PLACE


def run(options: Namespace) -> int:
    """Show old and new; ask; write; look whether it is so."""
    board.image_of(options.board, options.image)
    level = wanted_level(options.board, options.level)
    if options.dry_run:
        return _show_commands(options, level)
    old = word_at(CONTROL, board.call_flasher("openocd", look_command(options.probe)))
    new = new_control(old, level)
    if not options.json:
        print(f"{options.board}: option bytes {old:08x}\nbrown-out reset now: {level_text(old)}")
    if (old ^ new) & LEVEL_MASK == 0:
        return _done(options, old, written=False)
    if not options.json:
        print(f"brown-out reset new: {level_text(new)}\n{NOTE}")
    if not options.yes and not _agreed(options.json):
        raise Failure("nothing was written; unpower the motors, and answer y or give --yes", NOT_SO)
    said = board.call_flasher("openocd", write_command(options.probe, new))
    now = word_at(CONTROL, said)
    if word_at(STATUS, said) & BUSY or (now ^ new) & ~(LOCK | START):
        raise Failure(f"the option bytes are {now:08x}, not what was written; try again", NOT_SO)
    return _done(options, now, written=True)


def _agreed(as_json: bool) -> bool:
    if as_json or not sys.stdin.isatty():
        return False
    forget_typed()
    print(QUESTION, end="", flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def _show_commands(options: Namespace, level: str) -> int:
    commands = [
        look_command(options.probe),
        write_command(options.probe, new_control(DELIVERED, level)),
    ]
    if options.json:
        print(json.dumps({"look": commands[0], "command": commands[1]}))
    else:
        print("\n".join(map(shlex.join, commands)))
    return DONE


def _done(options: Namespace, control: int, *, written: bool) -> int:
    if options.json:
        facts = {"board": options.board, "option_bytes": f"{control:08x}", "written": written}
        print(json.dumps(facts))
    else:
        print("written; it is in force from the next power-on" if written else "nothing to do")
    return DONE
