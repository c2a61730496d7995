"""Long jobs for the GVE134 unit: vectors of all kinds, and what changes speeds on the way."""

from __future__ import annotations

import random
from collections.abc import Iterator

CHAIN_VECTORS = 3000
"""About so many vectors join, then an L waits for the end."""


def any_job(seed: int, vectors: int) -> list[str]:
    """A job of so many vectors."""
    rng = random.Random(seed)
    lines = ["A400", "V12000", "B12000", "VJ4000,4000,4000,4000"]
    way = [1, 1, 1, 1]
    for number in range(vectors):
        if rng.random() < 0.02:
            lines += _setting(rng)
        if rng.random() < 0.05:
            way = [rng.choice((-1, 1)) for _ in range(4)]
        letter = "L" if rng.randrange(CHAIN_VECTORS) == 0 or number == 0 else "C"
        steps = (sign * each for sign, each in zip(way, _steps(rng), strict=True))
        lines.append(letter + ",".join(map(str, steps)))
    return lines


def _steps(rng: random.Random) -> Iterator[int]:
    most = rng.choice((3, 20, 20, 20, 40, 40, 150))
    return (rng.randint(0, most) if rng.random() < 0.7 else 0 for _ in range(4))


def _setting(rng: random.Random) -> list[str]:
    """Something that is in force from then on, or that changes what is under way."""
    override = rng.choice(("XU", "XD", "XA", f"XM{rng.randint(60, 160)}"))
    return rng.choice(
        (
            [override],
            [override],
            ["XA"],
            [f"V{rng.randint(2000, 40000)}"],
            [f"B{rng.randint(500, 40000)}"],
            [f"B{rng.randint(500, 40000)}"],
            [f"A{rng.randint(50, 4000)}"],
            [rng.choice(("VK", "VN"))],
            [f"VJ{','.join(str(rng.choice((0, 500, 4000))) for _ in range(4))}"],
            [f"VL{','.join(str(rng.randint(3000, 50000)) for _ in range(4))}", "XA"],
        )
    )
