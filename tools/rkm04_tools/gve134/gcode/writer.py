"""The lines of a vector file: modal commands where they change, vectors, outputs, directives.

Lines that begin with ;@ are for the host (see the README): a unit would not take them.
"""

from __future__ import annotations

from collections.abc import Callable

from rkm04_tools.gve134.gcode.axes import PULSES_LEAST, PULSES_TOP, Axis, Homing, Mill
from rkm04_tools.gve134.gcode.corners import Corners, Side

STEPS_MAX = 2_147_483_647
ACCEL_UNIT, ACCEL_TOP = 1000, 8000
NO_AXIS_SPEED = PULSES_TOP
AT_REST_S = 0.01
"""After an answered L0,0,0 the unit is at rest in so short a time, for W and N."""

PORT_OFF = 0xFF
SPINDLE_BIT, FLOOD_BIT, MIST_BIT = 0, 2, 3

Steps = tuple[int, int, int, int]


class TooSlow(Exception):
    """The unit has no speed as low as that."""


class Writer:
    """Writes lines, and counts them."""

    def __init__(self, mill: Mill, put: Callable[[str], object]) -> None:
        self.mill = mill
        self.vectors = 0
        self.slowed = 0
        """Vectors that an axis' limit makes slower than they should be."""
        self.port = PORT_OFF
        self.line = 0
        """The line of the program that is being turned."""
        self._put = put
        self._told_line = 0
        self._rate = 0
        self._accel = 0
        self._corrected = True
        self._moved = False
        self._port_told = False
        self._speeds = [axis.speed if axis else NO_AXIS_SPEED for axis in mill.axes]
        self._corners = Corners(mill) if mill.corner_deviation else None
        self._border = PULSES_TOP
        """B as it was written last."""
        self._held: tuple[str, Side | None] | None = None
        """A vector whose B follows from the next one."""
        self._slowest = min(self._speeds)
        """A rate up to that can be kept on any way of X, Y and Z."""
        self._accels = [axis.accel if axis else ACCEL_TOP * ACCEL_UNIT for axis in mill.axes]
        x_accel, y_accel, *_ = self._accels
        self._flat_accel = x_accel // ACCEL_UNIT if x_accel == y_accel else 0
        """As A has it, of ways of X and Y alone; 0: it depends on them."""

    def begin(self, name: str) -> None:
        """Write what holds for the whole file."""
        jumps = [axis.jump if axis else 0 for axis in self.mill.axes]
        self.say(f"; {_plain(name)}, for {_plain(self.mill.name)}; written by gve134 gcode")
        self.say("; ;@wait, ;@pause and ;@probe are for the host, gve134 send and sim")
        self.say("L0,0,0,0\nT1\nVK\nB200000")
        if self._corners:
            self.say("$1")  # else B would be the speed of short vectors
        self.say(f"VL{','.join(map(str, self._speeds))}")
        self.say(f"VJ{','.join(map(str, jumps))}")

    def say(self, text: str) -> None:
        """Write a line as it is; the axes stand before it, or it moves none."""
        if self._held:
            self._put(self._held[0])
            self._held = None
        self._put(f"{text}\n")

    def join(self, steps: Steps, extent: float, rate: float, is_rapid: bool = False) -> None:
        """Write a vector that joins the one before.

        Extent and rate are in pulses and pulses/s of X, Y and Z together, or of A if they rest; of
        a rapid one the axes' limits alone count.
        """
        modal = self._pace(steps, extent, rate, is_rapid)
        x, y, z, a = steps
        text = f"C{x},{y},{z},{a}\n"
        if self.line != self._told_line:
            self._told_line = self.line
            text = f"C{x},{y},{z},{a} ; line {self.line}\n"
        if self._corners:
            side = self._corners.side(steps, self._corrected)
            self._release(self._corners, side)
            self._held = (text, side)
            text = ""
        if modal or text:
            self._put(modal + text)
        self.vectors += 1
        self._moved = True

    def _release(self, corners: Corners, following: Side | None) -> None:
        """Write the vector that is held, with the speed of the corner at its end."""
        if self._held is None:
            return
        text, side = self._held
        border = corners.speed(side, following)
        if border != self._border:
            self._border = border
            text = f"B{border}\n{text}"
        self._put(text)

    def sync(self) -> None:
        """Wait until all that is before has been done."""
        if self._moved:
            self.say("L0,0,0,0")
            self._moved = False

    def wait(self, seconds: float) -> None:
        """Have the host wait; the axes stand."""
        if seconds > 0:
            self.say(f";@wait {seconds:.6f}".rstrip("0").rstrip("."))

    def pause(self, text: str) -> None:
        """Have the host wait for a person."""
        self.sync()
        self.say(f";@pause line {self.line}: {_plain(text)}")

    def home(self, axis: Axis, homing: Homing) -> None:
        """Write the reference run of an axis."""
        self.sync()
        self.wait(AT_REST_S)
        opens = (
            each.index for each in self.mill.axes if each and each.homing and each.homing.opens
        )
        self.say(f"SW2,{sum(1 << index for index in opens):02X}")
        self._put(self._accel_text(axis.accel // ACCEL_UNIT))
        run = (homing.way_steps, homing.speed, homing.back_steps, homing.back_speed)
        self.say(f"W{axis.letter}{','.join(map(str, run))} ; line {self.line}")
        self.say(f"N{axis.letter}{homing.position_steps}")

    def probe(self, steps: Steps, extent: float, rate: float) -> None:
        """Write a vector that the tool sensor ends, and have the host go back to where it did."""
        sensor = self.mill.probe
        assert sensor is not None
        bit = 1 << sensor.interrupt % 8
        self.sync()
        self.wait(AT_REST_S)
        self.say(f"SW3,{bit if sensor.opens else 0:02X}\nSW1,{bit:02X}")
        self._put(self._pace(steps, extent, rate, False))
        self.say(f"L{','.join(map(str, steps))} ; line {self.line}")
        self.say(";@probe")
        self.vectors += 1

    def turn_spindle(self, permille: int, is_reverse: bool) -> None:
        """Set the spindle's speed; 0 stops it."""
        self.sync()
        spindle = self.mill.spindle
        if permille and spindle and spindle.reverse_bit is not None:
            self._set_port({spindle.reverse_bit: is_reverse})
        self.say(f"!7V{permille}")
        off = 1 << SPINDLE_BIT
        self.port = self.port & ~off | (0 if permille else off)

    def cool(self, flood: bool, mist: bool) -> None:
        """Switch cooling and blow."""
        self._set_port({FLOOD_BIT: flood, MIST_BIT: mist})

    def _set_port(self, bits: dict[int, bool]) -> None:
        """Switch outputs, which are on where their bit is 0."""
        port = self.port
        for bit, is_on in bits.items():
            port = port & ~(1 << bit) | (0 if is_on else 1 << bit)
        if port != self.port or not self._port_told:
            self.sync()
            self.say(f"O0,{port:02X}")
        self.port, self._port_told = port, True

    def _pace(self, steps: Steps, extent: float, rate: float, is_rapid: bool) -> str:
        """V, VK or VN, and A where they change, as lines."""
        x, y, z, a = map(abs, steps)
        longest = max(x, y, z, a)
        if longest > STEPS_MAX:
            raise TooSlow(f"the way is longer than {STEPS_MAX} pulses of an axis; divide it")
        corrected = True
        if is_rapid or a or rate > self._slowest:
            v0, v1, v2, v3 = self._speeds
            limit = extent / max(x / v0, y / v1, z / v2, a / v3)
            if is_rapid:
                rate = max(limit, PULSES_TOP)
            elif rate > limit * 1.001:
                self.slowed += 1
            corrected = min(rate, limit) <= PULSES_TOP
        whole = PULSES_TOP if is_rapid else round(rate if corrected else rate * longest / extent)
        if whole < PULSES_LEAST:
            raise TooSlow(f"the feed is too low: the unit makes {PULSES_LEAST} pulses/s at least")
        modal = ""
        if corrected is not self._corrected:
            self._corrected = corrected
            modal = "VK\n" if corrected else "VN\n"
        if (whole := min(whole, PULSES_TOP)) != self._rate:
            self._rate = whole
            modal += f"V{whole}\n"
        accel = self._flat_accel
        if z or a or not accel:
            a0, a1, a2, a3 = self._accels
            least = longest / max(x / a0, y / a1, z / a2, a / a3)
            accel = int(least * (1 + 1e-12)) // ACCEL_UNIT
        return modal if accel == self._accel else modal + self._accel_text(accel)

    def _accel_text(self, accel: int) -> str:
        accel = min(accel, ACCEL_TOP)
        if accel == self._accel:
            return ""
        self._accel = accel
        return f"A{accel}\n"


def _plain(text: str) -> str:
    """What is safe in a line of a file."""
    return "".join(c if c.isprintable() else " " for c in text).strip()
