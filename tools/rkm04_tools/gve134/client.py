"""The commands that talk to a unit; their arguments are in `client_options`."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable

from rkm04_tools.gve134 import (
    client_console,
    client_memory,
    client_motion,
    client_outputs,
    client_reading,
    client_send,
)

RUNS: dict[str, Callable[[Namespace], int]] = {
    "send": client_send.run_send,
    "console": client_console.run_console,
    "position": client_reading.run_position,
    "status": client_reading.run_status,
    "watch": client_reading.run_watch,
    "halt": client_motion.run_halt,
    "go": client_motion.run_go,
    "delete": client_motion.run_delete,
    "home": client_motion.run_home,
    "override": client_motion.run_override,
    "jog": client_motion.run_jog,
    "output": client_outputs.run_output,
    "spindle": client_outputs.run_spindle,
    "memory get": client_memory.run_get,
    "memory set": client_memory.run_set,
    "memory backup": client_memory.run_backup,
    "memory restore": client_memory.run_restore,
    "memory diff": client_memory.run_diff,
}
