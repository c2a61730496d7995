"""A positioning unit and its axes, for scripts and for the commands.

    from rkm04_tools.positioning.unit import open_unit

    with open_unit("/dev/ttyUSB0") as unit:
        axis = unit.axis(1)
        axis.init()
        axis.move(10.0, feed=1000, accel=500)
        print(axis.read().position_um)

Ways are in mm, feeds in mm/min, accelerations in mm/s². Every call ends: with what was asked for,
or with an error of one line. An instruction is executed once, however often its request had to be
sent, and nothing is sent later than its call.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from types import TracebackType

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.line_errors import LineError
from rkm04_tools.positioning.line_errors import (
    Faulted,
    NotConfirmed,
    NotHeld,
    Refused,
    RequestRefused,
    Restarted,
    WrongUnit,
)
from rkm04_tools.positioning.state import (
    FEED_PER_MM_MIN,
    IN_FIRST,
    IN_NUMBERS,
    UM_PER_MM,
    AxisState,
    UnitState,
    axis_state,
    error_text,
    mm_text,
)
from rkm04_tools.positioning.table import (
    AXES,
    AXIS_STEP,
    WORD_MAX,
    Register,
    instructions,
    registers,
    values_text,
)
from rkm04_tools.positioning.wire import FORMAT, RATE, Wire, open_wire

PRODUCT = "POS4"
LAYOUT = 1
CONTROL, FEED = 5, 6
UNIT_WORDS = 28
NUMBERS = 256
SPACES = range(7)
POLL_SECONDS = 0.05
STOP_SECONDS = 5.0
"""How long a stop is tried for on a line that does not answer."""
BRAKE_SECONDS = 60.0
"""How long an axis may brake before it is told that nobody knows."""
SLOWER_SECONDS = 2.0
"""An axis that brakes, and makes steps, is slower after that."""
HELD_SECONDS = 0.3
"""So long an axis that stands is looked at: a PLC gives the permission in each of its cycles."""
CLOCK_HALF = 1 << 31
MM_MAX = (CLOCK_HALF - 1) / UM_PER_MM
FEED_MAX = (1 << 32) - 1
GIVEN_AGAIN = "another master, such as a PLC, has given the permission (MP) again"
Tell = Callable[[AxisState], None] | None
"""What is called with each look at an axis that is waited for."""


def open_unit(port: str, node: int = 1, rate: int = RATE, form: str = FORMAT) -> Unit:
    """Open the line to a unit: a serial device, a pty, socket://HOST:PORT, modbus://HOST:PORT."""
    return Unit(open_wire(port, node, rate, form))


def setting(name: str) -> Register:
    """A register that can be set, by its name."""
    row = registers().get(name.upper())
    if row is None or not row.is_setting:
        known = ", ".join(r.name for r in registers().values() if r.is_setting)
        raise Failure(f"{name}: no such setting; there are {known}")
    return row


