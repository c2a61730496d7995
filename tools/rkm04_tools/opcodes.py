"""The commands in words: what each does, and what may stand behind its letter.

Letters, forms and ranges come from the firmware's own table; only the words are here.
"""

from __future__ import annotations

from collections.abc import Sequence

from rkm04_tools.host import OpcodeRow

MEANINGS = {
    "RESET": "reset",
    "LABEL": "label",
    "ACCELERATION": "acceleration",
    "STEPS_BACKWARD": "steps backward",
    "CLEAR_OUTPUT": "clear an output",
    "FUNCTION_OFF": "switch a function off",
    "RESUME": "resume",
    "CLEAR_VARIABLE": "clear a variable",
    "ZERO_POSITION": "zero the position",
    "REVERSE": "reverse the direction",
    "LOOP_END": "end of a loop",
    "STEPS_FORWARD": "steps forward",
    "GO_TO": "go to a position",
    "RUN_FORWARD": "run forward without end",
    "RUN_BACKWARD": "run backward without end",
    "GO_HOME": "go to position 0",
    "JUMP_IF_HIGH": "jump if an input or variable is 1",
    "JUMP_IF_LOW": "jump if an input or variable is 0",
    "JUMP": "jump to a label",
    "HALT": "stop the program",
    "LOOP": "start of a loop",
    "GUARD_HIGH": "guard the moves by an input that is 1",
    "GUARD_LOW": "guard the moves by an input that is 0",
    "WAIT_INPUT_HIGH": "wait until an input is 1",
    "WAIT_VARIABLE_HIGH": "wait until a variable is 1",
    "MOVE": "do the move",
    "START_SPEED": "start/stop speed",
    "SET_OUTPUT": "set an output",
    "FUNCTION_ON": "switch a function on",
    "SET_VARIABLE": "set a variable",
    "GUARDS_OFF": "cancel the guards",
    "SPEED": "maximum speed",
    "WAIT": "wait for milliseconds",
    "APPEND_SECTION": "append a section to the compound move",
    "TOTAL_STOP": "total stop by an input",
    "WAIT_INPUT_LOW": "wait until an input is 0",
    "WAIT_VARIABLE_LOW": "wait until a variable is 0",
    "LIMIT_FORWARD": "run forward to a limit",
    "LIMIT_BACKWARD": "run backward to a limit",
    "SET_POSITION": "write the position",
    "CALL": "call a subroutine",
    "RETURN": "end of a subroutine",
    "HOLD": "hold the program",
    "RELEASE": "release the program",
}

CONDITIONAL = ("HIGH", "LOW")
CONDITIONAL_WANTS = (
    "the number of an input (1 to 8) or variable (80 to 95), H or L, and a label"
    " from {0.min} to {0.max}, as in I05H10"
)


def rows_of(letter: str, rows: Sequence[OpcodeRow]) -> list[OpcodeRow]:
    """The rows of a letter."""
    return [row for row in rows if row.letter == letter]


def wants(rows: Sequence[OpcodeRow]) -> str:
    """Say what must follow the letter that these rows share."""
    if rows[0].form in CONDITIONAL:
        return CONDITIONAL_WANTS.format(rows[0])
    if len(rows) == 1:
        return f"a number from {rows[0].min} to {rows[0].max}"
    choices = [_choice(row) for row in rows]
    return f"{', '.join(choices[:-1])} or {choices[-1]}"


def _choice(row: OpcodeRow) -> str:
    """One of several things that a letter takes."""
    signs = {"PLUS": "+", "MINUS": "-"}
    if row.form in signs:
        what = signs[row.form]
    elif row.min == row.max:
        what = str(row.min)
    else:
        what = f"{row.min} to {row.max}"
    return f"{what} ({MEANINGS[row.name]})"
