"""`send`: a vector file to the unit."""

from __future__ import annotations

import io
import math
import sys
import time
from argparse import Namespace
from collections.abc import Callable
from contextlib import ExitStack

from rkm04_tools.bar import Bar
from rkm04_tools.client_base import count_of, tell
from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.check import SHOWN_MAX, Checked
from rkm04_tools.gve134.client_base import unit_of
from rkm04_tools.gve134.gcode.axes import read_mill
from rkm04_tools.gve134.gcode.command import machine_of
from rkm04_tools.gve134.gcode.options import START_DEFAULT, TOLERANCE_DEFAULT
from rkm04_tools.gve134.gcode.reading import lines_of
from rkm04_tools.gve134.gcode.turning import turn_file
from rkm04_tools.gve134.job import job_of
from rkm04_tools.gve134.keys import Keys, are_there
from rkm04_tools.gve134.link_errors import (
    LineError,
    NotConfirmed,
    OutOfStep,
    Refused,
    Restarted,
)
from rkm04_tools.gve134.sending import Interrupted, Sender, require_stands
from rkm04_tools.gve134.source import FILE_BYTES_MAX, TOO_LARGE, is_gcode, read_source
from rkm04_tools.gve134.state import AXES, Flags, positions_text
from rkm04_tools.gve134.steering import HELP, Held, Steering
from rkm04_tools.gve134.stopping import guarded
from rkm04_tools.gve134.unit import Halted
from rkm04_tools.source import Source, named
from rkm04_tools.stopper import Stopper

LEFT_AFTER_SECONDS = 2.0
SHOWN_SECONDS = 0.25


def run_send(options: Namespace) -> int:
    """Check a file, send it, and say what became of it."""
    source = vectors_of(options)
    if source is None or not is_good(source):
        print(f"gve134: {options.file}: nothing was sent", file=sys.stderr)
        return NOT_SO
    job = job_of(source)
    for command in job.left_out:
        print(f"gve134: {job.source.name}: {command} is left out", file=sys.stderr)
    if job.pauses and not sys.stdin.isatty():
        raise Failure(f"{job.source.name}: waits for a person (;@pause); send it from a terminal")
    with unit_of(options) as unit, Bar("executing") as bar:
        if is_gcode(options.file):
            require_stands(unit.flags())
            here = positions_text(unit.positions())
            start = ",".join(f"{at:g}" for at in options.start)
            at = "position 0" if options.start == START_DEFAULT else f"position {start}"
            print(
                f"gve134: {source.name}: {at} of the program is where the axes stand, {here},"
                " unless its G28 or G92 says otherwise",
                file=sys.stderr,
            )
        sender = Sender(unit, job)
        try:
            return guarded(
                unit,
                lambda stopper: _send(options, sender, bar, stopper),
                lambda: f"interrupted after {sender.sent} of {count_of(job.vectors, 'vector')}; ",
                after=lambda halted: _executed(sender, halted),
                spindle=lambda: sender.spindle_text,
            )
        except (NotConfirmed, Restarted):
            raise
        except (Interrupted, Refused) as error:
            raise Failure(f"{error}; {sender.spindle_text}", error.status) from None
        except LineError as error:
            if isinstance(error, OutOfStep):
                sender.lose()
            what = "no vector was sent"
            if sender.sent_text != "0":
                what = f"{sender.sent_text} of {count_of(job.vectors, 'vector')} were sent and go"
                what += " on by themselves"
            text = f"{error}; {what}: whether the axes move is NOT KNOWN"
            raise Failure(f"{text}; {sender.spindle_text}", error.status) from None
        except Failure as error:
            raise Failure(f"{error}; {sender.spindle_text}", error.status) from None


def vectors_of(options: Namespace) -> Source | None:
    """The commands of a file, whatever kind of file it is; None: it has errors, which are shown."""
    if is_gcode(options.file):
        return _turned(options)
    if options.start != START_DEFAULT or options.tolerance != TOLERANCE_DEFAULT:
        raise Failure(f"{options.file}: --start and --tolerance are for G-code, leave them out")
    return read_source(options.file)


