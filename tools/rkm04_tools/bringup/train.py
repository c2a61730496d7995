"""Pulses that the image has made, as its second timer has captured them, against what was asked."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

from rkm04_tools.board_header import Board
from rkm04_tools.bringup.findings import Seen, compared, noted
from rkm04_tools.bringup.talk import Answer

RATE_TOLERANCE = 0.002
"""Of the two timers, which have one crystal: more is another divider."""
FLOATS = [1, 0]
"""With pull-up, with pull-down."""


@dataclass(frozen=True)
class Limits:
    """What a class of steps promises, with a tick of each timer for the capture."""

    width_us: float
    narrower_us: float
    wider_us: float
    apart_us: float


def limits(header: Board) -> Limits:
    width = int(header.values["BOARD_STEP_HIGH_NS"].rstrip("U")) / 1000
    if header.values.get("BOARD_STEP_CLASS", "1") == "1":
        return Limits(width, 0.1, 0.1, 0.025)
    return Limits(width, 0.1, 4.0, 4.0)


@dataclass(frozen=True)
class Train:
    """All times in microseconds; those of pulses count from the first one."""

    asked: list[float]
    captured: list[float]
    widths: list[float]
    pulled: list[int]
    made: int
    late: int
    overrun: bool


def read(answer: Answer) -> Train:
    tick, capture = (answer.number(name) / 1e6 for name in ("tick_hz", "capture_hz"))
    widths = answer.numbers("widths")
    gone = accumulate(answer.numbers("intervals"), initial=0)
    return Train(
        asked=[at / tick for at in accumulate(answer.numbers("wanted"), initial=0)],
        captured=[at / capture for at in gone][: len(widths)],
        widths=[width / capture for width in widths],
        pulled=answer.numbers("pulled"),
        made=answer.number("made"),
        late=answer.number("late"),
        overrun=answer.number("overrun") == 1,
    )


def judge(train: Train, limits: Limits) -> list[Seen]:
    """Of pulses that have come: how many, how wide, when."""
    if train.overrun:
        text = "captures were lost: the image did not fetch them in time"
        return [compared("pulses", text, "none lost", good=False)]
    rate = _rate(train)
    if abs(rate - 1) > RATE_TOLERANCE:
        text = f"{rate:.3f} of what was asked: the step timer has another clock"
        return [compared("rate of the pulses", text, "1", good=False)]
    missing, surplus, off = _matched(train, limits.apart_us)
    return [_counted(train, missing, surplus), _widths(train, limits), _times(off, limits),
            *_made(train)]  # fmt: skip


def _rate(train: Train) -> float:
    """By which all of them come at another rate; 1 where they are not just that."""
    if len(train.captured) != len(train.asked):
        return 1.0
    rates = [asked / at for asked, at in zip(train.asked[1:], train.captured[1:], strict=True)]
    mean = sum(rates) / len(rates)
    alike = all(abs(rate / mean - 1) < RATE_TOLERANCE for rate in rates)
    return mean if alike else 1.0


def _matched(train: Train, apart_us: float) -> tuple[list[int], list[int], list[float]]:
    """The numbers of those asked for that did not come, of those that came unasked, and by how much
    the others are off; the first that came may be any of those asked for."""
    near = max(5 * apart_us, 1.0)
    tries = [_match(train, shift, near) for shift in train.asked]
    return min(tries, key=lambda tried: len(tried[0]) + len(tried[1]))


def _match(train: Train, shift: float, near: float) -> tuple[list[int], list[int], list[float]]:
    left = {number: at - shift for number, at in enumerate(train.asked, 1)}
    surplus, off = [], []
    for number, at in enumerate(train.captured, 1):
        best = min(left, key=lambda each: abs(left[each] - at), default=None)
        if best is None or abs(left[best] - at) > near:
            surplus.append(number)
        else:
            off.append(at - left.pop(best))
    return sorted(left), surplus, off


def _counted(train: Train, missing: list[int], surplus: list[int]) -> Seen:
    said = f"{len(train.captured)} of {len(train.asked)}"
    for what, numbers in (("missing", missing), ("surplus", surplus)):
        if numbers:
            said += f"; {what}: {', '.join(map(str, numbers))}"
    return compared("pulses", said, f"{len(train.asked)}", not missing and not surplus)


def _widths(train: Train, limits: Limits) -> Seen:
    least, most = min(train.widths), max(train.widths)
    low, high = limits.width_us - limits.narrower_us, limits.width_us + limits.wider_us
    good = low <= least and most <= high
    said = f"{least:.3f} to {most:.3f} us"
    if not good:
        said += f": too {'narrow' if least < low else 'wide'}"
    return compared("width", said, f"{low:.3f} to {high:.3f} us", good)


def _times(off: list[float], limits: Limits) -> Seen:
    """The first pulse is no better than the others, so what counts is the spread."""
    spread = max(off) - min(off) if off else 0.0
    return compared("ticks", f"within {spread * 1000:.0f} ns", f"{limits.apart_us * 1000:.0f} ns",
                    spread <= limits.apart_us)  # fmt: skip


def _made(train: Train) -> list[Seen]:
    """What the driver of the steps says of them."""
    seen = []
    if train.made != len(train.asked):
        seen.append(compared("made by the driver", f"{train.made} pulses", f"{len(train.asked)}",
                             good=False))  # fmt: skip
    if train.late:
        seen.append(noted("late, as the driver says", f"{train.late}"))
    return seen


def wire_text(train: Train) -> str:
    """Of a pin at which nothing came."""
    if train.pulled == FLOATS:
        return "no wire: the pin follows its pull resistors"
    return f"held {'high' if train.pulled[0] else 'low'}, no pulse comes"
