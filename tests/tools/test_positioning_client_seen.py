"""`positioning` on a terminal, and beside another master; against `serve`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from rkm04_tools.failure import Failure
from rkm04_tools.positioning.unit import Unit, open_unit
from served import Served

Tool = Callable[..., Any]
Serve = Callable[..., Served]


@pytest.fixture
def unit(pos_serve: Serve) -> Iterator[Unit]:
    """A unit that answers well."""
    with open_unit(pos_serve().place) as opened:
        yield opened


def test_how_far_it_is_is_shown_on_a_terminal_only(
    positioning: Tool, pos_serve: Serve, monkeypatch: pytest.MonkeyPatch
):
    place = pos_serve().place
    assert positioning("move", "10", "--port", place).err == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)

    made = positioning("move", "10", "--port", place).err
    assert re.search(r"um made \[#+\.+\] \d+/\d+, \d+ %, at 1\d\.\d+ mm", made)
    assert made.endswith("\r\x1b[K")
    assert "asking [" in positioning("scan", "--port", place).err
    assert positioning("settings", "set", "REFERENCE=1", "--port", place).status == 1
    positioning("reset", "--port", place)
    positioning("settings", "set", "REFERENCE=1", "HOME_WAY=5000", "--port", place)
    assert "mm/min, MOVING" in positioning("home", "--port", place).err


def test_another_master_is_noticed(unit: Unit):
    axis = unit.axis(1)
    axis.init()
    unit.wire.write(100, [99 << 8 | 3])

    with pytest.raises(Failure, match="another master has given it back"):
        axis.mode(1.0, 500)


def test_a_measure_of_another_master_is_not_taken_for_the_own_one(unit: Unit):
    axis, other = unit.axis(1), unit.axis(1)
    axis.init()
    axis.mode(1000.0, 500)
    axis.control(feed=600, permitted=True)
    other.hold()
    other.move(1.0, feed=6000, accel=500)

    with pytest.raises(Failure, match="another master has given an instruction meanwhile"):
        axis.wait()


def test_an_axis_that_was_taken_before_is_told_to_have_been_given_back(unit: Unit):
    axis, other = unit.axis(1), unit.axis(1)
    other.init()
    axis.mode(1000.0, 500)
    other.reset()

    with pytest.raises(Failure, match="another master has given it back"):
        axis.wait()
