"""The desk of a GVE134 unit: machine and files that pages bring, and orders for the worker."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from threading import Lock
from typing import Any

from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import Mill
from rkm04_tools.gve134.service.files import NO_MILL, File, read_file
from rkm04_tools.gve134.service.machine_file import MachineFile, machine_file
from rkm04_tools.gve134.service.orders import Home, Order, Start, Work, read_order
from rkm04_tools.gve134.service.worker import Worker
from rkm04_tools.gve134.source import is_gcode
from rkm04_tools.service.browsers import Tell
from rkm04_tools.service.fields import Asked
from rkm04_tools.service.trouble import BadRequest
from rkm04_tools.service.unit_desk import TurnsDesk
from rkm04_tools.service.unit_orders import Connect
from rkm04_tools.service.virtual import VirtualLine


class UnitDesk(TurnsDesk):
    """A Desk; it connects to a `first` port when it starts."""

    def __init__(
        self, first: Connect, baud: int, machine: MachineFile | None,
        tell: Tell, is_watched: Callable[[], bool],
    ) -> None:  # fmt: skip
        units = VirtualLine(host.program_path, ("--baud", str(baud)))
        self._worker = Worker(tell, is_watched, units, baud)
        super().__init__(first, self._worker, units)
        self._opening = Lock()
        self._file: File | None = None
        self._machine: MachineFile | None = None
        if machine:
            self._set_machine(machine)

    def read(self, text: str) -> tuple[Order, Asked]:
        """Read an order."""
        return read_order(text)

    def work_of(self, order: Any) -> Work:
        """An order as the worker takes it: a reference run is a file of its own."""
        if isinstance(order, Home):
            if self._machine is None:
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
        machine = machine_file(name, data)
        with self._opening:
            self._worker.require_no_job()
            self._set_machine(machine)
            if self._file and is_gcode(self._file.name):
                self._show(read_file(self._file.name, self._data, machine.mill), self._data)

    def machine(self) -> MachineFile:
        """The machine file that is open."""
        if self._machine is None:
            raise BadRequest("no machine file is open; open one (.rkm) first")
        return self._machine

    def file(self, number: int) -> File:
        """The file of a number, if it is still the one that is open."""
        if self._file is None or self._file.number != number:
            raise BadRequest("another file was opened meanwhile; look at that")
        return self._file

    def _show(self, file: File, data: bytes) -> None:
        self._worker.require_no_job()
        self._file, self._data = file, data
        self._worker.board.change(file=file.as_json())

    def _set_machine(self, machine: MachineFile) -> None:
        self._machine = machine
        self._worker.board.change(machine=_told(machine.mill))

    @property
    def _mill(self) -> Mill | None:
        return self._machine.mill if self._machine else None

    @property
    def has_machine(self) -> bool:
        """Whether a machine file is open."""
        return self._machine is not None


def _told(mill: Mill) -> dict[str, Any]:
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
