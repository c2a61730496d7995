"""Modbus TCP in front of a virtual unit: a gateway to its line, where RTU is spoken.

A request goes on as it is, with the unit identifier as the address, and its answer comes back as
it is; what does not come is exception 0Bh. One request at a time, whoever asks.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import signal
import sys
from contextlib import suppress

from pymodbus.framer import FramerRTU
from pymodbus.pdu import DecodePDU

from rkm04_tools import child, serve
from rkm04_tools.failure import DONE, NOT_SO, Failure
from rkm04_tools.positioning import host
from rkm04_tools.positioning.master import more_seconds

BROADCAST = 0
TARGET_FAILED = 0x0B
HEAD_BYTES = 6
PDU_BYTES_MAX = 253
ANSWER_SECONDS = 1.0
"""More than the longest frames take, there and back, at 9600 Bd."""
TURN_SECONDS = 0.1
"""What a unit is given for a broadcast, which it does not answer."""
START_SECONDS = 0.1
"""In which a unit that was switched on is ready to answer."""
DEFAULT_ADDRESS = "127.0.0.1"
LINE_BYTES = 4096


class Gateway:
    """The line, and those who ask."""

    def __init__(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, slowness: float
    ) -> None:
        self._reader = reader
        self._writer = writer
        self.slowness = slowness
        self._turn = asyncio.Lock()
        self._framer = FramerRTU(DecodePDU(False))
        self._clients: set[asyncio.StreamWriter] = set()

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer a client until it goes, or until what it sends is no Modbus TCP."""
        self._clients.add(writer)
        with suppress(asyncio.IncompleteReadError, OSError, asyncio.CancelledError):
            while request := await read_request(reader):
                head, unit, pdu = request
                async with self._turn:
                    answer = await self._ask(unit, pdu)
                if answer:
                    length = (len(answer) + 1).to_bytes(2, "big")
                    writer.write(head[:4] + length + bytes([unit]) + answer)
                    await writer.drain()
        self._clients.discard(writer)
        writer.close()

    def close(self) -> None:
        """Let all clients go."""
        for client in self._clients:
            client.close()

    async def _ask(self, unit: int, pdu: bytes) -> bytes:
        """The answer of a unit; empty for a broadcast."""
        await self._drop_late()
        self._writer.write(self._framer.encode(pdu, unit, 0))
        await self._writer.drain()
        if unit == BROADCAST:
            await asyncio.sleep(TURN_SECONDS * self.slowness)
            return b""
        seconds = ANSWER_SECONDS + more_seconds(pdu)
        try:
            async with asyncio.timeout(seconds * self.slowness):
                return await self._hear(unit, pdu[0])
        except TimeoutError:
            return bytes([pdu[0] | 0x80, TARGET_FAILED])

    async def _drop_late(self) -> None:
        """Forget what was answered too late."""
        with suppress(TimeoutError):
            while True:
                async with asyncio.timeout(0):
                    if not await self._reader.read(LINE_BYTES):
                        return

    async def _hear(self, unit: int, function: int) -> bytes:
        """Wait for the answer. What is damaged is passed over, and then none comes."""
        heard = b""
        while True:
            data = await self._reader.read(LINE_BYTES)
            if not data:
                raise ConnectionResetError
            heard += data
            used, address, _, pdu = self._framer.decode(heard)
            heard = heard[used:]
            if pdu and address == unit and pdu[0] & 0x7F == function & 0x7F:
                return pdu


async def read_request(reader: asyncio.StreamReader) -> tuple[bytes, int, bytes] | None:
    """The head, the unit and the PDU of the next request; None: that is no Modbus TCP."""
    head = await reader.readexactly(HEAD_BYTES)
    length = int.from_bytes(head[4:], "big")
    if head[2:4] != b"\0\0" or not 2 <= length <= 1 + PDU_BYTES_MAX:
        return None
    body = await reader.readexactly(length)
    return head, body[0], body[1:]


def run(options: argparse.Namespace, passed_on: serve.Passed) -> int:
    """Serve until a signal, or until the C program ends."""
    port = options.modbus_tcp
    if not (port.isascii() and port.isdigit() and int(port) < 65_536):
        raise Failure(f"--modbus-tcp {port}: write a port, 0 to 65535")
    host.program_path()
    return asyncio.run(_run(options, passed_on))


async def _run(options: argparse.Namespace, passed_on: serve.Passed) -> int:
    address = options.address[-1] if options.address else DEFAULT_ADDRESS
    speed = float(options.speed[-1]) if options.speed and _is_number(options.speed[-1]) else 1.0
    own = argparse.Namespace(**{**vars(options), "tcp": "0", "address": [], "json": True})
    unit = await asyncio.create_subprocess_exec(
        host.program_path(), "serve", *serve.arguments_of(own, passed_on),
        stdout=asyncio.subprocess.PIPE, env=child.bound(), limit=1 << 20,
    )  # fmt: skip
    assert unit.stdout is not None
    ready = await unit.stdout.readline()
    if not ready:
        return await unit.wait()
    loop = asyncio.get_running_loop()
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        with suppress(AttributeError, NotImplementedError):  # Windows: Ctrl-C reaches the unit, too
            loop.add_signal_handler(getattr(signal, name), _end, unit)
    told = json.loads(ready)
    place, _, line = told["listening"].removeprefix("socket://").rpartition(":")
    gateway = Gateway(*await asyncio.open_connection(place, int(line)), max(1.0, 1 / (speed or 1)))
    try:
        server = await asyncio.start_server(gateway.serve, address, int(options.modbus_tcp))
    except OSError as error:
        _end(unit)
        await unit.wait()
        reason = (error.strerror or str(error)).lower()
        raise Failure(f"--modbus-tcp {options.modbus_tcp}: {reason}; name another port") from None
    await asyncio.sleep(START_SECONDS * gateway.slowness)
    told["listening"] = "modbus://{}:{}".format(*server.sockets[0].getsockname()[:2])
    _tell_ready(told, options)
    while answer := await unit.stdout.readline():
        sys.stdout.write(answer.decode())
        sys.stdout.flush()
    server.close()
    gateway.close()
    if await unit.wait() != DONE:
        raise Failure("the virtual unit has ended by itself; start it again", NOT_SO)
    return DONE


def _is_number(text: str) -> bool:
    with suppress(ValueError):
        float(text)
        return True
    return False


def _end(unit: asyncio.subprocess.Process) -> None:
    with suppress(ProcessLookupError):
        unit.terminate()


def _tell_ready(told: dict[str, object], options: argparse.Namespace) -> None:
    if options.json:
        print(json.dumps(told), flush=True)
        return
    control = f", control on {told['control']}" if told["control"] else ""
    print(f"listening on {told['listening']}{control}", flush=True)
