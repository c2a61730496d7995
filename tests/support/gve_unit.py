"""The GVE134 unit as the contract has it: its motion, its queue and what makes it stop.

It is told what comes and when, and what the real unit did (`gve_record.Done`). Where the contract
leaves a choice it takes the one that the unit took, and complains where none explains what was
done. The commands are in `gve_commands.py`, the reference run in `gve_run.py`, the order of things
in `gve_model.py`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from exact import Fraction
from gve_course import MS, Mismatch, Place, Vectors
from gve_line import Item, Request
from gve_motion import Motion
from gve_record import BYTE_TICKS, Answer, Done
from gve_state import INTA, INTCOM, RUN, STOP, State
from gve_vector import Entry, path_of
from gve_words import with_sum

SLACK = MS
"""So long after the axes have come to rest the unit may still say that they move."""

NEAR_US = 84
LED_LATE = 20 * MS
QUEUE_MAX = 128
NONE = (0, Fraction(0))
Phase = Literal["rest", "work", "stop", "wait", "run"]
"""As in the table of states; work is STOP = 0, stop is STOP = 1, run is a reference run."""


class Unsure(Exception):
    """What the contract wants hangs on things that it does not tell."""


class Chooser:
    """Tries one choice after the other until what follows agrees with the unit."""

    def __init__(self) -> None:
        """Choose the first everywhere."""
        self.taken: list[int] = []
        self.counts: list[int] = []
        self.at = 0

    def pick(self, count: int) -> int:
        """Choose one of so many."""
        if self.at == len(self.taken):
            self.taken.append(0)
            self.counts.append(count)
        self.at += 1
        return self.taken[self.at - 1]

    def again(self) -> bool:
        """Begin anew with the next choices; False: all have been tried."""
        while self.taken and self.taken[-1] + 1 == self.counts[-1]:
            self.taken.pop()
            self.counts.pop()
        self.at = 0
        if self.taken:
            self.taken[-1] += 1
        return bool(self.taken)


@dataclass
class Kept:
    """What K keeps."""

    entries: list[Entry]
    vectors: Vectors
    phase: Phase
    causes: list[int]
    inta: bool
    intcom: bool


class Unit:
    """The motion of the unit; times are ticks."""

    def __init__(self, done: Done, chooser: Chooser) -> None:
        """Nothing has happened yet."""
        self.done = done
        self.chooser = chooser
        self.state = State()
        self.motion = Motion(done.motors)
        self.phase: Phase = "rest"
        self.entries: list[Entry] = []
        self.vectors: Vectors = ()
        self.kept: Kept | None = None
        self.caught = (0, 0)
        self.came_from_h = False
        self.offsets = [0, 0, 0, 0]
        self.stood_tick = 0.0
        """When the axes last came to rest."""
        self.answered = 0
        self.ready_tick = 0
        """When the last answer was out, and the next command may be executed."""
        self.last_answer = ""
        self.changes: dict[str, list[tuple[int, int, int]]] = {}
        """Of each signal the window and the level of each change."""

    # --- answers ---

    def peek(self, latest: int, what: object) -> Answer:
        """Return the next answer that the unit gave."""
        if self.done.growing:
            return Answer(latest - 4 * MS // 5, latest, "")
        if self.answered == len(self.done.answers):
            raise Mismatch(latest, f"no answer to {what}")
        return self.done.answers[self.answered]

    def answer(self, item: Item, texts: Iterable[str], low: float, high: float) -> None:
        """The unit must answer one of these texts within a window."""
        options = [with_sum(text) if item.sums else text for text in sorted(texts)]
        what = item.text if isinstance(item, Request) else type(item).__name__
        if self.done.growing:
            begin = min(int(low) + MS // 5, int(high))
            out = begin + BYTE_TICKS * (len(options[0]) + 1)
            self.done.answers.append(Answer(begin, out, options[0]))
        if self.answered == len(self.done.answers):
            raise Mismatch(high, f"no answer to {what}")
        got = self.done.answers[self.answered]
        self.answered += 1
        if got.text not in options:
            raise Mismatch(got.begin, f"{what} is answered {got.text}, not {' or '.join(options)}")
        if not low - 1 <= got.begin <= high + 1:
            raise Mismatch(
                got.begin,
                f"{what} is answered {got.text} at {got.begin / MS:.3f} ms, "
                f"not from {low / MS:.3f} to {high / MS:.3f}",
            )
        self.ready_tick = got.out
        plain = isinstance(item, Request) and getattr(item.command, "name", "") in ("@", ">")
        if not plain:
            self.last_answer = got.text

    def code(self, code: int) -> str:
        """The digit of an answer."""
        return f"{code | self.state.inta << 3:X}"

    # --- what there is to know ---

    @property
    def run(self) -> bool:
        """RUN."""
        return self.phase != "rest"

    @property
    def st6(self) -> int:
        """ST6."""
        state = self.state
        bits = {STOP: self.phase == "stop", INTCOM: state.intcom, RUN: self.run, INTA: state.inta}
        return sum(1 << bit for bit, on in bits.items() if on) | (
            1 << state.fault if state.fault else 0
        )

    def position(self, axis: int, tick: int) -> int:
        """Where an axis is."""
        axis = self.state.follows if axis == 3 and self.state.follows is not None else axis
        number = self.done.motors.trains[axis].place_at(tick) + self.offsets[axis]
        return (number + 2**31) % 2**32 - 2**31

    def moments(self, low: int, high: int) -> list[int]:
        """The ticks of a window at which positions change, and its begin."""
        trains = self.done.motors.trains
        ticks = {tick for train in trains for tick in train.between(low, high)}
        return [low, *sorted(ticks)]

    def places_free(self, low: int, high: int) -> tuple[int, int]:
        """How many more vectors fit: the least and the most in a window."""
        if self.phase == "rest":
            return QUEUE_MAX, QUEUE_MAX
        if self.phase == "wait":
            done = [course.rest[0] for course in self.motion.courses]
            least, most = min(done), max(done)
        else:
            least, _ = self.motion.vectors_done(max(0, low - SLACK))
            _, most = self.motion.vectors_done(high)
        taken = len(self.entries) - QUEUE_MAX
        return least - taken, most - taken

    def no_vector_fits(self, low: int, high: int) -> set[bool]:
        """Bit 5 of F; both where it changes within a window."""
        if self.phase == "rest":
            return {False}
        if self.kept:
            return {True}
        return {free <= 0 for free in self.places_free(low, high)}

    # --- motion ---

    def window(self, low: int, pause_ms: int) -> tuple[int, int]:
        """When a chain may begin that was asked for at a tick."""
        due = self.done.motors.last_before(low) + pause_ms * MS
        return max(low, due - 1), max(low + MS, due + 1)

    def begin_chain(self, entries: list[Entry], low: int, high: int) -> None:
        """Vectors that join none before them; one without motion is done at once."""
        if not any(entry.length for entry in entries):
            return
        self.entries = list(entries)
        self.vectors = path_of(self.entries)
        for course in self.motion.courses:
            course.follows = self.state.follows
        if self.state.inta:
            self.phase = "wait"
            for course in self.motion.courses:
                course.rest, course.vectors = NONE, self.vectors
        else:
            self.begin(NONE, low, high)

    def begin(self, at: Place | None, low: int, high: int) -> None:
        """Leave the stand, from a place, or from where each course rests."""
        self.phase = "work"
        self.vectors = path_of(self.entries)
        fresh = (at or self.motion.courses[0].rest) == NONE
        window = self.window(low, self.entries[0].pause_ms if fresh else 0)
        self.motion.begin(self.vectors, at, window)
        self.sense(low - 1, high)

    def add(self, new: list[Entry], low: int) -> None:
        """Vectors that join what is there."""
        if not new:
            return
        before = [*self.entries[-1:], *new]
        added = path_of(before)
        self.vectors += added[-len(new) :]
        self.entries += new
        if self.phase == "work":
            self.motion.add(low, self.vectors, new[0].pause_ms * MS)
        for course in self.motion.courses:
            course.vectors = self.vectors

    def limit_anew(self, low: int, high: int) -> None:
        """The vectors of the queue have other limits."""
        vectors = path_of(self.entries)
        if vectors == self.vectors:
            return
        self.vectors = vectors
        if self.phase == "work":
            self.motion.change(low, vectors, stops=False)
        else:
            for course in self.motion.courses:
                course.vectors = vectors

    def stop(self, low: int, high: int) -> None:
        """Brake down the ramp, for a cause within a window."""
        self.motion.change(low, self.vectors, stops=True, latest=high)
        if self.phase == "work":
            self.phase = "stop"

    def sense(self, low: int, high: int) -> None:
        """Look whether an enabled INTR is active; it is at the earliest and latest at a tick."""
        if self.phase not in ("work", "stop") or self.state.inta:
            return
        causes = self.state.causes
        if not any(causes):
            return
        self.caught = (self.caught[0] | causes[0], self.caught[1] | causes[1])
        if self.phase == "work":
            self.latch(low, high)
            self.stop(low, high)

    def latch(self, low: int, high: int) -> None:
        """Note PL for an INTR that became active within a window."""
        moments = self.moments(low - NEAR_US, high + NEAR_US)
        self.state.latched = tuple(
            frozenset(self.position(axis, tick) for tick in moments) for axis in range(4)
        )

    def stand(self, low: float, high: float) -> None:
        """The axes have come to rest, within a window."""
        left = {course.rest[0] < len(self.entries) for course in self.motion.courses}
        is_left = left.pop() if len(left) == 1 else not self.chooser.pick(2)
        count = len(self.entries)
        self.motion.keep(
            lambda course: (course.rest[0] < count) == is_left, int(high), "what is left"
        )
        stopped, self.stood_tick = self.phase == "stop", low
        self.phase = "wait" if is_left else "rest"
        if not is_left:
            self.entries, self.vectors = [], ()
        if stopped:
            self.interrupted()
        self.note_outputs(low, high)

    def interrupted(self) -> None:
        """INTA and its causes, when the axes stand."""
        state = self.state
        state.inta = True
        state.intcom |= self.came_from_h
        for i in (0, 1):
            old = state.status[4 + i]
            added = not self.caught[i] or not old & ~self.caught[i] or not self.chooser.pick(2)
            state.status[4 + i] = self.caught[i] | (old if added else 0)
        self.caught, self.came_from_h = (0, 0), False

    def advance(self, tick: int) -> None:
        """Come to a tick: note a rest that the unit must have seen by then."""
        self.motion.verify(tick)
        if self.phase in ("work", "stop"):
            ends = [end for end in self.motion.ends(tick) if end is not None]
            if len(ends) == len(self.motion.courses) and max(ends) + SLACK <= tick:
                self.stand(min(ends), max(ends) + SLACK)

    def may_stand(self, low: int, high: int) -> None:
        """Decide whether the unit has seen a rest that it may have seen within a window."""
        if self.phase not in ("work", "stop"):
            return
        ends = [end for end in self.motion.ends(high) if end is not None]
        if not ends:
            return
        if self.chooser.pick(2) == 0:
            self.motion.keep_ended(high, since=-MS)
            self.stand(min(ends), high)
        else:
            self.motion.keep_moving(low - SLACK, high)

    # --- outputs ---

    def note_outputs(self, low: float, high: float) -> None:
        """Outputs and LEDs may have changed within a window."""
        for name, level in self.state.signals.items():
            changes = self.changes.setdefault(name, [])
            if level != (changes[-1][2] if changes else 0):
                late = LED_LATE if name.startswith("led") else MS
                changes.append((int(low), int(high) + late, level))
