"""How many vectors of a job have been executed, told from the positions of the axes.

A unit tells neither how many wait nor which one runs. But it holds 128 at most, they lie on a path
that is known, and L and N are taken only when nothing waits. So the vector is looked for on whose
line all axes stand, from the last one known on; on that they do not go back. Where the path comes
by the same place again the first is meant: the number may be too low for a while, never too high.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from fractions import Fraction

from rkm04_tools.gve134.job import Command
from rkm04_tools.gve134.state import AXES, Positions

PLACES = 128
LOSES_TRACK = ("D", "K", "R", "J", "!7J")
"""What drops vectors, or puts others in their place."""

Steps = tuple[int, ...]


class Executed:
    """Follows the vectors that a unit takes."""

    def __init__(self, place: Positions) -> None:
        """`place`: where the first vector begins."""
        self.done: int | None = 0
        """So many are over; None: it is not known any more."""
        self._place = list(place)
        self._waiting: deque[Steps] = deque()
        self._gone = 0
        """Pulses of all axes that were seen of the first of them."""
        self._places = 0
        """Those of the queue that vectors take which wait; one without motion takes none."""
        self._moved = [False] * len(AXES)
        """The axes that the job has moved; of a coupled A the positions are those of another."""

    @property
    def place(self) -> Positions:
        """Where the first vector begins that is not over."""
        x, y, z, a = self._place
        return x, y, z, a

    def taken(self, commands: Iterable[Command]) -> None:
        """The unit has taken these."""
        for command in commands:
            if command.is_vector:
                if command.letter == "L":
                    self._pass(len(self._waiting))
                self._append(steps_of(command))
            elif command.letter == "N":
                self._count_anew(command.text[1:])
            elif command.letter == "W" or command.text in LOSES_TRACK:
                self.done = None

    def _append(self, steps: Steps) -> None:
        self._waiting.append(steps)
        self._places += any(steps)
        self._moved = [was or step != 0 for was, step in zip(self._moved, steps, strict=True)]
        while self._places > PLACES:
            self._pass(1)

    def stood(self, place: Positions) -> None:
        """All that was taken is over, and the axes stand there."""
        self._pass(len(self._waiting))
        self._place = list(place)

    def look(self, place: Positions, perhaps: Iterable[Command] = ()) -> int | None:
        """How many are over when the axes are there; `perhaps` these were taken, too."""
        at = list(self._place)
        known = len(self._waiting)
        ahead = [*self._waiting, *(steps_of(each) for each in perhaps if each.is_vector)]
        for number, steps in enumerate(ahead):
            ways = self._ways(at, place)
            gone = sum(map(abs, ways))
            if is_on(steps, ways) and (number > 0 or gone >= self._gone):
                over = number + (ways == steps)
                self._pass(min(over, known))
                self._gone = gone if over == number < known else 0
                return None if self.done is None else self.done + max(0, over - known)
            at = [here + each for here, each in zip(at, steps, strict=True)]
        return self.done

    def _ways(self, at: Sequence[int], place: Positions) -> Steps:
        return tuple(
            _signed(there - here) if moved else 0
            for here, there, moved in zip(at, place, self._moved, strict=True)
        )

    def _pass(self, count: int) -> None:
        self._gone = 0 if count else self._gone
        for _ in range(count):
            steps = self._waiting.popleft()
            self._places -= any(steps)
            self._place = [here + each for here, each in zip(self._place, steps, strict=True)]
            if self.done is not None:
                self.done += 1

    def _count_anew(self, parameters: str) -> None:
        self._pass(len(self._waiting))
        if not parameters:
            self._place = [0] * len(AXES)
        else:
            self._place[AXES.index(parameters[0])] = int(parameters[1:].lstrip(","))


def steps_of(command: Command) -> Steps:
    """What a vector has on each axis."""
    return tuple(map(int, command.text[1:].split(",")))


def is_on(steps: Sequence[int], ways: Sequence[int]) -> bool:
    """Whether the axes come by a place on a vector, given from where that begins.

    Axis j makes its pulse k when the path has come to the part k / |d_j| of the vector.
    """
    begin, end = Fraction(0), Fraction(2)
    for step, way in zip(steps, ways, strict=True):
        if step * way < 0 or abs(way) > abs(step):
            return False
        if step:
            begin = max(begin, Fraction(abs(way), abs(step)))
            end = min(end, Fraction(abs(way) + 1, abs(step)))
    return begin < end


def _signed(number: int) -> int:
    """Positions are told modulo 2^32."""
    return (number + 2**31) % 2**32 - 2**31
