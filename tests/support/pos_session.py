"""Sessions with the positioning unit, as they are and as files for its simulator."""

from __future__ import annotations

from dataclasses import dataclass

from pos_words import MS, OFFSETS, Code


@dataclass(frozen=True)
class Act:
    """An instruction and when it comes; values in the order of the scripts.

    POS_INIT: space. POS_MODE: len, accel. POS_CONTROL: feed, mp (-1: left out). POS_MODE_ABS:
    position, accel. POS_HOME: method, position, accel.
    """

    tick: int
    axis: int
    code: Code
    values: tuple[int, ...] = ()


@dataclass(frozen=True)
class Setting:
    """A register that is written."""

    tick: int
    register: int
    value: int

    @property
    def axis(self) -> int:
        """Whose setting it is."""
        return self.register // 100

    @property
    def name(self) -> str:
        """Which one it is."""
        return OFFSETS[self.register % 100]


@dataclass(frozen=True)
class Edge:
    """An input, BI1 to BI8, that has a new level from a tick on."""

    tick: int
    number: int
    level: int


@dataclass(frozen=True)
class Sample:
    """Registers of an axis that were read at a tick: value by name as in the contract."""

    tick: int
    axis: int
    values: dict[str, int]


Event = Act | Setting | Edge | Sample


@dataclass(frozen=True)
class Session:
    """What comes to a unit; ticks count from its start, what comes at one keeps its order."""

    script: tuple[Act | Setting, ...]
    edges: tuple[Edge, ...] = ()
    end: int = 0
    reads: tuple[tuple[int, int], ...] = ()
    """Tick and axis of each reading of registers."""

    @property
    def lines(self) -> tuple[Act | Setting | tuple[int, int], ...]:
        """The script with its readings, in the order of time."""
        return tuple(sorted((*self.script, *self.reads), key=_tick))

    @property
    def csv(self) -> str:
        """The script as `positioning sim` reads it."""
        return "".join(f"{_row(each)}\n" for each in self.lines)

    @property
    def inputs_csv(self) -> str:
        """The inputs as `--inputs` has them."""
        return "".join(f"{_ms(e.tick)},{e.number},{e.level}\n" for e in self.edges)

    @property
    def text(self) -> str:
        """What comes, for people."""
        rows = [(each.tick, 1, _row(each)) for each in self.script]
        rows += [(e.tick, 0, f"{_ms(e.tick)},BI{e.number}={e.level}") for e in self.edges]
        return "\n".join(row for *_, row in sorted(rows, key=lambda row: row[:2]))


def _ms(tick: int) -> str:
    return f"{tick / MS:.6f}".rstrip("0").rstrip(".")


def _tick(each: Act | Setting | tuple[int, int]) -> int:
    return each[0] if isinstance(each, tuple) else each.tick


def _row(each: Act | Setting | tuple[int, int]) -> str:
    if isinstance(each, tuple):
        return f"{_ms(each[0])},{each[1]},READ"
    if isinstance(each, Setting):
        return f"{_ms(each.tick)},0,SETTING,{each.register},{each.value}"
    values = [str(v) for v in each.values]
    if each.code == Code.POS_CONTROL and each.values[1] < 0:
        values.pop()
    return ",".join([_ms(each.tick), str(each.axis), each.code.name, *values])
