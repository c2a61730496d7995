"""The GVE134 unit against the contract: a session and what the unit did in it, held side by side.

`compare` raises `Mismatch` with the first thing that no reading of the contract explains, and
`Unsure` where the contract does not tell what has to come.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace

from gve_commands import Commands
from gve_course import MS, Mismatch, Record
from gve_line import Item, Packet, Refusal, Request, read_line
from gve_record import Done, Edge, Session
from gve_run import Runner
from gve_state import BRAKE, BRAKE_MAX, NO_CRYSTAL, RESTARTED
from gve_unit import LED_LATE, Chooser, Unit, Unsure
from gve_words import Command

TRIES_MAX = 400
READY = 100 * MS
KEPT_BYTES = 256
FAR = 2**62
CAUSES = {"power": 0, "watchdog": RESTARTED, "crystal": NO_CRYSTAL}


def named(item: Item, *names: str) -> bool:
    """Whether it is one of these commands."""
    command = item.command if isinstance(item, Request) else 0
    return isinstance(command, Command) and command.name in names


class Model:
    """One way through a session."""

    def __init__(
        self, session: Session, done: Done, chooser: Chooser, memory: bytes | None = None
    ) -> None:
        """Switch the unit on, as delivered or with what its memory has."""
        self.session = session
        self.unit = Unit(done, chooser)
        self.runner = Runner(self.unit)
        self.commands = Commands(self.unit, self.runner)
        self.items: deque[Item] = deque(read_line(session.line, session.end))
        self.edges: deque[Edge] = deque(session.edges)
        self.waiting: deque[Request] = deque()
        """H and W that wait for the axes."""
        self.acted: list[Item] = []
        """H that came while others waited: it has acted, and is executed again in its turn. It acts
        on the next one that waits, too: that came before it."""
        self.waits_since = 0
        self.brake_tick = FAR
        if memory is not None:
            self.unit.state.memory = bytearray(memory)
        self.unit.state.fault = CAUSES[session.cause]
        self.unit.state.inta = session.cause != "power"
        self.unit.done.motors.resets = [each.tick for each in self.items if named(each, "J")]
        self._set_brake(0)
        self.unit.note_outputs(0, READY)

    def _set_brake(self, tick: int) -> None:
        state = self.unit.state
        if not state.fault:
            self.brake_tick = tick + min(state.memory[BRAKE], BRAKE_MAX) * READY

    def go(self) -> None:
        """Follow the session to its end."""
        end = self.session.end
        while True:
            item_tick, item = self._next_item()
            edge_tick = self.edges[0].tick if self.edges else FAR
            late = self._late_tick()
            tick = min(item_tick, edge_tick, late, self.brake_tick)
            if tick >= end:
                break
            self.unit.advance(tick)
            if tick == edge_tick:
                self._edge(self.edges.popleft())
            elif item is not None and named(item, "J") and tick == item_tick:
                self._take(item, tick)
            elif tick == self.brake_tick:
                self.brake_tick = FAR
                self.unit.state.released = True
                self.unit.note_outputs(tick, tick + READY)
            elif tick == late:
                self._come(tick)
            else:
                assert item is not None
                self._take(item, tick)
        self.unit.motion.verify(end - 2 * MS)
        self._check_end()

    def _next_item(self) -> tuple[int, Item | None]:
        if not self.waiting:
            if not self.items:
                return FAR, None
            item = self.items[0]
            return max(item.tick, self.unit.ready_tick), item
        for item in self.items:
            if named(item, "H", "J") and item not in self.acted and item.tick <= self._wait_end():
                return max(item.tick, self.waits_since), item
        return FAR, None

    def _wait_end(self) -> int:
        """When the answer for which others wait begins."""
        done = self.unit.done
        if done.growing:
            return FAR
        return done.answers[self.unit.answered].begin if self._has_answer else FAR

    @property
    def _has_answer(self) -> bool:
        return self.unit.answered < len(self.unit.done.answers)

    def _late_tick(self) -> int:
        """When something comes by itself: a part of a reference run ends, or H is answered."""
        if self.runner.now:
            return self.runner.next_tick
        if not self.waiting:
            return FAR
        if not self.unit.done.growing:
            return self._wait_end()
        _, high = self.unit.motion.end()
        return max(int(high) + MS // 5, self.unit.ready_tick)

    def _come(self, tick: int) -> None:
        unit = self.unit
        if self.runner.now:
            self.runner.look(tick)
            if not self.runner.now:
                self._waited(tick)
            return
        item = self._waited(tick)
        earliest = unit.ready_tick
        if unit.phase == "stop":
            since = tick - MS - 1 if earliest < tick - MS else -FAR
            unit.motion.keep_ended(tick, since=since)
            ends = [end for end in unit.motion.ends(tick) if end is not None]
            unit.stand(min(ends), tick)
        unit.state.inta = unit.state.intcom = True
        low = max(math.floor(unit.stood_tick), item.tick)
        unit.answer(item, [unit.code(0)], low, max(low, earliest) + MS)
        unit.note_outputs(low, tick)

    def _waited(self, tick: int) -> Request:
        """Take the first of those that wait; not too much must have come meanwhile."""
        item = self.waiting.popleft()
        if sum(item.tick < byte.tick <= tick for byte in self.session.line) > KEPT_BYTES:
            raise Unsure("more bytes wait than a unit must keep")
        return item

    def _take(self, item: Item, tick: int) -> None:
        unit = self.unit
        if self.waiting and named(item, "H") and item is not self.items[0]:
            self._halt_early(tick)
            self.acted.append(item)
            return
        self.items.remove(item)
        if isinstance(item, Refusal):
            text = f"{unit.code(2)},0" if item.packet else unit.code(2)
            high = max(item.latest, unit.ready_tick) + MS
            unit.answer(item, [text], max(item.tick, unit.ready_tick), high)
        elif isinstance(item, Packet):
            self.commands.packet(item, tick)
        elif named(item, "J"):
            self._reset(item, tick)
        else:
            was = unit.state.fault
            if not self.commands.execute(item, tick):
                self.waiting.append(item)
                self.waits_since = tick
                self.acted.clear()
            if was and not unit.state.fault:
                self._set_brake(tick)

    def _halt_early(self, tick: int) -> None:
        """An H acts that came while others wait before it."""
        if self.runner.now:
            self.runner.halt(tick, tick)
            self.unit.came_from_h = bool(self.unit.chooser.pick(2))
        elif self.unit.phase == "stop":
            self.unit.came_from_h = True

    def _edge(self, edge: Edge) -> None:
        unit = self.unit
        unit.state.levels[edge.number] = edge.level
        unit.note_outputs(edge.tick, edge.tick)
        if self.runner.now:
            self.runner.edge(edge.tick)
        elif any(unit.state.causes):
            unit.may_stand(edge.tick, edge.tick)
            unit.sense(edge.tick, edge.tick)

    def _reset(self, item: Request, tick: int) -> None:
        unit = self.unit
        after = "8" if unit.state.reset().inta else "0"
        unit.answer(item, [after], tick, max(tick, unit.ready_tick) + MS)
        limit = unit.ready_tick + MS
        following = [each.tick for each in self.items] or [FAR]
        record = unit.done.motors
        if record.growing:
            unit.motion.verify(tick)
        last = record.last_before(min(tick + READY, min(following)))
        if last > limit:
            raise Mismatch(last, "pulses after J")
        unit.motion.verify(max(tick, last))
        fresh = Unit(unit.done, unit.chooser)
        fresh.state = unit.state.reset()
        fresh.answered = unit.answered
        fresh.ready_tick = unit.ready_tick
        fresh.changes = unit.changes
        for axis, train in enumerate(record.trains):
            seen = train.count_until(max(tick, last))
            fresh.motion.courses[0].cursors[axis].seen = seen
            fresh.offsets[axis] = -train.places[seen]
        self.unit = fresh
        self.runner = Runner(fresh)
        self.commands = Commands(fresh, self.runner)
        self.waiting.clear()
        while self.items and self.items[0].tick < tick:
            self.items.popleft()
        if fresh.state.levels is unit.state.levels:
            fresh.state.levels = dict(unit.state.levels)
        self._set_brake(tick)
        fresh.note_outputs(tick, fresh.ready_tick)

    # --- the end ---

    def _check_end(self) -> None:
        unit, end = self.unit, self.session.end
        if unit.done.growing:
            return
        if self._has_answer:
            answer = unit.done.answers[unit.answered]
            raise Mismatch(answer.begin, f"an answer to nothing: {answer.text}")
        if self.waiting and not self.runner.now:
            ends = unit.motion.ends(end - 2 * MS)
            if all(each is not None for each in ends):
                raise Mismatch(end, f"no answer to {self.waiting[0].text}")
        for axis, train in enumerate(unit.done.motors.trains):
            seen = max(course.cursors[axis].seen for course in unit.motion.courses)
            extra = train.ticks[seen : train.count_until(end - 2 * MS)]
            if extra:
                raise Mismatch(extra[0], f"axis {axis}: {len(extra)} pulses too many")
        for name, wanted in unit.changes.items():
            check_changes(name, unit.done.signals.get(name, []), wanted, end)


def check_changes(
    what: str, done: list[tuple[int, int]], wanted: list[tuple[int, int, int]], end: int
) -> None:
    """Compare changes of levels with the windows in which they have to be."""
    done = [change for change in done if change[0] < end - LED_LATE]
    wanted = [change for change in wanted if change[1] < end - LED_LATE]
    at = shown = 0
    for i, (low, high, level) in enumerate(wanted):
        if level == shown:
            continue
        tick, got = done[at] if at < len(done) else (FAR, -1)
        if (got != level or tick > high) and i + 1 < len(wanted) and wanted[i + 1][0] <= high:
            continue
        at, shown = at + 1, level
        if tick == FAR:
            raise Mismatch(high, f"{what} does not become {level:02X}")
        if got != level or not low - 1 <= tick <= high:
            raise Mismatch(
                tick,
                f"{what} becomes {got:02X}, "
                f"not {level:02X} from {low / MS:.3f} to {high / MS:.3f} ms",
            )
    if at < len(done):
        tick, got = done[at]
        raise Mismatch(tick, f"{what} becomes {got:02X}")


def compare(session: Session, done: Done, memory: bytes | None = None) -> float:
    """Compare what a unit did in a session; return by how much the worst pulse is off, in ticks.

    It has this memory, or one as delivered.
    """
    if done.complaints:
        raise Mismatch(session.end, "; ".join(done.complaints))
    chooser = Chooser()
    worst: Mismatch | None = None
    for _ in range(TRIES_MAX):
        model = Model(session, done, chooser, memory)
        try:
            model.go()
        except Mismatch as mismatch:
            if worst is None or mismatch.tick > worst.tick:
                worst = mismatch
        else:
            return max(course.worst for course in model.unit.motion.courses)
        if not chooser.again():
            break
    assert worst is not None
    raise worst


def imagine(session: Session) -> Done:
    """Return what a unit might do in a session: the model's own choices."""
    done = Done(Record(session.end, growing=True), growing=True)
    model = Model(session, done, Chooser())
    model.go()
    for name, wanted in model.unit.changes.items():
        done.signals[name] = [((low + high) // 2, level) for low, high, level in wanted]
    record = replace(done.motors, growing=False)
    return replace(done, motors=record, growing=False)
