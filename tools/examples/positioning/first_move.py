"""Moves axis 1 by 10 mm and back. `tools/positioning serve` is a unit without hardware.

PYTHONPATH=tools build/venv/bin/python tools/examples/positioning/first_move.py
"""

import os

from rkm04_tools.positioning.unit import open_unit

with open_unit(os.environ.get("POSITIONING_PORT", "socket://127.0.0.1:5000")) as unit:
    axis = unit.axis(1)
    axis.init()
    for way_mm in (10.0, -10.0):
        state = axis.move(way_mm, feed=1000, accel=500)
        print(f"axis 1 stands at {state.position_um / 1000} mm")
    axis.reset()
