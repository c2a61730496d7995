"""The commands that talk to a unit; their arguments are in `client_options`, the work in `line`."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
from difflib import unified_diff
from typing import Any

from rkm04_tools import archive
from rkm04_tools.acting import BROADCAST_NOTE
from rkm04_tools.bar import Bar
from rkm04_tools.client_acts import run_reset, run_resume, run_send, run_speed, run_stop
from rkm04_tools.client_base import (
    checked_file,
    count_of,
    name_of,
    node_of,
    port_of,
    reading_node_of,
    tell,
    who,
)
from rkm04_tools.doubt import Doubt, in_doubt
from rkm04_tools.failure import DONE, NO_CONNECTION, NOT_SO, Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.line import Motor, Unit, open_line
from rkm04_tools.messages import ALL_MOTORS, MOTORS
from rkm04_tools.sending import Plan, held_commands, plan_program
from rkm04_tools.source import named
from rkm04_tools.status import status_text
from rkm04_tools.table import table, thousands
from rkm04_tools.watch import require_looks, run_watch


def run_version(options: Namespace) -> int:
    """Print version and date."""
    node = reading_node_of(options)
    with open_line(port_of(options)) as line:
        version = line.unit(node).version()
    date = version.date.isoformat()
    answer = {"node": node, "version": version.number, "date": date, "text": version.text}
    return tell(options, answer, f"unit {node}: version {version.number} of {date}")


def run_position(options: Namespace) -> int:
    """Print the positions of one motor or all."""
    node = reading_node_of(options)
    with open_line(port_of(options)) as line:
        unit = line.unit(node)
        if options.motor == ALL_MOTORS:
            positions = dict(zip(MOTORS, unit.positions(), strict=True))
        else:
            positions = {options.motor: unit.motor(options.motor).position()}
    answer = [{"motor": motor, "position": at} for motor, at in positions.items()]
    rows = [("motor", "position"), *((str(m), thousands(at)) for m, at in positions.items())]
    return tell(options, {"node": node, "motors": answer}, table(rows, "rr"))


def run_program(options: Namespace) -> int:
    """Print the programs, so that the output is a program file if it is of one motor."""
    node, programs = _of_motors(options, Motor.program)
    answer = [{"motor": motor, "program": text} for motor, text in programs.items()]
    if len(programs) == 1:
        (text,) = programs.values()
    else:
        text = "\n".join(f"{{ motor {motor} }}\n{text}" for motor, text in programs.items())
    return tell(options, {"node": node, "motors": answer}, text)


def run_table(options: Namespace) -> int:
    """Print the break points."""
    node, tables = _of_motors(options, Motor.table)
    answer = [
        {"motor": motor, "points": [{"step": p.step, "speed": p.speed} for p in points]}
        for motor, points in tables.items()
    ]
    rows = [("motor", "step", "steps/s")]
    for motor, points in tables.items():
        rows += [(str(motor), thousands(p.step), thousands(p.speed)) for p in points]
        rows += [] if points else [(str(motor), "-", "no move in progress")]
    return tell(options, {"node": node, "motors": answer}, table(rows, "rrr"))


def run_progress(options: Namespace) -> int:
    """Print the steps made and the command being run."""
    node, found = _of_motors(options, Motor.progress)
    answer = [{"motor": m, "steps": p.steps, "command": p.command} for m, p in found.items()]
    rows = [(str(m), thousands(p.steps), str(p.command)) for m, p in found.items()]
    text = table([("motor", "steps", "command"), *rows], "rrr")
    return tell(options, {"node": node, "motors": answer}, text)


def run_status(options: Namespace) -> int:
    """Print what a unit is like."""
    node = reading_node_of(options)
    with open_line(port_of(options)) as line:
        status = line.unit(node).status()
    return tell(options, {"node": node, **status.as_json()}, status_text(status))


def run_store(options: Namespace) -> int:
    """Store a program, if it is the one that is meant, and look whether it still is."""
    node = node_of(options)
    port = port_of(options)
    plan = None
    if options.file is not None:
        node = reading_node_of(options)
        checked = checked_file(options.file)
        if not checked.is_good:
            return NOT_SO
        plan = plan_program(checked)
    with in_doubt(Doubt()) as doubt, open_line(port) as line:
        motor = line.unit(node).motor(options.motor)
        before = _programs(motor)
        for each, commands in before.items():
            _require_same(plan, commands, each)
        doubt.about(f"whether {name_of(motor)} has stored", "store again")
        motor.store()
        for each, commands in _programs(motor).items():
            if commands != before[each]:
                raise Failure(
                    f"{name_of(each)}: the program has changed while it was stored; "
                    "store it again when nobody else sends programs",
                    NOT_SO,
                )
    counts = [{"motor": each.number, "commands": len(c)} for each, c in before.items()]
    rows = [f"{name_of(each)}: {count_of(len(c), 'command')} stored" for each, c in before.items()]
    text = "\n".join(rows) or f"{name_of(motor)}: told to store; {BROADCAST_NOTE}"
    answer = {"node": node, "confirmed": bool(rows), "motors": counts}
    return tell(options, answer, text)


def run_scan(options: Namespace) -> int:
    """Print who is there."""
    port = port_of(options)
    with open_line(port) as line, Bar("asking") as bar:
        found = line.scan(tell=bar.show)
    answer = [
        {
            "node": each.node,
            "version": each.version.number if each.version else None,
            "date": each.version.date.isoformat() if each.version else None,
            "remark": each.remark,
        }
        for each in found
    ]
    rows = [("node", "version", "date", "")]
    rows += [
        (
            str(each.node),
            each.version.number if each.version else "?",
            each.version.date.isoformat() if each.version else "?",
            each.remark,
        )
        for each in found
    ]
    if not found and not options.json:
        raise Failure(
            f"{port}: nobody answers on addresses 1 to 16; check power, wiring (A, B) and the port",
            NO_CONNECTION,
        )
    tell(options, {"units": answer}, table(rows, "rlll"))
    return DONE if found else NO_CONNECTION


def run_diff(options: Namespace) -> int:
    """Compare a file with a motor, command by command."""
    node, port = reading_node_of(options), port_of(options)
    if options.motor == ALL_MOTORS:
        raise Failure("diff compares one motor; name one with --motor, 1 to 4")
    checked = checked_file(options.file)
    if not checked.is_good:
        return NOT_SO
    plan = plan_program(checked)
    with open_line(port) as line:
        motor = line.unit(node).motor(options.motor)
        held = held_commands(motor)
    if plan.is_held(held):
        held = plan.plain
    lines = list(unified_diff(plan.plain, held, options.file, name_of(motor), lineterm=""))
    answer = {**who(motor), "file": options.file, "same": not lines, "diff": lines}
    tell(options, answer, "\n".join(lines) or f"{name_of(motor)}: the same as {options.file}")
    return NOT_SO if lines else DONE


def run_backup(options: Namespace) -> int:
    """Write the programs of a line to a folder."""
    with open_line(port_of(options)) as line, Bar("asking") as bar:
        saved = archive.backup(line, named(options.folder), bar.show)
    return _tell_archive(options, saved, "saved to")


def run_restore(options: Namespace) -> int:
    """Load and store the programs of a folder."""
    port = port_of(options)
    programs = archive.read_folder(named(options.folder))
    doubt = Doubt(advice="restore again", done="nothing was restored")

    def show(done: int, total: int) -> None:
        doubt.done = f"restored: {archive.names_of(programs[:done])}"
        if done < total:
            doubt.what = (
                f"{archive.names_of([programs[done]])}: its memory may hold a part of the program, "
                "which rkm04 resume would run, and what is stored is the old program or the new one"
            )
            doubt.done += f"; not begun: {archive.names_of(programs[done + 1 :])}"
        bar.show(done, total)

    with in_doubt(doubt), open_line(port) as line, Bar("restoring") as bar:
        moved = archive.restore(line, programs, show)
    left = archive.motors_without(programs)
    more = {"moved": _motors(moved), "left": _motors(left)}
    status = _tell_archive(options, programs, "restored from", more)
    if not options.json:
        if moved:
            print(f"moved, and were stopped: {archive.names_of(moved)}")
        if left:
            print(f"left as they are, without a file: {archive.names_of(left)}")
        print(
            "nothing runs: rkm04 resume starts a motor, and so does switching its unit off and on"
        )
    return status


def _motors(found: Sequence[archive.Saved]) -> list[dict[str, int]]:
    return [{"node": each.node, "motor": each.motor} for each in found]


def _tell_archive(
    options: Namespace,
    saved: Sequence[archive.Saved],
    what: str,
    more: Mapping[str, Any] | None = None,
) -> int:
    rows = [
        {"node": each.node, "motor": each.motor, "file": str(each.path), "commands": each.commands}
        for each in saved
    ]
    lines = [
        f"unit {each.node}, motor {each.motor}: "
        f"{count_of(each.commands, 'command')} {what} {each.path}"
        for each in saved
    ]
    answer = {"programs": rows, **(more or {})}
    return tell(options, answer, "\n".join(lines) or "no unit has a program")


def run_watching(options: Namespace) -> int:
    """Show positions and programs until Ctrl-C."""
    require_looks(options)
    node = reading_node_of(options)
    with open_line(port_of(options)) as line:
        return run_watch(line.unit(node), options)


RUNS: dict[str, Callable[[Namespace], int]] = {
    "version": run_version,
    "send": run_send,
    "store": run_store,
    "position": run_position,
    "program": run_program,
    "table": run_table,
    "progress": run_progress,
    "status": run_status,
    "stop": run_stop,
    "resume": run_resume,
    "reset": run_reset,
    "speed": run_speed,
    "scan": run_scan,
    "diff": run_diff,
    "backup": run_backup,
    "restore": run_restore,
    "watch": run_watching,
}


def motors_of(unit: Unit, number: int) -> list[Motor]:
    """The motor of a number, or all four for 0."""
    return [unit.motor(each) for each in (MOTORS if number == ALL_MOTORS else [number])]


def _of_motors(options: Namespace, ask: Callable[[Motor], Any]) -> tuple[int, dict[int, Any]]:
    """Ask one motor or all; return the address and the answers by motor."""
    node = reading_node_of(options)
    with open_line(port_of(options)) as line:
        motors = motors_of(line.unit(node), options.motor)
        return node, {motor.number: ask(motor) for motor in motors}


def _programs(motor: Motor) -> dict[Motor, list[str]]:
    """The commands in the memory of a motor, or of all; nothing of a broadcast."""
    if motor.unit.node == BROADCAST:
        return {}
    motors = motors_of(motor.unit, motor.number)
    return {each: held_commands(each) for each in motors}


def _require_same(plan: Plan | None, held: list[str], motor: Motor) -> None:
    """Refuse to store another program than the one of the file."""
    if plan is None:
        return
    if plan.is_held(held):
        return
    name = plan.checked.source.name
    raise Failure(
        f"{name_of(motor)}: the memory holds another program than {name} "
        f"({_difference(plan.plain, held)}); nothing was stored; rkm04 send {name} comes first",
        NOT_SO,
    )


def _difference(wanted: list[str], held: list[str]) -> str:
    """The first command in which two programs differ."""
    for place, (want, have) in enumerate(zip(wanted, held, strict=False), 1):
        if want != have:
            return f"command {place} is {have}, not {want}"
    return f"{count_of(len(held), 'command')}, not {len(wanted)}"