class Unit:
    """A unit at the end of a line."""

    def __init__(self, wire: Wire) -> None:
        self.wire = wire
        self._uptime_ms: int | None = None
        self._known = False

    def __enter__(self) -> Unit:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            self.wire.close()
        else:
            self.wire.abandon()

    def axis(self, number: int) -> Axis:
        """An axis, 1 to 4."""
        if not 1 <= number <= AXES:
            raise Failure(f"axis {number}: write an axis, 1 to {AXES}")
        return Axis(self, number)

    def read(self) -> UnitState:
        """What the unit tells of itself; also whether it is one, and has not restarted."""
        self.require_known()
        words = self.wire.read(0, UNIT_WORDS)
        rows = [r for r in registers().values() if r.scope == "U" and r.number < UNIT_WORDS]
        values = {r.name: r.of_words(words[r.number : r.number + r.words]) for r in rows}
        self._note_uptime(values["UPTIME"])
        return UnitState(self.wire.node, values)

    def require_known(self) -> None:
        """Refuse what is another device, or a unit with other registers."""
        if self._known:
            return
        try:
            told = self.wire.identify()
        except RequestRefused:
            raise WrongUnit(self.wire.name) from None
        layout = self.wire.read(0, 1) if PRODUCT in told else []
        if layout != [LAYOUT]:
            raise WrongUnit(self.wire.name)
        self._known = True

    def require_no_other(self) -> None:
        """The same for a stop, which goes out to a unit that does not answer, too."""
        tries, self.wire.tries = self.wire.tries, 1
        try:
            self.require_known()
        except WrongUnit:
            raise
        except LineError:
            pass
        finally:
            self.wire.tries = tries

    def require_same_start(self, executed: bool = False) -> None:
        """Tell a unit that has restarted since it was looked at first."""
        row = registers()["UPTIME"]
        self._note_uptime(row.of_words(self.wire.read(row.number, row.words)), executed)

    def _note_uptime(self, uptime_ms: int, executed: bool = False) -> None:
        before, self._uptime_ms = self._uptime_ms, uptime_ms
        if before is not None and (uptime_ms - before) % (1 << 32) >= CLOCK_HALF:
            raise Restarted(self.wire.name, executed)

    # ---- settings ----

    def place(self, row: Register, axis: int) -> int:
        """The number of a register on the line; `axis` counts for those of axes."""
        if row.scope == "A":
            return row.number + AXIS_STEP * self.axis(axis).number
        return row.number

    def get(self, name: str, axis: int = 0) -> int:
        """A setting, in the unit of its register."""
        row = setting(name)
        self.require_known()
        return row.of_words(self.wire.read(self.place(row, axis), row.words))

    def set(self, name: str, value: int, axis: int = 0) -> None:
        """Write a setting and read it back. It counts at once; `store` keeps it."""
        self.set_many({name: value}, axis)

    def set_many(self, values: dict[str, int], axis: int = 0) -> None:
        """Write settings that stand side by side, in one request, and read them back."""
        rows = sorted((setting(name) for name in values), key=lambda row: row.number)
        by_name = {name.upper(): value for name, value in values.items()}
        for row in rows:
            if not row.takes(by_name[row.name]):
                raise Failure(f"{row.name} {by_name[row.name]}: write {values_text(row)}")
        self.require_known()
        words = [word for row in rows for word in row.to_words(by_name[row.name])]
        first = self.place(rows[0], axis)
        self.wire.write(first, words)
        if (found := self.wire.read(first, len(words))) != words:
            raise Failure(
                f"{self.wire.name}: {', '.join(by_name)}: {words} was written and {found} is read",
                NOT_SO,
            )

    def store(self) -> None:
        """Keep all settings without power; what is stored afterwards is as they are."""
        self._store(1)
        if self.read().values["CONDITION"] & 4:
            raise Failure(f"{self.wire.name}: after STORE they are not as stored", NOT_SO)

    def deliver(self) -> None:
        """Take the delivered settings; they are not stored yet."""
        self._store(2)

    def _store(self, value: int) -> None:
        self.require_known()
        self.wire.write(registers()["STORE"].number, [value])


