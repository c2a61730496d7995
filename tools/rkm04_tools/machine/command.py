"""The actions of `machine`: check, show, new, unpack, diff, send and store."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from collections.abc import Callable, Iterator, Mapping
from difflib import unified_diff
from shutil import rmtree
from typing import Any

from rkm04_tools.acting import KEPT, MAY_MOVE
from rkm04_tools.bar import Bar
from rkm04_tools.client_base import OVERWRITTEN, count_of, port_of, reading_node_of, tell
from rkm04_tools.doubt import Doubt, in_doubt
from rkm04_tools.failure import DONE, NOT_SO, Failure, writing_failed
from rkm04_tools.line import Motor as UnitMotor
from rkm04_tools.line import open_line
from rkm04_tools.machine.machine import (
    FORMAT,
    VERSION,
    Machine,
    Motor,
    read_machine,
    write_machine,
)
from rkm04_tools.machine.programs import MotorProgram, good_programs, programs_of, require_inputs
from rkm04_tools.messages import MOTORS
from rkm04_tools.sending import held_commands, plan_program, without_hold
from rkm04_tools.service.together import send_all
from rkm04_tools.source import MACHINE_SUFFIX, named, read_source
from rkm04_tools.table import table, thousands

INPUTS_FILE = "inputs.csv"
WAITS = "what has come waits for ] to all motors; rkm04 reset forgets it"


def run_check(options: Namespace) -> int:
    """Check all files; the status is that of the worst one."""
    status, answers = DONE, []
    for file in options.files:
        try:
            machine = read_machine(file)
            require_inputs(machine)
            found = programs_of(machine)
        except Failure as failure:
            print(f"rkm04: {failure}", file=sys.stderr)
            status = max(status, failure.status)
            answers.append({"file": str(file), "ok": False, "error": str(failure)})
            continue
        for each in found:
            each.show()
        is_good = all(each.is_good for each in found)
        status = max(status, DONE if is_good else NOT_SO)
        answers.append({"file": machine.file, "ok": is_good, "motors": _counts(found)})
        if not options.json:
            print(f"{machine.file}: {_verdict(machine, found)}")
    if options.json:
        print(json.dumps({"files": answers}, indent=2))
    return status


def run_show(options: Namespace) -> int:
    """Print a machine as text."""
    machine = read_machine(options.file)
    return tell(options, machine.content, "\n".join(_shown(machine)))


def run_new(options: Namespace) -> int:
    """Make a machine file of programs without errors, as they are, with their comments."""
    path = named(options.file)
    if path.suffix != MACHINE_SUFFIX:
        raise Failure(f"{path}: the name of a machine file ends in {MACHINE_SUFFIX}")
    programs = _given_programs(options.motor)
    content: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "name": path.stem if options.name is None else options.name,
        "notes": "",
        "motors": [{"program": programs.get(number, "")} for number in MOTORS],
    }
    if options.inputs is not None:
        content["inputs"] = read_source(options.inputs).text
    machine = Machine(str(path), content)
    require_inputs(machine)
    found = programs_of(machine)
    for each in found:
        each.show()
    if not all(each.is_good for each in found):
        raise Failure(f"{path}: {_verdict(machine, found)}; nothing was written", NOT_SO)
    write_machine(content, path)
    which = ", ".join(map(str, programs)) or "none yet"
    return tell(options, {"file": str(path)}, f"{path}: written, with programs of motors: {which}")


def run_unpack(options: Namespace) -> int:
    """Write programs and inputs as files of their own."""
    machine, folder = read_machine(options.file), named(options.folder)
    files = {f"motor{m.number}.rks": m.program for m in machine.motors if m.program}
    if machine.inputs:
        files[INPUTS_FILE] = machine.inputs
    if not files:
        raise Failure(f"{machine.file}: has no programs and no inputs", NOT_SO)
    if folder.exists():
        raise Failure(f"{folder}: is there already; choose another folder")
    try:
        folder.mkdir(parents=True)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        rmtree(folder, ignore_errors=True)
        raise writing_failed(folder, error) from None
    paths = [str(folder / name) for name in files]
    return tell(options, {"files": paths}, "\n".join(paths))


def run_diff(options: Namespace) -> int:
    """Compare with another file, or with a unit."""
    machine = read_machine(options.file)
    if options.other is not None:
        if options.port is not None or options.node is not None:
            raise Failure("diff compares with OTHER or with a unit; leave one of them out")
        other = read_machine(options.other)
        lines = _differences(machine, other)
        name = other.file
    else:
        node, port = reading_node_of(options), port_of(options)
        programs = good_programs(machine)
        if programs is None:
            return NOT_SO
        name = f"unit {node}"
        with open_line(port) as line:
            unit = line.unit(node)
            lines = [
                line
                for number in MOTORS
                for line in _unit_differences(machine, programs.get(number), unit.motor(number))
            ]
    answer = {"file": machine.file, "other": name, "same": not lines, "diff": lines}
    tell(options, answer, "\n".join(lines) or f"{machine.file}: the same as {name}")
    return NOT_SO if lines else DONE


def run_send(options: Namespace) -> int:
    """Send all programs, or none if one of them is wrong."""
    node, port = reading_node_of(options), port_of(options)
    machine = read_machine(options.file)
    programs = good_programs(machine)
    if programs is None:
        return NOT_SO
    texts = {number: each.motor.program for number, each in programs.items()}
    with in_doubt(Doubt()) as doubt, open_line(port) as line, Bar("sending") as bar:

        def show(done: int, total: int) -> None:
            waits = options.together and done < total
            does = "wait" if waits else "run"
            what = f"which motors have got their programs of {machine.file}, and {does}"
            counts = f"{done} of {count_of(total, 'message')} taken"
            if done and not options.together:
                counts += "; motors that have all of theirs run it"
            doubt.about(what, WAITS if waits else MAY_MOVE, counts)
            bar.show(done, total)

        unit = line.unit(node)
        unit.begin()
        doubt.done = KEPT
        answer = send_all(unit, texts, options.together, show)
    if full := ", ".join(map(str, answer.values["full"])):
        warning = f"warning: the program memory was full (motor {full}), {OVERWRITTEN}"
        print(f"rkm04: {machine.file}: {warning}", file=sys.stderr)
    others = ", ".join(str(number) for number in MOTORS if number not in programs)
    left = "left as they are, without a program in the file"
    if options.together and len(programs) > 1:
        left = "without a program in the file, and empty but for ], which does nothing there"
    rest = f"; {left}: {others}" if others else ""
    text = f"{machine.file}: sent to unit {node}: {answer.text}{rest}"
    return tell(options, {"file": machine.file, "node": node, **answer.values}, text)


def run_store(options: Namespace) -> int:
    """Store programs, if those of all motors are the ones of the file."""
    node, port = reading_node_of(options), port_of(options)
    machine = read_machine(options.file)
    programs = good_programs(machine)
    if programs is None:
        return NOT_SO
    doubt = Doubt(advice="store again")
    with in_doubt(doubt), open_line(port) as line, Bar("storing") as bar:
        unit = line.unit(node)
        for number, each in programs.items():
            _require_held(machine, each, unit.motor(number), "nothing was stored")
        for done, (number, each) in enumerate(programs.items()):
            bar.show(done, len(programs))
            doubt.what = f"whether motor {number} has stored"
            doubt.done = f"stored before: {', '.join(map(str, list(programs)[:done])) or 'none'}"
            unit.motor(number).store()
            _require_held(machine, each, unit.motor(number), "it has changed while it was stored")
        bar.show(len(programs), len(programs))
    counts = _counts(programs.values())
    words = ", ".join(f"motor {each['motor']}: {each['commands']} commands" for each in counts)
    answer = {"file": machine.file, "node": node, "motors": counts}
    return tell(options, answer, f"{machine.file}: stored in unit {node}: {words}")


RUNS: dict[str, Callable[[Namespace], int]] = {
    "check": run_check,
    "show": run_show,
    "new": run_new,
    "unpack": run_unpack,
    "diff": run_diff,
    "send": run_send,
    "store": run_store,
}


def _counts(programs: Any) -> list[dict[str, Any]]:
    return [
        {"motor": each.motor.number, "ok": each.is_good, "commands": each.commands}
        for each in programs
    ]


def _verdict(machine: Machine, programs: list[MotorProgram]) -> str:
    wrong = [str(each.motor.number) for each in programs if not each.is_good]
    if wrong:
        where = f"program of motor {wrong[0]}"
        if len(wrong) > 1:
            where = f"programs of motors {', '.join(wrong)}"
        return f"{machine.name}: errors in the {where}"
    counts = [
        f"motor {each.motor.number}: {count_of(each.commands, 'command')}" for each in programs
    ]
    return f"{machine.name}: {', '.join(counts) or 'no programs'}; no errors"


def _given_programs(given: list[str]) -> Mapping[int, str]:
    programs: dict[int, str] = {}
    for text in given:
        number, equals, name = text.partition("=")
        if not equals or not name or number not in map(str, MOTORS):
            raise Failure(f"--motor {text}: write --motor N=FILE with N from 1 to 4")
        if int(number) in programs:
            raise Failure(f"motor {number} has two programs; give it one")
        programs[int(number)] = read_source(name).text
    return dict(sorted(programs.items()))


def _shown(machine: Machine) -> Iterator[str]:
    """Name, notes, what is wired where, and a table of the motors."""
    yield machine.name
    yield from ["", machine.content["notes"].strip()] if machine.content.get("notes") else []
    for kind, letters in (("input", "BI"), ("output", "BO")):
        names = machine.content.get(f"{kind}_names", {})
        yield from [""] if names else []
        yield from (f"{letters}{number}  {name}" for number, name in sorted(names.items()))
    rows: list[tuple[str, ...]] = [
        ("motor", "name", "steps per", "lowest", "highest", "steps/s", "program")
    ]
    rows += [_row(motor) for motor in machine.motors]
    yield from ["", table(rows, "rllrrrl")]
    if "gve134" in machine.content:
        yield from ["", table(list(_gve134_rows(machine.content["gve134"])), "lrrrl")]


def _gve134_rows(told: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    """The axes of a GVE134 unit."""
    yield ("axis", "steps/s", "steps/s2", "jump", "reference run")
    for letter, axis in told["axes"].items():
        homing = axis.get("homing")
        run = f"{thousands(homing['way_steps'])} steps" if homing else "none"
        limits = (axis[f"{key}_steps_per_{unit}"] for key, unit in
                  (("speed", "s"), ("accel", "s2"), ("jump", "s")))  # fmt: skip
        yield (letter.upper(), *map(thousands, limits), run)


def _row(motor: Motor) -> tuple[str, ...]:
    scale = "" if motor.steps_per_unit is None else f"{motor.unit}: {motor.steps_per_unit:g}"
    lines = len(motor.program.splitlines())
    limits = (motor.position_min_steps, motor.position_max_steps, motor.speed_max_steps_per_s)
    shown = ("" if each is None else thousands(each) for each in limits)
    return (
        str(motor.number), motor.name, scale, *shown,
        count_of(lines, "line") if motor.program.strip() else "none",
    )  # fmt: skip


def _differences(machine: Machine, other: Machine) -> list[str]:
    """A unified diff of each text, and of all else together."""
    one, two = _texts(machine), _texts(other)
    return [
        line
        for part in one
        for line in unified_diff(
            one[part], two[part], f"{machine.file}: {part}", f"{other.file}: {part}", lineterm=""
        )
    ]


def _texts(machine: Machine) -> dict[str, list[str]]:
    told = {key: value for key, value in machine.content.items() if key not in ("notes", "inputs")}
    motors = [{k: v for k, v in motor.items() if k != "program"} for motor in told.pop("motors")]
    settings = json.dumps({**told, "motors": motors}, ensure_ascii=False, indent=2, sort_keys=True)
    return {
        "settings": settings.splitlines(),
        "notes": str(machine.content.get("notes", "")).splitlines(),
        "inputs": machine.inputs.splitlines(),
        **{f"motor {each.number}": each.program.splitlines() for each in machine.motors},
    }


def _unit_differences(
    machine: Machine, program: MotorProgram | None, motor: UnitMotor
) -> list[str]:
    """A unified diff; of a motor without a program in the file all that it holds."""
    held = held_commands(motor)
    wanted: list[str] = []
    if program is not None:
        plan = plan_program(program.checked)
        wanted = held if plan.is_held(held) else plan.plain
    elif not without_hold(held):
        return []
    names = (f"{machine.file}: motor {motor.number}",
             f"unit {motor.unit.node}, motor {motor.number}")  # fmt: skip
    return list(unified_diff(wanted, held, *names, lineterm=""))


def _require_held(machine: Machine, program: MotorProgram, motor: UnitMotor, so: str) -> None:
    if not plan_program(program.checked).is_held(held_commands(motor)):
        raise Failure(
            f"motor {motor.number} of unit {motor.unit.node}: the memory holds another program "
            f"than {machine.file}; {so}; rkm04 machine diff shows it, and send comes first",
            NOT_SO,
        )
