"""`bringup`: pulses measured by a second timer; ENABLE; the clock of the board."""

from __future__ import annotations

import io
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from typing import Any

import pytest
from bringup_bench import Bench, Hands, Typed, powered
from hypothesis import given
from hypothesis import strategies as st
from rkm04_tools import board
from rkm04_tools.board_header import read_board
from rkm04_tools.bringup import pulses, step, train
from rkm04_tools.bringup.person import Person
from rkm04_tools.bringup.talk import Talk
from rkm04_tools.bringup.train import Limits, Train
from rkm04_tools.bringup.wires import walk as walk_wires

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host") / "bin" / "rkm04-vboard"
modelled = pytest.mark.skipif(
    not PROGRAM.is_file() or not shutil.which(board.COMPILER),
    reason="there is no virtual board, or no compiler for the image",
)
Walk = Callable[..., dict[str, Any]]


@pytest.fixture
def power(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Bench]]:
    """Power on a virtual board."""
    with ExitStack() as running:

        def begin(name: str, *options: str) -> Bench:
            return running.enter_context(powered(tmp_path, monkeypatch, name, *options))

        yield begin


@pytest.fixture
def walk(tool: Callable[..., Any], monkeypatch: pytest.MonkeyPatch) -> Walk:
    """Go through one step, all others left out; what was seen in it."""

    def go(name: str, bench: Bench, step: str, *inner: Typed) -> dict[str, Any]:
        monkeypatch.setattr("sys.stdin", Hands(bench.only(step, inner)))
        report = tool("bringup", "--board", name, "--port", "virtual", "--json").json
        found = next(each for each in report["steps"] if each["name"] == step)
        assert found["state"] == "done"
        rows: list[dict[str, str]] = found["seen"]
        return {
            "rows": rows,
            "bad": [row for row in rows if row["verdict"] == "BAD"],
            "seen": [(row["what"].strip(), row["seen"]) for row in rows],
        }

    return go


def motor_rows(seen: dict[str, Any], motor: int) -> dict[str, str]:
    """What was seen of a motor."""
    names = [i for i, (what, _) in enumerate(seen["seen"]) if what.startswith("STEP_")]
    ends = [*names[1:], len(seen["seen"])]
    return dict(seen["seen"][names[motor - 1] : ends[motor - 1]])


@modelled
@pytest.mark.parametrize(
    ("name", "width"),
    [
        ("f405", "0.500 to 0.500 us"),
        ("weact-f405", "2.500 to 2.500 us"),
        ("f407-discovery", "2.500 to 2.500 us"),
    ],
)
def test_pulses_of_each_motor_are_captured_on_their_ticks_and_as_wide_as_asked(
    power, walk, name, width
):
    bench = power(name)

    seen = walk(name, bench, "pulses", *bench.measured())

    assert seen["bad"] == []
    for motor in range(1, 5):
        rows = motor_rows(seen, motor)
        assert rows[f"STEP_{motor} at {bench.pins[f'STEP_{motor}']}"] == "comes"
        assert (rows["pulses"], rows["width"]) == ("16 of 16", width)
        assert rows["ticks"] == "within 0 ns"


@modelled
def test_pulses_of_class_2_are_held_against_what_that_class_promises(power, walk):
    bench = power("skr-pro-1.2")

    seen = walk("skr-pro-1.2", bench, "pulses", *bench.measured())

    assert seen["bad"] == []
    late = [int(rows["ticks"].split()[1]) for rows in (motor_rows(seen, m) for m in range(1, 5))]
    assert all(0 < each < 1000 for each in late)


@modelled
@pytest.mark.parametrize(
    ("start", "said"),
    [
        ("none", "no wire: the pin follows its pull resistors"),
        ("STEP_3", "held low, no pulse comes; the wire is at STEP_3 at PA2"),
        ("DIR_2", "held low, no pulse comes; the wire is at DIR_2 at PA7"),
        ("BO_7", "held low, no pulse comes; the wire is at BO_7 at PB14"),
        ("LED_4", "held low, no pulse comes; the wire is at LED_4 at PC11"),
        ("S1_1", "held high, no pulse comes; nothing that can be switched moves it"),
    ],
)
def test_a_wrong_wire_is_told_with_where_it_leads(power, walk, start, said):
    bench = power("f405")

    seen = walk("f405", bench, "pulses", "", ("", bench.wire(start)), *bench.measured()[2:])

    (row,) = seen["bad"]
    assert row["what"] == "STEP_1 at PA0"
    assert row["seen"].startswith(said)
    assert row["expected"] == "a wire to CAPTURE at PB6"


