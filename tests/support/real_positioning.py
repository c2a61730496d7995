"""The positioning unit in virtual time, behind the frames of its line: positioning_probe.c."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

from pymodbus.framer import FramerRTU
from pymodbus.pdu import DecodePDU, ModbusPDU
from pymodbus.pdu.register_message import (
    ReadHoldingRegistersRequest,
    ReadWriteMultipleRegistersRequest,
    WriteMultipleRegistersRequest,
    WriteSingleRegisterRequest,
)

ROOT = Path(__file__).resolve().parents[2]
FULL_OUT, FULL_IN, FULL_COUNT = 600, 640, 32
RATE, RATE_115200, STORE = 31, 1152, 40
MASTER = FramerRTU(DecodePDU(False))

Tell = Callable[[list[int] | None, list[list[int]] | None], None]


class RealUnit:
    """A unit of address 1 at 115 200 Bd; to be closed. `more`: arguments of the probe."""

    def __init__(self, *more: str) -> None:
        build = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host"))
        self.process = subprocess.Popen(
            [str(build / "bin" / "positioning-probe"), *more],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1,
        )  # fmt: skip
        self.tell: Tell | None = None
        self.heard = b""
        self.positions = [0] * 4
        self.pulses = 0
        self.run(10)
        for register, value in [(RATE, RATE_115200), (STORE, 1)]:
            self.write(register, value)
        self.restart()
        self.run(10)

    def close(self) -> None:
        self.process.communicate()

    def put(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(line + "\n")

    def run(self, ms: int) -> None:
        """Time goes by; an answer that is whole is told."""
        assert self.process.stdout is not None
        self.put(f"run {1000 * ms}")
        *steps, pulses, heard = self.process.stdout.readline().split()
        self.positions, self.pulses = [int(step) for step in steps], int(pulses)
        self.heard += bytes.fromhex(heard) if heard != "-" else b""
        if self.heard and self.tell is not None:
            _, answer = MASTER.handleFrame(self.heard, 1, 0)
            if answer is not None:
                tell, self.tell, self.heard = self.tell, None, b""
                assert not answer.isError(), answer
                tell(list(answer.registers) if answer.function_code in (3, 23) else None, None)

    def step(self) -> None:
        self.run(1)

    def send(self, request: ModbusPDU) -> None:
        request.dev_id = 1
        self.heard = b""
        self.put_frame(MASTER.buildFrame(request))

    def put_frame(self, frame: bytes) -> None:
        """A frame begins on the line."""
        self.put(f"send {frame.hex()}")

    def write(self, register: int, value: int) -> None:
        """Writes one register, and waits until that has been answered."""
        self.tell = None
        self.send(WriteSingleRegisterRequest(address=register, registers=[value]))
        self.run(200)
        assert self.heard[1] == 6, self.heard

    def ask(self, out: list[int] | None, asks: bool, tell: Tell) -> None:
        """Sends a request of the full image; `tell` gets the answer."""
        self.tell = tell
        if out is None:
            self.send(ReadHoldingRegistersRequest(address=FULL_IN, count=FULL_COUNT))
        elif asks:
            self.send(
                ReadWriteMultipleRegistersRequest(
                    read_address=FULL_IN,
                    read_count=FULL_COUNT,
                    write_address=FULL_OUT,
                    write_registers=out,
                )
            )
        else:
            self.send(WriteMultipleRegistersRequest(address=FULL_OUT, registers=out))

    def restart(self) -> None:
        """Power goes and comes."""
        self.tell, self.heard = None, b""
        self.put("restart")

    def set_input(self, number: int, level: int) -> None:
        """BI1 to BI8 has a level."""
        self.put(f"in {number} {level}")
