"""Requests to a unit and their answers: Modbus RTU, or Modbus TCP through a gateway.

Frames and what is in them are pymodbus'; when something is sent, how long an answer is waited for
and how often a request is repeated is decided here. Repeating is safe: the unit executes no
instruction word twice, and all else that is written is the same again.
"""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pymodbus.framer import FramerRTU, FramerSocket
from pymodbus.pdu import DecodePDU, ExceptionResponse, ModbusPDU
from pymodbus.pdu.mei_message import ReadDeviceInformationRequest, ReadDeviceInformationResponse
from pymodbus.pdu.register_message import (
    ReadHoldingRegistersRequest,
    ReadWriteMultipleRegistersRequest,
    WriteMultipleRegistersRequest,
)

from rkm04_tools.line_errors import GarbledAnswer, LineError, NoAnswer
from rkm04_tools.positioning.line_errors import RequestRefused, WrongUnit
from rkm04_tools.positioning.table import registers
from rkm04_tools.transport import Port, open_transport

logging.getLogger("pymodbus").addHandler(logging.NullHandler())

TCP = "modbus://"
PTYS = "/dev/pts/"
RATE, FORMAT = 19_200, "8E1"
FORMATS = ("8E1", "8O1", "8N1", "8N2")
ANSWER_SECONDS = 0.3
"""How long the first byte of an answer may take on its way, through converters and networks."""
TCP_SECONDS = 3.0
"""A gateway waits by itself, and tells that nothing came."""
STORE_SECONDS = 2.2
BITS_MAX = 11
GAP_CHARACTERS = 3.5
GAP_SECONDS_MIN = 0.00175
REST_SECONDS = 0.05
"""Silence that long in an answer is its end, whole or not."""
LATE_SECONDS = 0.1
"""After a repeat an answer may come twice; so long the second one is waited for."""
SENT_MAX = 4
"""How often a request is sent at the most."""
FRAME_BYTES_MAX = 256
TARGET_FAILED = 0x0B


def is_store(pdu: bytes) -> bool:
    """Whether a request writes STORE, whose answer may take its time."""
    place = int.from_bytes(pdu[1:3], "big")
    number = registers()["STORE"].number
    if pdu[0] == 16:
        return place <= number < place + int.from_bytes(pdu[3:5], "big")
    return pdu[0] == 6 and place == number


@dataclass
class Counts:
    """What has happened on the line."""

    requests: int = 0
    repeats: int = 0


