"""Steps that only ask: the part, its options, its last reset, its clocks."""

from __future__ import annotations

import hashlib

from rkm04_tools import board, board_options
from rkm04_tools.board_part import FLASH_KB_MIN
from rkm04_tools.bringup.clock import look_at_clock
from rkm04_tools.bringup.findings import NOTE, Seen, compared, noted
from rkm04_tools.bringup.step import Bench
from rkm04_tools.bringup.talk import VERSION, Answer
from rkm04_tools.failure import NOT_SO, Failure

DEVICE = "413"
REVISIONS = {
    "1000": "A", "1001": "Z", "1003": "1", "1007": "2", "100f": "Y or 4", "101f": "5 or 6",
}  # fmt: skip
"""DBGMCU_IDCODE, RM0090 38.6.1."""
RESETS = {
    25: "brown-out", 26: "reset pin", 27: "power-on", 28: "software", 29: "watchdog",
    30: "window watchdog", 31: "low power",
}  # fmt: skip
"""RCC_CSR, RM0090 7.3.21."""
WATCHDOG_FLAG, SOFTWARE_FLAG = 1 << 29, 1 << 28
LSI_HZ = range(17_000, 47_001)
SUPPLY_MAX_MV = 3600
"""DS8626."""
CORE_HZ = 168_000_000
SOURCES = {0: "internal oscillator", 1: "crystal without PLL", 2: "PLL"}
EMPTY_IDS = ({"00000000"}, {"ffffffff"})
UNLOCKED = board_options.LOCK | board_options.START
BROWN_OUT = board_options.LEVEL_MASK


class WrongImage(Failure):
    """An image with other pins, or other answers: what it did might be anything."""

    def __init__(self, name: str, wanted: str) -> None:
        other = ", whose board.h is another one" if name.split()[:2] == wanted.split()[:2] else ""
        text = f"the board has the image {name}, not {wanted}{other}: flash that"
        super().__init__(text, NOT_SO)
        self.name = name
        self.wanted = wanted


def name_of_image(name: str) -> str:
    """What the image of a board says that it is: with which answers, made of which header."""
    header = (board.BOARDS / name / "board.h").read_bytes()
    return f"bringup-{name} {VERSION} {hashlib.sha1(header, usedforsecurity=False).hexdigest()[:8]}"


def look_at_line(bench: Bench) -> list[Seen]:
    """Who answers."""
    name = " ".join(bench.talk.ask("h").words("ready"))
    wanted = name_of_image(bench.board)
    if name != wanted:
        raise WrongImage(name, wanted)
    bench.talk.started = False
    return [compared("image, version of its answers, board.h", name, wanted, good=True)]


def look_at_part(bench: Bench) -> list[Seen]:
    answer = bench.talk.ask("p")
    device, revision = answer.word("device"), answer.word("revision")
    kilobytes, words = answer.number("flash_kb"), answer.words("id")
    return [
        compared("device", device, f"{DEVICE} (STM32F405, F407)", device == DEVICE),
        noted("revision", f"{REVISIONS.get(revision, 'not known')} ({revision})",
              "A: runs without prefetch" if revision == "1000" else ""),
        compared("flash", f"{kilobytes} kB", f"{FLASH_KB_MIN} kB: stored programs need it",
                 kilobytes >= FLASH_KB_MIN),
        compared("unique number", "-".join(words), "not empty", set(words) not in EMPTY_IDS),
        *option_bytes(bench.board, answer.number("option_bytes", 16)),
    ]  # fmt: skip


