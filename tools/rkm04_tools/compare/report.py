"""The result of a comparison in words, and as one JSON object."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from rkm04_tools.compare.align import Alignment
from rkm04_tools.compare.clock import RATE_MAX
from rkm04_tools.compare.findings import Allowed, Jump, Motor, Places, Shift, wander_max
from rkm04_tools.compare.follow import BEND_MAX, bend
from rkm04_tools.compare.sampling import DIGITS, GIVEN, SEEN, Resolution
from rkm04_tools.table import table, thousands

HEAD = (
    "motor", "captured", "simulated", "in both", "missing", "surplus", "wrong DIR",
    "worst", "median", "too far", "pulse width",
)  # fmt: skip
RUNS_SHOWN_MAX = 6
NO_WIDTH_SAMPLES = 2
"""Pulses of fewer samples may fall between two of them."""


@dataclass(frozen=True)
class Scope:
    """What of the simulation the capture shows."""

    not_captured: Sequence[int]
    """Motors that move in the simulation, and whose STEP was not captured."""
    without_dir: Sequence[int]
    """Motors whose STEP was captured, and whose DIR was not."""
    unseen_dir: Sequence[int]
    """Those of them whose DIR the simulation tells."""
    is_chosen: bool
    """The channels were named: what is not among them was left out on purpose."""
    mapping: str
    """How the channels that there are would be named."""
    too_wide: Sequence[str]

    @property
    def absent(self) -> str:
        """Wires that should be there and are not; empty: none."""
        return "" if self.is_chosen else self._unseen

    @property
    def left_out(self) -> str:
        """Those that were left out on purpose."""
        return self._unseen if self.is_chosen else ""

    @property
    def _unseen(self) -> str:
        wires = (("STEP", self.not_captured), ("DIR", self.unseen_dir))
        return " and ".join(f"{name} of {_motors(which)}" for name, which in wires if which)


@dataclass(frozen=True)
class Result:
    """A comparison."""

    capture: str
    kind: str
    steps: str
    steps_kind: str
    tick_hz: int
    resolution: Resolution
    allowed: Allowed
    alignment: Alignment | None
    wander: float
    shift: Shift | None
    jump: Jump | None
    motors: Sequence[Motor]
    scope: Scope

    @property
    def is_same(self) -> bool:
        """Whether the capture is what was simulated, and nothing else that was."""
        return self.differs_nowhere and not self.fits_elsewhere

    @property
    def differs_nowhere(self) -> bool:
        """Whether it is, if it was captured where it was aligned."""
        return (
            self.is_steady and not self.scope.absent and all(motor.is_same for motor in self.motors)
        )

    @property
    def fits_elsewhere(self) -> bool:
        """Whether another place of the simulation fits as well."""
        return self.alignment is not None and self.alignment.elsewhere

    @property
    def told_jump(self) -> Jump | None:
        """The jump, unless what it may be is the slow drift of clocks in a long pause."""
        is_far = any(len(motor.too_far) for motor in self.motors)
        return self.jump if is_far or not self.is_steady else None

    @property
    def bend(self) -> float:
        """By how much the rate of the clocks changes in a second, at most."""
        return bend(self.alignment.clock) if self.alignment else 0.0

    @property
    def is_steady(self) -> bool:
        """Whether crystals do what the clocks do."""
        return self.bend <= BEND_MAX and self.wander <= wander_max(self.allowed)

    def ticks(self, seconds: float) -> float:
        """A time in ticks."""
        return seconds * self.tick_hz


@dataclass(frozen=True)
class Stretch:
    """Pulses in a row."""

    first: int
    last: int
    begin: float
    end: float


def stretches(places: Places) -> list[Stretch]:
    """Pulses, with those in a row put together."""
    breaks = np.flatnonzero(np.diff(places.numbers) != 1) + 1
    ends = [*breaks, len(places)] if len(places) else []
    return [
        Stretch(
            int(places.numbers[a]), int(places.numbers[b - 1]),
            float(places.seconds[a]), float(places.seconds[b - 1]),
        )
        for a, b in zip([0, *breaks], ends, strict=False)
    ]  # fmt: skip


def text(result: Result) -> str:
    """The result in words."""
    rows = [HEAD, *(_row(result, motor) for motor in _moving(result))]
    details = [line for motor in result.motors for line in _details(result, motor)]
    return "\n".join(
        [
            *_head(result), "", table(rows, "rrrrrrrrrrl"),
            *(["", *details] if details else []), "", *_notes(result), _verdict(result),
        ]
    )  # fmt: skip


def _moving(result: Result) -> list[Motor]:
    return [motor for motor in result.motors if motor.captured or motor.simulated]


def _head(result: Result) -> Iterator[str]:
    found, seconds = result.resolution, result.allowed.end - result.allowed.begin
    rate = (
        f"{found.hz / 1e6:g} MHz{_SOURCES.get(found.source, '')}" if found.hz else "rate not told"
    )
    yield (
        f"{result.capture}: {result.kind}, {seconds:.6f} s, {rate}: it resolves "
        f"{_time(found.seconds)} = {result.ticks(found.seconds):.1f} ticks"
    )
    tick = _time(1 / result.tick_hz)
    yield f"{result.steps}: {result.steps_kind} of the simulator, {tick} a tick"
    if result.alignment is None:
        yield (
            "nothing fits: nowhere are the captured pulses the simulated ones, with clocks that "
            f"differ by no more than {RATE_MAX * 1e6:.0f} ppm; is it the same program, and are the "
            "channels right?"
        )
        return
    line = result.alignment.overall
    zero = float(line.capture(np.zeros(1))[0])
    clock = "the rate of the clocks was not fitted"
    if result.alignment.has_rate:
        clock = f"the capture's clock is {_ppm(line.rate)}"
    wanders = result.wander > result.resolution.seconds / 10
    drift = f", and wanders by up to {_time(result.wander)}" if wanders else ""
    yield (
        f"aligned by {_pulses(result.alignment.count)}: the simulation begins at "
        f"{round(zero, 9) + 0.0:.9f} s of the capture; {clock}{drift}"
    )


_SOURCES = {GIVEN: " as given", SEEN: " by its times"}


def _row(result: Result, motor: Motor) -> tuple[str, ...]:
    worst = motor.worst
    counts = (
        motor.captured, motor.simulated, len(motor.both), len(motor.missing) + motor.outside,
        len(motor.surplus),
    )  # fmt: skip
    direction = (
        "?" if motor.motor in result.scope.without_dir else thousands(len(motor.wrong_direction))
    )
    median = float(np.median(np.abs(motor.deviations))) if worst is not None else None
    width = motor.width
    return (
        str(motor.motor),
        *map(thousands, counts),
        direction,
        "-" if worst is None else _signed(float(motor.deviations[worst])),
        "-" if median is None else _time(median),
        thousands(len(motor.too_far)),
        "-" if width is None else f"{_time(width.least)} to {_time(width.most)}",
    )


def _details(result: Result, motor: Motor) -> Iterator[str]:
    name = f"motor {motor.motor}"
    if motor.outside:
        yield (
            f"{name}: {_pulses(motor.outside)} of the simulation before the capture begins or "
            "after it ends; --part if it is meant to hold only a part"
        )
    for title, places in (
        ("missing", motor.missing),
        ("surplus (numbers are the capture's)", motor.surplus),
        ("DIR is the other way round at", motor.wrong_direction),
        (f"further off than {_time(result.allowed.limit)}", motor.too_far),
    ):
        if len(places):
            yield f"{name}: {title}: {_listed(places)}"
    worst = motor.worst
    if worst is not None and len(motor.too_far):
        yield (
            f"{name}: the worst is pulse {motor.both.numbers[worst]} at "
            f"{motor.both.seconds[worst]:.9f} s, {_signed(float(motor.deviations[worst]))} = "
            f"{result.ticks(float(motor.deviations[worst])):+.1f} ticks (+: too late)"
        )
    if motor.direction_setup is not None or motor.direction_hold is not None:
        before, after = map(_or_none, (motor.direction_setup, motor.direction_hold))
        yield f"{name}: DIR changes at least {before} before a pulse, at least {after} after one"


def _notes(result: Result) -> Iterator[str]:
    yield from _not_captured(result.scope)
    if result.fits_elsewhere:
        yield (
            "the capture fits as well at another place of the simulation, as where moves repeat: "
            "record from the first pulse on to be sure"
        )
    if (shift := result.shift) is not None:
        when = "later" if shift.seconds > 0 else "earlier"
        yield (
            f"from pulse {shift.first} of motor {shift.motor} on, pulses come "
            f"{_time(abs(shift.seconds))} {when}: as after a wait for an input, or where the "
            "analyser has lost samples"
        )
    if result.resolution.source == DIGITS:
        yield "the sample rate is not told, so times are taken as written: --sample-rate tells it"
    shortest = min((m.width.least for m in result.motors if m.width), default=1.0)
    if shortest < NO_WIDTH_SAMPLES * result.resolution.seconds and result.resolution.hz:
        yield "pulses are hardly longer than a sample: some may have been missed; sample faster"
    if any(len(m.wrong_direction) == len(m.both) > 0 for m in result.motors):
        yield "DIR is the other way round everywhere: --channels DIR1=!NAME if a wire is inverted"
    turned = [m.motor for m in result.motors if m.upside_down]
    if turned:
        yield (
            f"STEP of {_motors(turned)} is high between the pulses: turned round, the pulse is "
            "elsewhere; --channels with a ! before the name if the wire is inverted, else without"
        )
    yield from _unsteady(result)


def _not_captured(scope: Scope) -> Iterator[str]:
    if scope.too_wide:
        yield f"not used, as it has more than one bit: {', '.join(scope.too_wide)}"
    if scope.absent:
        yield (
            f"not captured: {scope.absent}, which the simulation moves: look at the names of the "
            f"channels; if it is left out on purpose, say so: --channels {scope.mapping}"
        )
    still = [motor for motor in scope.without_dir if motor not in scope.unseen_dir]
    if still:
        yield f"not captured: DIR of {_motors(still)}: nothing is said about it"


def _unsteady(result: Result) -> Iterator[str]:
    """What no crystal does."""
    if (jump := result.told_jump) is not None:
        when = "later" if jump.seconds > 0 else "earlier"
        yield (
            f"from pulse {jump.pulse} of motor {jump.motor} on ({jump.captured_seconds:.6f} s), "
            f"after {_time(jump.pause)} without a pulse, all come {_time(abs(jump.seconds))} "
            f"{when}: no clock jumps so; or the analyser has lost samples"
        )
    elif result.bend > BEND_MAX:
        yield (
            f"the rate of the clocks changes by {result.bend * 1e6:.2f} ppm in a second, more than "
            f"the {BEND_MAX * 1e6:g} ppm that crystals may: pulses come later, or earlier, from "
            "some time on, or the analyser has lost samples"
        )
    elif result.wander > wander_max(result.allowed):
        yield (
            f"the clocks wander by {_time(result.wander)}, more than crystals do: pulses come "
            "later, or earlier, from some time on, or the analyser has lost samples"
        )


def _verdict(result: Result) -> str:
    limit = f"{_time(result.allowed.limit)} = {result.ticks(result.allowed.limit):.1f} ticks"
    pulses, left_out = "every pulse", ""
    if result.scope.left_out:
        pulses = f"every pulse of {_motors([motor.motor for motor in _moving(result)])}"
        left_out = f"; left out: {result.scope.left_out}"
    if result.is_same:
        finest = _time(result.resolution.seconds)
        return (
            f"the same: {pulses} is within {limit}{left_out}; what is below {finest} cannot be seen"
        )
    if result.differs_nowhere:
        return (
            f"not known to be the same: {pulses} is within {limit}{left_out} here, and as well at "
            "another place"
        )
    return f"not the same: see above; a pulse may be off by {limit}{left_out}"


def _listed(places: Places) -> str:
    found = stretches(places)
    shown = ", ".join(map(_stretch, found[:RUNS_SHOWN_MAX]))
    rest = sum(each.last - each.first + 1 for each in found[RUNS_SHOWN_MAX:])
    return f"{shown} and {_pulses(rest)} more" if rest else shown


def _stretch(each: Stretch) -> str:
    if each.first == each.last:
        return f"{each.first} ({each.begin:.6f} s)"
    return f"{each.first} to {each.last} ({each.begin:.6f} s to {each.end:.6f} s)"


def _pulses(number: int) -> str:
    return f"{thousands(number)} pulse{'' if number == 1 else 's'}"


def _motors(numbers: Sequence[int]) -> str:
    return f"motor{'' if len(numbers) == 1 else 's'} {', '.join(map(str, numbers))}"


def _ppm(rate: float) -> str:
    return f"{abs(rate) * 1e6:.2f} ppm {'fast' if rate > 0 else 'slow'} against the unit's"


def _time(seconds: float) -> str:
    """A time with three digits and its unit."""
    for unit, factor in (("ns", 1e9), ("us", 1e6), ("ms", 1e3)):
        if round(abs(seconds) * factor, 1) < 1000:
            value = seconds * factor
            return f"{value:.1f} {unit}" if unit == "ns" else f"{value:.3f} {unit}"
    return f"{seconds:.6f} s"


def _signed(seconds: float) -> str:
    return f"{'+' if seconds >= 0 else '-'}{_time(abs(seconds))}"


def _or_none(seconds: float | None) -> str:
    return "-" if seconds is None else _time(seconds)


def as_json(result: Result) -> dict[str, Any]:
    """For scripts; times in seconds of the capture, deviations in nanoseconds."""
    alignment = result.alignment
    line = alignment.overall if alignment else None
    return {
        "same": result.is_same,
        "capture": {
            "file": result.capture,
            "format": result.kind,
            "begin_seconds": result.allowed.begin,
            "end_seconds": result.allowed.end,
            "sample_hz": result.resolution.hz or None,
            "sample_rate_from": result.resolution.source,
        },
        "steps": {"file": result.steps, "tick_hz": result.tick_hz},
        "resolution_ns": result.resolution.seconds * 1e9,
        "resolution_ticks": result.ticks(result.resolution.seconds),
        "limit_ns": result.allowed.limit * 1e9,
        "offset_seconds": float(line.capture(np.zeros(1))[0]) if line else None,
        "rate_ppm": line.rate * 1e6 if line and alignment and alignment.has_rate else None,
        "wander_ns": result.wander * 1e9,
        "rate_change_ppm_per_second": result.bend * 1e6,
        "shift": None if result.shift is None else asdict(result.shift),
        "jump": None if result.told_jump is None else asdict(result.told_jump),
        "fits_elsewhere": result.fits_elsewhere,
        "not_captured": list(result.scope.not_captured),
        "dir_not_captured": list(result.scope.unseen_dir),
        "left_out_on_purpose": bool(result.scope.left_out),
        "not_used": list(result.scope.too_wide),
        "motors": [_motor_as_json(result, motor) for motor in result.motors],
    }


def _motor_as_json(result: Result, motor: Motor) -> dict[str, Any]:
    worst = motor.worst
    far = float(motor.deviations[worst]) if worst is not None else None
    return {
        "motor": motor.motor,
        "captured": motor.captured,
        "simulated": motor.simulated,
        "both": len(motor.both),
        "outside": motor.outside,
        "step_upside_down": motor.upside_down,
        "missing": _as_list(motor.missing),
        "surplus": _as_list(motor.surplus),
        "wrong_dir": None
        if motor.motor in result.scope.without_dir
        else _as_list(motor.wrong_direction),
        "too_far": _as_list(motor.too_far),
        "worst_ns": None if far is None else far * 1e9,
        "worst_ticks": None if far is None else result.ticks(far),
        "worst_pulse": None if worst is None else int(motor.both.numbers[worst]),
        "worst_seconds": None if worst is None else float(motor.both.seconds[worst]),
        "median_ns": None if far is None else float(np.median(np.abs(motor.deviations))) * 1e9,
        "width_ns": [motor.width.least * 1e9, motor.width.most * 1e9] if motor.width else None,
        "dir_setup_ns": _nanoseconds(motor.direction_setup),
        "dir_hold_ns": _nanoseconds(motor.direction_hold),
    }


def _as_list(places: Places) -> dict[str, Any]:
    """Their number, and the pulses in a row."""
    rows = [
        {"first": s.first, "last": s.last, "begin_seconds": s.begin, "end_seconds": s.end}
        for s in stretches(places)
    ]
    return {"count": len(places), "pulses": rows}


def _nanoseconds(seconds: float | None) -> float | None:
    return None if seconds is None else seconds * 1e9
