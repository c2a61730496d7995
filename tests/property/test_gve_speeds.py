"""The speeds of the GVE134 unit against exact numbers, for any vectors and settings."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import gve_speeds_reference as reference
from gve_speeds_reference import FACTOR_ONE, TOP, Vector
from hypothesis import given, settings
from hypothesis import strategies as st

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host"))
LONG = bool(os.environ.get("RKM04_LONG"))
CASES_MAX = 20  # in a run of the probe
Four = tuple[int, int, int, int]


@dataclass(frozen=True)
class Case:
    """Two vectors, and what is in force."""

    before: Vector
    after: Vector
    factor: int
    limits: Four
    jumps: Four

    @property
    def line(self) -> str:
        """The case as the probe reads it."""
        numbers: list[int] = []
        for one in (self.before, self.after):
            numbers += [*one.steps, one.speed, one.brake, one.short, int(one.corrected)]
        return " ".join(map(str, [*numbers, self.factor, *self.limits, *self.jumps]))

    @property
    def expected(self) -> str:
        """What the probe should tell."""
        return " ".join(
            map(
                str,
                (
                    reference.limit(self.before, self.factor, self.limits),
                    self.before.extent2,
                    reference.border(self.before, self.after, self.jumps),
                    reference.changed(self.factor, 17),
                    reference.changed(self.factor, 15),
                ),
            )
        )


def sized(most: int) -> st.SearchStrategy[int]:
    """Numbers up to a bound, of any size, and the ends of the range often."""
    small = st.integers(0, 40)
    bits = st.integers(0, most.bit_length()).flatmap(lambda n: st.integers(0, min(most, 2**n)))
    return st.one_of(small, bits, st.sampled_from((0, 1, most - 1, most)))


STEPS = st.builds(lambda size, sign: size * sign, sized(2**31 - 1), st.sampled_from((1, -1)))
RATES = sized(TOP).map(lambda rate: max(10, rate))
VECTORS = st.builds(
    Vector,
    steps=st.tuples(STEPS, STEPS, STEPS, STEPS).filter(any),
    speed=RATES,
    brake=RATES,
    short=sized(2**31 - 1).map(lambda n: max(1, n)),
    corrected=st.booleans(),
)
JUMPS = sized(TOP)
CHOICES = st.builds(
    Case,
    before=VECTORS,
    after=VECTORS,
    factor=sized(10 * FACTOR_ONE).map(lambda f: max(FACTOR_ONE // 100, f)),
    limits=st.tuples(RATES, RATES, RATES, RATES),
    jumps=st.tuples(JUMPS, JUMPS, JUMPS, JUMPS),
)


@settings(max_examples=10_000 if LONG else 60, deadline=None)
@given(st.lists(CHOICES, min_size=1, max_size=CASES_MAX))
def test_limits_borders_and_factors_are_those_of_exact_numbers(cases: list[Case]) -> None:
    text = "".join(f"{case.line}\n" for case in cases)
    probe = BUILD / "bin" / "gve-speeds-probe"
    done = subprocess.run([probe], input=text, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [case.expected for case in cases]
