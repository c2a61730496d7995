"""`speed`: V for a move, and whether the move has it then.

The language says when V has no effect: in a limit run, and while the motor stops. And where a move
ends just before V comes, V becomes a command of the program. The table of the move and the memory
tell which of these it was.
"""

from __future__ import annotations

from collections.abc import Sequence

from rkm04_tools.acting import MAY_MOVE, Told, states
from rkm04_tools.doubt import Doubt
from rkm04_tools.line import Motor
from rkm04_tools.messages import BreakPoint


def send_speed(motor: Motor, steps_per_s: int, doubt: Doubt) -> Told:
    """Send V to a motor that moves, and look what has become of it; in one session."""
    unit, number = motor.unit, motor.number
    before = motor.table()
    doubt.about(f"whether V{steps_per_s} was taken by motor {number}", MAY_MOVE)
    motor.set_speed(steps_per_s)
    doubt.what = f"V{steps_per_s} was sent to motor {number}, but what it has changed"
    after, held, found = motor.table(), motor.program(), states(unit, number)
    if found is None:
        return Told(number, f"was sent V{steps_per_s}", None)
    if held.endswith(f"V{steps_per_s}"):
        return Told(
            number,
            f"may not have moved when V{steps_per_s} came: it is the last command in its memory, "
            "and was stored there if the program did not end so before",
            False,
        )
    if not found[0].moving:
        return Told(number, f"has come to a stand meanwhile; V{steps_per_s} was not stored", False)
    if _has(after, before, steps_per_s):
        return Told(number, f"speed {steps_per_s} steps/s", True)
    if after == before:
        why = "a limit run, or one that brakes, takes none, or it has begun since"
        return Told(number, f"V{steps_per_s} has changed nothing of its move: {why}", False)
    why = "the way is too short, or another move has begun since; rkm04 table tells its speeds"
    return Told(number, f"does not come to {steps_per_s} steps/s: {why}", False)


def send_speed_briefly(motor: Motor, steps_per_s: int) -> Told:
    """Send it likewise without a look at the memory, and tell in the words that the page has, too.

    Of an original unit nothing is known.
    """
    number, before = motor.number, motor.table()
    motor.set_speed(steps_per_s)
    state, after = states(motor.unit, number), motor.table()
    if state and not state[0].moving:
        text = f"has come to a stand meanwhile: V{steps_per_s} may be in its memory now"
        return Told(number, text, False)
    if state and after == before and not _has(after, before, steps_per_s):
        return Told(number, "keeps its speed: it is in a limit run, or stops", False)
    return Told(number, f"speed {steps_per_s} steps/s", True)


def _has(after: Sequence[BreakPoint], before: Sequence[BreakPoint], speed: int) -> bool:
    """Whether a table shows that a move has got a speed.

    What lies below S is taken at once, and makes no corner: the last one is S then, or less.
    """
    if not after or after == before:
        return [point.speed for point in after[-1:]] == [speed]  # a run without end that has it
    corners = [point.speed for point in after[1:] if point.speed]
    return speed in corners or any(last <= after[0].speed for last in corners[-1:])
