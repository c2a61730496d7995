"""A stop that is believed only when each unit has confirmed it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from rkm04_tools import messages
from rkm04_tools.failure import Failure
from rkm04_tools.frame import BROADCAST
from rkm04_tools.line import Line, Wait
from rkm04_tools.line_errors import LineError, PortError, UnknownMessage
from rkm04_tools.messages import ALL_MOTORS, GET_STATUS, SET_COMMAND
from rkm04_tools.status import MotorStatus, Status, parse_status

STOP = messages.request(SET_COMMAND, ALL_MOTORS, b"K")
ONCE = Wait(attempts=1)
SILENT_ROUNDS = 4
"""So often a unit is asked that does not answer."""

PAUSE_SECONDS = 0.02
ANSWERING_SECONDS = 12.0
"""So long a unit is told to stop that answers and does not."""


def stop_all(
    line: Line,
    nodes: Sequence[int],
    left_are: Callable[[Sequence[int]], None],
    see: Callable[[int, Status], None],
) -> list[int]:
    """Send K to all units at once, then to each node until it has confirmed.

    Returns those that have not; `left_are` is told of them meanwhile, also before a port is lost;
    `see` of every status.
    """
    line.request_at_once(BROADCAST, STOP)
    end = time.monotonic() + ANSWERING_SECONDS
    left = list(nodes)
    silent = dict.fromkeys(nodes, 0)
    asked = list(left)
    while asked and time.monotonic() < end:
        for node in asked:
            try:
                if _confirms(line, node, see):
                    left.remove(node)
                    left_are(left)
            except LineError as error:
                if isinstance(error, PortError):
                    raise
                silent[node] += 1
        asked = [node for node in left if silent[node] < SILENT_ROUNDS]
        if asked:
            time.sleep(PAUSE_SECONDS)
    return left


def _confirms(line: Line, node: int, see: Callable[[int, Status], None]) -> bool:
    """Send K; whether the unit has taken it, and says that its motors brake or stand.

    An original unit, which does not know Get Status, confirms by taking it.
    """
    try:
        messages.parse_set_command(line.request_at_once(node, STOP, ONCE), ALL_MOTORS)
        answer = line.request_at_once(node, bytes([GET_STATUS]), ONCE)
    except LineError:
        raise
    except Failure:
        return False
    try:
        status = parse_status(answer)
    except UnknownMessage:
        return True
    except Failure:
        return False
    see(node, status)
    return all(map(is_stopped, status.motors))


def is_stopped(motor: MotorStatus) -> bool:
    """Whether a motor brakes to stay, or stands and has nothing to run."""
    brakes_to_stay = motor.stopped or motor.failed or motor.ended
    return brakes_to_stay or not (motor.moving or motor.running)
