"""Which channel of a capture is which wire of which motor: by its name, or as the user says."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from rkm04_tools.compare.recording import Names, Trace
from rkm04_tools.failure import Failure

STEP, DIR = "STEP", "DIR"
KINDS = {"STEP": STEP, "STP": STEP, "PUL": STEP, "PULSE": STEP, "DIR": DIR, "DIRECTION": DIR}
MOTORS = {**{str(n): n for n in range(1, 5)}, "X": 1, "Y": 2, "Z": 3, "A": 4}
"""Numbers and axes."""
_KIND, _MOTOR = "|".join(KINDS), "[1-4XYZA]"
NAME = re.compile(rf"M?(?P<before>{_MOTOR})?(?P<kind>{_KIND})(?P<after>{_MOTOR})?", re.IGNORECASE)
SHOWN_MAX = 16
INVERTED = "!"

Role = tuple[str, int]
"""STEP or DIR, and the motor."""


@dataclass(frozen=True)
class Channel:
    """A channel of a capture, perhaps after an inverter."""

    name: str
    inverted: bool = False

    def of(self, traces: Mapping[str, Trace]) -> Trace:
        """What it shows, as the motor's driver sees it."""
        trace = traces[self.name]
        return trace.inverted() if self.inverted else trace


@dataclass(frozen=True)
class Wiring:
    """The channels of a motor."""

    step: Channel
    direction: Channel | None


def role(name: str) -> Role | None:
    """What a name says: STEP1, DIR_2, m3_step, X STEP, or just STEP for motor 1."""
    match = NAME.fullmatch(re.sub(r"[\s_.\-\[\]]", "", name))
    if not match or (match["before"] and match["after"]):
        return None
    motor = (match["before"] or match["after"] or "1").upper()
    return KINDS[match["kind"].upper()], MOTORS[motor]


def wire(file: str, names: Names, mapping: str | None) -> dict[int, Wiring]:
    """The channels of each motor whose STEP was captured."""
    roles = _by_mapping(file, names, mapping) if mapping is not None else _by_name(file, names)
    for channel in roles.values():
        if channel.name in names.twice:
            raise Failure(
                f"{file}: two of its channels are named {channel.name}; rename one in the program "
                "that has recorded them, or say by --channels which others are meant"
            )
    wirings = {
        motor: Wiring(channel, roles.get((DIR, motor)))
        for (kind, motor), channel in sorted(roles.items())
        if kind == STEP
    }
    if not wirings:
        wide = ", ".join(too_wide(names, roles))
        wide = f" ({wide}: of more than one bit)" if wide else ""
        raise Failure(
            f"{file}: its channels are {_listed(names.wires)}{wide}, and none is named as STEP1 or "
            f"m1_step; say which is which: --channels {_proposal(names.wires)}"
        )
    for kind, motor in roles:
        if motor not in wirings:
            raise Failure(f"{file}: motor {motor} has {kind} and no STEP; name its channel, too")
    return wirings


def too_wide(names: Names, found: Collection[Role]) -> list[str]:
    """Names as of a wire that was not found, of what has more than one bit."""
    return sorted(name for name in names.wide if (what := role(name)) and what not in found)


def mapping_of(wirings: Mapping[int, Wiring]) -> str:
    """What `--channels` would say of them."""
    pairs = [
        f"{kind}{motor}={channel.name}"
        for motor, each in wirings.items()
        for kind, channel in ((STEP, each.step), (DIR, each.direction))
        if channel
    ]
    return _quoted(",".join(pairs))


def _by_name(file: str, names: Names) -> dict[Role, Channel]:
    found: dict[Role, Channel] = {}
    for name in names.wires:
        if (what := role(name)) is None:
            continue
        if what in found:
            raise Failure(
                f"{file}: {found[what].name} and {name} are both {what[0]}{what[1]}; "
                f"say which it is: --channels {what[0]}{what[1]}={name}"
            )
        found[what] = Channel(name)
    steps = {motor for kind, motor in found if kind == STEP}
    return {what: channel for what, channel in found.items() if what[1] in steps}


def _by_mapping(file: str, names: Names, mapping: str) -> dict[Role, Channel]:
    found: dict[Role, Channel] = {}
    for item in mapping.split(","):
        key, equals, text = item.partition("=")
        what = role(key.strip())
        if not equals or what is None:
            raise Failure(f"--channels {item}: write STEP1=NAME or DIR1=NAME, with commas between")
        name = text.strip().removeprefix(INVERTED)
        if name not in names.wires:
            why = (
                f"{name} has more than one bit"
                if name in names.wide
                else f"has no channel {name or text}"
            )
            raise Failure(f"{file}: {why}; its channels are {_listed(names.wires)}")
        if what in found:
            raise Failure(f"--channels: {what[0]}{what[1]} is named twice; leave one away")
        found[what] = Channel(name, text.strip().startswith(INVERTED))
    return found


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - SHOWN_MAX} more" if len(names) > SHOWN_MAX else ""
    return ", ".join(names[:SHOWN_MAX]) + more


def _proposal(names: Sequence[str]) -> str:
    """A mapping as it might be, to be copied and changed."""

    def pairs() -> Iterator[str]:
        for what, name in zip(("STEP1", "DIR1"), names, strict=False):
            yield f"{what}={name}"

    return _quoted(",".join(pairs()))


def _quoted(text: str) -> str:
    """As a shell takes it."""
    return f'"{text}"' if " " in text else text
