"""An image, all in SRAM, in QEMU's STM32F405: the line over TCP, the processor over gdb's protocol.

The machine has no clock control, pins, flash controller or watchdog: their registers read 0 and
ignore writes. So the image finds no crystal and all pins low, that is all switches of S1 on: 16.
It has no memory where the part says how much flash it has, either; so the image is told to look
for that at the begin of the flash, where its first word stands for more than enough.
"""

from __future__ import annotations

import contextlib
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from elftools.elf.elffile import ELFFile
from elftools.elf.sections import SymbolTableSection
from frames import FLAG, fcs16, frame, unescape

MACHINE = "netduinoplus2"
PROGRAM = "qemu-system-arm"
NODE = 16
SP, PC = 13, 15
TIMEOUT_SECONDS = 1
INTERRUPTED, TRAPPED = "T02", "T05"

# The emulated line has no rate of its own and gives the program a byte when it has taken the one
# before; the emulated timer counts twelve times too fast. So a request goes out in one piece, and
# time is counted in instructions (of 16 ns): a busy host makes no gaps.
TIME = ["-icount", "shift=4"]
TURNAROUND_SECONDS = 0.05


def missing() -> str:
    """Why it cannot run here; empty if it can."""
    return "" if shutil.which(PROGRAM) else f"{PROGRAM} is not installed: run tools/setup test"


@cache
def symbols(image: Path) -> dict[str, int]:
    """Names and addresses of the image."""
    with image.open("rb") as file:
        table = ELFFile(file).get_section_by_name(".symtab")
        assert isinstance(table, SymbolTableSection)
        return {symbol.name: int(symbol["st_value"]) for symbol in table.iter_symbols()}


SIZE_AT = "stm32_part_flash_kb_at"
FLASH_BASE = 0x0800_0000


def with_flash_size(image: Path, folder: Path) -> Path:
    """A copy of the image that finds the size of the flash."""
    content = bytearray(image.read_bytes())
    with image.open("rb") as file:
        (place,) = ELFFile(file).address_offsets(symbols(image)[SIZE_AT], 4)
    content[place : place + 4] = FLASH_BASE.to_bytes(4, "little")
    copy = folder / image.name
    copy.write_bytes(content)
    return copy


def unframe(received: bytes) -> bytes:
    """The message of an answer, whose FCS must be right."""
    inner = unescape(received.strip(bytes([FLAG])))
    assert fcs16(inner[:-2]) == int.from_bytes(inner[-2:], "little")
    return inner[2:-2]


class Gdb:
    """As much of gdb's remote protocol as stops the processor and changes it."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection

    def call(self, command: str) -> str:
        """Send a packet and return the answer's content."""
        self.send(command)
        return self.receive()

    def send(self, command: str) -> None:
        data = command.encode()
        self._socket.sendall(b"$%s#%02x" % (data, sum(data) % 256))

    def receive(self) -> str:
        """The next packet; acknowledged."""
        data = b""
        while not (b"#" in data and len(data.rpartition(b"#")[2]) == 2):
            data += self._socket.recv(1)
        self._socket.sendall(b"+")
        return data[data.index(b"$") + 1 : data.rindex(b"#")].decode()

    def stop(self) -> None:
        """Stop the processor where it is; there may be older news to be read first."""
        self._socket.sendall(b"\x03")
        self._await(INTERRUPTED)

    def stop_at(self, function: int) -> None:
        """Stop the processor where a function begins."""
        self.stop()
        place = f"{function & ~1:x},2"  # an odd address says that it is Thumb code
        assert self.call(f"Z0,{place}") == "OK"
        self.go()
        self._await(TRAPPED)
        assert self.call(f"z0,{place}") == "OK"

    def _await(self, reason: str) -> None:
        while not self.receive().startswith(reason):
            pass

    def go(self) -> None:
        """Let it run again."""
        self.send("c")

    def set_register(self, number: int, value: int) -> None:
        assert self.call(f"P{number:x}={value.to_bytes(4, 'little').hex()}") == "OK"

    def read_words(self, address: int, count: int) -> list[int]:
        data = bytes.fromhex(self.call(f"m{address:x},{4 * count:x}"))
        return [int.from_bytes(data[i : i + 4], "little") for i in range(0, 4 * count, 4)]


class Emulator:
    """A running board."""

    def __init__(self, line: socket.socket, gdb: Gdb) -> None:
        self._line = line
        self.gdb = gdb

    def ask(self, message: bytes, number: int = 1, node: int = NODE) -> bytes:
        """Send a request and return its answer; empty if none came in time."""
        time.sleep(TURNAROUND_SECONDS)
        self._line.sendall(frame(node, number, message))
        return self.answer()

    def answer(self) -> bytes:
        received = b""
        with contextlib.suppress(TimeoutError):
            while received.count(FLAG) < 2 or received[-1] != FLAG:
                received += self._line.recv(1)
        return unframe(received) if received else b""

    def ask_repeatedly(self, message: bytes, number: int, tries: int = 20) -> bytes:
        """The same request until it is answered; the unit executes it once."""
        for _ in range(tries):
            if answer := self.ask(message, number):
                return answer
        return b""

    def ask_until_answered(self, message: bytes, tries: int = 20) -> bytes:
        """The same again and again, as long as the board is starting."""
        for number in range(1, tries + 1):
            if answer := self.ask(message, number):
                return answer
        return b""


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def connect(port: int) -> socket.socket:
    """Connect to a server that may be starting."""
    for _ in range(100):
        try:
            connection = socket.create_connection(("127.0.0.1", port))
            connection.settimeout(TIMEOUT_SECONDS)
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return connection
        except ConnectionRefusedError:
            time.sleep(0.1)
    raise TimeoutError(f"nobody listens at port {port}")


@contextlib.contextmanager
def emulator(image: Path) -> Iterator[Emulator]:
    """Start a board; it is running when this returns."""
    line_port, gdb_port = free_port(), free_port()
    with contextlib.ExitStack() as ending:
        folder = Path(ending.enter_context(TemporaryDirectory()))
        command = [
            PROGRAM, "-M", MACHINE, *TIME, "-display", "none", "-monitor", "none",
            "-kernel", str(with_flash_size(image, folder)),
            "-serial", f"tcp:127.0.0.1:{line_port},server=on,wait=off",
            "-gdb", f"tcp:127.0.0.1:{gdb_port}",
        ]  # fmt: skip
        process = ending.enter_context(subprocess.Popen(command))
        ending.callback(process.kill)
        line = ending.enter_context(connect(line_port))
        gdb = Gdb(ending.enter_context(connect(gdb_port)))
        gdb.call("?")
        gdb.call("qXfer:features:read:target.xml:0,ffb")  # else it takes no registers
        gdb.go()
        yield Emulator(line, gdb)