class Wire:
    """A line to a unit. `look` is called before anything is sent."""

    def __init__(self, port: Port, node: int, rate: int, bits: int, tcp: bool) -> None:
        self.node = node
        self.counts = Counts()
        self.tries = SENT_MAX
        self.look: Callable[[], None] = lambda: None
        self._port = port
        self._tcp = tcp
        decoder = DecodePDU(False)
        self._decoder = decoder
        self._framer = FramerSocket(decoder) if tcp else FramerRTU(decoder)
        self._byte_seconds = 0.0 if tcp else bits / rate
        self._number = 0
        self._quiet_from = 0.0
        self._owed = False

    @property
    def name(self) -> str:
        """Where the unit is, for messages."""
        return f"{self._port.name}, unit {self.node}"

    def close(self) -> None:
        """Give the port back."""
        self._port.close()

    def abandon(self) -> None:
        """Give the port back, and let nothing go out any more that still waits."""
        self._port.abandon()

    def read(self, first: int, count: int) -> list[int]:
        """Registers."""
        request = ReadHoldingRegistersRequest(address=first, count=count)
        return self._words(self._ask(request, f"reading register {first}"), count)

    def write(self, first: int, words: Sequence[int]) -> None:
        """Write registers, all of them or none."""
        request = WriteMultipleRegistersRequest(address=first, registers=list(words))
        self._ask(request, f"writing register {first}")

    def write_and_read(
        self, first: int, words: Sequence[int], read: int, count: int
    ) -> tuple[list[int], bool]:
        """Write registers, then read others; whether the request had to be repeated."""
        request = ReadWriteMultipleRegistersRequest(
            read_address=read, read_count=count, write_address=first, write_registers=list(words)
        )
        before = self.counts.repeats
        found = self._words(self._ask(request, f"writing register {first}"), count)
        return found, self.counts.repeats != before

    def identify(self) -> list[str]:
        """Vendor, product and version."""
        request = ReadDeviceInformationRequest(read_code=1, object_id=0)
        answer = self._ask(request, "the identification")
        assert isinstance(answer, ReadDeviceInformationResponse)
        return [bytes(text).decode("ascii", "replace") for text in answer.information.values()]

    def _words(self, answer: ModbusPDU, count: int) -> list[int]:
        if len(answer.registers) != count:
            raise WrongUnit(self.name)
        return list(answer.registers)

    def _ask(self, request: ModbusPDU, what: str) -> ModbusPDU:
        """Send a request until it is answered."""
        request.dev_id = self.node
        error: LineError = NoAnswer("")
        for sent in range(self.tries):
            self.look()
            self.counts.requests += 1
            self.counts.repeats += sent > 0
            try:
                answer = self._exchange(request)
            except (NoAnswer, GarbledAnswer) as failed:
                error = failed
                continue
            finally:
                self._owed = sent > 0 and not self._tcp
            if not isinstance(answer, ExceptionResponse):
                return answer
            if answer.exception_code != TARGET_FAILED:
                raise RequestRefused(self.name, what, answer.exception_code)
            error = NoAnswer(
                f"{self.name}: the gateway tells that the unit does not answer; "
                "is it on, and is this its address?"
            )
        raise error

    def _exchange(self, request: ModbusPDU) -> ModbusPDU:
        self._number = self._number % 0xFFFF + 1
        request.transaction_id = self._number
        frame = self._framer.buildFrame(request)
        self._be_quiet()
        self._port.write(frame)
        function = request.function_code
        seconds = TCP_SECONDS if self._tcp else ANSWER_SECONDS + len(frame) * self._byte_seconds
        if is_store(bytes([function]) + request.encode()):
            seconds += STORE_SECONDS
        return self._hear(function, seconds)

    def _be_quiet(self) -> None:
        """Drop what has come too late, and leave the silence that ends a frame for all units."""
        while self._port.read(LATE_SECONDS if self._owed else 0.0):
            pass
        self._owed = False
        gap = max(GAP_CHARACTERS * self._byte_seconds, GAP_SECONDS_MIN)
        left = self._quiet_from + gap - time.monotonic()
        if not self._tcp and left > 0:
            time.sleep(left)

    def _hear(self, function: int, seconds: float) -> ModbusPDU:
        heard, garbled = b"", False
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            data = self._port.read(left)
            if data:
                heard += data
                end = (
                    max(end, time.monotonic() + REST_SECONDS)
                    if self._tcp
                    else (time.monotonic() + REST_SECONDS + len(heard) * self._byte_seconds)
                )
            answer, heard, bad = self._take(heard, function)
            garbled = garbled or bad
            if answer is not None:
                self._quiet_from = time.monotonic()
                return answer
        self._quiet_from = time.monotonic()
        if heard or garbled:
            raise GarbledAnswer(
                f"{self.name}: what comes is damaged, or no Modbus; check rate and format of the "
                "line (--baud, --format), cable and terminators"
            )
        raise NoAnswer(
            f"{self.name} does not answer; is it on, are address, rate and format right "
            "(--node, --baud, --format), and are A and B not swapped?"
        )

    def _take(self, heard: bytes, function: int) -> tuple[ModbusPDU | None, bytes, bool]:
        """The answer, if it is there; what is left; whether something else was there."""
        used, node, number, content = self._framer.decode(heard)
        heard = heard[used:]
        if not content:
            return None, heard, used > 0
        is_own = node == self.node and (not self._tcp or number == self._number)
        if not is_own or content[0] & 0x7F != function:
            return None, heard, False
        return self._decoder.decode(content), heard, False


def open_wire(name: str, node: int = 1, rate: int = RATE, form: str = FORMAT) -> Wire:
    """Open a line: a serial device, a pty, socket://HOST:PORT (RTU) or modbus://HOST:PORT (TCP)."""
    if name.startswith(TCP):
        port = open_transport(name, scheme=TCP)
        return Wire(port, node, rate, BITS_MAX, tcp=True)
    is_pty = os.path.realpath(name).startswith(PTYS)
    port = open_transport(name, rate, "8N1" if is_pty else form)
    return Wire(port, node, rate, 10 if form == "8N1" else BITS_MAX, tcp=False)
