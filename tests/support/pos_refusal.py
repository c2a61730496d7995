"""Why the positioning unit refuses an instruction, written from the contract alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pos_session import Act
from pos_words import HERE_METHOD, WAY_MAX, Code, Error

if TYPE_CHECKING:
    from pos_axis import Axis


def refusal(axis: Axis, act: Act) -> Error:
    """The first of the reasons to refuse an instruction."""
    bits, code, values = axis.bits, act.code, act.values
    if code == Code.POS_INIT:
        return Error.SPACE if values and values[0] > 6 else Error.NONE
    if code == Code.POS_CAPTURE:
        return Error.NONE if axis.settings.capture else Error.NO_INPUT
    if code == Code.POS_RESET:
        return Error.NONE
    homing = code == Code.POS_HOME
    here = homing and values[0] == HERE_METHOD
    reasons = (
        (not bits.disp, Error.NOT_TAKEN),
        (bits.fault, Error.FAULT),
        (bits.prog and bits.jede, Error.MOVES),
        (homing and values[0] not in (19, 21, 37), Error.METHOD),
        (axis.damaged and not here, Error.DAMAGED),
        (not axis.crystal and not here, Error.NO_CRYSTAL),
        (homing and not here and not axis.settings.reference, Error.NO_INPUT),
        (values[-1] == 0 and not here, Error.ACCEL),
        (_too_far(axis, act), Error.WAY),
    )
    return next((error for holds, error in reasons if holds), Error.NONE)


def _too_far(axis: Axis, act: Act) -> bool:
    way = act.values[-2]
    if way == -(2**31):
        return True
    if act.code == Code.POS_HOME:
        return False
    if act.code == Code.POS_MODE_ABS:
        here = axis.seat_at(act.tick).step
        if abs(way - axis.origin.position_of(axis.settings, here)) > WAY_MAX:
            return True
    return not axis.goal_of(act).possible
