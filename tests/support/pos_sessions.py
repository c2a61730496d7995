"""Random sessions with the positioning unit, each by a seed.

They are made of episodes, so that holds, changes on ramps, homing and limits come to pass often. A
session is for one to four axes; what comes to one is drawn by itself.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from pos_model import setting
from pos_session import Act, Edge, Session, Setting
from pos_words import AXES, FEED_UNITS, MS, Code, Settings

FIRST_MS = 5.0
PULSES = 1500
"""About so many pulses has a measure at most."""

RATIOS = ((1, 10), (1, 10), (1, 10), (3200, 40_000), (7, 3), (1, 1), (2, 5), (50, 1), (1, 1000))
GAPS_MS = (1.5, 2.0, 5.0, 15.0, 15.0, 40.0, 150.0)


class Writer:
    """Writes what comes to one axis."""

    def __init__(self, rng: random.Random, axis: int) -> None:
        """Draw everything from a generator."""
        self.rng, self.axis = rng, axis
        self.ms = FIRST_MS + rng.uniform(0, 5)
        self.script: list[Act | Setting] = []
        self.edges: list[Edge] = []
        self.set: dict[str, int] = {}
        self.feed = FEED_UNITS * 1000
        self.mode_ms = 0.0

    # --- what comes ---

    def tell(self, code: Code, *values: int, wait: float | None = None) -> None:
        """Give an instruction, and wait."""
        self.script.append(Act(self.tick, self.axis, code, values))
        self.ms += self.rng.choice(GAPS_MS) if wait is None else wait

    def setting(self, name: str, value: int) -> None:
        """Write a setting."""
        self.set[name] = value
        self.script.append(setting(self.tick, self.axis, name, value))

    @property
    def tick(self) -> int:
        """The present, on the grid of scripts."""
        return round(self.ms * 1000) * (MS // 1000)

    @property
    def settings(self) -> Settings:
        """All settings."""
        return Settings(**self.set)

    def size(self, least: float, most: float) -> int:
        """Draw a number of any order of size."""
        low, high = math.log(max(least, 1)), math.log(max(most, 1))
        return max(1, round(math.exp(self.rng.uniform(low, high))))

    def feeds(self, low: float = 5, high: float = 60_000) -> int:
        """A feed with so many steps/s."""
        rate = self.size(low, high)
        units = rate * 60 * FEED_UNITS / 1000 / float(self.settings.ratio)
        return max(1, min(2**32 - 1, round(units)))

    def slope(self) -> int:
        """An acceleration with which the axis comes to 1000 steps/s in 1 ms to 1 s."""
        accel = self.size(1000, 1_000_000) / 1000 / float(self.settings.ratio)
        return max(1, min(65_535, round(accel)))

    def way(self, pulses: int = PULSES) -> int:
        """A way in micrometres."""
        rng = self.rng
        most = pulses / float(self.settings.ratio)
        way = rng.choice((self.size(1, most), self.size(most / 10, most), rng.randint(0, 20)))
        return rng.choice((1, 1, -1)) * way

    # --- episodes ---

    def prepare(self) -> None:
        """Write settings."""
        rng = self.rng
        steps, micrometres = rng.choice(RATIOS)
        self.setting("steps", steps)
        self.setting("micrometres", micrometres)
        if rng.random() < 0.3:
            self.setting("start_feed", self.feeds(5, 800))
        if rng.random() < 0.3:
            self.setting("error_accel", min(65_535, 4 * self.slope()))
        if rng.random() < 0.3:
            self.setting("backlash", round(rng.choice((1, 3, 20)) / float(self.settings.ratio)))
        if rng.random() < 0.2:
            self.setting("invert", 1)
        if rng.random() < 0.2:
            self.setting("highest_feed", self.feeds(300, 20_000))
        for at, name in enumerate(("limit_minus", "limit_plus", "reference", "capture")):
            if rng.random() < 0.5:
                number = rng.choice((at * 2 + 1, at * 2 + 2))
                self.setting(name, rng.choice((1, 1, -1)) * number if at > 1 else number)
        self.setting("home_feed", self.feeds(100, 5000))
        self.setting("home_slow", self.feeds(50, 1000))
        self.setting("home_way", abs(self.way()) + math.ceil(2 / self.settings.ratio))
        if rng.random() < 0.3:
            low, high = sorted((self.way(), self.way()))
            self.setting("soft_min", low)
            self.setting("soft_max", high + 1)

    def measure(self) -> None:
        """Program a measure, start it, mostly."""
        rng = self.rng
        code = rng.choice((Code.POS_MODE, Code.POS_MODE, Code.POS_MODE_ABS))
        self.tell(code, self.way(), self.slope(), wait=rng.choice((0, 0, 0, 2.5, 10)))
        if rng.random() < 0.9:
            self.control()

    def control(self) -> None:
        """Give a feed."""
        rng = self.rng
        if rng.random() < 0.7:
            self.feed = self.feeds()
        self.tell(Code.POS_CONTROL, self.feed, rng.choice((1, 1, 1, 1, -1, 0)))

    def drive(self) -> None:
        """Change the feed again and again, hold, and let it go on."""
        rng = self.rng
        for _ in range(rng.choice((1, 2, 4, 8))):
            feed = rng.choice((self.feed, self.feeds(), self.feeds(5, 500), 0, self.feed ^ 1))
            self.tell(Code.POS_CONTROL, feed, rng.choice((1, 1, 1, 0)))
        if rng.random() < 0.8:
            self.tell(Code.POS_CONTROL, self.feeds(300, 60_000), 1)

    def init(self) -> None:
        """Take the axis."""
        self.tell(Code.POS_INIT, self.rng.choice((0, 0, 0, 6, 7)))

    def again(self) -> None:
        """Take the axis, perhaps in motion, and program at once."""
        self.tell(Code.POS_INIT, 0, wait=self.rng.choice((0, 2, 30)))
        self.measure()

    def reset(self) -> None:
        """Give the axis back."""
        self.tell(Code.POS_RESET)
        if self.rng.random() < 0.7:
            self.again()

    def wrong(self) -> None:
        """Give an instruction that may be refused."""
        rng = self.rng
        choices: tuple[tuple[Code, tuple[int, ...]], ...] = (
            (Code.POS_MODE, (-(2**31), 100)),
            (Code.POS_MODE, (self.way(), 0)),
            (Code.POS_MODE, (self.way(), self.slope())),
            (Code.POS_MODE_ABS, (-(2**31), 0)),
            (Code.POS_HOME, (20, 0, 100)),
            (Code.POS_HOME, (19, 0, 0)),
            (Code.POS_INIT, (7,)),
            (Code.POS_CAPTURE, ()),
        )
        code, values = rng.choice(choices)
        self.tell(code, *values)

    def refer(self) -> None:
        """Say where the axis is."""
        self.tell(Code.POS_HOME, 37, self.way(), 0)

    def home(self) -> None:
        """Home, with a switch that comes and goes."""
        rng = self.rng
        number = self.set.get("reference", 0)
        method = rng.choice((19, 21))
        self.tell(Code.POS_INIT, 0, wait=rng.choice((60, 300)))
        self.tell(Code.POS_HOME, method, self.way(), self.slope(), wait=2)
        self.tell(Code.POS_CONTROL, 2**32 - 1, 1, wait=0)
        if number:
            met = self.ms + self.size(3, 300)
            left = met + self.size(100, 900)
            self.toggle(met, number, active=True)
            self.toggle(left, number, active=False)
            if rng.random() < 0.3:
                self.ms += rng.uniform(2, 200)
                self.drive()
            self.ms = max(self.ms, left + rng.choice((200, 500)))

    def toggle(self, ms: float, number: int, *, active: bool) -> None:
        """Change an input."""
        level = int(active == (number > 0))
        tick = round(ms * 1000) * (MS // 1000) + MS // 2
        self.edges.append(Edge(tick, abs(number), level))

    def limit(self) -> None:
        """Let an input come and go."""
        rng = self.rng
        name = rng.choice(("limit_minus", "limit_plus", "capture"))
        number = self.set.get(name, 0)
        if name == "capture":
            self.tell(Code.POS_CAPTURE, wait=rng.choice((0, 2)))
        if number:
            at = self.ms + self.size(1, 200)
            self.toggle(at, number, active=True)
            self.toggle(at + self.size(2, 200), number, active=False)
        if rng.random() < 0.5:
            self.ms += 300
            self.again()

    def wait(self) -> None:
        """Wait."""
        self.ms += self.rng.choice((5, 50, 300, 1000))

    EPISODES: tuple[tuple[Callable[[Writer], None], int], ...] = (
        (measure, 12),
        (control, 10),
        (drive, 18),
        (init, 3),
        (again, 10),
        (reset, 4),
        (wrong, 5),
        (refer, 2),
        (home, 5),
        (limit, 5),
        (wait, 12),
    )

    def write(self) -> None:
        """Write it all."""
        rng = self.rng
        if rng.random() < 0.8:
            self.prepare()
            self.ms += 2
        if self.set.get("soft_max") is not None:
            self.init()
            self.refer()
        if rng.random() < 0.95:
            self.again()
        acts, weights = zip(*self.EPISODES, strict=True)
        for act in rng.choices(acts, weights, k=rng.choice((2, 4, 8, 12))):
            act(self)
        self.ms += rng.choice((20, 300, 1500))


def session(seed: object) -> Session:
    """The session of a seed."""
    rng = random.Random(f"positioning {seed}")
    axes = rng.sample(AXES, rng.choice((1, 1, 2, 4)))
    writers = [Writer(rng, axis) for axis in axes]
    for writer in writers:
        writer.write()
    end = max(writer.tick for writer in writers) + 200 * MS
    script = sorted((a for writer in writers for a in writer.script), key=lambda act: act.tick)
    edges = spaced([edge for writer in writers for edge in writer.edges if edge.tick < end])
    reads = {(rng.randrange(1, end // MS) * MS, rng.choice(axes)) for _ in range(8)}
    reads |= {(end - MS, axis) for axis in axes}
    return Session(tuple(script), tuple(edges), end, tuple(sorted(reads)))


def spaced(edges: list[Edge]) -> list[Edge]:
    """The edges that change a level, each at a tick of its own."""
    levels: dict[int, int] = {}
    kept: list[Edge] = []
    for edge in sorted(edges, key=lambda edge: edge.tick):
        if levels.get(edge.number, 0) == edge.level:
            continue
        if kept and edge.tick <= kept[-1].tick:
            continue
        levels[edge.number] = edge.level
        kept.append(edge)
    return kept
