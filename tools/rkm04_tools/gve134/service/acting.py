"""What a page may have done with a unit, besides sending a file and halting."""

from __future__ import annotations

import re

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.client_base import require_good
from rkm04_tools.gve134.link_errors import Refused
from rkm04_tools.gve134.service.orders import Jog, Output, Spindle, Typed
from rkm04_tools.gve134.state import FAULT, INTA, NO_CRYSTAL, RUN, Flags, positions_text
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.service.trouble import BadRequest

QUESTION = re.compile(r"\?|Q|P[F4L]?|SR\d|F|I[12]|E[UF]?R[0-9A-F]{1,2}")
NOT_TYPED = re.compile(r"[@>%*].*|H|W.*")
"""What the line does itself, and what has buttons of its own."""

CUTS_IN = re.compile(r"[LCGDNRK].*|(!7)?J|SW0*6.*")
"""What moves axes, or takes away what a job goes on with."""


def cuts_in(text: str) -> bool:
    """Whether a command would change what a job that was stopped goes on with."""
    return CUTS_IN.fullmatch(_plain(text)) is not None


def only_asks(text: str) -> bool:
    """Whether a command only asks."""
    return QUESTION.fullmatch(_plain(text)) is not None


def act(unit: Unit, order: Typed | Output | Spindle) -> str:
    """Do what is one command."""
    if isinstance(order, Output):
        unit.order(f"O0,{order.port:02X}")
        return f"port 0 is {order.port:02X}"
    if isinstance(order, Spindle):
        unit.order(f"!7V{order.permille}", "spindle")
        return (
            f"the spindle is set to {order.permille / 10:g} %" if order.permille else "spindle off"
        )
    return _type(unit, _plain(order.text))


def _plain(text: str) -> str:
    return answers.canonical(text.strip().removeprefix("!0"))


def _type(unit: Unit, text: str) -> str:
    if NOT_TYPED.fullmatch(text):
        raise BadRequest(f"{text}: the page has a button for it, or the line does it by itself")
    require_good(text, text)
    link = unit.link
    answer = link.reset(answers.addressed(text)[0]) if text in ("J", "!7J") else link.ask(text)
    if answer.code != answers.DONE:
        raise Refused(text, answer)
    return f"{text} → {answer.text}  {answer.words}"


def require_free(flags: Flags) -> None:
    """Refuse to begin a motion where another one is under way or waits."""
    if flags.has(NO_CRYSTAL | FAULT):
        why = flags.text.replace("gve134 delete clears it", "Delete clears it")
        raise Failure(f"nothing was moved: {why}", NOT_SO)
    if flags.has(INTA):
        raise Failure("nothing was moved: the unit was stopped; go on or delete first", NOT_SO)
    if flags.has(RUN):
        raise Failure("nothing was moved: the axes move; wait or halt them", NOT_SO)


def jog(unit: Unit, order: Jog) -> str:
    """Move axes a little."""
    require_free(unit.flags())
    unit.order(f"V{order.speed}")
    unit.order(f"L{','.join(map(str, order.parts))}")
    return f"the axes move by {positions_text(order.parts)}"


def go(unit: Unit, may_be_empty: bool) -> str:
    """Let what waits go on. `may_be_empty`: more comes from here."""
    answer = unit.link.ask("G")
    is_empty = answer.code == answers.NOTHING_TO_GO_ON
    if answer.code != answers.DONE and not (is_empty and may_be_empty):
        raise Refused("nothing waits to go on" if is_empty else "G", answer)
    return "the axes go on"


def delete(unit: Unit) -> str:
    """Delete the queue, and what is told of the last stop."""
    answer = unit.link.ask("D")
    if answer.code == answers.NOT_WHILE_MOVING:
        raise Refused("nothing was deleted", answer, "the axes move; halt comes first")
    if answer.code != answers.DONE:
        raise Refused("D", answer)
    return f"the queue is empty; the axes stand at {positions_text(unit.positions())}"
