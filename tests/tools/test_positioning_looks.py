"""What a look at a positioning unit makes of changes between its requests."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import pytest
from pos_desk import MM_MIN, PosDesk
from relay import Relay
from rkm04_tools.positioning import settings
from rkm04_tools.positioning.line_errors import Restarted
from rkm04_tools.positioning.service.looking import IMAGE, Looks
from rkm04_tools.positioning.table import registers
from rkm04_tools.positioning.unit import UNIT_WORDS, Unit, open_unit
from rkm04_tools.positioning.wire import Counts
from served import Served

LOOKS_MAX = 1000
REQUESTS = 6
"""Of a look."""


@dataclass
class Restarting:
    """The wire to a unit whose axes have moved, which starts anew before one of its requests."""

    restarts_at: int
    name: str = "unit"
    node: int = 1
    counts: Counts = field(default_factory=Counts)
    seconds: float = 100.0
    _started: float = 99.0
    _is_new: bool = False

    def identify(self) -> list[str]:
        return ["", "POS4"]

    def read(self, first: int, count: int) -> list[int]:
        if self.counts.requests == self.restarts_at:
            self._started, self._is_new = self.seconds, True
        self.counts.requests += 1
        self.seconds += 0.005
        if first > 0:
            return [0 if self._is_new else 1] * count
        uptime = divmod(round(1000 * (self.seconds - self._started)), 1 << 16)
        words = [1, *[0] * UNIT_WORDS]
        place = registers()["UPTIME"].number
        words[place : place + 2] = uptime
        return words[:count]


@pytest.mark.parametrize("silence", [0.1, 60])
@pytest.mark.parametrize("request_number", range(REQUESTS))
def test_a_restart_between_any_requests_of_a_look_is_told_however_long_the_line_rests_then(
    request_number: int, silence: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    wire = Restarting(restarts_at=1 + REQUESTS + request_number)
    monkeypatch.setattr(time, "monotonic", lambda: wire.seconds)
    unit, looks = Unit(wire), Looks()  # type: ignore[arg-type]
    looks.look(unit)
    assert wire.counts.requests == 1 + REQUESTS

    with pytest.raises(Restarted):  # noqa: PT012
        told = looks.look(unit)
        wire.seconds += silence
        assert not any(axis["by_other"] for axis in told["axes"])
        looks.look(unit)


def test_a_fault_between_the_requests_of_a_look_is_no_order_of_another_master(
    pos_serve: Callable[..., Served], monkeypatch: pytest.MonkeyPatch
) -> None:
    served = pos_serve("--unpaced", speed="1")
    looks = Looks()
    with open_unit(served.place) as unit:
        axis = unit.axis(1)
        unit.set("LIMIT_PLUS", 4, 1)
        axis.init()
        axis.mode(500, 500)
        axis.control(600, permitted=True)
        looks.look(unit)
        read = unit.wire.read

        def read_before_a_fault(first: int, count: int) -> list[int]:
            words = read(first, count)
            if first == IMAGE:
                served.control().order("4=1")
                assert any(axis.read().has_fault for _ in range(LOOKS_MAX))
            return words

        with monkeypatch.context() as patch:
            patch.setattr(unit.wire, "read", read_before_a_fault)
            during = looks.look(unit)["axes"][0]
        later = looks.look(unit)["axes"][0]

    assert (during["state"], during["feed"], during["by_other"]) == ("FAULT", 600 * MM_MIN, False)
    assert (later["state"], later["feed"], later["by_other"]) == ("FAULT", 0, False)


def test_settings_whose_writing_was_cut_short_are_read_again(
    pos_serve: Callable[..., Served], monkeypatch: pytest.MonkeyPatch
) -> None:
    relay = Relay(pos_serve("--unpaced", speed="1").place)
    desk = PosDesk(relay.port)
    desk.connected()
    write = settings.write

    def write_and_fall_silent(*given: Any) -> None:
        write(*given)
        relay.muted = True

    monkeypatch.setattr(settings, "write", write_and_fall_silent)
    told = desk.ask("write", values={"axis1": {"BACKLASH": 5}})
    relay.muted = False
    found = desk.until(lambda m: m["type"] == "settings" and m["values"])["values"]
    desk.close()
    relay.close()
    assert told["error"]["kind"] == "NoAnswer"
    assert found["axis1"]["BACKLASH"] == 5