@modelled
def test_a_wire_at_enable_is_found_too(power, walk):
    bench = power("skr-pro-1.2")

    seen = walk("skr-pro-1.2", bench, "pulses", "", ("", bench.wire("EN_2")), *bench.measured()[2:])

    assert [row["seen"] for row in seen["bad"]] == [
        "held high, no pulse comes; the wire is at EN_2 at PD7"
    ]


@modelled
def test_a_wire_that_was_put_right_is_measured_again(power, walk):
    bench = power("f405")
    again: list[Typed] = ["", ("", bench.wire("none")), "r", *bench.measured()[1:]]

    assert walk("f405", bench, "pulses", *again)["bad"] == []


@modelled
def test_a_width_that_is_wrong_is_told_as_such(power, walk):
    bench = power("weact-f405")

    seen = walk("weact-f405", bench, "pulses", *bench.measured(":late=300"))

    assert [row["what"].strip() for row in seen["bad"]] == ["width"] * 4
    assert seen["bad"][0]["seen"] == "2.196 to 2.196 us: too narrow"
    assert seen["bad"][0]["expected"] == "2.400 to 2.600 us"


@modelled
def test_pulses_that_do_not_come_are_told_by_their_numbers(power, walk):
    bench = power("f405")

    seen = walk("f405", bench, "pulses", *bench.measured(":loses=6"))

    assert [row["what"].strip() for row in seen["bad"]] == ["pulses"] * 4
    assert [row["seen"] for row in seen["bad"]] == ["14 of 16; missing: 6, 12"] * 4


@modelled
def test_a_step_pin_that_is_stuck_is_no_wrong_wire(power, walk):
    bench = power("f405", "--stuck", "PA1=0")

    seen = walk("f405", bench, "pulses", *bench.measured())

    (row,) = seen["bad"]
    assert row["what"] == "STEP_2 at PA1"
    assert "nothing that can be switched moves it: STEP shorted" in row["seen"]


@modelled
@pytest.mark.parametrize(
    ("megahertz", "bad"), [("7.9", ["slow (-1.25 %)"]), ("7.97", [])], ids=["slow", "near"]
)
def test_a_slow_clock_is_told_as_such_and_not_as_wrong_pulses(power, walk, megahertz, bad):
    bench = power("f405", "--crystal", megahertz)
    pulses = walk("f405", bench, "pulses", *bench.measured())
    clocks = walk("f405", bench, "clocks", "", "")

    assert pulses["bad"] == []
    assert [row["seen"] for row in clocks["bad"]] == bad
    shown = dict(clocks["seen"])
    assert shown["timers against the processor"] == "2.000 cycles a tick"


@modelled
def test_enable_outputs_are_walked_and_seen_where_wires_lead_back(power, walk):
    name = "skr-pro-1.2"
    bench = power(name)
    bench.wire("EN_1", "BI_3")()
    bench.wire("EN_3")()

    seen = walk(name, bench, "enables", "", *"yyyn", "")

    assert [(row["what"], row["seen"]) for row in seen["bad"]] == [("EN_4 at PC3", "not so")]
    assert [seen for what, seen in seen["seen"] if what == "seen at"] == [
        "BI_3 at PG8", "CAPTURE at PA8",
    ]  # fmt: skip
    assert [seen for what, seen in seen["seen"] if what == "read at the pins"] == [
        f"EN_{i}" for i in range(1, 5)
    ]


@modelled
def test_leds_that_blink_without_a_crystal_are_no_short_at_an_output(power, walk):
    bench = power("f405", "--no-crystal", "--stuck", "PB8=0")

    seen = walk("f405", bench, "outputs", "", *["y"] * 8, "")

    assert [row["seen"] for row in seen["bad"]] == ["none is on"]


