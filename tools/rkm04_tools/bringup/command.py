"""The walk: one step after the other, confirmed by the person, then the report."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from contextlib import closing
from datetime import datetime
from pathlib import Path

from rkm04_tools import board
from rkm04_tools.bringup import findings
from rkm04_tools.bringup.findings import (
    BAD,
    LEFT_OUT,
    NOT_DONE,
    Part,
    Report,
    Seen,
    bad_before,
    rows_of,
)
from rkm04_tools.bringup.part import WrongImage, look_at_starts
from rkm04_tools.bringup.person import AGAIN, GO, LEAVE, NO, YES, Person, Stopped
from rkm04_tools.bringup.plan import SAFETY, STEPS
from rkm04_tools.bringup.step import Bench, Step
from rkm04_tools.bringup.talk import Refused, Talk
from rkm04_tools.client_base import port_of
from rkm04_tools.doubt import interrupted_by_any_end
from rkm04_tools.failure import (
    DONE,
    INTERRUPTED,
    NO_CONNECTION,
    NOT_SO,
    Failure,
    finished_or_absent,
    writing_failed,
)
from rkm04_tools.line_errors import GarbledAnswer, NoAnswer
from rkm04_tools.transport import open_transport

SILENT = """\
Nothing answers. What to look at, in this order:
  1. the board has power: its red LED, 3.3 V at its pin
  2. its bring-up image is flashed, and not that of the unit:
     tools/rkm04 board flash --board {board} --image bringup
     (taken out of the loader: BOOT0 low, one reset)
  3. the port is that of your adapter
  4. the adapter's RX is at LINE_TX ({tx}), its TX at LINE_RX ({rx}), ground at ground; with a
     transceiver: DE and /RE at LINE_DE ({de}), A and B not exchanged
  5. 3.3 V levels; 19 200 Bd is set by this program
  6. a crystal that is not of {mhz} MHz: the rate of the line is wrong then"""
GARBLED = """\
Something comes, but it is not what a bring-up image says. Another unit or program on the line? The
rate of another crystal than {mhz} MHz? A loose ground?"""
BEFORE = "Enter: do it, s: leave it out, q: stop here"
AFTER = "Enter: go on, r: once more, q: stop here"
AFTER_SILENCE = "r: try again, q: stop here"


def run(options: Namespace) -> int:
    """Ask whether it is safe before anything is sent; report whatever ends the walk, a terminal
    that is closed, too."""
    name = board.image_of(options.board).board
    header = board.header_of(name)
    if options.report:
        _require_place(Path(options.report))
    when = datetime.now().astimezone().isoformat(sep=" ", timespec="seconds")
    report = Report(name, port_of(options), [Part(step.name) for step in STEPS], when)
    person = Person(sys.stderr if options.json else sys.stdout)
    status, ending = DONE, ""
    try:
        with interrupted_by_any_end():
            _make_sure(person, name)
            with closing(open_transport(report.port)) as transport:
                bench = Bench(name, header, Talk(transport), person, options.patience)
                status = _walk(bench, report)
    except KeyboardInterrupt:
        status, ending = INTERRUPTED, "interrupted"
    except Stopped as stopped:
        status, ending = stopped.status, "stopped"
    except Failure as failure:
        status, ending = failure.status, str(failure)
    return _tell(options, person, report, ending, status)


def _require_place(path: Path) -> None:
    """Make sure, before the walk, that its report can be written and costs no other one."""
    if path.is_file():
        raise Failure(f"{path}: is there already, and a report replaces none; choose another name")
    _write(path, "")
    if path.is_file():
        path.unlink()


def _make_sure(person: Person, name: str) -> None:
    person.screen(f"Bring-up of {name}")
    person.tell(SAFETY.format(board=name))
    question = "Are the motors unpowered, and nothing else switched by the board? y, n"
    if person.choose(question, YES + NO) == NO:
        raise Stopped


def _walk(bench: Bench, report: Report) -> int:
    for number, (step, part) in enumerate(zip(STEPS, report.parts, strict=True), 1):
        bench.person.screen(f"Step {number} of {len(STEPS)}: {step.name}")
        bench.person.tell(f"{step.do}\nExpected: {step.expect}\n")
        if bench.person.choose(BEFORE, LEAVE, enter=GO) == LEAVE:
            part.state = LEFT_OUT
        else:
            _do(bench, step, part)
    return DONE if report.complete and not report.bad else NOT_SO


def _do(bench: Bench, step: Step, part: Part) -> None:
    """A step, as often as the person wants it; without an answer there is no way on."""
    again, before = True, list[Seen]()
    while again:
        silent = _try(bench, step, part)
        before += [each for each in bad_before(part.seen) if each not in before]
        bench.person.tell(rows_of(part.seen))
        if silent:
            bench.person.tell("\n" + silent)
            again = bench.person.choose(AFTER_SILENCE, AGAIN, status=NO_CONNECTION) == AGAIN
        else:
            again = bench.person.choose(AFTER, AGAIN, enter=GO) == AGAIN
    part.seen += [each for each in before if each not in bad_before(part.seen)]


def _try(bench: Bench, step: Step, part: Part) -> str:
    """What was seen; what to look at if there was no answer."""
    part.state = NOT_DONE
    bench.seen.clear()
    try:
        part.seen = list(step.run(bench))
        part.seen += look_at_starts(bench)
        part.state = findings.DONE
        return ""
    except WrongImage as wrong:
        part.seen = [Seen("image", wrong.name, wrong.wanted, BAD)]
        raise
    except (NoAnswer, GarbledAnswer) as error:
        part.seen = [*bench.seen, Seen("answer", str(error), "one", BAD)]
        text = SILENT if isinstance(error, NoAnswer) else GARBLED
        return text.format(
            board=bench.board, tx=bench.pin_of("LINE_TX"), rx=bench.pin_of("LINE_RX"),
            de=bench.pin_of("LINE_DE"), mhz=bench.header.values["BOARD_CRYSTAL_MHZ"].rstrip("U"),
        )  # fmt: skip
    except Refused as refused:
        part.seen = [*bench.seen, Seen("answer", str(refused), "it is done", BAD)]
        return ""
    except (KeyboardInterrupt, Stopped, Failure):
        part.seen = list(bench.seen) or part.seen
        raise


def _tell(options: Namespace, person: Person, report: Report, ending: str, status: int) -> int:
    """The file first: the terminal may be gone. And the terminal anyway: the disk may be full."""
    try:
        if options.report and report.begun:
            _write(Path(options.report), report.as_text())
    finally:
        if ending:
            person.tell(f"\n{ending}")
        text = json.dumps(report.as_object(), indent=2) if options.json else report.as_text()
        print(text if options.json else f"\n{text}")
    if options.report and not report.begun:
        person.tell(f"{options.report}: not written, as nothing was done")
    return status


def _write(path: Path, text: str) -> None:
    try:
        with finished_or_absent(path) as part:
            part.write_text(f"{text}\n", encoding="utf-8")
    except OSError as error:
        raise writing_failed(path, error) from None
