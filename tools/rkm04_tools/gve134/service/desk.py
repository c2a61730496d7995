"""The desk of a GVE134 unit: machine and files that pages bring, and orders for the worker."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from threading import Lock
from typing import Any

from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import Mill, mill_of
from rkm04_tools.gve134.service.files import NO_MILL, File, is_gcode, read_file
from rkm04_tools.gve134.service.orders import (
    HALT,
    PORTS,
    Connect,
    Home,
    SetInput,
    Start,
    Work,
    read_order,
)  # fmt: skip
from rkm04_tools.gve134.service.worker import Worker
from rkm04_tools.machine.machine import Machine, parse_machine
from rkm04_tools.service import virtual
from rkm04_tools.service.browsers import Aside, IsLate, Tell
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.ports import ports
from rkm04_tools.service.trouble import BadRequest, Late
from rkm04_tools.service.virtual import VirtualLine


class UnitDesk:
    """A Desk; it connects to a `first` port when it starts."""

    def __init__(
        self, first: Connect, baud: int, mill: Mill | None,
        tell: Tell, is_watched: Callable[[], bool],
    ) -> None:  # fmt: skip
        self._first = first
        self._units = VirtualLine(host.program_path, ("--baud", str(baud)))
        self._worker = Worker(tell, is_watched, self._units, baud)
        self._opening = Lock()
        self._file: File | None = None
        self._mill: Mill | None = None
        if mill:
            self._set_mill(mill)

    def start(self) -> None:
        """Begin to work."""
        self._worker.start()
        self._worker.give(self._first, Asked())

    def close(self) -> None:
        """End line, virtual unit and thread."""
        self._worker.close()
        self._units.close()

    def greetings(self) -> list[dict[str, Any]]:
        """The state of the connection, and the way made."""
        return self._worker.greetings()

    def take(self, text: str, client: int, is_late: IsLate) -> Aside | None:
        """Take what a browser says."""
        order, asked = read_order(text)
        asked = replace(asked, client=client)
        if order == HALT:
            self._worker.halt(asked)  # better late than never
        elif order == PORTS:
            return ports
        elif is_late(asked.beat):
            if isinstance(order, SetInput):
                raise Late
            self._worker.refuse(self._work(order), asked, Late())
        elif isinstance(order, SetInput):
            return partial(self._set_input, order)
        else:
            self._worker.give(self._work(order), asked)
        return None

    def _work(self, order: Any) -> Work:
        """An order as the worker takes it: a reference run is a file of its own."""
        if isinstance(order, Home):
            if self._mill is None:
                raise BadRequest("which switches? open a machine file (.rkm) that has them")
            name = f"home {order.axis or 'all'}.nc"
            text = f"G91 G28 {order.axis}0" if order.axis else "G28"
            file = replace(read_file(name, f"{text}\n".encode(), self._mill), is_own=True)
            if file.problems and file.job is None:
                raise BadRequest(f"{name}: {file.problems[0]['message']}")
            return Start(file)
        if isinstance(order, Start) and isinstance(order.file, int):
            file_now = self._file
            if file_now is None or file_now.number != order.file:
                raise BadRequest("another file was opened meanwhile; look at it, then start again")
            return Start(file_now)
        work: Work = order
        return work

    def _set_input(self, order: SetInput) -> None:
        state = self._worker.board.state
        if not (state.connected and state.virtual):
            raise BadRequest(
                f"only the port {virtual.NAME} has inputs that can be set here; "
                "those of a unit are wires"
            )
        self._units.set_input(str(order.number), order.level)

    # ---- files, from other threads ----

    def open_file(self, name: str, data: bytes) -> File:
        """Read a file, and show it in all browsers."""
        with self._opening:
            self._worker.require_no_job()
            file = read_file(name, data, self._mill)
            self._show(file, data)
            return file

    def open_machine(self, name: str, data: bytes) -> None:
        """Take another machine; a program that is open is turned for it anew."""
        mill = mill_of(Machine(name, parse_machine(data, name)))
        with self._opening:
            self._worker.require_no_job()
            self._set_mill(mill)
            if self._file and is_gcode(self._file.name):
                self._show(read_file(self._file.name, self._data, mill), self._data)

    def file(self, number: int) -> File:
        """The file of a number, if it is still the one that is open."""
        if self._file is None or self._file.number != number:
            raise BadRequest("another file was opened meanwhile; look at that")
        return self._file

    def _show(self, file: File, data: bytes) -> None:
        self._worker.require_no_job()
        self._file, self._data = file, data
        self._worker.board.change(file=file.as_json())

    def _set_mill(self, mill: Mill) -> None:
        self._mill = mill
        self._worker.board.change(machine=_machine(mill))

    @property
    def has_mill(self) -> bool:
        """Whether a machine file is open."""
        return self._mill is not None


def _machine(mill: Mill) -> dict[str, Any]:
    """What a page is told of a machine."""
    assert mill is not NO_MILL
    return {
        "name": mill.name,
        "axes": [
            axis
            and {
                "unit": axis.unit,
                "steps_per_unit": float(axis.steps_per_unit),
                "speed": axis.speed,
                "lowest": axis.lowest,
                "highest": axis.highest,
                "homes": axis.homing is not None,
            }
            for axis in mill.axes
        ],
        "rpm": mill.spindle and mill.spindle.rpm,
    }
