"""What the planner of paths costs: a step up is seen here first."""

from __future__ import annotations

from path_count import measure

CHAIN = "100 steps, ramp and cruise in each"
INSTRUCTIONS_MAX = 10_800


def test_a_vector_of_four_axes_is_planned_within_its_budget() -> None:
    row = measure([CHAIN])[CHAIN]
    assert 5_000 < int(str(row["all of a vector"])) <= INSTRUCTIONS_MAX