def option_bytes(name: str, control: int) -> list[Seen]:
    """Against what `board options` sets, and the rest as delivered."""
    wanted = board_options.wanted_level(name, None)
    level = (control & BROWN_OUT) >> board_options.LEVEL_PLACE
    other = (control ^ board_options.DELIVERED) & ~(BROWN_OUT | UNLOCKED) & 0xFFFFFFFF
    text = board_options.level_text(control)
    if level == board_options.BITS[wanted]:
        brown_out = compared("brown-out reset", text, f"level {wanted}", good=True)
    else:
        advice = f"level {wanted}: tools/rkm04 board options --board {name}, later"
        brown_out = Seen("brown-out reset", text, advice, NOTE)
    rest = f"{board_options.DELIVERED:08x} but for that level, as delivered"
    return [compared("option bytes", f"{control:08x}", rest, other == 0), brown_out]


def flags_text(flags: int) -> str:
    """The resets that RCC_CSR tells, in words."""
    names = [name for bit, name in RESETS.items() if flags >> bit & 1]
    return ", ".join(names) or "none is told"


def fault_text(answer: Answer) -> str:
    """What the handler of faults has kept."""
    count, exception, status, hard, address, pc = (answer.words("faults") + ["?"] * 6)[:6]
    return (f"{count} since power-on, exception {exception}, CFSR {status}, HFSR {hard}, "
            f"BFAR {address}, pc {pc}")  # fmt: skip


def look_at_start(bench: Bench) -> list[Seen]:
    answer = bench.talk.ask("p")
    cause = answer.word("cause")
    seen = [
        noted("last reset", flags_text(answer.number("reset_flags", 16))),
        compared("cause of the start", cause, "power or reset", cause in ("power", "reset")),
    ]
    if cause == "fault":
        seen.append(noted("fault", fault_text(answer)))
    return seen


def look_at_starts(bench: Bench) -> list[Seen]:
    """A board that starts by itself is not good, whatever the step has seen."""
    if not bench.talk.started:
        return []
    bench.talk.started = False
    answer = bench.talk.ask("p")
    told = f"{answer.word('cause')} ({flags_text(answer.number('reset_flags', 16))})"
    return [compared("starts anew", told, "not by itself; if it was you: r, once more", good=False)]


def look_at_clocks(bench: Bench) -> list[Seen]:
    answer = bench.talk.ask("c")
    megahertz = bench.header.values["BOARD_CRYSTAL_MHZ"].rstrip("U")
    runs = answer.number("crystal") == 1 and answer.number("crystal_ready") == 1
    core, source = answer.number("core_hz"), answer.number("source")
    return [
        compared("crystal", "runs" if runs else "does not run", f"runs, {megahertz} MHz", runs),
        compared("processor driven by", SOURCES.get(source, "?"), SOURCES[2], source == 2),
        compared("PLL", "ready" if answer.number("pll_ready") else "not ready", "ready",
                 answer.number("pll_ready") == 1),
        compared("clock", f"{core / 1e6:g} MHz", f"{CORE_HZ / 1e6:g} MHz", core == CORE_HZ),
        noted("APB1, APB2", f"{answer.number('apb1_hz') / 1e6:g} MHz, "
              f"{answer.number('apb2_hz') / 1e6:g} MHz"),
        noted("wait states of the flash", answer.word("wait_states")),
        compared("low-speed oscillator", f"{answer.number('lsi_hz')} Hz",
                 "17 to 47 kHz; the watchdog's", answer.number("lsi_hz") in LSI_HZ),
        *look_at_clock(bench),
    ]  # fmt: skip


def look_at_supply(bench: Bench) -> list[Seen]:
    """By the part's own reference and what its factory has measured."""
    answer = bench.talk.ask("v")
    least = int(bench.header.values["BOARD_SUPPLY_MIN_MV"].rstrip("U"))
    millivolts, good = answer.number("supply_mv"), answer.number("detector_good") == 1
    return [
        compared("supply at the part", f"{millivolts / 1000:.3f} V",
                 f"{least / 1000:.3f} to {SUPPLY_MAX_MV / 1000:.3f} V",
                 least <= millivolts <= SUPPLY_MAX_MV),
        compared("voltage detector", "good" if good else "too low", "good", good),
    ]  # fmt: skip
