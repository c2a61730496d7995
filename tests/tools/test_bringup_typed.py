"""`bringup`: what was typed before a question was shown confirms nothing."""

from __future__ import annotations

import io
import os
import pty
import select
from collections.abc import Iterator

import pytest
from rkm04_tools.bringup.command import BEFORE
from rkm04_tools.bringup.person import GO, LEAVE, NO, YES, Person

PATIENCE_S = 60.0


class Terminal:
    """A terminal as standard input, and somebody at its keys."""

    def __init__(self) -> None:
        self._keys, self._slave = pty.openpty()
        self.stdin = os.fdopen(self._slave, encoding="utf-8")

    def type(self, keys: bytes) -> None:
        """Until the terminal has them: a flush before that would miss them."""
        os.write(self._keys, keys)
        assert select.select([self._slave], [], [], PATIENCE_S)[0]

    def close(self) -> None:
        self.stdin.close()
        os.close(self._keys)


class Reading(io.StringIO):
    """Somebody who answers a question once it is shown."""

    def __init__(self, terminal: Terminal, answers: list[bytes]) -> None:
        super().__init__()
        self._terminal = terminal
        self._answers = answers

    def flush(self) -> None:
        if self.getvalue().endswith("> "):
            self._terminal.type(self._answers.pop(0))


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[Terminal]:
    opened = Terminal()
    monkeypatch.setattr("sys.stdin", opened.stdin)
    yield opened
    opened.close()


def test_what_was_typed_while_a_step_ran_confirms_no_later_one(terminal):
    person = Person(Reading(terminal, [b"s\n", b"\n"]))
    terminal.type(b"\n\n\n")

    assert person.choose(BEFORE, LEAVE, enter=GO) == LEAVE
    assert person.choose(BEFORE, LEAVE, enter=GO) == GO


def test_what_was_typed_behind_an_answer_confirms_no_later_question(terminal):
    person = Person(Reading(terminal, [b"y\ny\ny\n", b"n\n"]))

    assert person.choose("unpowered?", YES + NO) == YES
    assert person.choose("on, alone?", YES + NO) == NO


def test_a_wrong_answer_is_asked_again_and_what_was_behind_it_does_not_count(terminal):
    person = Person(Reading(terminal, [b"x\ny\n", b"n\n"]))

    assert person.choose("on, alone?", YES + NO) == NO


def test_answers_through_a_pipe_may_all_be_there_before_the_questions(monkeypatch):
    end, begin = os.pipe()
    os.write(begin, b"y\n\ns\n")
    os.close(begin)
    with os.fdopen(end, encoding="utf-8") as piped:
        monkeypatch.setattr("sys.stdin", piped)
        person = Person(io.StringIO())

        assert person.choose("unpowered?", YES + NO) == YES
        assert person.choose(BEFORE, LEAVE, enter=GO) == GO
        assert person.choose(BEFORE, LEAVE, enter=GO) == LEAVE