class Axis:
    """An axis of a unit."""

    def __init__(self, unit: Unit, number: int) -> None:
        self.unit = unit
        self.number = number
        self._base = AXIS_STEP * number
        self.instructed = False
        """Whether the unit may have got an instruction from here."""
        self._taken = False
        self._word: int | None = None
        """What was given here last."""

    def read(self) -> AxisState:
        """What it tells at this moment."""
        self.unit.require_known()
        return self._state(self.unit.wire.read(self._base + IN_FIRST, len(IN_NUMBERS)))

    # ---- instructions ----

    def init(self, space: int = 0) -> AxisState:
        """POS_INIT: take the axis; what moves stops, and errors are over."""
        if space not in SPACES:
            raise Failure(f"space {space}: write 0 to {SPACES[-1]}")
        return self._instruct("POS_INIT", [space])

    def mode(self, way_mm: float, accel: int) -> AxisState:
        """POS_MODE: a measure, from where it stands. It moves when it has a feed."""
        return self._instruct("POS_MODE", _measure(way_mm, accel))

    def mode_abs(self, position_mm: float, accel: int) -> AxisState:
        """POS_MODE_ABS: a measure to a position."""
        return self._instruct("POS_MODE_ABS", _measure(position_mm, accel))

    def prepare_home(self, method: int, position_mm: float = 0.0, accel: int = 0) -> AxisState:
        """POS_HOME: the reference is at this position. It moves when it has a feed."""
        return self._instruct("POS_HOME", _measure(position_mm, accel, method))

    def reset(self) -> AxisState:
        """POS_RESET: end the work, and give the axis back."""
        return self._instruct("POS_RESET", [])

    def capture(self) -> AxisState:
        """POS_CAPTURE: keep the position at the next edge of the input CAPTURE."""
        return self._instruct("POS_CAPTURE", [])

    def control(self, feed: float | None = None, permitted: bool | None = None) -> AxisState:
        """POS_CONTROL: feed in mm/min and permission; what is left out stays."""
        words = [] if permitted is None else [int(permitted)]
        words += [] if feed is None else _words(_feed(feed))
        stops = permitted is False or feed == 0
        require = self.unit.require_no_other if stops else self.unit.require_known
        require()
        if words:
            place = self._base + (CONTROL if permitted is not None else FEED)
            found, _ = self.unit.wire.write_and_read(
                place, words, self._base + CONTROL, 3, begins=not stops
            )
            mp, *wanted = found
            taken = (permitted is None or mp & 1 == permitted) and (
                feed is None or wanted == words[-2:]
            )
            if not taken:
                self._refuse_control(self.read())
        return self.read()

    def _refuse_control(self, state: AxisState) -> None:
        """Tell why a feed or a permission was not taken."""
        self._require_taken(state)
        if state.has_fault:
            raise Faulted(state)
        raise Failure(
            f"axis {self.number} is {state.words}, and takes no feed before a measure: "
            "mode gives one", NOT_SO,
        )  # fmt: skip

    # ---- motion ----

    def move(
        self,
        way_mm: float,
        feed: float,
        accel: int,
        tell: Tell = None,
    ) -> AxisState:
        """Move by so much, and wait until it is there."""
        self.mode(way_mm, accel)
        self.control(feed, permitted=True)
        return self.wait(tell)

    def move_to(
        self, position_mm: float, feed: float, accel: int,
        tell: Tell = None,
    ) -> AxisState:  # fmt: skip
        """Move to a position, and wait until it is there."""
        self.mode_abs(position_mm, accel)
        self.control(feed, permitted=True)
        return self.wait(tell)

    def home(
        self, method: int, position_mm: float, feed: float, accel: int,
        tell: Tell = None,
    ) -> AxisState:  # fmt: skip
        """Find the reference (19: positive, 21: negative; 37: here), and wait for it."""
        self.prepare_home(method, position_mm, accel)
        if method != 37:
            self.control(feed, permitted=True)
        return self.wait(tell)

    def wait(self, tell: Tell = None) -> AxisState:
        """Wait until the measure is reached; what ends it otherwise is an error."""
        while not (state := self.read()).is_reached:
            self._require_taken(state)
            if state.has_fault and not state.moves:
                raise Faulted(state)
            if not (state.has_fault or state.is_programmed):
                raise Failure(
                    f"axis {self.number}: the measure was given up by another master; "
                    f"it is at {mm_text(state.position_um)} mm", NOT_SO,
                )  # fmt: skip
            if tell:
                tell(state)
            time.sleep(POLL_SECONDS)
            self.unit.wire.look()
        if self._word not in (None, state.done):
            raise Failure(
                f"axis {self.number}: another master has given an instruction meanwhile; it is at "
                f"{mm_text(state.position_um)} mm, and for which measure is not known", NOT_SO,
            )  # fmt: skip
        return state

    def hold(self, waits: Callable[[], None] = lambda: None) -> AxisState:
        """MP = 0: brake, keep what is left of the measure, and make sure that it stands."""
        state = self._until_answered(lambda: self.control(permitted=False), waits)
        now = time.monotonic()
        end, stands_from, slower_by = now + BRAKE_SECONDS, now, now
        speed, steps = state.speed + 1, state.position_steps
        while state.moves or now < stands_from + HELD_SECONDS:
            if state.speed < speed or state.position_steps == steps:
                slower_by, speed = now + SLOWER_SECONDS, state.speed
            steps = state.position_steps
            if state.moves and now > min(end, slower_by):
                raise NotHeld(f"axis {self.number}", "MP is 0, and it does not brake")
            time.sleep(POLL_SECONDS)
            state = self._until_answered(self._read_held, waits)
            now = time.monotonic()
            stands_from = now if state.moves else stands_from
        return state

    def _read_held(self) -> AxisState:
        """What it tells, if nobody lets it go on meanwhile."""
        state = self.read()
        if state.may_move and self.unit.wire.read(self._base + CONTROL, 1)[0] & 1:
            raise NotHeld(
                f"axis {self.number}",
                f"{GIVEN_AGAIN}; take it away there, or end the measure: positioning init or reset",
            )
        return state

    def go(self) -> AxisState:
        """MP = 1: go on. After a fault it does not."""
        state = self.control(permitted=True)
        if state.has_fault:
            raise Failure(
                f"axis {self.number} does not go on: {error_text(state.error)}; init comes first",
                NOT_SO,
            )
        return state

    # ---- what is common to them ----

    def _instruct(self, name: str, parameters: Sequence[int]) -> AxisState:
        """Give an instruction once, with its parameters in the same request; see it done."""
        before = self.read()
        if self._taken:
            self._require_taken(before)
        self.unit.require_same_start()
        number = ((before.done >> 8) + 1) % NUMBERS
        word = number << 8 | instructions()[name]
        self.instructed = True
        found, repeated = self.unit.wire.write_and_read(
            self._base, [word, *parameters], self._base + IN_FIRST, len(IN_NUMBERS)
        )
        if repeated:
            self.unit.require_same_start(executed=True)
        state = self._state(found)
        if state.done != word:
            raise Failure(
                f"axis {self.number}: {name} is not what was done last; another master has given "
                "an instruction meanwhile", NOT_SO,
            )  # fmt: skip
        if state.result:
            if self._taken:
                self._require_taken(state)
            raise Refused(self.number, name, state.result, state.error if state.has_fault else 0)
        self._taken, self._word = state.is_taken, word
        return state

    def _require_taken(self, state: AxisState) -> None:
        if state.is_taken:
            return
        self.unit.require_same_start(executed=True)
        if self._taken and state.done == 0:
            raise Restarted(self.unit.wire.name, executed=True)
        why = "another master has given it back" if self._taken else "init comes first"
        raise Failure(f"axis {self.number} is not taken: {why}", NOT_SO)

    def _until_answered(self, ask: Callable[[], AxisState], waits: Callable[[], None]) -> AxisState:
        """Ask again while the line is dumb, for a while; a unit that has restarted stands."""
        end = time.monotonic() + STOP_SECONDS
        while True:
            try:
                return ask()
            except NotHeld:
                raise
            except Restarted:
                return self.read()
            except LineError as error:
                if time.monotonic() > end:
                    raise NotConfirmed(str(error)) from None
                waits()
            except Failure:
                state = self.read()
                if state.moves and state.is_taken and not state.has_fault:
                    raise
                return state

    def _state(self, words: Sequence[int]) -> AxisState:
        return axis_state(self.number, IN_NUMBERS, words)


