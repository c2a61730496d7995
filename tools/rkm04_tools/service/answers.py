"""Answers as all browsers get them: in words, as values, and as bytes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.trouble import as_json
from rkm04_tools.service.wire import Exchange


@dataclass(frozen=True)
class Answer:
    """What came of it: words, and the same as values by name. `node`: if another was meant."""

    text: str
    values: dict[str, Any] = field(default_factory=dict)
    node: int | None = None


class ProgramWrong(Failure):
    """The program has an error; `told` is it for the page."""

    def __init__(self, told: dict[str, Any]) -> None:
        super().__init__(f"{told['cause']}; {told['next']}", NOT_SO)
        self.told = told


def answer_of(
    name: str,
    motor: int | None,
    node: int,
    asked: Asked,
    got: Answer | Failure,
    exchanges: list[Exchange] | None = None,
) -> dict[str, Any]:
    """An answer for the log of all browsers."""
    told = {"type": "answer", **whose(asked), "message": name, "node": node, "motor": motor}
    told |= _bytes(exchanges or [])
    if isinstance(got, Answer):
        told["node"] = node if got.node is None else got.node
        return {**told, "text": got.text, "values": got.values, "error": None}
    error = got.told if isinstance(got, ProgramWrong) else as_json(got)
    return {**told, "text": None, "values": None, "error": error}


def _bytes(exchanges: list[Exchange]) -> dict[str, str | None]:
    requests = [each.request for each in exchanges]
    answers = [each.answer for each in exchanges if each.answer]
    return {
        "request_bytes": "  ".join(_hex(each.encode()) for each in requests),
        "answer_bytes": "  ".join(_hex(each.encode()) for each in answers) or None,
        "request_message": _hex(requests[-1].message) if requests else "",
        "answer_message": _hex(answers[-1].message) if answers else None,
    }


def _hex(data: bytes) -> str:
    return data.hex(" ").upper()


def whose(asked: Asked) -> dict[str, int | None]:
    return {"id": asked.number, "from": asked.client}
