"""The commands of the GVE134 unit, written from the contract alone."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import replace

from gve_course import MS
from gve_line import Packet, Request
from gve_run import Runner
from gve_state import FULL, INTA, INTCOM, RESTARTED
from gve_unit import Kept, Unit, Unsure
from gve_vector import FACTOR_MAX, PERCENT, Four, scaled, with_speed
from gve_words import BOUNDS, Command, single_text

VERSION = "IP134/200 v1 22.11.2026"
NO_ROOM, DAMAGED, NOTHING, BUSY = 1, 2, 6, 7
WRITE_MS = 2000
BY_RUN = ("L", "C", "W", "N", "H", "G", "D", "K", "R", "F", "EW", "EUW", "EFW", "SR", "SW")
"""What RUN decides about."""

READ_EARLY = 500
"""Ticks: a pulse is counted a little after its edge."""


class Refuse(Exception):
    """The code of an answer."""

    def __init__(self, code: int) -> None:
        """Keep the code."""
        super().__init__(code)
        self.code = code


class Commands:
    """Executes commands within a window of ticks."""

    def __init__(self, unit: Unit, runner: Runner) -> None:
        """Work on a unit."""
        self.unit = unit
        self.runner = runner
        self.low = self.high = 0
        self.index = 0

    def execute(self, item: Request, low: int) -> bool:
        """Execute a command; False: its answer comes when the axes stand."""
        unit, command = self.unit, item.command
        latest = low + MS
        if isinstance(command, int):
            unit.may_stand(low, unit.peek(latest, item.text).begin)
            unit.answer(item, [unit.code(command)], low, latest)
            return True
        if command.name[0] == "E" and command.name[-1] == "W":
            latest += WRITE_MS * MS
        waits = command.name in ("H", "W")
        self.low, self.index = low, item.index
        self.high = low + MS if waits else unit.peek(low + MS, item.text).begin
        if unit.done.growing and command.name[0] in "PN":
            unit.motion.verify(self.high)
        if unit.phase == "stop" or command.name in BY_RUN:
            unit.may_stand(low, self.high)
        if command.name in ("@", ">"):
            self._repair(item, command.name, low)
            return True
        try:
            texts = self._do(item, command)
        except Refuse as refused:
            texts = [unit.code(refused.code)]
        if texts is None:
            return False
        unit.answer(item, texts, low, latest)
        unit.note_outputs(low, unit.ready_tick)
        return True

    def _repair(self, item: Request, name: str, low: int) -> None:
        unit = self.unit
        if name == "@":
            unit.answer(item, [f"{unit.code(0)},{self.index}"], low, low + MS)
        elif unit.last_answer:
            unit.answer(replace(item, sums=False), [unit.last_answer], low, low + MS)
        else:
            unit.answer(item, {"0", unit.code(0)}, low, low + MS)

    def _do(self, item: Request, command: Command) -> list[str] | None:
        unit = self.unit
        if command.name == "V" and item.address != 0:
            return self._spindle(command.args[0])
        if command.name == "H":
            return self._halt()
        if command.name == "W":
            self._run(item, command.args)
            return None
        values = self._values(command)
        was = unit.state.inta if command.name in ("G", "L", "C") else None
        done = getattr(self, f"_do_{NAMES.get(command.name, command.name.lower())}", None)
        if done:
            done(*command.args)
        inta = unit.state.inta if was is None or not was or command.name == "G" else was
        digit = f"{int(inta) << 3:X}"
        return [digit + value for value in values]

    # --- what is read ---

    def _values(self, command: Command) -> list[str]:
        unit, state, args = self.unit, self.unit.state, command.args
        name = command.name
        if name in ("P", "PF", "P4"):
            count = {"P": 2, "PF": 3, "P4": 4}[name]
            moments = unit.moments(self.low - READ_EARLY, self.high + 1)
            places = {tuple(unit.position(axis, t) for axis in range(count)) for t in moments}
            return [",".join(["", *map(str, place)]) for place in places]
        if name == "PL":
            got = unit.peek(self.high, name).text.split(",")
            follows = 3 if state.follows is None else state.follows
            latched = (*state.latched[:3], state.latched[follows])
            if unit.done.growing or len(got) < 5:
                return ["," + ",".join(str(min(each)) for each in latched)]
            shown = [
                word if word in {str(n) for n in right} else str(min(right))
                for word, right in zip(got[1:5], latched, strict=True)
            ]
            return ["," + ",".join(shown)]
        reads: dict[str, Callable[[], str]] = {
            "?": lambda: VERSION,
            "Q": state.made,
            "ER": lambda: f"{state.memory[args[0]]:02X}",
            "EUR": lambda: f"{self._four(args[0]):08X}",
            "EFR": lambda: single_text(self._four(args[0])),
        }
        if name in reads:
            return [f",{reads[name]()}"]
        if name in ("I1", "I2"):
            return [f",{state.port_levels(int(name[1])):02X}"]
        if name == "F":
            full = unit.no_vector_fits(self.low, self.high)
            return [f",{unit.st6 | each << FULL:02X}" for each in full]
        if name == "SR":
            return [f",{each:02X}" for each in self._status(args[0])]
        return [""]

    def _four(self, address: int) -> int:
        return int(struct.unpack_from("<I", self.unit.state.memory, address)[0])

    def _status(self, number: int) -> set[int]:
        """What a status may be: causes may be told before the axes stand."""
        unit = self.unit
        if number in (4, 5):
            told = unit.state.status[number]
            return {told, told | unit.caught[number - 4]}
        return {0 if number == 7 else [*unit.state.status, unit.st6][number]}

    # --- what is in force ---

    def _do_t(self, n: int) -> None:
        self.unit.state.modal.pause_ms = n

    def _do_short(self, n: int) -> None:
        self.unit.state.modal.short_below = n

    def _do_a(self, n: int) -> None:
        self.unit.state.modal.accel = n

    def _do_v(self, n: int) -> None:
        self.unit.state.modal.speed = n

    def _do_b(self, n: int) -> None:
        self.unit.state.modal.border = n

    def _do_vk(self) -> None:
        self.unit.state.modal.corrected = True

    def _do_vn(self) -> None:
        self.unit.state.modal.corrected = False

    def _do_vl(self, *limits: int) -> None:
        self.unit.state.modal.limits = four(limits)

    def _do_vj(self, *jumps: int) -> None:
        self.unit.state.modal.jumps = four(jumps)

    def _do_xa(self) -> None:
        self._do_xm(100)

    def _do_xm(self, percent: int) -> None:
        self.unit.state.modal.factor = min(FACTOR_MAX, percent * PERCENT)
        self._override(self.unit.state.modal.speed)

    def _do_xu(self) -> None:
        self._step_factor(17)

    def _do_xd(self) -> None:
        self._step_factor(15)

    def _step_factor(self, sixteenths: int) -> None:
        modal = self.unit.state.modal
        modal.factor = scaled(modal.factor, sixteenths)
        self._override(None)

    def _override(self, speed: int | None) -> None:
        unit = self.unit
        modal = unit.state.modal
        unit.entries = [
            with_speed(entry, speed, modal.factor, modal.limits) for entry in unit.entries
        ]
        unit.limit_anew(self.low, self.high)

    # --- vectors ---

    def _check_coupled(self, *ways: int) -> None:
        if self.unit.state.follows is not None and any(ways):
            raise Refuse(BOUNDS)

    def _begin(self, steps: tuple[int, ...]) -> None:
        """Take an L, or a C that begins a chain."""
        unit = self.unit
        unit.begin_chain([unit.state.modal.entry(four(steps))], self.low, self.high)

    def _do_l(self, *steps: int) -> None:
        unit = self.unit
        self._check_coupled(steps[3])
        if unit.state.fault:
            raise Refuse(BUSY)
        if unit.phase != "rest":
            raise Refuse(NO_ROOM)
        if not any(steps) and (any(unit.state.causes) or unit.state.inta):
            raise Unsure("a vector without motion that has to wait")
        self._begin(steps)

    def _do_c(self, *steps: int) -> None:
        unit = self.unit
        self._check_coupled(steps[3])
        if unit.state.fault:
            raise Refuse(BUSY)
        if unit.kept or not self._room(1):
            raise Refuse(NO_ROOM)
        if not any(steps):
            return
        if unit.phase == "rest":
            self._begin(steps)
        else:
            unit.add([unit.state.modal.entry(four(steps))], self.low)

    def _room(self, count: int) -> bool:
        """Whether so many vectors fit; where that changes meanwhile, as the unit says."""
        unit = self.unit
        least, most = unit.places_free(self.low, self.high)
        if least < count <= most:
            return not unit.peek(self.high, "C").text.startswith(("1", "9"))
        return least >= count

    def packet(self, item: Packet, low: int) -> None:
        """Execute a packet: all of it or nothing."""
        unit = self.unit
        self.low, self.high = low, unit.peek(low + MS, "a packet").begin
        unit.may_stand(low, self.high)
        border = unit.state.modal.border
        try:
            count = self._take_packet(item)
            text = f"{unit.code(0)},{count}"
        except Refuse as refused:
            unit.state.modal.border = border
            text = f"{unit.code(refused.code)},0"
        unit.answer(item, [text], low, low + MS)

    def _take_packet(self, item: Packet) -> int:
        unit, entries = self.unit, []
        for number, line in enumerate(item.lines, start=1):
            if isinstance(line, int):
                raise Refuse(line)
            if number > 128:
                raise Refuse(BOUNDS)
            if line.name == "B":
                unit.state.modal.border = line.args[0]
                continue
            self._check_coupled(line.args[3])
            if any(line.args):
                entries.append(unit.state.modal.entry(four(line.args)))
        if item.number != len(item.lines):
            raise Refuse(DAMAGED)
        if entries and unit.state.fault:
            raise Refuse(BUSY)
        if entries and (unit.kept or not self._room(len(entries))):
            raise Refuse(NO_ROOM)
        if entries and unit.phase == "rest":
            unit.begin_chain(entries, self.low, self.high)
        else:
            unit.add(entries, self.low)
        return item.number

    # --- motion ---

    def _do_n(self, *args: int) -> None:
        unit = self.unit
        if args and args[0] == 3:
            self._check_coupled(1)
        if unit.run:
            raise Refuse(BUSY)
        for axis in [args[0]] if args else range(4):
            made = unit.done.motors.trains[axis].place_at(self.high)
            unit.offsets[axis] = (args[1] if args else 0) - made

    def _run(self, item: Request, args: tuple[int, ...]) -> None:
        unit = self.unit
        if args[0] == 3:
            self._check_coupled(1)
        if unit.run or unit.state.inta or unit.state.fault:
            raise Refuse(BUSY)
        self.runner.start(item, args, self.low, self.high)

    def _halt(self) -> list[str] | None:
        unit = self.unit
        if unit.phase == "run":
            self.runner.halt(self.low, self.high)
            return None
        if unit.phase in ("work", "stop"):
            unit.came_from_h = True
            if unit.phase == "work":
                unit.stop(self.low, self.low)
            return None
        unit.state.inta = unit.state.intcom = True
        return [unit.code(0)]

    def _do_g(self) -> None:
        unit, state = self.unit, self.unit.state
        if state.fault or not state.inta or unit.phase in ("work", "stop"):
            raise Refuse(NOTHING)
        state.inta = state.intcom = False
        state.status[4] = state.status[5] = 0
        if unit.phase == "rest":
            raise Refuse(NOTHING)
        unit.begin(None, self.low, self.high)

    def _need_stand(self) -> None:
        if self.unit.phase in ("work", "stop"):
            raise Refuse(BUSY)

    def _do_d(self) -> None:
        self._need_stand()
        if self.unit.state.fault == RESTARTED:
            self.unit.state.fault = 0
        self._empty()

    def _empty(self) -> None:
        unit, state = self.unit, self.unit.state
        unit.entries, unit.vectors, unit.phase = [], (), "rest"
        unit.motion.forget(self.low)
        state.status[4] = state.status[5] = 0
        state.inta, state.intcom = bool(state.fault), False

    def _do_k(self) -> None:
        unit, state = self.unit, self.unit.state
        self._need_stand()
        if unit.kept:
            raise Refuse(NO_ROOM)
        if state.fault:
            raise Unsure("K while no motion is allowed")
        unit.kept = Kept(
            unit.entries, unit.vectors, unit.phase, state.status[4:], state.inta, state.intcom
        )
        for course in unit.motion.courses:
            course.kept = course.rest
        self._empty()

    def _do_r(self) -> None:
        unit, state, kept = self.unit, self.unit.state, self.unit.kept
        self._need_stand()
        if kept is None:
            raise Refuse(NOTHING)
        if state.fault:
            raise Unsure("R while no motion is allowed")
        unit.kept = None
        unit.entries, unit.vectors, unit.phase = list(kept.entries), kept.vectors, kept.phase
        state.status[4:], state.inta, state.intcom = kept.causes, kept.inta, kept.intcom
        for course in unit.motion.courses:
            course.rest, course.vectors = course.kept, kept.vectors

    # --- status, memory, outputs ---

    def _do_sw(self, number: int, value: int) -> None:
        unit, state = self.unit, self.unit.state
        if number < 6:
            state.status[number] = value
            unit.sense(self.low, self.high)
            return
        if unit.phase in ("work", "stop"):
            if any(course.pending for course in unit.motion.courses):
                raise Unsure("SW6 while the axes are about to start")
            if value & 1 and unit.phase == "work":
                unit.stop(self.low, self.low)
            return
        if state.fault:
            raise Unsure("SW6 while no motion is allowed")
        state.inta, state.intcom = bool(value >> INTA & 1), bool(value >> INTCOM & 1)
        if not state.inta and unit.phase == "wait":
            unit.begin(None, self.low, self.high)

    def _do_ew(self, address: int, value: int) -> None:
        self._write(bytes([value]), address)

    def _do_euw(self, address: int, value: int) -> None:
        self._write(struct.pack("<I", value), address)

    _do_efw = _do_euw

    def _write(self, data: bytes, address: int) -> None:
        if self.unit.run:
            raise Refuse(BUSY)
        memory = self.unit.state.memory
        memory[address : address + len(data)] = data

    def _do_o(self, _port: int, value: int) -> None:
        self.unit.state.port = value

    def _spindle(self, permille: int) -> list[str]:
        state = self.unit.state
        state.pwm = permille
        state.port = state.port | 1 if permille == 0 else state.port & ~1
        return [self.unit.code(0)]


NAMES = {"$": "short"}
"""Of commands whose names are none in Python."""


def four(numbers: tuple[int, ...]) -> Four:
    """Return four numbers as such."""
    x, y, z, a = numbers
    return x, y, z, a
