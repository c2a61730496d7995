"""Lines of a vector file that are for the host, not for the unit: they begin with ;@

    ;@wait 2.5            wait so many seconds
    ;@pause line 7: TEXT  show the text, and wait for a person
    ;@probe               the vector before was to touch something; see below

They stand after a line that was answered when all before had been done, so that the axes stand;
after a vector that probes they may still move. `;@probe` asks for this: wait until they stand (F:
INTA is set, or RUN is not). Without INTA, or with INTCOM, nothing was touched: the file ends with
an error, and nothing more is sent. Else write SW1,00, so that the sensor stops nothing any more;
read PL and P4; D; send L with PL - P4 on the axes of that vector, so that they go back to where it
was touched; wait until they stand. Positions that follow count from there.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

MARK = ";@"
WAIT = re.compile(r"wait (\d+(?:\.\d+)?)")
PAUSE = re.compile(r"pause\b ?(.*)")


@dataclass(frozen=True)
class Wait:
    """So many seconds."""

    seconds: float


@dataclass(frozen=True)
class Pause:
    """Until a person has seen a text."""

    text: str


@dataclass(frozen=True)
class Probe:
    """Until the axes stand, then back to where the sensor was touched."""


def directive_of(line: str) -> Wait | Pause | Probe | None:
    """What a line of a vector file asks of the host; None: nothing.

    A line with the mark and anything else raises ValueError: it asks for what nobody knows.
    """
    text = line.strip()
    if not text.startswith(MARK):
        return None
    text = text.removeprefix(MARK)
    if match := WAIT.fullmatch(text):
        return Wait(float(match[1]))
    if match := PAUSE.fullmatch(text):
        return Pause(match[1])
    if text == "probe":
        return Probe()
    raise ValueError(f"nothing is known of {line.strip()}; it was written by later tools")
