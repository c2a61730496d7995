"""Why a probing ends without a touch: `send` finds it out, the simulator's host tells it.

The reasons are those of tools/gve134_host/gve_probing.c.
"""

from __future__ import annotations

UNTOUCHED, HALTED, BEFORE, SWITCH, BACK = "untouched", "halted", "before", "switch", "back"

WORDS = {
    UNTOUCHED: "nothing was touched on the way",
    HALTED: "a halt (H) has stopped the axes, nothing was touched",
    BEFORE: "the sensor was touched before the axes moved, so nothing was probed; look at the "
    "sensor, its wire and its active level (ST3)",
    SWITCH: "a reference switch has stopped the axes, nothing was touched",
    BACK: "something has stopped the axes on their way back to where the sensor was touched",
}
