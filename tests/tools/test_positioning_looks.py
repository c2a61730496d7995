"""What a look at a positioning unit makes of changes between its requests."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from pos_desk import MM_MIN, PosDesk
from relay import Relay
from rkm04_tools.positioning import settings
from rkm04_tools.positioning.service.looking import IMAGE, Looks
from rkm04_tools.positioning.unit import open_unit
from served import Served

LOOKS_MAX = 1000


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