def _turned(options: Namespace) -> Source | None:
    """Vectors of a file of G-code."""
    path, mill = named(options.file), read_mill(machine_of(options))
    vectors = io.StringIO()

    def put(text: str) -> None:
        if vectors.tell() + len(text) > FILE_BYTES_MAX:
            raise Failure(f"{path}: more than {FILE_BYTES_MAX} bytes of vectors, {TOO_LARGE}")
        vectors.write(text)

    with Bar("turning") as bar:
        turned = turn_file(
            lines_of(path, bar.show), path.name, mill, put, options.tolerance, options.start
        )
    for kind, problems in (("error", turned.problems), ("warning", turned.warnings)):
        for each in problems[:SHOWN_MAX]:
            print(f"{path}:{each.line}:{each.column}: {kind}: {each.message}", file=sys.stderr)
    return Source(f"{path} as vectors", vectors.getvalue()) if turned.is_good else None


def is_good(source: Source) -> bool:
    """Whether the firmware's own parser has nothing to say; else that is shown."""
    parsed = host.check(source.text)
    checked = Checked(source, parsed)
    if parsed.errors:
        checked.report(sys.stderr)
    else:
        checked.warn(sys.stderr)
    return not parsed.errors


class Progress:
    """Vectors executed and sent, and the time that the others take if it goes on like this.

    The positions are asked for only where somebody looks.
    """

    def __init__(
        self, bar: Bar, sender: Sender, clock: Callable[[], float] = time.monotonic,
        steering: Steering | None = None,
    ) -> None:  # fmt: skip
        self._bar = bar
        self._sender = sender
        self._steering = steering
        self._clock = clock
        self._started = clock()
        self._shown = -math.inf

    def show(self, sent: int) -> None:
        """Show it, not too often, after what keys have asked for."""
        if self._steering:
            self._steering.between()
        now = self._clock()
        if now - self._shown < SHOWN_SECONDS or not sys.stderr.isatty():
            return
        self._shown = now
        total, done = self._sender.job.vectors, self._sender.look()
        more = ", how many are executed is not known" if done is None else f", {sent} sent"
        counted = sent if done is None else done
        passed = now - self._started - (self._steering.held_s if self._steering else 0.0)
        if counted and passed > LEFT_AFTER_SECONDS:
            left = passed * (total - counted) / counted
            more += f", {int(left // 60)}:{int(left % 60):02d} left"
        more += self._steering.text if self._steering else ""
        self._bar.show(counted, total, more)


def _executed(sender: Sender, halted: Halted) -> str:
    """What to tell of the vectors once the axes stand; nothing of a unit that has restarted."""
    if halted.restarted:
        return ""
    if halted.others:
        sender.lose()
    return f"; {sender.executed_text(halted.positions)}"


def _send(options: Namespace, sender: Sender, bar: Bar, stopper: Stopper) -> int:
    with ExitStack() as stack:
        keys = stack.enter_context(Keys()) if are_there() else None
        steering = Steering(sender, keys, bar) if keys else None
        if steering:
            print(f"gve134: {HELP}", file=sys.stderr)
            wire = sender.unit.link.wire
            wire.look = steering.watching(stopper.look)
            stack.callback(setattr, wire, "look", stopper.look)

        def ask_person(text: str) -> None:
            bar.clear()
            print(f"gve134: {text}; Enter goes on, Ctrl-C halts", file=sys.stderr, flush=True)
            with ExitStack() as asking:
                if keys:
                    asking.enter_context(keys.lines())
                asking.enter_context(stopper.at_once())
                sys.stdin.readline()

        sender.ask_person = ask_person
        sender.tell = Progress(bar, sender, steering=steering).show
        flags = _sent(sender, steering, options.wait)
    return _tell_sent(options, sender, bar, flags)


def _sent(sender: Sender, steering: Steering | None, waits: bool) -> Flags:
    """Send all of it, with as many halts as a person wants."""
    while True:
        try:
            sender.send()
            return sender.finish() if waits else sender.unit.flags()
        except Held:
            assert steering is not None
            steering.hold()


def _tell_sent(options: Namespace, sender: Sender, bar: Bar, flags: Flags) -> int:
    positions = sender.unit.positions()
    job = sender.job
    answer = {
        "file": job.source.name,
        "commands": sender.lines,
        "vectors": sender.sent,
        "executed": sender.look(positions),
        "packets": sender.packets,
        "repairs": sender.unit.link.repairs,
        "state": flags.text,
        "positions": dict(zip(AXES, positions, strict=True)),
    }
    where = "stand at" if flags.stands else "are at"
    bar.clear()
    executed = "" if flags.stands else f", {sender.executed_text(positions)}"
    text = f"{job.source.name}: {count_of(sender.sent, 'vector')} sent{executed}; "
    text += f"the unit is {flags.text}, "
    return tell(options, answer, f"{text}the axes {where} {positions_text(positions)}")
