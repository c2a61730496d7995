"""Ten jobs for a machine of three axes, straight and curved, with the points on their way."""

from __future__ import annotations

import math
from dataclasses import dataclass

from peer_pulses import Circle, Steps

STEPS_PER_MM = 400
FEED_MM_PER_MIN = 3000
ACCEL_MM_PER_S2 = 500

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Job:
    """A job of G1 moves, or of lines of G-code with arcs."""

    name: str
    points: tuple[Point, ...] = ()
    lines: tuple[str, ...] = ()
    circles: tuple[Circle, ...] = ()
    """On which the arcs lie, of a job of lines."""

    def gcode(self) -> str:
        """The job as a controller is sent it; it begins at 0."""
        body = self.lines or tuple(f"G1 X{x:.4f} Y{y:.4f} Z{z:.4f}" for x, y, z in self.points)
        return "\n".join(["G21 G90 G94", f"F{FEED_MM_PER_MIN}", *body, "M30", ""])

    def steps(self) -> list[Steps]:
        """The ends of the straight moves in steps, the origin first."""
        ends = [
            (0.0, 0.0, 0.0),
            *((round(x, 4), round(y, 4), round(z, 4)) for x, y, z in self.points),
        ]
        whole = [tuple(math.floor(v * STEPS_PER_MM + 0.5) for v in point) for point in ends]
        return [(x, y, z) for x, y, z in whole]


def circle(segments: int, radius: float, turns: int, rise: float) -> tuple[Point, ...]:
    """A circle or helix of chords that begins and ends at x = y = 0."""
    total = segments * turns
    return tuple(
        (
            radius * math.sin(2 * math.pi * i / segments),
            radius * (1 - math.cos(2 * math.pi * i / segments)),
            rise * i / total,
        )
        for i in range(1, total + 1)
    )


def spiral() -> tuple[Point, ...]:
    """Chords of 0.2 mm that get farther out."""
    points = []
    angle = 0.0
    while angle < 12 * math.pi:
        radius = 1 + 0.4 * angle
        angle += 0.2 / radius
        points.append(
            ((1 + 0.4 * angle) * math.cos(angle) - 1, (1 + 0.4 * angle) * math.sin(angle), 0.0)
        )
    return tuple(points)


def zigzag() -> tuple[Point, ...]:
    """Corners of 20 degrees."""
    return tuple((5.0 * i, 0.0 if i % 2 == 0 else 0.88, 0.0) for i in range(1, 13))


def relief() -> tuple[Point, ...]:
    """A surface in lines of 0.5 mm chords."""
    points = []
    for row in range(5):
        for i in range(41):
            x = (i if row % 2 == 0 else 40 - i) * 0.5
            points.append((x, row * 1.0, 0.6 * math.sin(x) * math.cos(row)))
    return tuple(points)


JOBS = (
    Job("diagonal", points=((30.0, 7.3, 1.9), (0.0, 0.0, 0.0))),
    Job("shallow", points=((40.0, 0.31, 0.0), (0.0, 0.62, 0.0), (40.0, 0.93, 0.0))),
    Job("square", points=((20.0, 0.0, 0.0), (20.0, 20.0, 0.0), (0.0, 20.0, 0.0), (0.0, 0.0, 0.0))),
    Job("zigzag", points=zigzag()),
    Job(
        "star",
        points=tuple(
            (10 * math.sin(0.8 * math.pi * i), 10 - 10 * math.cos(0.8 * math.pi * i), 0.0)
            for i in range(1, 6)
        ),
    ),
    Job("circle of chords", points=circle(180, 10.0, 1, 0.0)),
    Job("helix of chords", points=circle(90, 5.0, 3, 6.0)),
    Job("spiral of chords", points=spiral()),
    Job("relief", points=relief()),
    Job(
        "arcs",
        lines=(
            "G2 X0 Y0 I10 J0",
            "G3 X0 Y0 I0 J5",
            "G2 X10 Y10 I10 J0 Z2",
            "G3 X0 Y0 R-10 Z0",
        ),
        circles=tuple(
            Circle(x * STEPS_PER_MM, y * STEPS_PER_MM, r * STEPS_PER_MM)
            for x, y, r in ((10, 0, 10), (0, 5, 5), (0, 10, 10))
        ),
    ),
)
