"""What a unit tells of itself: ST0 to ST7, F, its input ports, in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

AXES = ("X", "Y", "Z", "A")
INTERRUPTS = {0: "RefX", 1: "RefY", 2: "RefZ", 3: "RefA", 14: "sensor button", 15: "sensor plate"}
"""Names of INTR0 to INTR15: 0 to 7 are the bits of ST0, 2, 4 and of port 1, the others those of
ST1, 3, 5 and of port 2."""
STOP, NO_CRYSTAL, FAULT, INTCOM, FULL, RUN, INTA = 1, 4, 8, 16, 32, 64, 128

Positions = tuple[int, int, int, int]


@dataclass(frozen=True)
class Flags:
    """ST6, or what F answers: that has the bit that no vector fits."""

    bits: int

    def has(self, bit: int) -> bool:
        """Whether one of the bits is set."""
        return bool(self.bits & bit)

    @property
    def stands(self) -> bool:
        """Whether no axis moves: a vector that waits after an interrupt does not."""
        return self.has(INTA) or not self.has(RUN)

    @property
    def text(self) -> str:
        """The state in words."""
        if self.has(NO_CRYSTAL):
            return "no motion: its crystal does not run"
        if self.has(FAULT):
            return "no motion: restarted by its watchdog or a fault (gve134 delete clears it)"
        if not self.has(INTA):
            if not self.has(RUN):
                return "at rest"
            return "braking" if self.has(STOP) else "moving"
        if self.has(RUN):
            return "stopped, the rest of the vectors waits (gve134 go or delete)"
        return "stopped, nothing waits (gve134 delete clears it)"


def named(low: int, high: int) -> list[str]:
    """The names of the interrupts whose bits are set in a pair of statuses."""
    bits = low | high << 8
    return [INTERRUPTS.get(n, f"INTR{n}") for n in range(16) if bits >> n & 1]


@dataclass(frozen=True)
class Status:
    """All of it. `late` is None for a unit that does not count pulses made late."""

    registers: tuple[int, ...]
    flags: Flags
    ports: tuple[int, int]
    late: int | None

    @property
    def causes(self) -> list[str]:
        """What has stopped the axes last."""
        found = named(self.registers[4], self.registers[5])
        return found + (["H"] if self.flags.has(INTCOM) else [])

    def as_json(self) -> dict[str, Any]:
        """For scripts."""
        flags = self.flags
        return {
            "state": flags.text,
            "run": flags.has(RUN),
            "inta": flags.has(INTA),
            "stop": flags.has(STOP),
            "intcom": flags.has(INTCOM),
            "full": flags.has(FULL),
            "fault": flags.has(FAULT),
            "no_crystal": flags.has(NO_CRYSTAL),
            "causes": self.causes,
            "interrupts": self._interrupts(),
            "registers": {f"ST{n}": f"{value:02X}" for n, value in enumerate(self.registers)},
            "f": f"{flags.bits:02X}",
            "ports": {"I1": f"{self.ports[0]:02X}", "I2": f"{self.ports[1]:02X}"},
            "late_pulses": self.late,
        }

    def _interrupts(self) -> dict[str, dict[str, int]]:
        enabled, active, _ = (
            self.registers[n] | self.registers[n + 1] << 8 for n in (0, 2, 4)
        )  # fmt: skip
        inputs = self.ports[0] | self.ports[1] << 8
        return {
            name: {
                "enabled": enabled >> n & 1,
                "active_at": active >> n & 1,
                "input": inputs >> n & 1,
            }
            for n, name in INTERRUPTS.items()
        }

    def _unnamed(self) -> str:
        """What stopped the axes where no interrupt and no H did."""
        flags = self.flags
        if flags.has(INTA) and not flags.has(RUN | NO_CRYSTAL | FAULT):
            return "a reference run (W) that failed: its switch was not found, or not let go"
        return "what the unit does not tell" if flags.has(INTA) else "nothing"

    def as_text(self) -> str:
        """For people."""
        rows = [
            ("state", self.flags.text),
            ("RUN, INTA", f"{self.flags.has(RUN):d}, {self.flags.has(INTA):d}"),
            ("stopped by", ", ".join(self.causes) or self._unnamed()),
            ("queue", "no vector fits" if self.flags.has(FULL) else "has room"),
        ]
        for name, each in self._interrupts().items():
            use = f"interrupts at {each['active_at']}" if each["enabled"] else "does not interrupt"
            rows.append((name, f"{each['input']}, {use}"))
        late = {None: "not counted by this unit", 255: "255 or more"}.get(self.late, str(self.late))
        rows.append(("late pulses", late))
        told = " ".join(f"{value:02X}" for value in self.registers)
        rows.append(("ST0 to ST6", told))
        return "\n".join(f"{name:<14}{text}" for name, text in rows)


def positions_text(positions: Positions) -> str:
    """Positions in a line."""
    return "  ".join(f"{axis} {at}" for axis, at in zip(AXES, positions, strict=True))
