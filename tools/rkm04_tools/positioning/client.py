"""The commands that talk to a unit; their arguments are in `client_options`."""

from __future__ import annotations

import os
import sys
import time
from argparse import Namespace
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from rkm04_tools.bar import Bar
from rkm04_tools.client_base import port_of, tell
from rkm04_tools.doubt import Doubt, in_doubt, interrupted_by_any_end
from rkm04_tools.failure import INTERRUPTED, NO_CONNECTION, Failure
from rkm04_tools.frame import NODES
from rkm04_tools.line_errors import LineError, PortError
from rkm04_tools.positioning import settings
from rkm04_tools.positioning.line_errors import NotHeld, Restarted, WrongUnit
from rkm04_tools.positioning.state import AxisState, UnitState, feed_text, mm_text
from rkm04_tools.positioning.table import AXES
from rkm04_tools.positioning.unit import Axis, Tell, Unit, open_unit, require_motion
from rkm04_tools.stopper import ENDED_BEFORE, TWICE_SECONDS, Stopper, shout
from rkm04_tools.table import table
from rkm04_tools.watch import Shown, require_looks, watch

PORT_VARIABLE, NODE_VARIABLE = "POSITIONING_PORT", "POSITIONING_NODE"
LATE_SECONDS = 2.0
"""What has not begun to move an axis by then is given up: nobody expects it any more."""
HEAD = ("axis", "state", "position mm", "to go mm", "mm/min")


def unit_of(options: Namespace, node: int | None = None) -> Unit:
    """Open the line that is named by option or environment. Nothing is sent yet."""
    wanted = node_of(options) if node is None else node
    return open_unit(port_of(options, PORT_VARIABLE), wanted, options.baud, options.form)


def node_of(options: Namespace) -> int:
    """The address that is named by option or environment."""
    name, text = "--node", options.node
    if text is None:
        name, text = NODE_VARIABLE, os.environ.get(NODE_VARIABLE) or "1"
    if not (text.isascii() and text.isdigit() and int(text) in NODES):
        raise Failure(f"{name} {text}: write an address, 1 to 16")
    return int(text)


def late_from_now() -> Callable[[], bool]:
    """Whether what is begun now is late, at any time."""
    end = time.monotonic() + LATE_SECONDS
    return lambda: time.monotonic() > end


def all_axes(unit: Unit) -> list[AxisState]:
    """What all axes tell."""
    return [unit.axis(number).read() for number in range(1, AXES + 1)]


def axis_text(state: AxisState) -> str:
    """An axis in one line."""
    speed = f", {feed_text(state.speed)} mm/min" if state.moves else ""
    return f"axis {state.axis}: {mm_text(state.position_um)} mm{speed}, {state.words}"


# ---- reading ------------------------------------------------------------------------------------


def run_scan(options: Namespace) -> int:
    """Ask all addresses."""
    found = []
    with Bar("asking") as bar:
        for done, node in enumerate(NODES):
            bar.show(done, len(NODES))
            with unit_of(options, node) as unit:
                unit.wire.tries = 1
                try:
                    found.append({"node": node, "version": unit.read().version})
                except PortError:
                    raise
                except WrongUnit:
                    found.append({"node": node, "version": None})
                except LineError:
                    continue
    lines = [f"unit {u['node']}: version {u['version'] or 'NONE: another device'}" for u in found]
    tell(options, {"units": found}, "\n".join(lines) or "no unit answers")
    return 0 if found else NO_CONNECTION


def run_status(options: Namespace) -> int:
    """Print what the unit tells of itself."""
    with unit_of(options) as unit:
        state, axes = unit.read(), all_axes(unit)
    answer = {**state.as_json(), "axes": [axis.as_json() for axis in axes]}
    return tell(options, answer, f"{_unit_text(state)}\n\n{_table(axes)}")


