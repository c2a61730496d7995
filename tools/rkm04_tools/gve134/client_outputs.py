"""The commands that switch: output and spindle."""

from __future__ import annotations

import re
from argparse import Namespace

from rkm04_tools.client_base import tell
from rkm04_tools.failure import Failure
from rkm04_tools.gve134.client_base import unit_of
from rkm04_tools.gve134.client_options import OUTPUTS

ALL_OFF = 0xFF
PERCENT = re.compile(r"(\d{1,3})(?:\.(\d))?%?")


def run_output(options: Namespace) -> int:
    """Write port 0: what is named is on or off, what is not named is off."""
    on = set(options.keep) | {options.output} if options.level == "on" else set(options.keep)
    if options.level == "off" and options.output in options.keep:
        raise Failure(f"output {options.output}: is to be off and kept on; leave one of them out")
    port = ALL_OFF
    for bit, name in enumerate(OUTPUTS):
        port &= ~(1 << bit) if name in on else ALL_OFF
    with unit_of(options) as unit:
        unit.order(f"O0,{port:02X}")
    off = [name for name in OUTPUTS if name not in on]
    lit = ", ".join(name for name in OUTPUTS if name in on)
    text = f"on: {lit or 'none'}; off: {', '.join(off) or 'none'} (port 0 is {port:02X})"
    return tell(options, {"port": f"{port:02X}", "on": sorted(on), "off": off}, text)


def run_spindle(options: Namespace) -> int:
    """Set the speed of the spindle."""
    match = PERCENT.fullmatch(options.percent)
    permille = 10 * int(match[1]) + int(match[2] or 0) if match else -1
    if not 0 <= permille <= 1000:
        raise Failure(f"spindle {options.percent}: write per cent, 0 to 100.0, as in 30.5")
    with unit_of(options) as unit:
        unit.order(f"!7V{permille}", "spindle")
    text = f"the spindle is set to {permille / 10:.1f} %" if permille else "the spindle is off"
    return tell(options, {"percent": permille / 10}, text)
