"""The model of the GVE134 unit against the contract's examples, and against units that are wrong.

A unit that is wrong is the model itself with one slip planted, which makes answers and pulses; the
right model has to notice.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gve_commands
import gve_line
import gve_run
import gve_vector
import path_reference
import pytest
from gve_commands import Commands
from gve_course import Course, Mismatch
from gve_line import Line
from gve_model import compare, imagine
from gve_record import Answer, Done, Edge, Session
from gve_sessions import Writer, session
from gve_state import Modal, State
from gve_unit import Unit, Unsure
from gve_vector import Entry, jump_cap, path_of, scaled
from gve_words import Refused, checksum, read_command, single, single_text, with_sum

MS = gve_line.MS
SETTLE_MS = 10
SEEDS = range(150)

PACKET = (
    *("!0*S,FA", "!0C697,30,0,51", "!0C692,92,0,54", "!0C682,151,0,7F", "!0C665,209,0,84"),
    *(
        "!0C645,268,0,87",
        "!0C619,322,0,7F",
        "!0C589,375,0,8D",
        "!0C553,425,0,80",
        "!0C515,471,0,7F",
    ),
    *("!0C471,515,0,7F", "!0*E10,4D"),
)


def talk(*lines: str | float, edges: tuple[Edge, ...] = (), end_ms: int = 300) -> Session:
    """Return a session of lines as they are, each with a wait after it; numbers are ms to wait."""
    writer = Writer("talk")
    writer.tick = 150 * MS
    for line in lines:
        if isinstance(line, str):
            writer.send(line + "\r")
            writer.tick += SETTLE_MS * MS
        else:
            writer.tick += round(line * MS)
    return Session(tuple(writer.line), edges, writer.tick + end_ms * MS)


def answers(*lines: str | float, edges: tuple[Edge, ...] = ()) -> list[str]:
    """Return what the model answers."""
    return [answer.text for answer in imagine(talk(*lines, edges=edges)).answers]


def test_sums_are_those_of_the_contract() -> None:
    assert checksum("0,") == "5C"
    for text in ("!0%-,CF", "!0A100,4F", "!0?,BC", "!0PF,13", "!0H,C5", "!0SR6,58", "!7V300,6D"):
        assert with_sum(text[:-3]) == text
    for text in (*PACKET, "0,10,E9", "1,0,B9", "2,0,BA", "8,10,F1", "8,D0,04", "2,5E", "8,64"):
        assert with_sum(text[:-3]) == text


def test_the_packet_of_the_sheet_is_answered_as_there() -> None:
    assert answers("!0%+", *PACKET) == ["0,5C", "0,10,E9"]
    damaged = [line if i != 5 else line + "0" for i, line in enumerate(PACKET)]
    assert answers("!0%+", *damaged) == ["0,5C", "2,0,BA"]
    assert answers("!0%+", "!0H,C5", *PACKET) == ["0,5C", "8,64", "8,10,F1"]


def test_the_examples_of_the_table_of_requests() -> None:
    spoken = answers("!0%+", "!0?,BC", "!0A100,4F", 200, "!0A100,4E", 200, "!7V300,6D", "!0%-,CF")
    assert spoken == ["0,5C", "0,IP134/200 v1 22.11.2026,4D", "0,5C", "2,5E", "0,5C", "0"]
    assert answers("!0SW8,F1", "!0L1000,0,0", "!0F") == ["5", "0", "0,40"]


def test_the_dialogue_of_the_sheet() -> None:
    spoken = answers(
        *("!0V20000", "!0A1000", "!0L20000,0", 300, "!0H", "!0SR4", "!0SR5", "!0SR6"),
        *("!0SW0,1A", "!0SW1,3F", "!0K", "!0L0,0,-1000", "!0L0,0,1000", 300, "!0L0,0,1000"),
        *("!0R", 300, "!0R", "!0V500", "!0XA", "!0SW0,A2", "!0SW1,78", "!0G", "!0SR6"),
    )
    assert spoken[3:] == [
        *("8", "8,00", "8,00", "8,D0", "8", "8", "0", "0", "1", "0"),
        *("7", "8", "8", "8", "8", "8", "0", "0,40"),
    ]


def test_an_input_stops_the_axes_and_latches_where_they_were() -> None:
    edge = Edge(300 * MS, 2, 0)
    spoken = answers(
        *("!0SW0,02", "!0V2000", "!0A1000", "!0L2000", 300, "!0SR4", "!0PL", "!0G"), edges=(edge,)
    )
    assert spoken[4] == "8,02"
    assert 100 < int(spoken[5].split(",")[1]) < 400
    assert spoken[6] == "0"


def test_a_reference_run_ends_at_the_pulse_at_which_the_switch_lets_go() -> None:
    edges = (Edge(300 * MS, 1, 0), Edge(500 * MS, 1, 1))
    done = imagine(talk("!0A1000", "!0WX-500,1000,500,500", 2000, "!0SR6", edges=edges))
    assert [answer.text for answer in done.answers] == ["0", "0", "0,00"]
    train = done.motors.trains[0]
    let_go = train.place_at(500 * MS)
    assert train.places[-1] in (let_go + 1, let_go)
    assert answers("!0WX20,1000,500,500", 400, "!0SR6") == ["D", "8,80"]


def test_corrected_speeds_are_those_of_the_example() -> None:
    modal = Modal(speed=10_000, corrected=True, short_below=1)
    assert modal.entry((3000, 4000, 0, 0)).speed_limit() == 256 * 8000
    assert modal.entry((0, 0, 0, 700)).speed_limit() == 256 * 10_000
    assert Modal(speed=10_000, border=50).entry((100, 0, 0, 0)).speed_limit() == 256 * 50
    assert Modal(speed=200_000).entry((10, 0, 0, 0)).speed_limit() == 256 * 20_000


def test_a_corner_is_as_fast_as_its_jump_allows() -> None:
    before = Modal().entry((100, 0, 0, 0))
    after = Modal(jumps=(500, 300, 0, 0)).entry((0, 100, 0, 0))
    assert jump_cap(before, after) == 256 * 300
    assert path_of([before, after])[1].border == 256 * 300
    assert jump_cap(before, Modal(jumps=(500, 0, 0, 0)).entry((100, 0, 0, 0))) is None


def test_the_factor_is_rounded_to_the_nearest_and_stays_in_its_range() -> None:
    assert scaled(100 * 65_536, 17) == 106 * 65_536 + 16_384
    assert [scaled(65_536 + 8, 17), scaled(65_536, 15)] == [69_641, 65_536]
    assert scaled(1000 * 65_536, 17) == 1000 * 65_536


@pytest.mark.parametrize(
    ("text", "bits", "read"),
    [
        ("1.5", 0x3FC00000, "1.5"),
        ("0.1", 0x3DCCCCCD, "0.100000001"),
        ("1.5E-7", 0x34210FB0, "1.50000005E-07"),
        ("16777217", 0x4B800000, "16777216"),
        ("-0", 0x80000000, "-0"),
        ("1E-45", 1, "1.40129846E-45"),
        ("3.4028235E38", 0x7F7FFFFF, "3.40282347E+38"),
    ],
)
def test_singles_are_read_to_the_nearest_and_written_with_nine_digits(
    text: str, bits: int, read: str
) -> None:
    assert single(text) == bits
    assert single_text(bits) == read


def test_singles_that_are_none() -> None:
    assert [single_text(bits) for bits in (0x7FC00000, 0x7F800000, 0xFF800000)] == [
        *("NAN", "INF", "-INF")
    ]
    for text, code in (
        ("1E39", 5),
        ("3.4028236E38", 5),
        (".5", 4),
        ("1.5E", 4),
        ("", 4),
        ("1,", 4),
    ):
        with pytest.raises(Refused) as refused:
            single(text)
        assert refused.value.code == code


@pytest.mark.parametrize(
    ("text", "code"),
    [
        *(("Z", 3), ("", 3), ("V", 4), ("V9", 5), ("V1,2", 4), ("L-2147483648", 5), ("C1,,2", 4)),
        *(("NQ1", 4), ("NX", 4), ("WX0,100,1,100", 5), ("SW8,F1", 5), ("ER100", 5), ("EWGG,1", 4)),
        *(("VL1,2,3", 4), ("V9x", 4), ("L9999999999x,1", 4), ("T25", 5), ("*E129", 5), ("PX", 4)),
    ],
)
def test_what_is_wrong_with_a_text(text: str, code: int) -> None:
    with pytest.raises(Refused) as refused:
        read_command(0, text)
    assert refused.value.code == code


def test_the_model_agrees_with_what_it_would_do_itself() -> None:
    for seed in SEEDS:
        try:
            compare(session(seed), imagine(session(seed)))
        except Unsure:
            continue


def test_an_answer_too_late_a_pulse_too_many_and_one_that_is_off_are_noticed() -> None:
    spoken = talk("!0L20,10", "!0P", 300)
    for spoil in (_late_answer, _no_answer, _pulse_too_many, _pulse_missing, _pulse_off):
        done = imagine(spoken)
        compare(spoken, done)
        spoil(done)
        with pytest.raises(Mismatch):
            compare(spoken, done)


def _late_answer(done: Done) -> None:
    answer = done.answers[0]
    done.answers[0] = Answer(answer.begin + 2 * MS, answer.out + 2 * MS, answer.text)


def _no_answer(done: Done) -> None:
    done.answers.pop()


def _pulse_too_many(done: Done) -> None:
    train = done.motors.trains[0]
    train.add(train.ticks[-1] + 40 * MS, 1)


def _pulse_missing(done: Done) -> None:
    train = done.motors.trains[0]
    train.ticks.pop()
    train.places.pop()


def _pulse_off(done: Done) -> None:
    done.motors.trains[1].ticks[4] += 3


# --- units that are wrong ---

Slip = tuple[Any, str, Callable[[Any], Any]]


def _entry_slip(**changes: Callable[[Entry], Any]) -> Callable[[Any], Any]:
    def plant(right: Any) -> Any:
        def entry(self: Modal, steps: Any, own_speed: int = 0) -> Entry:
            made: Entry = right(self, steps, own_speed)
            for name, change in changes.items():
                object.__setattr__(made, name, change(made))
            return made

        return entry

    return plant


def _f_down(_right: Any) -> Any:
    return lambda factor, sixteenths: max(65_536, min(1000 * 65_536, factor * sixteenths // 16))


def _own_border(right: Any) -> Any:
    return lambda entry, _before: right(entry, None)


def _d_keeps_causes(right: Any) -> Any:
    def empty(self: Commands) -> None:
        kept = self.unit.state.status[4:]
        right(self)
        self.unit.state.status[4:] = kept

    return empty


def _no_intcom(right: Any) -> Any:
    return property(lambda self: right.fget(self) & ~0x10)


def _only_first_cause(right: Any) -> Any:
    def sense(self: Unit, low: int, high: int) -> None:
        if self.phase != "stop":
            right(self, low, high)

    return sense


def _u_exact(right: Any) -> Any:
    return lambda entry: right(entry) + 1


def _stop_is_late(right: Any) -> Any:
    def places(self: Course, earliest: int, cause: int) -> Any:
        return right(self, earliest + MS, cause + MS)

    return places


def _n_keeps_z(right: Any) -> Any:
    def number(self: Commands, *args: int) -> None:
        was = self.unit.offsets[2]
        right(self, *args)
        self.unit.offsets[2] = was

    return number


def _index_counts_repair(right: Any) -> Any:
    def request(self: Line, address: int, text: str, tick: int, *, too_long: bool) -> None:
        if text in ("@", ">"):
            self.index += 1
        right(self, address, text, tick, too_long=too_long)

    return request


def _xm_without_v(right: Any) -> Any:
    return lambda self, _speed: right(self, None)


def _back_is_short(right: Any) -> Any:
    def go(self: Any, part: int, low: int, high: int, steps: int = 0) -> None:
        right(self, part, low, high, steps + (1 if steps < -1 else -1 if steps > 1 else 0))

    return go


def _all_inputs_high(right: Any) -> Any:
    return lambda self, port: right(self, port) & 0x0F


def _kept_is_lost(right: Any) -> Any:
    def restore(self: Commands) -> None:
        right(self)
        self.unit.state.inta = True

    return restore


SLIPS: dict[str, Slip] = {
    "f is rounded down": (gve_commands, "scaled", _f_down),
    "B of the vector behind the border": (gve_vector, "limited", _own_border),
    "D keeps ST4 and ST5": (Commands, "_empty", _d_keeps_causes),
    "INTCOM is not told": (Unit, "st6", _no_intcom),
    "only the first cause is kept": (Unit, "sense", _only_first_cause),
    "U is one too high": (Entry, "speed_limit", _u_exact),
    "a change takes effect 1 ms late": (Course, "places", _stop_is_late),
    "N leaves Z": (Commands, "_do_n", _n_keeps_z),
    "@ counts itself": (Line, "_request", _index_counts_repair),
    "XM leaves V": (Commands, "_override", _xm_without_v),
    "W comes back one pulse too short": (gve_run.Runner, "_go", _back_is_short),
    "I1 reads unused bits as 0": (State, "port_levels", _all_inputs_high),
    "R always sets INTA": (Commands, "_do_r", _kept_is_lost),
    "VK is not heeded": (Modal, "entry", _entry_slip(corrected=lambda _: False)),
    "VJ is not heeded": (Modal, "entry", _entry_slip(jumps=lambda _: (0, 0, 0, 0))),
    "VL is not heeded": (Modal, "entry", _entry_slip(limits=lambda _: None)),
    "$ means up to n": (Modal, "entry", _entry_slip(short_below=lambda made: made.short_below + 1)),
    "T of a chain is 1 ms": (Modal, "entry", _entry_slip(pause_ms=lambda _: 1)),
    "the ramp is 1/4096 too steep": (
        path_reference.Vector,
        "gain",
        lambda right: property(lambda self: right.fget(self) * 4097 // 4096),
    ),
    "turns need no time": (path_reference, "turn_cap", lambda _: lambda *_: None),
}
QUICK = (
    *("!0A8000", "!0V190000", "!0B200000", "!0$1", "!0XM1000", "!0L2000,100", "!0C-300,50"),
    *("!0C300,1", 300, "!0P4"),
)
"""So fast that an axis which turns has to be waited for."""

SHORTEST = ("!0$20", "!0B100", "!0L20", 600, "!0P", "!0V5000", "!0A200", "!0L0,20", 600)
"""A vector of just n pulses."""

SOON = ("!0T24", "!0L4", 20, "!0L4", 100)
"""The second one comes while the pause lasts."""

SLOWER = ("!0V200000", "!0A8000", *("!0XD",) * 9, "!0L50000", 800)
"""So often slower that f is no round number, and so long that this is seen."""

CORNERS = (
    *("!0V5000", "!0A500", "!0$1", "!0B300", "!0L100", "!0B900", "!0C100,100", 400),
    *("!0VJ100,100,0,0", "!0L200", "!0C0,200", 400),
)
KEPT = ("!0K", "!0R", "!0SR6", "!0SW4,55", "!0D", "!0SR4", "!0H", "!0SR6")


def sessions_for_slips() -> list[Session]:
    """Sessions that are likely to show any slip."""
    crafted = (KEPT, CORNERS, SOON, QUICK, SHORTEST, SLOWER)
    return [*(talk(*lines) for lines in crafted), *(session(f"slip {n}") for n in range(100))]


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_noticed(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    where, what, plant = SLIPS[name]
    for spoken in sessions_for_slips():
        with monkeypatch.context() as patch:
            patch.setattr(where, what, plant(getattr(where, what)))
            try:
                done = imagine(spoken)
            except (Unsure, Mismatch, AssertionError):
                continue
        try:
            compare(spoken, done)
        except Unsure:
            continue
        except Mismatch:
            return
    pytest.fail(f"nobody notices that {name}")