def _words(value: int) -> list[int]:
    """Two registers of a number of 32 bits."""
    return [value >> 16 & WORD_MAX, value & WORD_MAX]


def require_motion(mm: float, feed: float, accel: int) -> None:
    """Refuse what no axis can do, before one is taken for it."""
    _measure(mm, accel)
    if not _feed(feed):
        raise Failure(f"{feed} mm/min: write a feed of more than 0")
    if not accel:
        raise Failure(f"{accel} mm/s2: write an acceleration, 1 to {WORD_MAX}")


def _measure(mm: float, accel: int, space: int = 0) -> list[int]:
    if not abs(mm) <= MM_MAX:
        raise Failure(f"{mm} mm: write up to {MM_MAX} mm, either way")
    if mm and not round(mm * UM_PER_MM):
        raise Failure(f"{mm} mm: it would be none; write 0.001 mm or more, or 0")
    if not 0 <= accel <= WORD_MAX:
        raise Failure(f"{accel} mm/s2: write an acceleration, 1 to {WORD_MAX}")
    return [space, *_words(round(mm * UM_PER_MM)), accel]


def _feed(mm_min: float) -> int:
    """What is not 0 stays so."""
    if not 0 <= mm_min <= FEED_MAX / FEED_PER_MM_MIN:
        raise Failure(f"{mm_min} mm/min: write a feed, 0 to 65535.99")
    return max(round(mm_min * FEED_PER_MM_MIN), mm_min > 0)
