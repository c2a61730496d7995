"""`send`: a vector file to the unit."""

from __future__ import annotations

import sys
import time
from argparse import Namespace

from rkm04_tools.bar import Bar
from rkm04_tools.client_base import count_of, tell
from rkm04_tools.failure import NOT_SO
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.check import Checked
from rkm04_tools.gve134.client_base import unit_of
from rkm04_tools.gve134.job import job_of
from rkm04_tools.gve134.link_errors import NotConfirmed
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.gve134.source import read_source
from rkm04_tools.gve134.state import AXES, positions_text
from rkm04_tools.gve134.stopping import guarded, shout
from rkm04_tools.source import Source

LEFT_AFTER_SECONDS = 2.0


def run_send(options: Namespace) -> int:
    """Check a file, send it, and say what became of it."""
    checked = checked_vectors(vectors_of(options.file))
    if checked is None:
        return NOT_SO
    job = job_of(checked)
    for command in job.left_out:
        print(f"gve134: {job.source.name}: {command} is left out", file=sys.stderr)
    with unit_of(options) as unit, Bar("sending") as bar:
        sender = Sender(unit, job, Progress(bar, job.vectors).show)
        try:
            return guarded(
                unit,
                lambda _: _send(options, sender, bar),
                lambda: f"interrupted after {sender.sent} of {count_of(job.vectors, 'vector')}; ",
            )
        except NotConfirmed as error:
            shout(str(error))
            raise


def vectors_of(name: str) -> Source:
    """The commands of a file, whatever kind of file it is."""
    return read_source(name)


def checked_vectors(source: Source) -> Source | None:
    """The file, if the firmware's own parser has nothing to say; else that is shown."""
    parsed = host.check(source.text)
    if not parsed.errors:
        return source
    Checked(source, parsed).report(sys.stderr)
    print(f"gve134: {source.name}: nothing was sent", file=sys.stderr)
    return None


class Progress:
    """Vectors sent, and the time that the others will take if it goes on like this."""

    def __init__(self, bar: Bar, total: int) -> None:
        self._bar = bar
        self._total = total
        self._started = time.monotonic()

    def show(self, sent: int) -> None:
        """Show it; once all are sent the axes are waited for."""
        passed = time.monotonic() - self._started
        more = ""
        if sent == self._total:
            more = ", the axes move"
        elif sent and passed > LEFT_AFTER_SECONDS:
            left = passed * (self._total - sent) / sent
            more = f", {int(left // 60)}:{int(left % 60):02d} left"
        self._bar.show(sent, self._total, more)


def _send(options: Namespace, sender: Sender, bar: Bar) -> int:
    sender.send()
    flags = sender.finish() if options.wait else sender.unit.flags()
    positions = sender.unit.positions()
    job = sender.job
    answer = {
        "file": job.source.name,
        "commands": sender.lines,
        "vectors": sender.sent,
        "packets": sender.packets,
        "repairs": sender.unit.link.repairs,
        "state": flags.text,
        "positions": dict(zip(AXES, positions, strict=True)),
    }
    where = "stand at" if flags.stands else "are at"
    bar.clear()
    text = f"{job.source.name}: {count_of(sender.sent, 'vector')} sent; the unit is {flags.text}, "
    return tell(options, answer, f"{text}the axes {where} {positions_text(positions)}")
