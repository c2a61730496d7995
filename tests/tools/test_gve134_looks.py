"""What a look at a GVE134 makes of changes between its requests."""

from __future__ import annotations

from fake_gve134 import FakeGve
from gve134_ports import FakeGveLine, VirtualPort
from gve_desk import GveDesk
from relay import Relay
from rkm04_tools.gve134.link import BAUD, Link
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.gve134.service.files import read_file
from rkm04_tools.gve134.service.looking import Looks
from rkm04_tools.gve134.service.working import Work
from rkm04_tools.gve134.state import RUN, Flags
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.gve134.wire import Wire


class EndsInALook(FakeGve):
    """Its vector ends after the first question of a look."""

    def _act(self, name: str, parameters: list[str]) -> None:
        super()._act(name, parameters)
        if name in ("P4", "F") and self.queue:
            self._end_vector()


def unit_with(fake: FakeGve) -> Unit:
    port = VirtualPort(fake)
    return Unit(Link(Wire(port, BAUD, clock=port.clock)))


def test_axes_that_stand_by_their_flags_are_at_the_positions_told() -> None:
    unit = unit_with(EndsInALook(vector_s=10.0))
    unit.order("L10")
    looks = Looks()

    stood = []
    for _ in range(2):
        looks.look(unit)
        assert looks.flags is not None
        stood.append(looks.flags.stands)
        assert not looks.flags.stands or looks.positions == (10, 0, 0, 0)
    assert stood == [False, True]


def test_axes_at_the_end_of_a_file_that_still_count_as_moving_are_on_no_line() -> None:
    file = read_file("a.gve", b"C10\nC20\n", None)
    assert file.job is not None
    work = Work(file, Sender(unit_with(FakeGve()), file.job), (0, 0, 0, 0))
    work.sender.send()
    work.see((30, 0, 0, 0), is_at_rest=False)

    progress = work.progress(Flags(RUN), 1.0)
    assert progress is not None
    assert (progress["at"], progress["line"], progress["level"]) == (2, None, 0)


def test_a_unit_that_has_restarted_while_its_port_was_gone_is_told() -> None:
    unit = FakeGve()
    line = FakeGveLine(unit)
    relay = Relay(line.port)
    desk = GveDesk(relay.port)
    try:
        desk.connected()
        relay.cut()
        desk.state(lambda m: m["away"])
        with line.lock:
            unit.restart()
        relay.mend()
        desk.state(lambda m: m["restarted"])
    finally:
        desk.close()
        relay.close()
        line.close()
