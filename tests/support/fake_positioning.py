"""A positioning unit as a PLC sees it: registers and states, with ways in floating point.

It stands for the unit in tests of PLC programs: instructions, refusals, the records and their bits
are as the documents say, pulses are left out. Time goes on in passes of a millisecond.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from checks import plc, registers

TEXT = registers.TABLE.read_text(encoding="utf-8")
BITS = {name: 1 << bit for name, (_, bit) in plc.read_bits(TEXT).items()}
CODES = plc.read_instructions(TEXT)
ROWS = {row.name: row for row in registers.read_registers(TEXT) if row.scope == "A"}
IMAGES = {
    image.first + axis * len(image.numbers) + place: (axis, number)
    for image in registers.read_images(TEXT)
    for axis in range(registers.AXES)
    for place, number in enumerate(image.numbers)
}
IMAGE_OUT, IMAGE_IN = (
    image.first for image in registers.read_images(TEXT) if image.name.startswith("FULL")
)
FEED_UNIT = 3932160.0  # of the unit in 1 mm/s
FAULTS = (7, 8, 10, 11)
NO_DISP, IN_MOTION, TOO_FAR, NO_ACCEL, NO_METHOD, NO_SPACE, STANDS_FAULT = 3, 4, 5, 6, 13, 2, 15
HOMING_MS = 40


Tell = Callable[[list[int] | None, list[list[int]] | None], None]


def signed(value: int) -> int:
    """32 bits of two's complement as a number."""
    return (value + 2**31) % 2**32 - 2**31


@dataclass
class FakeAxis:
    """One axis; `written` are its registers 0 to 7."""

    written: list[int] = field(default_factory=lambda: [0] * 8)
    done: int = 0
    result: int = 0
    error: int = 0
    bits: int = 0
    mp: bool = False
    feed: int = 0
    position: float = 0.0  # um
    target: float = 0.0
    speed: float = 0.0  # mm/s
    accel: float = 1.0
    waits: tuple[int, float, float] | None = None  # a measure given while the axis brakes
    homing: tuple[int, int] | None = None  # position of the reference, passes left
    captures: int = 0
    captured: float = 0.0
    armed: bool = False
    referenced: bool = False
    executed: list[int] = field(default_factory=list)  # codes, refused ones too
    way_made: float = 0.0

    def has(self, name: str) -> bool:
        return bool(self.bits & BITS[name])

    def put(self, name: str, value: bool) -> None:
        self.bits = self.bits | BITS[name] if value else self.bits & ~BITS[name]

    def instruct(self) -> None:
        """Executes INSTRUCTION, if it is another one than the last."""
        if self.written[0] == self.done:
            return
        self.done = self.written[0]
        code = self.done & 0xFF
        self.result = 0
        if code == 0:
            return
        self.executed.append(code)
        name = next(name for name, number in CODES.items() if number == code)
        self.result = getattr(self, f"do_{name.lower()}")()
        if self.result:
            self.put("ERR", True)
            self.error = self.error or self.result

    def control(self) -> None:
        """POS_CONTROL: CONTROL and FEED as they are written."""
        if self.has("DISP"):
            self.mp = bool(self.written[5] & 1)
        if self.has("PROG"):
            self.feed = self.written[6] << 16 | self.written[7]

    def forget(self) -> None:
        self.bits &= ~(BITS["PROG"] | BITS["POL"] | BITS["ERR"])
        self.error = self.feed = 0
        self.waits = self.homing = None

    def do_pos_init(self) -> int:
        if self.written[1] > 6:
            return NO_SPACE
        self.forget()
        self.put("DISP", True)
        self.mp = True
        return 0

    def do_pos_reset(self) -> int:
        self.forget()
        self.put("DISP", False)
        self.mp = False
        return 0

    def refusal(self, way: float, accel: int) -> int:
        if not self.has("DISP"):
            return NO_DISP
        if self.has("ERR") and self.error in FAULTS:
            return STANDS_FAULT
        if self.has("PROG") and self.has("JEDE"):
            return IN_MOTION
        return NO_ACCEL if accel == 0 else TOO_FAR if abs(way) > 2**31 - 1 else 0

    def measure(self, code: int) -> int:
        length = signed(self.written[2] << 16 | self.written[3])
        if refused := self.refusal(length, self.written[4]):
            return refused
        self.put("PROG", True)
        self.put("POL", False)
        self.feed = 0
        self.waits = (code, length, self.written[4])
        if not self.has("JEDE"):
            self.begin()
        return 0

    def do_pos_mode(self) -> int:
        return self.measure(CODES["POS_MODE"])

    def do_pos_mode_abs(self) -> int:
        return self.measure(CODES["POS_MODE_ABS"])

    def do_pos_home(self) -> int:
        if self.has("DISP") and self.written[1] not in (19, 21, 37):
            return NO_METHOD
        return self.measure(CODES["POS_HOME"])

    def do_pos_capture(self) -> int:
        self.armed = True
        return 0

    def begin(self) -> None:
        """The initiator: the axis stands, a measure waits."""
        assert self.waits is not None
        code, length, accel = self.waits
        self.waits, self.accel = None, accel
        if code == CODES["POS_HOME"]:
            self.homing = (int(length), 0 if self.written[1] == 37 else HOMING_MS)
            if self.written[1] == 37:
                self.home()
            return
        start = self.position if code == CODES["POS_MODE"] else 0.0
        self.target = start + length
        self.put("POL", self.target == self.position)

    def home(self) -> None:
        assert self.homing is not None
        self.position = self.target = self.homing[0]
        self.homing, self.referenced = None, True
        self.put("POL", True)
        self.put("JEDE", False)

    def fault(self, number: int) -> None:
        """A fault: brakes, and ends the measure."""
        self.forget()
        self.put("ERR", True)
        self.error = number

    def capture(self) -> None:
        """An edge on the input CAPTURE."""
        if self.armed:
            self.armed = False
            self.captures = (self.captures + 1) % 65536
            self.captured = self.position

    def step(self) -> None:
        """A millisecond."""
        measured = self.has("PROG") and not self.has("POL") and not self.waits
        wanted = self.feed / FEED_UNIT if self.mp and measured else 0.0
        if self.homing is not None:
            if wanted > 0:
                self.put("JEDE", True)
                self.homing = (self.homing[0], self.homing[1] - 1)
                if self.homing[1] <= 0:
                    self.home()
            return
        left = self.target - self.position
        if measured and not wanted and not self.speed:
            return
        self.ramp(wanted, left if measured else math.inf)
        if measured and abs(left) <= max(self.speed, 0.001):
            self.way_made += abs(left)
            self.position, self.speed = self.target, 0.0
            self.put("POL", True)
        elif self.speed > 0:
            way = math.copysign(self.speed, left) if measured else self.coast()
            self.put("SMER", way < 0)
            self.position += way
            self.way_made += abs(way)
        self.put("JEDE", self.speed > 0)
        if self.speed == 0 and self.waits:
            self.begin()

    def coast(self) -> float:
        return -self.speed if self.has("SMER") else self.speed

    def ramp(self, wanted: float, left: float) -> None:
        """The speed of the next millisecond, in mm/s, which is um/ms."""
        change = self.accel / 1000.0
        top = math.sqrt(2.0 * self.accel * abs(left) / 1000.0) if left < math.inf else wanted
        wanted = min(wanted, max(top, change))
        if self.speed < wanted:
            self.speed = min(self.speed + change, wanted)
        else:
            self.speed = max(self.speed - change, wanted)

    def values(self) -> list[int]:
        """The registers 10 to 27."""
        flags = BITS["REFERENCED"] * self.referenced | BITS["ARMED"] * self.armed
        flags |= BITS["HOMING"] * (self.homing is not None)
        left = self.target - self.position if self.has("PROG") else 0.0
        wide = [
            self.position, left, self.speed * FEED_UNIT, self.position, self.captured, self.captured
        ]  # fmt: skip
        words = [self.bits, self.error, self.done, self.result, flags, self.captures]
        for value in wide:
            words += [int(value) >> 16 & 0xFFFF, int(value) & 0xFFFF]
        return words


