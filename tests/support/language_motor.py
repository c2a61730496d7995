"""One motor in the model of the language: its program, from message to message.

Written from the language's description, independently of the firmware. The motor is led along
what the firmware did: it says what must happen, and between which ticks, and takes the exact tick
from the record where the contract leaves room. What the record cannot be is a `Difference`.
"""

from __future__ import annotations

from dataclasses import replace

from language_flow import Flow
from language_marks import Marks
from language_memory import Memory
from language_pins import Pins
from language_pulses import Follower
from language_setup import ERRORS, Failed, Order, Setup
from language_signals import COMMAND_TICKS, MS, SEEN_TICKS, US, Levels, Moment, Unsure
from language_text import Command
from language_world import BEHIND_TICKS, BURST_MAX, LOCK, SIMULATION, STOPS, Phase, World


class Motor:
    """One motor from power-on; `advance` and the messages come in the order of their ticks."""

    def __init__(self, number: int, world: World) -> None:
        self.number = number
        self.phase = Phase.IDLE
        self._world = world
        self._watch = world.watch
        self._pins = Pins(world)
        self._moving: Order | None = None
        self.starts: list[tuple[Moment, bool]] = []
        """When its moves began, and whether they reached the pins."""
        self._levels = Levels(world.inputs, world.variables, number)
        self._clock = 0
        self._now = Moment(0, 0)
        self._start_over()

    def _start_over(self) -> None:
        self._setup = Setup()
        self.memory = Memory()
        self._flow = Flow(self.memory)
        self._guards = {"M": 0, "N": 0}
        self._totals: set[int] = set()
        self._cause = ""
        self._resume_wanted = False
        self._order: Order | None = None
        self._due = 0
        self._paused = Phase.IDLE

    # What comes by messages

    def reset(self, tick: int) -> None:
        r"""Take a `\`; the motor has been advanced to the tick."""
        moving = self.phase is Phase.MOVING
        if moving:
            self._marks.forget(tick, self.made_at(tick))
            self._stop("\\", tick)
        self._start_over()
        if moving:
            self._cause = "\\"
        else:
            self._watch.allow("stop", STOPS["\\"], tick, tick)
            self.phase, self._clock, self._now = Phase.IDLE, tick, Moment(tick, tick + SEEN_TICKS)

    def wake(self, tick: int) -> None:
        """Look at what a message has stored."""
        idle = self.phase is Phase.IDLE and not self._has_run_all
        if idle or (self.phase is Phase.HELD and self.memory.is_released(self._flow.next)):
            self._run_from(tick, tick)

    def halt(self, tick: int) -> None:
        """Take a `K` that stands alone; a motor at rest has nothing to stop."""
        if self.phase is Phase.ENDED or self._cause == "X" or self._is_at_rest:
            return
        if self._cause == "\\" and self._has_run_all:
            return
        if self.phase is Phase.MOVING:
            self._resume_wanted = False
            if self._cause in ("M", "N", "\\"):
                self._order = None
            if self._cause != "K":
                self._stop("K", tick)
        elif self.phase is not Phase.STOPPED:
            self._watch.expect("stop", STOPS["K"], tick, tick + MS)
            self._paused, self._due = self.phase, self._due - tick
            self.phase = Phase.STOPPED

    @property
    def _has_run_all(self) -> bool:
        return self._flow.next >= self.memory.end

    @property
    def _is_at_rest(self) -> bool:
        return self.phase is Phase.IDLE and self._has_run_all

    @property
    def is_jog_stopped(self) -> bool:
        """Whether `K` has ended, or is ending, a run without end after which nothing is stored."""
        jog = self._moving is not None and self._moving.is_endless and not self._moving.limit
        paused = self.phase is Phase.STOPPED and self._paused in (Phase.MOVING, Phase.RUNNING)
        braking = self.phase is Phase.MOVING and self._cause == "K"
        return jog and (paused or braking) and self._has_run_all

    def leave_jog(self, tick: int) -> None:
        """Something was stored after a jog that has been stopped: it follows the stand."""
        self._order = None
        self._resume_wanted = False
        if self.phase is Phase.MOVING:
            self._cause = "jog"
        else:
            self._run_from(tick, tick)

    def resume(self, tick: int) -> None:
        """Take a `C75` that stands alone."""
        if self.phase is Phase.MOVING and self._cause == "K":
            self._resume_wanted = True
        elif self.phase is Phase.STOPPED:
            self._resume(tick, Moment(tick, tick + SEEN_TICKS))

    def change_speed(self, tick: int, speed: int) -> bool:
        """Take a `V` that stands alone; whether it was one for the move in progress."""
        if self.phase is not Phase.MOVING or self._cause in ("X", "\\"):
            return False
        if self._order and not self._order.limit and not self._cause:
            self._follower.follow(tick)
            last = self._follower.curve.last
            event = self._watch.next("speed")
            if last == self._follower.made + 1 and (event is None or event.tick > tick + MS):
                return True
            self._watch.expect("speed", speed, tick, tick + MS)
            self._follower.change(tick, lambda curve, k: curve.speed_changed_at(k, speed))
        return True

    @property
    def is_locked(self) -> bool:
        """Whether function 40 keeps what is stored from being overwritten."""
        return LOCK in self._world.functions

    def made_at(self, tick: int) -> int:
        """Steps made so far in the move in progress."""
        if self.phase is not Phase.MOVING:
            return 0
        self._follower.follow(tick)
        return self._follower.made

    def position_at(self, tick: int) -> int:
        """The position counter."""
        made = self.made_at(tick)
        if self.phase is not Phase.MOVING:
            self._pins.follow(tick)
        return self._pins.position + (self._moving.heading * made if self._moving else 0)

    @property
    def place(self) -> int:
        """The ordinal of the command that runs or has run last."""
        return self._flow.place

    def expect_no_more(self, end: int) -> None:
        """Compare the pulses of a move that has not ended, and that nothing else has happened."""
        last = self.made_at(end)
        if self.phase is Phase.MOVING:
            self._marks.pass_by(last)
            self._pins.take(last)
        self._pins.expect_no_more(self.number)
        self._watch.expect_no_more()

    # Time

    def advance(self, until: int, for_this: bool = True) -> None:
        """Live up to a tick at which something comes, which is not part of it.

        If it comes for others, it does not matter what this motor does at that tick.
        """
        self._for_this = for_this
        steps = {
            Phase.RUNNING: self._run,
            Phase.MOVING: self._move,
            Phase.WAITING: self._wait,
            Phase.LOOKING: self._look,
        }
        while steps.get(self.phase, self._rest)(until):
            pass

    def _collide(self, what: str) -> bool:
        if self._for_this:
            raise Unsure(what)
        return False

    def _rest(self, until: int) -> bool:
        """Idle, held, stopped or ended: only a total stop comes by itself, and not at rest."""
        if self.phase is Phase.ENDED or self._is_at_rest:
            return False
        found = self._total_stop(self._now.low, until)
        if found is not None:
            self._end_by_x(found)
        return found is not None

    def _run_from(self, clock: int, seen: int) -> None:
        self._clock = clock
        self._now = Moment(seen, seen + SEEN_TICKS)
        self._clock_is_loose = False
        self._burst = 0
        self.phase = Phase.RUNNING

    def _run(self, until: int) -> bool:
        """Run one command."""
        if self._now.high >= until:
            return self._collide("something comes while commands run")
        if any(self._world.inputs[n].during(self._now) for n in self._totals):
            self._end_by_x(self._now.low)
            return True
        if self._has_run_all:
            if self._flow.place:
                self._watch.expect("end", 0, self._clock, self._now.high)
            self.phase = Phase.IDLE
            return True
        self._pins.settle(self._now)
        command = self._flow.fetch()
        self._burst += 1
        if self._burst > BURST_MAX:
            raise Unsure("the program runs on and on without a wait")
        self._now.high += COMMAND_TICKS
        try:
            self._obey(command)
        except Failed as error:
            self._fail(str(error))
        return True

    def _fail(self, error: str) -> None:
        self._watch.expect("error", ERRORS.index(error), self._now.low, self._now.high)
        self.phase = Phase.ENDED

    def _wait(self, until: int) -> bool:
        limit = min(self._due, until)
        found = self._total_stop(self._now.low, limit)
        if found is not None:
            if self._due - found < SEEN_TICKS:
                raise Unsure("a total stop at the end of a wait")
            self._end_by_x(found)
            return True
        if self._due > until:
            return False
        if self._due == until:
            return self._collide("something comes when a wait ends")
        self._run_from(self._due, self._due)
        return True

    def _look(self, until: int) -> bool:
        """Wait for a level."""
        signal, level = self._sought
        seen = signal.first_lasting(level, self._now.low)
        limit = until if seen is None else min(seen, until)
        found = self._total_stop(self._now.low, limit)
        if found is not None:
            if seen is not None and seen - found < SEEN_TICKS:
                raise Unsure("a total stop at the end of a wait")
            self._end_by_x(found)
            return True
        if seen is None or seen >= until:
            return seen == until and self._collide("something comes when a wait ends")
        seen = max(seen, self._now.low)
        self._run_from(seen, seen)
        self._clock_is_loose = True
        return True

    # Commands

    def _obey(self, command: Command) -> None:
        if self._setup.obey(command):
            return
        n = command.number
        match command.letter:
            case "T" | "C":
                self._switch(command.letter, n)
            case "=":
                self._pins.position = n
            case "R":
                self._begin(self._setup.order())
            case "G":
                self._begin(self._setup.way(n - self._pins.position))
            case "H":
                self._begin(self._setup.way(-self._pins.position))
            case "G+" | ")":
                self._begin(self._setup.run(1, n))
            case "G-" | "(":
                self._begin(self._setup.run(-1, n))
            case "M" | "N":
                self._guards[command.letter] = n
            case "U":
                self._guards = {"M": 0, "N": 0}
            case "X":
                self._totals.add(n)
            case "W":
                self._begin_wait(n)
            case "O" | "Z":
                self._begin_look(n, int(command.letter == "O"))
            case "[":
                self._hold()
            case _:
                self._flow.obey(command, lambda number: self._levels.at(number, self._now))

    def _switch(self, letter: str, n: int) -> None:
        value = n if letter == "T" else -n
        if n <= 8:
            self._now.pin(self._watch.expect("out", value, self._now.low, self._now.high))
        elif n >= 80 and n != 100:
            self._now.pin(self._watch.expect("var", value, self._now.low, self._now.high))
            self._levels.writes_made += 1
        elif n == 100:
            self._pins.position = 0
        else:
            turn = self._world.functions.add if letter == "T" else self._world.functions.discard
            turn(n)
            if n == SIMULATION:
                self._pins.simulate(letter == "T", self._now)

    def _begin_look(self, n: int, level: int) -> None:
        if self._levels.at(n, self._now) == level:
            return
        self._watch.expect("wait", 0, self._now.low, self._now.high)
        self._sought = (self._levels.signal(n), level)
        self.phase = Phase.LOOKING

    def _hold(self) -> None:
        if self.memory.is_released(self._flow.place):
            return
        self._watch.expect("wait", 0, self._now.low, self._now.high)
        self._flow.next = self._flow.place
        self.phase = Phase.HELD

    def _begin_wait(self, ms: int) -> None:
        start = self._start("wait", ms)
        self._due = start + ms * MS
        self.phase = Phase.WAITING

    def _start(self, name: str, value: int) -> int:
        """When a move or a wait starts: at the clock, or now if that is too far behind."""
        event = self._watch.next(name)
        on_time = self._now.low - self._clock <= BEHIND_TICKS
        late = self._now.high - self._clock > BEHIND_TICKS
        if self._clock_is_loose:
            self._clock = self._watch.expect(name, value, self._clock, self._now.high)
            self._clock_is_loose = False
            return self._clock
        if event is not None and event.tick == self._clock and on_time:
            self._watch.expect(name, value, self._clock, self._clock)
            return self._clock
        if not late:
            self._watch.expect(name, value, self._clock, self._clock)
        self._clock = self._watch.expect(name, value, self._now.low, self._now.high)
        self._now.pin(self._clock)
        return self._clock

    # Moves

    def _begin(self, order: Order | None) -> None:
        if order is None:
            return
        self._pins.settle(self._now)
        start = self._start("move", order.value)
        self.starts.append((replace(self._now), self._pins.connected))
        self._order = self._moving = order
        self._cause = ""
        self.phase = Phase.MOVING
        looked = Moment(min(start, self._now.low), self._now.high)
        for guard, level in (("M", 1), ("N", 0)):
            n = self._guards[guard]
            if n and self._world.inputs[n].during(looked) == level:
                self._begin_nothing(guard, start, looked)
                return
        if order.limit and self._world.inputs[order.limit].during(looked):
            self._begin_nothing("limit", start, looked)
            return
        self._follower = Follower(start, order.curve, self._pins.ticks, self._pins.taken)
        self._cared = start
        self._marks = Marks(order, self._watch, self._follower)
        self._marks.start(self._now.high)

    def _begin_nothing(self, cause: str, start: int, looked: Moment) -> None:
        """A guard has its level already: the move makes no step."""
        self._watch.expect("stop", STOPS[cause], looked.low, looked.high)
        self._watch.expect("done", 0, start, start)
        if cause != "limit":
            self._guards[cause] = 0
        self.phase = Phase.RUNNING

    def _move(self, until: int) -> bool:
        if self._cause and (done := self._watch.next("done")):
            self._follower.settle(abs(done.value))
        end = self._follower.end
        limit = until if end is None else min(until, end + SEEN_TICKS)
        found = self._next_cause(self._cared, limit)
        if found is not None:
            tick, cause = found
            self._cared = tick
            if end is not None and end - tick < US:
                raise Unsure("a guard acts when a move ends")
            self._stop(cause, tick)
            return True
        if end is None or end > until + 2:
            return False
        if end + SEEN_TICKS >= until:
            return self._collide("something comes when a move ends")
        self._follower.follow(end + 2)
        last = self._follower.tick_of(self._follower.made)
        self._end_move(last, last)
        return True

    def _next_cause(self, after: int, until: int) -> tuple[int, str] | None:
        """The first guard that acts from a tick on: its tick and what it is."""
        if self._cause in ("X", "\\"):
            return None
        wanted = [("X", n, 1) for n in sorted(self._totals)]
        if not self._cause and self._order:
            wanted += [("M", self._guards["M"], 1), ("N", self._guards["N"], 0)]
            wanted += [("limit", self._order.limit, 1)]
        firsts = [(self._world.inputs[n].first(level, after), c) for c, n, level in wanted if n]
        due = [(tick, cause) for tick, cause in firsts if tick is not None and tick < until]
        return min(due, key=lambda first: first[0], default=None)

    def _stop(self, cause: str, tick: int) -> None:
        if cause == "limit":
            self._end_limit_run(tick)
            return
        if self._cause:
            self._watch.allow("stop", STOPS[cause], tick, tick + MS)
        else:
            self._watch.expect("stop", STOPS[cause], tick, tick + MS)
            self._follower.change(tick, lambda curve, k: curve.stopped_at(k))
        self._cause = cause

    def _end_limit_run(self, tick: int) -> None:
        self._watch.expect("stop", STOPS["limit"], tick, tick + MS)
        self._follower.follow(tick + 1)
        last = self._follower.made
        self._cause = "limit"
        self._end_move(self._follower.tick_of(last), tick)

    def _end_move(self, done: int, seen: int) -> None:
        """The move has made its last pulse; main has something to do at `seen`."""
        assert self._moving
        made = self._follower.made
        self._watch.expect("done", self._moving.heading * made, done, done)
        self._pins.end_move(self._moving.heading, made, done, seen)
        if self._marks.pass_by(made) and self._order:
            self._order = replace(self._order, marks=())
        self._run_from(done, seen)
        self._finish(made, seen)

    def _finish(self, made: int, seen: int) -> None:
        """Go on after a move as what has stopped it wants."""
        cause, self._cause = self._cause, ""
        if cause in self._guards and self._order and self._order.rest(made):
            self._guards[cause] = 0
        if cause == "X":
            self._watch.allow("end", 0, self._clock, self._now.high)
            self.phase = Phase.ENDED
        elif cause == "K":
            self._order = self._order.rest(made) if self._order else None
            self._paused = Phase.MOVING if self._order else Phase.RUNNING
            self.phase = Phase.STOPPED
            if self._resume_wanted:
                self._resume(seen, self._now)

    def _resume(self, tick: int, now: Moment) -> None:
        self._run_from(tick, tick)
        self._now = replace(now)
        self._clock_is_loose = self._resume_wanted
        self._resume_wanted = False
        if self._paused is Phase.MOVING:
            self._begin(self._order)
        elif self._paused is Phase.WAITING:
            self._due += tick
            self._watch.allow("wait", -1, tick, tick)
            self.phase = Phase.WAITING
        elif self._paused is Phase.LOOKING:
            self.phase = Phase.LOOKING
        elif self._paused is Phase.HELD and not self.memory.is_released(self._flow.next):
            self.phase = Phase.HELD

    def _total_stop(self, low: int, until: int) -> int | None:
        """The first tick at which an input of X is 1, before another tick."""
        firsts = [self._world.inputs[n].first(1, low) for n in self._totals]
        return min((tick for tick in firsts if tick is not None and tick < until), default=None)

    def _end_by_x(self, tick: int) -> None:
        high = max(tick + MS, self._now.high)
        self._watch.expect("stop", STOPS["X"], tick, high)
        self._watch.allow("end", 0, tick, high)
        self.phase = Phase.ENDED
