"""What a GVE134 unit remembers besides its motion: what is in force, status, memory, outputs.

Written from the contract alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from gve_vector import PERCENT, Entry, Four
from gve_words import SPEED_MAX

MEMORY_BYTES = 256
RELAY, POLARITY, COUPLING, MADE, BRAKE = 0x01, 0x05, 0x0C, 0xF8, 0xFD
BRAKE_MAX = 0x32
BRAKE_FUNCTION, INTERRUPT_FUNCTION = 8, 9
RELAY_BITS = {0: 0, 1: 0, 2: 2, 3: 3, 4: 4, 5: 5, 6: 6}
OUTPUT_BITS = {4: 0, 5: 2, 6: 3, 7: 1}
"""Of each binary output, BO5 to BO8, the bit of port 0."""

OFF = 0xFF
INPUTS = (1, 2, 3, 4, 7, 8)
STOP, NO_CRYSTAL, RESTARTED, INTCOM, FULL, RUN, INTA = 0, 2, 3, 4, 5, 6, 7


@dataclass
class Modal:
    """What the next vector is entered with."""

    speed: int = 1000
    accel: int = 20
    border: int = SPEED_MAX
    short_below: int = 512
    pause_ms: int = 1
    corrected: bool = False
    limits: Four | None = None
    jumps: Four = (0, 0, 0, 0)
    factor: int = 100 * PERCENT

    def entry(self, steps: Four, own_speed: int = 0) -> Entry:
        """Return a vector as it is entered."""
        return Entry(
            steps,
            self.speed,
            self.accel,
            self.border,
            self.short_below,
            self.corrected,
            self.limits,
            self.jumps,
            self.pause_ms,
            self.factor,
            own_speed,
        )


def delivered() -> bytearray:
    """The memory as delivered."""
    memory = bytearray(b"\xff" * MEMORY_BYTES)
    memory[RELAY], memory[BRAKE] = 0, 0x0A
    return memory


@dataclass
class State:
    """All of it; a reset keeps the memory and the levels of the inputs."""

    modal: Modal = field(default_factory=Modal)
    status: list[int] = field(default_factory=lambda: [0] * 6)
    """ST0 to ST5."""
    inta: bool = False
    intcom: bool = False
    fault: int = 0
    """The bit of ST6 that says why there is no motion; 0: there is."""
    memory: bytearray = field(default_factory=delivered)
    port: int = OFF
    pwm: int = 0
    levels: dict[int, int] = field(default_factory=lambda: dict.fromkeys(INPUTS, 1))
    latched: tuple[frozenset[int], ...] = (frozenset({0}),) * 4
    """PL: of each axis the positions that are right."""
    released: bool = False
    """The brake, by the time since the start."""

    def reset(self) -> State:
        """Return the state after a reset; a crystal that does not run is still none."""
        fault = self.fault if self.fault == NO_CRYSTAL else 0
        return State(memory=self.memory, levels=self.levels, fault=fault, inta=bool(fault))

    @property
    def follows(self) -> int | None:
        """The axis with which A is coupled."""
        axis = self.memory[COUPLING]
        return axis - 1 if 1 <= axis <= 3 else None

    @property
    def outputs(self) -> int:
        """The levels of the binary outputs; bit 0 is BO1."""
        function = self.memory[RELAY]
        relay = False
        if function in RELAY_BITS:
            relay = not self.port >> RELAY_BITS[function] & 1
        elif function == BRAKE_FUNCTION:
            relay = self.released and not self.fault
        elif function == INTERRUPT_FUNCTION:
            relay = self.inta
        levels = sum(1 << bo for bo, bit in OUTPUT_BITS.items() if not self.port >> bit & 1)
        return levels | relay

    @property
    def signals(self) -> dict[str, int]:
        """The levels of all that can be seen besides the pulses."""
        outputs, polarity = self.outputs, self.memory[POLARITY]
        falls = (not polarity >> axis & 1 for axis in range(4))
        turned = (not polarity >> axis + 4 & 1 for axis in range(4))
        return {
            "outputs": outputs,
            "pwm": self.pwm,
            "led 3": outputs & 1,
            **{f"led {3 + bi}": int(not self.levels[bi]) for bi in range(1, 5)},
            **{
                f"polarity {motor}": a | b << 1
                for motor, (a, b) in enumerate(zip(falls, turned, strict=True), start=1)
            },
        }

    def port_levels(self, port: int) -> int:
        """What I1 or I2 reads."""
        inputs = {1: {0: 1, 1: 2, 2: 3, 3: 4}, 2: {6: 7, 7: 8}}[port]
        return OFF - sum(1 << bit for bit, bi in inputs.items() if not self.levels[bi])

    def active(self, port: int) -> int:
        """The INTR of an input port that are active."""
        used = {1: 0x0F, 2: 0xC0}[port]
        high = self.status[1 + port]
        return ~(self.port_levels(port) ^ high) & used

    @property
    def causes(self) -> tuple[int, int]:
        """The enabled INTR that are active: those of ST4, and of ST5."""
        return self.active(1) & self.status[0], self.active(2) & self.status[1]

    def switch_active(self, axis: int) -> bool:
        """Whether the reference switch of an axis is active, enabled or not."""
        return bool(self.active(1) >> axis & 1)

    def made(self) -> str:
        """What Q answers."""
        return self.memory[MADE : MADE + 4].hex().upper()
