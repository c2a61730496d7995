"""A GVE134 unit for tests of its client: the second implementation of its line, by the contract.

It keeps the rules of firmware/gve134/docs/line.md for bytes, checksums, damage, packets, `@` and
`>`, and those of the queue as far as a host sees them. It moves nothing: a vector takes `vector_s`
seconds whatever it is, and its parts are added to the positions at its end. Time is told to it, so
that it runs in real time as well as in virtual time. It shares no code with the client.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from fake_gve134_receiver import NEVER, Receiver, checksum

PLACES = 128

# Name: least and most parameters. The longest name that fits is meant.
NAMES = {
    "?": (0, 0), "Q": (0, 0), "L": (1, 4), "C": (1, 4), "T": (1, 1), "$": (1, 1), "A": (1, 1),
    "V": (1, 1), "B": (1, 1), "VK": (0, 0), "VN": (0, 0), "VL": (4, 4), "VJ": (4, 4), "XA": (0, 0),
    "XU": (0, 0), "XD": (0, 0), "XM": (1, 1), "P": (0, 0), "PF": (0, 0), "P4": (0, 0),
    "PL": (0, 0), "N": (0, 2), "W": (5, 5), "H": (0, 0), "G": (0, 0), "D": (0, 0), "K": (0, 0),
    "R": (0, 0), "SR": (1, 1), "SW": (2, 2), "F": (0, 0), "I1": (0, 0), "I2": (0, 0), "O": (2, 2),
    "ER": (1, 1), "EUR": (1, 1), "EFR": (1, 1), "EW": (2, 2), "EUW": (2, 2), "EFW": (2, 2),
    "@": (0, 0), ">": (0, 0), "%+": (0, 0), "%-": (0, 0), "*S": (0, 0), "*E": (1, 1), "J": (0, 0),
}  # fmt: skip
OF_SPINDLE = {"V", "?", "Q", ">", "@", "J", "%+", "%-", "ER", "EUR", "EFR", "EW", "EUW", "EFW"}
RANGES = {"V": (10, 200_000), "B": (10, 200_000), "A": (1, 8000), "XM": (1, 1000), "T": (1, 24)}
AXES = "XYZA"


Fault = Callable[[bytes], bytes]
"""Makes what goes back to the host out of the answer's bytes."""


def lost(answer: bytes) -> bytes:
    """Nothing arrives."""
    return b""


def damaged(answer: bytes) -> bytes:
    """A bit is wrong."""
    return answer[:-2] + bytes([answer[-2] ^ 1]) + answer[-1:]


def cut_off(answer: bytes) -> bytes:
    """The end is missing."""
    return answer[:-2]


@dataclass
class Vector:
    parts: tuple[int, ...]