def _unit_text(state: UnitState) -> str:
    values = state.values
    high = ", ".join(f"BI{i}" for i, level in enumerate(state.inputs, 1) if level) or "none"
    trouble = ("BROKEN", "CRC", "LENGTH", "PAUSES", "EXCEPTIONS", "UNSENT", "SILENCES")
    counts = [f"{name} {values[name]}" for name in trouble if values[name]]
    lines = [
        f"unit {state.node}, version {state.version}",
        f"started {values['UPTIME'] / 1000:.1f} s ago: {state.start_cause}",
        f"inputs at 1: {high}",
        f"line: {values['FRAMES']} good frames{''.join(f', {each}' for each in counts)}",
        *state.conditions,
    ]
    if values["LATE_STEPS"]:
        lines.append(f"{values['LATE_STEPS']} PULSES CAME TOO LATE")
    return "\n".join(lines)


def _table(axes: list[AxisState]) -> str:
    rows = [
        (
            str(axis.axis), axis.words, mm_text(axis.position_um), mm_text(axis.way_left_um),
            feed_text(axis.speed),
        )
        for axis in axes
    ]  # fmt: skip
    return table([HEAD, *rows], "rlrrr")


def run_watch(options: Namespace) -> int:
    """Look until Ctrl-C or as often as asked for; a unit that is away is waited for."""
    require_looks(options)
    with unit_of(options) as unit:
        return watch(options, lambda: _look(unit), "positioning")


def _look(unit: Unit) -> Shown:
    state, axes = unit.read(), all_axes(unit)
    answer = {"inputs": state.inputs, "axes": [axis.as_json() for axis in axes]}
    return Shown(answer, _table(axes), "  ".join(map(axis_text, axes)))


# ---- instructions -------------------------------------------------------------------------------


Act = Callable[[Axis, Namespace], AxisState]


def _one(what: str, act: Act) -> Callable[[Namespace], int]:
    """A command that gives one instruction, and tells what the axis does then."""

    def run(options: Namespace) -> int:
        with (
            in_doubt(Doubt()) as doubt, unit_of(options) as unit, unit.wire.until(late_from_now()),
        ):  # fmt: skip
            axis = unit.axis(options.axis)
            axis.read()
            doubt.about(f"whether {what} was done", "positioning status tells what the axis does")
            state = act(axis, options)
        return tell(options, state.as_json(), axis_text(state))

    return run


def _stop(act: Act) -> Callable[[Namespace], int]:
    """The same of what stops an axis: what is not confirmed is shouted."""

    def run(options: Namespace) -> int:
        try:
            with interrupted_by_any_end(), unit_of(options) as unit:
                state = act(unit.axis(options.axis), options)
        except KeyboardInterrupt:
            shout(ENDED_BEFORE)
            return INTERRUPTED
        except Restarted:
            raise
        except LineError as error:
            raise _unconfirmed(error) from None
        return tell(options, state.as_json(), axis_text(state))

    return run


def _feed(options: Namespace) -> int:
    """Another feed; 0 is a stop."""
    give: Act = lambda axis, _: axis.control(feed=options.feed)  # noqa: E731
    return (_one("feed", give) if options.feed else _stop(give))(options)


def _unconfirmed(failure: Failure) -> Failure:
    """Shout; what to raise then."""
    shout(str(failure))
    return Failure(
        "the stop is NOT CONFIRMED, use the emergency stop; what stands or moves is not known",
        NO_CONNECTION,
    )


def _mode(axis: Axis, options: Namespace) -> AxisState:
    give = axis.mode_abs if options.abs else axis.mode
    return give(options.mm, options.accel)


def _hold(axis: Axis, _: Namespace) -> AxisState:
    return hold_loudly(axis)


def hold_loudly(axis: Axis) -> AxisState:
    """Hold; what is not confirmed is shouted, and raised."""
    try:
        return axis.hold(_tell_meanwhile)
    except NotHeld as failure:
        shout(str(failure))
        raise Failure("the axis is NOT HELD, use the emergency stop", failure.status) from None
    except Failure as failure:
        raise _unconfirmed(failure) from None


def _tell_meanwhile() -> None:
    print(
        "positioning: STOP NOT CONFIRMED YET: no answer, it is sent again; where the axis does "
        "not brake, use the emergency stop", file=sys.stderr, flush=True,
    )  # fmt: skip