@modelled
def test_an_enable_output_that_is_stuck_is_read_at_its_pin(power, walk):
    name = "skr-pro-1.2"
    bench = power(name, "--stuck", "PF2=1", "--stuck", "PD7=0")

    seen = walk(name, bench, "enables", "", *"yyyy", "")

    read = [row["seen"] for row in seen["rows"] if "read" in row["what"]]
    assert read == ["EN_2", "EN_2", "EN_2, EN_3", "EN_2, EN_4"]


HEADER = read_board((board.BOARDS / "f405" / "board.h").read_text())
ASKED = list(accumulate([60.0, 95.0, 130.0, 85.0, 120.0, 75.0, 110.0], initial=0.0))
GOOD = Train(ASKED, ASKED, [0.5] * 8, [0, 0], 8, 0, overrun=False)
LIMITS = Limits(0.5, 0.1, 0.1, 0.025)


def bad(found: Train) -> dict[str, str]:
    return {s.what: s.seen for s in train.judge(found, LIMITS) if s.verdict == "BAD"}


def test_what_a_class_promises_is_what_its_pulses_are_held_against():
    assert train.limits(HEADER) == LIMITS
    second = replace(HEADER, values=HEADER.values | {"BOARD_STEP_CLASS": "2"})
    assert train.limits(second) == Limits(0.5, 0.1, 4.0, 4.0)


def test_good_pulses_are_good():
    assert bad(GOOD) == {}


@given(st.sets(st.integers(1, 8), min_size=1, max_size=4), st.floats(0, 1e6))
def test_whichever_pulses_are_missing_they_are_named(missing, begin):
    left = [at + begin for number, at in enumerate(ASKED, 1) if number not in missing]
    some = replace(GOOD, captured=[at - left[0] for at in left], widths=[0.5] * len(left))

    assert bad(some) == {
        "pulses": f"{len(left)} of 8; missing: {', '.join(map(str, sorted(missing)))}"
    }


@given(st.integers(1, 7), st.floats(10, 40))
def test_a_pulse_that_nobody_asked_for_is_named(after, later):
    more = sorted([*ASKED, ASKED[after - 1] + later])
    some = replace(GOOD, captured=more, widths=[0.5] * 9)

    assert bad(some) == {"pulses": f"9 of 8; surplus: {after + 1}"}


@pytest.mark.parametrize("rate", [0.5, 0.98, 1.02, 2.0])
def test_a_step_timer_with_another_clock_is_told_as_that(rate):
    some = replace(GOOD, captured=[at / rate for at in ASKED])

    said = f"{rate:.3f} of what was asked: the step timer has another clock"
    assert bad(some) == {"rate of the pulses": said}


def test_pulses_off_their_ticks_are_told_as_that():
    some = replace(GOOD, captured=[at + (0.2 if at == ASKED[4] else 0) for at in ASKED])

    assert bad(some) == {"ticks": "within 200 ns"}


def test_wide_pulses_are_told_as_that():
    assert bad(replace(GOOD, widths=[0.5] * 7 + [0.7])) == {"width": "0.500 to 0.700 us: too wide"}


def test_what_the_image_has_lost_is_not_laid_at_the_wire():
    some = replace(GOOD, captured=ASKED[:3], widths=[0.5] * 3, overrun=True)

    assert list(bad(some)) == ["pulses"]
    assert "the image did not fetch them in time" in bad(some)["pulses"]


def test_what_the_driver_says_of_its_pulses_is_told():
    some = replace(GOOD, made=7, late=1)
    rows = {s.what: s.seen for s in train.judge(some, LIMITS)}

    assert bad(some) == {"made by the driver": "7 pulses"}
    assert rows["late, as the driver says"] == "1"


class NoLine:
    """Nothing may be asked of the image."""

    name = "none"

    def read(self, seconds: float) -> bytes:
        raise AssertionError

    def write(self, data: bytes) -> None:
        raise AssertionError

    def close(self) -> None:
        pass


def test_a_board_without_a_pin_to_capture_at_says_what_was_not_measured():
    pins = [pin for pin in HEADER.pins if pin.signal != "CAPTURE"]
    bare = step.Bench("f405", replace(HEADER, pins=pins), Talk(NoLine()), Person(io.StringIO()), 1)

    assert [(row.verdict, row.seen) for row in pulses.measure(bare)] == [("note", "not measured")]
    assert [(row.verdict, row.seen) for row in walk_wires("EN")(bare)] == [
        ("note", "the board has none")
    ]