@dataclass
class FakeGve:
    """A unit. `taken` are the vectors that it has taken, in order; `done` every command."""

    name: str = "IP134/200 v1 22.11.2026"
    vector_s: float = 0.002
    brake_s: float = 0.01
    home_s: float = 0.05
    home_answer: int = 0
    """Code of W: 0, or 5 with INTA for a switch that was not found."""
    taken: list[tuple[int, ...]] = field(default_factory=list)
    done: list[str] = field(default_factory=list)
    codes: dict[str, int] = field(default_factory=dict)
    """Codes that are not to be the usual ones, by command."""
    memory: bytearray = field(default_factory=lambda: bytearray(b"\xff\x00" + b"\xff" * 254))
    stuck: set[int] = field(default_factory=set)
    """Places of the memory that do not take what is written."""
    faults: deque[Fault] = field(default_factory=deque)
    """Used up one by one, one for each answer."""
    restart_after: int = -1
    """Restarts by itself when so many further commands were executed."""
    restarts_at: str = ""
    """Restarts by itself, once, instead of executing this."""
    mute: bool = False
    now: float = 0.0
    out: bytearray = field(default_factory=bytearray)

    def __post_init__(self) -> None:
        self.restart()

    def restart(self, by_fault: bool = False) -> None:
        self.receiver = Receiver(self._keep)
        self.index = 0
        self.last = b"0\r"
        self.positions = [0, 0, 0, 0]
        self.latched = [0, 0, 0, 0]
        self.status = [0] * 8
        self.queue: deque[Vector] = deque()
        self.kept: deque[Vector] | None = None
        self.kept_status = [0, 0, 0]
        self.inta = by_fault
        self.status[6] = 8 if by_fault else 0
        self.motion_end = NEVER
        self.brake_end = NEVER
        self.home_end = NEVER
        self.causes = (0, 0)
        self.waiting: deque[str] = deque()  # H and W that are to be answered when the axes stand
        self.backlog: deque[tuple[str, bytes]] = deque()
        self.ports = {"I1": 0xFF, "I2": 0xFF, "O": 0xFF, "spindle": 0}
        self.modal: dict[str, str] = {}

    # ---- time ----

    @property
    def run(self) -> bool:
        return bool(self.queue) or self.home_end < NEVER

    @property
    def moves(self) -> bool:
        return min(self.motion_end, self.brake_end, self.home_end) < NEVER

    def wake(self) -> float:
        """When something happens by itself next."""
        return min(self.motion_end, self.brake_end, self.home_end, self.receiver.wake())

    def take(self, data: bytes) -> None:
        """Bytes that arrive now."""
        for byte in data:
            self.receiver.take(bytes([byte]), self.now)

    def advance(self, to: float) -> None:
        """Let time pass."""
        while (due := self.wake()) <= to:
            self.now = max(due, self.now)
            self._happen()
        self.now = max(self.now, to)

    def _happen(self) -> None:
        if self.brake_end <= self.now:
            self._stand()
        elif self.motion_end <= self.now:
            self._end_vector()
        elif self.home_end <= self.now:
            self._end_home()
        else:
            self.receiver.end_silence()

    def _begin(self) -> None:
        if self.queue and not self.inta and not self.moves:
            self.motion_end = self.now + self.vector_s

    def _end_vector(self) -> None:
        self.motion_end = NEVER
        vector = self.queue.popleft()
        self.positions = [a + b for a, b in zip(self.positions, vector.parts, strict=True)]
        self._begin()

    def _stand(self) -> None:
        self.brake_end = NEVER
        self.inta = True
        self.status[6] &= ~1
        self.status[4] |= self.causes[0]
        self.status[5] |= self.causes[1]
        self.causes = (0, 0)
        self._answer_waiting()

    def _end_home(self) -> None:
        self.home_end = NEVER
        if self.home_answer:
            self.inta = True
        self.waiting.remove("W")
        self._answer(self.home_answer)
        self._next()

    def interrupt(self, st4: int = 0, st5: int = 0) -> None:
        """An enabled INTR becomes active while vectors run."""
        self.latched = list(self.positions)
        self.causes = (st4, st5)
        self._brake()

    def _brake(self) -> None:
        if self.home_end < NEVER:
            self.home_end = NEVER
        self.motion_end = NEVER
        self.status[6] |= 1
        self.brake_end = min(self.brake_end, self.now + self.brake_s)

    def _answer_waiting(self) -> None:
        waiting, self.waiting = self.waiting, deque()
        for _ in waiting:
            self._answer(0)
        self._next()

    # ---- commands in their order ----

    def _keep(self, kind: str, line: bytes) -> None:
        text = line.decode("latin-1").upper()
        if kind == "command" and self.waiting and text in ("0H", "0J", "7J"):
            self._execute(text)
            return
        self.backlog.append((kind, line))
        self._next()

    def _next(self) -> None:
        while self.backlog and not self.waiting:
            kind, line = self.backlog.popleft()
            if kind == "damage":
                self._send(line)
            else:
                self._execute(line.decode("latin-1").upper())

    def _execute(self, text: str) -> None:
        address, body = text[0], text[1:]
        name = max((n for n in NAMES if body.startswith(n)), key=len, default="")
        if body in ("@", ">"):
            if self.receiver.packet is not None:
                self.receiver.wrong = self.receiver.wrong or "4"
                return
            self._send(b"0,%d" % self.index if body == "@" else b"", apart=True)
            return
        if self.restart_after == 0 or body == self.restarts_at:
            self.restart_after, self.restarts_at = -1, ""
            self.restart()
            return
        self.restart_after -= 1
        self.index = (self.index + 1) % 256
        self.done.append(body if address == "0" else f"!7{body}")
        parameters = self._split(name, body)
        code = self._refusal(address, name, parameters)
        if self.receiver.packet is not None and name not in ("H", "J", "*S", "*E"):
            self._take_in_packet(name, parameters, code)
            return
        if code == 0 and body in self.codes:
            code = self.codes[body]
        if code:
            self._answer(code)
            return
        if name == "V" and address == "7":
            self.ports["spindle"] = int(parameters[0])
            self._answer(0)
            return
        self._act(name, parameters)

    def _split(self, name: str, body: str) -> list[str]:
        rest = body[len(name) :]
        if name in ("N", "W") and rest:
            return [rest[0], *rest[1:].removeprefix(",").split(",")]
        return rest.split(",") if rest else []

    def _refusal(self, address: str, name: str, parameters: list[str]) -> int:
        if not name or (address == "7" and name not in OF_SPINDLE):
            return 3
        least, most = NAMES[name]
        if not least <= len(parameters) <= most or (name == "N" and len(parameters) == 1):
            return 4
        is_hex = name[0] in "E" or name in ("SW", "O")
        pattern = r"[0-9A-F]+" if is_hex else r"-?\d+"
        axis = name in ("N", "W")
        numbers = parameters[1:] if axis else parameters
        if name != "EFW" and not all(re.fullmatch(pattern, each) for each in numbers):
            return 4
        if axis and parameters and parameters[0] not in AXES:
            return 4
        if address == "7" and name == "V":
            return 0 if 0 <= int(parameters[0]) <= 1000 else 5
        low, high = RANGES.get(name, (-(2**31) + 1, 2**32))
        if not is_hex and not all(low <= int(each) <= high for each in numbers):
            return 5
        if name in ("N", "D", "K", "R", "EW", "EUW", "EFW") and self.run and not self.inta:
            return 7
        if name in ("N", "EW", "EUW", "EFW", "W") and self.run:
            return 7
        if name == "W" and self.inta:
            return 7
        return 7 if name in "LC" and self.status[6] & 0xC else 0

    # ---- what they do ----

    def _act(self, name: str, parameters: list[str]) -> None:
        acts: dict[str, Callable[[list[str]], None]] = {
            "H": self._halt, "G": self._go, "D": self._delete, "K": self._keep_queue,
            "R": self._restore, "J": self._reset, "*S": self._begin_packet, "*E": self._end_packet,
            "W": self._home, "N": self._set_position, "L": self._line, "C": self._continue,
        }  # fmt: skip
        if name in acts:
            acts[name](parameters)
        else:
            self._plain(name, parameters)

    def _plain(self, name: str, given: list[str]) -> None:
        readings: dict[str, Callable[[], str]] = {
            "?": lambda: self.name,
            "Q": lambda: "25022504",
            "P": lambda: self._told(self.positions[:2]),
            "PF": lambda: self._told(self.positions[:3]),
            "P4": lambda: self._told(self.positions),
            "PL": lambda: self._told(self.latched),
            "SR": lambda: f"{self._status(int(given[0])):02X}",
            "F": lambda: f"{self._status(6) | 0x20 * (len(self.queue) >= PLACES):02X}",
            "I1": lambda: f"{self.ports['I1']:02X}",
            "I2": lambda: f"{self.ports['I2']:02X}",
            "ER": lambda: f"{self.memory[int(given[0], 16)]:02X}",
            "EUR": lambda: f"{self._word(int(given[0], 16)):08X}",
            "EFR": lambda: "1.5",
        }
        values = readings.get(name)
        if name == "SR" and int(given[0]) > 7:
            self._answer(5)
            return
        if name == "%+":
            self.receiver.sums = True
        if name == "%-":
            self.receiver.sums = False
        if name == "SW":
            self.status[int(given[0])] = int(given[1], 16)
        if name == "O":
            self.ports["O"] = int(given[1], 16)
        if name in ("EW", "EUW"):
            place, value = int(given[0], 16), int(given[1], 16)
            for at, byte in enumerate(value.to_bytes(1 if name == "EW" else 4, "little"), place):
                self.memory[at] = self.memory[at] if at in self.stuck else byte
        if name in ("V", "A", "B", "T", "$", "VK", "VN", "VL", "VJ", "XM", "XA", "XU", "XD"):
            self.modal[name] = ",".join(given)
        self._answer(0, values() if values else "")

    def _told(self, positions: list[int]) -> str:
        return ",".join(str(each) for each in positions)

    def _word(self, place: int) -> int:
        return int.from_bytes(self.memory[place : place + 4], "little")

    def _status(self, number: int) -> int:
        if number != 6:
            return self.status[number]
        return self.status[6] & 0x1F | 0x40 * self.run | 0x80 * self.inta

    def _halt(self, _: list[str]) -> None:
        self.receiver.packet = None
        self.status[6] |= 0x10
        if self.moves:
            self.waiting.append("H")
            self._brake()
        else:
            self.inta = True
            self._answer(0)

    def _go(self, _: list[str]) -> None:
        if not self.inta or not self.queue:
            self.inta = self.inta and bool(self.status[6] & 0xC)
            self.status[4:6] = [0, 0]
            self.status[6] &= 0xC
            self._answer(6)
            return
        self.inta = False
        self.status[4:6] = [0, 0]
        self.status[6] &= 0xC
        self._begin()
        self._answer(0)

    def _delete(self, _: list[str]) -> None:
        self.queue.clear()
        self.status[4:7] = [0, 0, 0]
        self.inta = False
        self._answer(0)

    def _keep_queue(self, _: list[str]) -> None:
        if self.kept is not None:
            self._answer(1)
            return
        self.kept, self.kept_status = deque(self.queue), [*self.status[4:6], self._status(6)]
        self.queue.clear()
        self.status[4:7] = [0, 0, 0]
        self.inta = False
        self._answer(0)

    def _restore(self, _: list[str]) -> None:
        if self.kept is None:
            self._answer(6)
            return
        self.queue, self.kept = self.kept, None
        self.status[4:6] = self.kept_status[:2]
        self.status[6] = self.kept_status[2] & 0x1F
        self.inta = bool(self.kept_status[2] & 0x80)
        self._answer(0)

    def _reset(self, _: list[str]) -> None:
        inta, self.inta, self.waiting = self.inta, False, deque()
        self._answer(0)
        self.inta = inta
        self.restart()

    def _home(self, _: list[str]) -> None:
        self.waiting.append("W")
        self.home_end = self.now + self.home_s

    def _set_position(self, given: list[str]) -> None:
        if not given:
            self.positions = [0, 0, 0, 0]
        else:
            self.positions[AXES.index(given[0])] = int(given[1])
        self._answer(0)

    def _line(self, given: list[str]) -> None:
        if self.run:
            self._answer(1)
            return
        self._enter([given])
        self._answer(0)

    def _continue(self, given: list[str]) -> None:
        if not self._has_room(1):
            self._answer(1)
            return
        self._enter([given])
        self._answer(0)

    def _has_room(self, count: int) -> bool:
        return self.kept is None and len(self.queue) + count <= PLACES

    def _enter(self, vectors: list[list[str]]) -> None:
        for given in vectors:
            parts = tuple(int(each) for each in given) + (0,) * (4 - len(given))
            self.taken.append(parts)
            self.queue.append(Vector(parts))
        self._begin()

    # ---- packets ----

    def _begin_packet(self, _: list[str]) -> None:
        self.receiver.packet, self.receiver.wrong = [], ""

    def _take_in_packet(self, name: str, parameters: list[str], code: int) -> None:
        assert self.receiver.packet is not None
        self.receiver.packet.append((name, parameters))
        if name not in ("C", "B"):
            code = code or 4
        if code and not self.receiver.wrong:
            self.receiver.wrong = str(code)

    def _end_packet(self, given: list[str]) -> None:
        packet, self.receiver.packet = self.receiver.packet, None
        if packet is None:
            self._answer(4)
            return
        wrong = self.receiver.wrong
        if not wrong and len(packet) > PLACES:
            wrong = "5"
        if not wrong and int(given[0]) != len(packet):
            wrong = "2"
        vectors = [parameters for name, parameters in packet if name == "C"]
        if not wrong and not self._has_room(len(vectors)):
            wrong = "1"
        if wrong:
            self._answer(int(wrong), "0")
            return
        self._enter(vectors)
        self._answer(0, str(len(packet)))

    # ---- answers ----

    def _answer(self, code: int, values: str = "") -> None:
        digit = f"{code + 8 * self.inta:X}"
        self._send((f"{digit},{values}" if values else digit).encode("latin-1"))

    def _send(self, text: bytes, apart: bool = False) -> None:
        if text and text[:1] in b"02" and self.inta:
            text = (b"8" if text[:1] == b"0" else b"A") + text[1:]
        if not text:
            answer = self.last
        else:
            answer = text + (b"," + checksum(text + b",") if self.receiver.sums else b"") + b"\r"
        if not apart:
            self.last = answer
        if self.mute:
            return
        self.out += self.faults.popleft()(answer) if self.faults else answer