# ---- motion -------------------------------------------------------------------------------------


def run_move(options: Namespace) -> int:
    """Move by so much, or to a position."""

    def move(axis: Axis, told: Tell) -> AxisState:
        act = axis.move_to if options.abs else axis.move
        return act(options.mm, options.feed, options.accel, told)

    return _moved(options, options.mm, move)


def run_home(options: Namespace) -> int:
    """Find the reference."""

    def home(axis: Axis, told: Tell) -> AxisState:
        return axis.home(options.method, options.position, options.feed, options.accel, told)

    return _moved(options, options.position, home)


def _shown(bar: Bar) -> Tell:
    """Shows how far it is on a terminal; of homing no way is known."""
    most_um = 0

    def show(state: AxisState) -> None:
        nonlocal most_um
        left_um = abs(state.way_left_um)
        most_um = max(most_um, left_um)
        if left_um:
            words = "" if state.moves else f", {state.words}"
            bar.show(most_um - left_um, most_um, f", at {mm_text(state.position_um)} mm{words}")
        else:
            bar.say(axis_text(state))

    return show


def _moved(options: Namespace, mm: float, work: Callable[[Axis, Tell], AxisState]) -> int:
    """Take the axis if need be, and do what moves it; Ctrl-C holds."""
    require_motion(mm, options.feed, options.accel)
    begun = False
    try:
        with (
            unit_of(options) as unit, unit.wire.until(late_from_now()),
            Stopper(unit.wire) as stopper,
        ):  # fmt: skip
            axis = unit.axis(options.axis)
            is_taken = axis.read().is_taken
            try:
                if not is_taken:
                    axis.init()
                with Bar("um made") as bar:
                    state = work(axis, _shown(bar))
            except KeyboardInterrupt:
                if not (is_taken or axis.instructed):
                    raise
                return _hold_at_signal(axis, stopper)
            except Restarted:
                raise
            except LineError as error:
                shout(str(error))
                with suppress(Failure):  # it may hear what it does not answer
                    axis.control(permitted=False)
                raise
            finally:
                begun = is_taken or axis.instructed
    except KeyboardInterrupt:
        if begun:
            raise
        why = "interrupted; nothing was sent that takes or moves the axis"
        raise Failure(why, INTERRUPTED) from None
    return tell(options, state.as_json(), axis_text(state))


def _hold_at_signal(axis: Axis, stopper: Stopper) -> int:
    print("\npositioning: holding ...", file=sys.stderr, flush=True)
    try:
        with stopper.at_once(TWICE_SECONDS):
            state = hold_loudly(axis)
    except KeyboardInterrupt:
        shout(ENDED_BEFORE)
        return INTERRUPTED
    except Failure as failure:
        print(f"positioning: {failure}", file=sys.stderr)
        return failure.status
    kept = "; go goes on, reset gives the axis back" if state.state == "READY" else ""
    if not state.is_taken:
        kept = "; it was given back: THE UNIT HAS RESTARTED, or another master has done it"
    print(f"positioning: it stands: {axis_text(state)}{kept}", file=sys.stderr)
    return INTERRUPTED


RUNS: dict[str, Callable[[Namespace], int]] = {
    "scan": run_scan,
    "status": run_status,
    "watch": run_watch,
    "init": _one("init", lambda axis, options: axis.init(options.space)),
    "mode": _one("mode", _mode),
    "feed": _feed,
    "hold": _stop(_hold),
    "go": _one("go", lambda axis, _: axis.go()),
    "reset": _stop(lambda axis, _: axis.reset()),
    "move": run_move,
    "home": run_home,
    "settings get": partial(settings.run_get, opened=unit_of),
    "settings set": partial(settings.run_set, opened=unit_of),
    "settings backup": partial(settings.run_backup, opened=unit_of),
    "settings restore": partial(settings.run_restore, opened=unit_of),
    "settings diff": partial(settings.run_diff, opened=unit_of),
}