@dataclass
class FakeUnit:
    """Four axes behind the registers of the line."""

    axes: list[FakeAxis] = field(default_factory=lambda: [FakeAxis() for _ in range(4)])

    def place(self, number: int) -> tuple[int, int]:
        """The axis, from 0, and the register of it that a number of the line is."""
        return IMAGES[number] if number in IMAGES else (number // 100 - 1, number % 100)

    def write(self, first: int, values: list[int]) -> None:
        touched = set()
        for number, value in enumerate(values, first):
            axis, register = self.place(number)
            self.axes[axis].written[register] = value
            touched.add(axis)
        for axis in sorted(touched):
            self.axes[axis].instruct()
        for axis in sorted(touched):
            self.axes[axis].control()

    def read(self, first: int, count: int) -> list[int]:
        values = []
        for number in range(first, first + count):
            axis, register = self.place(number)
            values.append(self.axes[axis].values()[register - plc.IN_FIRST])
        return values

    def ask(self, out: list[int] | None, asks: bool, tell: Tell) -> None:
        """A request of the full image, which writes, reads or both; `tell` gets the answer."""
        if out is not None:
            self.write(IMAGE_OUT, out)
        captured = [self.read(100 * axis + 24, 2) for axis in range(1, len(self.axes) + 1)]
        tell(self.read(IMAGE_IN, 8 * len(self.axes)) if asks else None, captured)

    def step(self) -> None:
        for axis in self.axes:
            axis.step()

    def restart(self) -> None:
        """Power goes and comes: all is forgotten, and the axes stand where they are."""
        for number, axis in enumerate(self.axes):
            fresh = FakeAxis(way_made=axis.way_made)
            self.axes[number] = fresh
