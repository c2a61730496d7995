"""How many vectors of a job are over; tools and page have that in common: tools/gve134_job."""

from __future__ import annotations

from collections.abc import Iterable
from ctypes import c_int32, c_uint32, c_void_p
from functools import cache
from typing import Any

from rkm04_tools.gve134.job import Command
from rkm04_tools.gve134.master import TEXT_BYTES_MAX
from rkm04_tools.gve134.state import Positions
from rkm04_tools.lines import Handle, declared

UNKNOWN = 2**32 - 1
"""GVE_EXECUTED_UNKNOWN"""


@cache
def _functions() -> dict[str, Any]:
    place = (c_int32, c_int32, c_int32, c_int32)
    return declared(
        "lines_gve134_executed_",
        {
            "begin": (c_void_p,),
            "end": (None, c_void_p),
            "request": (c_void_p, c_void_p),
            "start": (None, c_void_p, *place),
            "lose": (None, c_void_p),
            "take": (None, c_void_p, c_uint32),
            "stand": (None, c_void_p, *place),
            "look": (c_uint32, c_void_p, c_uint32, *place),
            "done": (c_uint32, c_void_p),
            "place": (c_void_p, c_void_p),
        },
    )


class Executed(Handle):
    """Follows the vectors that a unit takes; see gve_executed.h."""

    def __init__(self, place: Positions) -> None:
        """`place`: where the first vector begins."""
        super().__init__(_functions())
        self._call("start", *place)

    @property
    def done(self) -> int | None:
        """So many are over, as far as was looked; None: it is not known any more."""
        return _known(self._call("done"))

    @property
    def place(self) -> Positions:
        """Where the first vector begins that is not over."""
        x, y, z, a = (c_int32 * 4).from_address(self._call("place"))
        return x, y, z, a

    def lose(self) -> None:
        """It is not known any more how many are over."""
        self._call("lose")

    def taken(self, commands: Iterable[Command]) -> None:
        """The unit has taken these."""
        self._call("take", self._put_all(commands))

    def stood(self, place: Positions) -> None:
        """All that was taken is over, and the axes stand there."""
        self._call("stand", *place)

    def look(self, place: Positions, perhaps: Iterable[Command] = ()) -> int | None:
        """How many are over when the axes are there; `perhaps` these were taken, too."""
        return _known(self._call("look", self._put_all(perhaps), *place))

    def _put_all(self, commands: Iterable[Command]) -> int:
        """The length of their text; what the line has no room for is never under way."""
        text = "\n".join(command.text for command in commands).encode("latin-1")
        if len(text) > TEXT_BYTES_MAX:
            return 0
        self._put(text)
        return len(text)


def _known(count: int) -> int | None:
    return None if count == UNKNOWN else count
