"""Random sessions with a GVE134 unit, each by a seed.

They are made of episodes, so that holds, interrupts, kept paths and reference runs come to pass
often; between the lines of an episode the host waits for the answer, does not, or takes its time.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from gve_line import Byte
from gve_record import BYTE_TICKS, Edge, Session
from gve_words import AXES, with_sum
from reference import TICK_HZ

MS = TICK_HZ // 1000
READY_MS = 120.0
SILENCE_MS = (85.0, 120.0)
"""A pause must not come so near to the 100 ms after which damage is over."""

PATIENCE_MS = (900.0, 1150.0)
"""Likewise the 1 s of a line that is not whole."""

LENGTH = 300
SPEEDS = (50, 20_000)
KNOWN = ("?", "Q", "P", "PF", "P4", "PL", "F", "I1", "I2", "@", ">", "%-")
WRONG_WORDS = """
L L1,2,3,4,5 L2147483648 L-2147483648 C1,,2 L--1 C99999999999999 V9 V200001 V V1,2 V-5 Vx A0
A8001 B9 T0 T25 $0 $ XM0 XM1001 XQ XM VL1,2,3 VL9,10,10,10 VL10,10,10,200001 VJ1,2,3,200001 VX
VKV NQ1 NX NX1,2 WX WX0,100,1,100 WQ1,100,1,100 WX5,9,1,100 WX5,100,0,100 WX5,100,1 SR8 SR SR-1
SW8,F1 SW1 SW1,100 SW1,G O1,00 O0 O0,123 ER100 ER EURFD EUWFD,1 EUW10,123456789 EFW10,1E39
EFW10,.5 EFW10,1.5E EWFF E EU10,1 S Z 1 *Q *E200 *E *E5 *Sx J1 H1 G1 D0 K1 R, F1 P5 @1 >> % %x
?0 Q1 PX v1000x
"""
WRONG = ("", "L1 ", *WRONG_WORDS.split())


class Writer:
    """Writes a session line by line."""

    def __init__(self, seed: object) -> None:
        """Draw everything from a seed."""
        self.rng = random.Random(str(seed))
        self.tick = round(self.rng.uniform(READY_MS, 2 * READY_MS) * MS)
        self.line: list[Byte] = []
        self.edges: list[Edge] = []
        self.sums = False
        self.accel = 20
        self.cause = "power"

    # --- lines ---

    def pause(self, ms: float) -> None:
        """Let time pass, but keep clear of the limits of the line."""
        for low, high in (SILENCE_MS, PATIENCE_MS):
            if low < ms < high:
                ms = self.rng.choice((low - 5, high + 5))
        self.tick += round(ms * MS)

    def send(self, text: str, *, broken: int = -1, gap: int = -1) -> None:
        """Send characters; one of them may be broken, and before one there may be a pause."""
        for at, value in enumerate(text):
            if at == gap:
                self.pause(self.rng.choice((5.0, 60.0, 300.0)))
            self.tick += BYTE_TICKS
            self.line.append(Byte(self.tick, ord(value), broken == at))

    def say(self, text: str, *, wait: bool | None = None) -> None:
        """Send a command, and wait for its answer, or not, or longer."""
        rng = self.rng
        if rng.random() < 0.03:
            text = text.lower()
        request = f"!{text}"
        self.send((with_sum(request) if self.sums else request) + "\r", gap=self._gap(request))
        if wait is None:
            wait = rng.random() < 0.8
        if wait:
            self.pause(rng.choice((1.2, 3.0, 3.0, 3.0, 10.0, rng.uniform(1, 60))))

    def _gap(self, request: str) -> int:
        return self.rng.randrange(1, len(request)) if self.rng.random() < 0.01 else -1

    def tell(self, text: str, *, wait: bool | None = None) -> None:
        """Send a command to the interpolator."""
        self.say(f"0{text}", wait=wait)

    # --- numbers ---

    def size(self, least: int, most: int) -> int:
        """Draw a number of any order of size."""
        number = math.exp(self.rng.uniform(math.log(least), math.log(most + 1)))
        return max(least, min(most, int(number)))

    def steps(self, most: int = LENGTH) -> str:
        """Draw a vector."""
        rng = self.rng
        longest = self.size(1, most)
        count = rng.choice((1, 2, 2, 3, 4))
        steps = [
            rng.choice((1, -1)) * rng.choice((longest, self.size(1, longest), 0, longest // 2))
            for _ in range(count)
        ]
        if rng.random() < 0.97 and not any(steps):
            steps[rng.randrange(count)] = longest
        if self.sums:
            steps += [0] * (4 - count)
        return ",".join(map(str, steps))

    def four(self, least: int, most: int) -> str:
        """Draw a number for each axis."""
        return ",".join(str(self.size(max(1, least), most)) for _ in AXES)

    # --- episodes ---

    def modal(self) -> None:
        """Change what the next vectors are entered with."""
        rng = self.rng
        kind = rng.choice("VVVAAABBT$KNLJ")
        if kind == "V":
            self.tell(f"V{self.size(*SPEEDS)}")
        elif kind == "A":
            self.accel = rng.choice((self.size(1, 8000), self.size(10, 300)))
            self.tell(f"A{self.accel}")
        elif kind == "B":
            self.tell(f"B{self.size(10, 20_000)}")
        elif kind == "T":
            self.tell(f"T{rng.randint(1, 24)}")
        elif kind == "$":
            self.tell(f"${self.size(1, 1000)}")
        elif kind in "KN":
            self.tell(f"V{kind}")
        elif kind == "L":
            self.tell(f"VL{self.four(100, 20_000)}")
        else:
            jumps = self.four(1, 5000)
            self.tell(rng.choice((f"VJ{jumps}", f"VJ{jumps}", "VJ0,0,0,0")))

    def vectors(self) -> None:
        """Enter some vectors."""
        rng = self.rng
        if rng.random() < 0.5:
            self.tell(f"L{self.steps()}")
        for _ in range(rng.choice((0, 1, 1, 2, 3, 6))):
            if rng.random() < 0.15:
                self.modal()
            self.tell(f"C{self.steps()}")

    def packet(self) -> None:
        """Send a packet, some of them wrong."""
        rng = self.rng
        count = rng.choice((1, 2, 3, 5, 8, 20))
        wrong = rng.choice(
            (*("",) * 8, "number", "line", "other", "broken", "stop", "again", "short")
        )
        at = rng.randrange(count)
        self.tell("*S", wait=False)
        told = count
        for number in range(count):
            if number == at and wrong == "line":
                self.tell(rng.choice(WRONG[:10]), wait=False)
            elif number == at and wrong == "other":
                self.say(
                    rng.choice(("0V500", "0SR1", "0Z", "0%+", "0@", "7V100", "0L5,0,0,0")),
                    wait=False,
                )
            elif number == at and wrong == "broken":
                text = f"!0C{self.steps(40)},0"
                self.send(text + "\r", broken=rng.randrange(len(text)))
            elif number == at and wrong == "stop":
                self.tell(rng.choice("HHJ"), wait=False)
                self.pause(READY_MS if rng.random() < 2 else 0)
                self.sums = self.sums and "J" not in chr(self.line[-2].value)
                return self.calm()
            elif number == at and wrong == "again":
                self.tell("*S", wait=False)
                told = count - number - 1
            elif rng.random() < 0.2:
                self.tell(f"B{self.size(10, 20_000)}", wait=False)
            else:
                self.tell(f"C{self.steps(60)}", wait=False)
        if wrong == "short":
            return self.pause(1300)
        return self.tell(f"*E{told + (wrong == 'number')}")

    def calm(self) -> None:
        """Be sure that sums are off, whatever has happened."""
        self.pause(READY_MS + 10)
        if self.sums:
            self.tell("%-")
            self.sums = False
        self.send("!0%-,CF\r")
        self.pause(READY_MS + 10)

    def hold(self) -> None:
        """Stop the axes, and let them go on, or not."""
        rng = self.rng
        self.pause(rng.choice((0.0, 1.0, 20.0, rng.uniform(0, 80))))
        self.tell(rng.choice(("H", "H", "H", "H", "SW6,01")))
        for _ in range(rng.choice((0, 0, 1, 1, 2, 4))):
            rng.choice(
                (self.modal, self.override, self.read, self.status, self.vectors, self.number)
            )()
        self.tell(rng.choice(("G", "G", "G", "G", "D", "SW6,00", "H", "R")))

    def keep(self) -> None:
        """Keep a path beside another one."""
        rng = self.rng
        self.tell("H")
        if rng.random() < 0.5:
            self.pause(rng.uniform(0, 40))
        self.tell("K")
        for _ in range(rng.choice((0, 1, 2, 2, 3))):
            self.tell(
                rng.choice(
                    (f"L{self.steps(60)}", f"L{self.steps(60)}", "L0,0,0", "C5,5,5,5", "K", "R")
                )
            )
            self.pause(rng.choice((1.0, 20.0, 60.0, rng.uniform(0, 300))))
        if rng.random() < 0.3:
            self.override()
        self.tell("R")
        if rng.random() < 0.5:
            self.tell(rng.choice(("XA", "XM50", "XU", "SR6", "P4", "F", "XD")))
        self.tell(rng.choice("GGGGDR"))

    def override(self) -> None:
        """Change the speed of all that waits."""
        rng = self.rng
        for _ in range(rng.choice((1, 1, 1, 3))):
            self.tell(
                rng.choice(("XA", "XU", "XD", f"XM{self.size(10, 300)}", f"XM{self.size(1, 1000)}"))
            )

    def read(self) -> None:
        """Read something."""
        self.say(self.rng.choice("00000007") + self.rng.choice(KNOWN))

    def status(self) -> None:
        """Read or write status bytes."""
        rng = self.rng
        if rng.random() < 0.6:
            self.tell(f"SR{rng.choice((0, 1, 2, 3, 4, 4, 5, 5, 6, 6, 6, 6, 7))}")
        elif rng.random() < 0.85:
            self.tell(f"SW{rng.randrange(6)},{rng.choice((0, 255, 15, 192, rng.randrange(256))):X}")
        else:
            self.tell(f"SW6,{rng.choice((0, 1, 16, 128, 144, rng.randrange(256))):02X}")

    def number(self) -> None:
        """Set positions."""
        rng = self.rng
        axis = rng.choice(AXES) + rng.choice(("", "", ","))
        self.tell(
            rng.choice(
                (
                    "N",
                    f"N{axis}{rng.randint(-1000, 1000)}",
                    f"NX{rng.choice((-1, 1)) * (2**31 - 1)}",
                )
            )
        )

    def interrupts(self) -> None:
        """Enable interrupts while inputs change."""
        rng = self.rng
        self.tell(f"SW0,{rng.choice((1, 2, 15, rng.randrange(16))):02X}")
        if rng.random() < 0.6:
            self.tell(f"SW2,{rng.choice((0, 15, 1, rng.randrange(16))):02X}")
        if rng.random() < 0.5:
            self.tell(f"SW1,{rng.choice(('40', '80', 'C0', 'FF')):s}")
            self.tell(f"SW3,{rng.choice(('00', 'C0', '40')):s}")
        tick = self.tick
        for _ in range(rng.choice((1, 1, 2, 4))):
            tick += round(self.size(300, 100_000) * MS / 1000)
            self.toggle(
                tick, rng.choice((1, 2, 3, 4, 7, 8)), rng.choice((0.2, 2.0, 30.0, 300.0, 1e6))
            )

    def toggle(self, tick: int, number: int, ms: float) -> None:
        """Close a switch for a time; not while it is closed already."""
        last = [edge for edge in self.edges if edge.number == number]
        if last and (last[-1].tick > tick - MS or last[-1].level == 0):
            return
        self.edges.append(Edge(tick, number, 0))
        if ms < 1e5:
            self.edges.append(Edge(tick + round(ms * MS), number, 1))

    def search(self) -> None:
        """Run to a reference switch that is where one could be."""
        rng = self.rng
        axis, speed, slow = rng.randrange(4), self.size(300, 6000), self.size(100, 2000)
        way, back = self.size(20, 400), self.size(20, 400)
        if rng.random() < 0.85:
            self.tell("H" if rng.random() < 0.2 else "?")
            self.pause(rng.uniform(0, 400))
            self.tell("D")
        if rng.random() < 0.5:
            self.accel = self.size(20, 8000)
            self.tell(f"A{self.accel}")
        self.tell(f"SW2,{rng.choice(('00', '00', '0F', f'{rng.randrange(16):02X}'))}")
        sign = rng.choice((1, -1))
        comma = rng.choice(("", ","))
        self.tell(f"W{AXES[axis]}{comma}{sign * way},{speed},{back},{slow}", wait=False)
        at = rng.choice((rng.uniform(2, way), way / 2, 1.5 * way))
        met = self.tick + round((0.4 + time_to(at, way, speed, self.accel)) * MS)
        brake = min(way - at if at < way else 0, speed**2 / 2000 / self.accel)
        leave = rng.uniform(brake * 0.5, brake * 2 + 5)
        turned = met + round((speed / self.accel + 0.7) * MS)
        left = turned + round((time_to(leave, back, slow, self.accel) + 0.3) * MS)
        self.toggle(met, axis + 1, (left - met) / MS)
        if rng.random() < 0.15:
            self.pause(rng.uniform(0, 100))
            self.tell(rng.choice(("H", "H", "V500")))
        if rng.random() < 0.7:
            self.pause((left - self.tick) / MS + 200 if left > self.tick else 200)

    def memory(self) -> None:
        """Read or write the memory."""
        rng = self.rng
        at = rng.choice((0x10, 0x11, 0x12, 0x40, 0xF8, 0xFA, 0xFC, rng.randrange(0x20, 0xF8)))
        single = rng.choice(
            (
                "0",
                "1.5",
                "-0",
                "0.1",
                f"{rng.uniform(-1e6, 1e6):.6f}",
                "1E-40",
                "3.5E38",
                "1E39",
                "1E-46",
            )
        )
        number = rng.choice((rng.getrandbits(32), 0x7FC00000, 0xFF800000, 0x3FC00000))
        texts = (
            *(
                f"ER{at:02X}",
                f"ER{rng.choice((1, 5, 12, 253)):X}",
                f"EUR{min(at, 0xFC):X}",
                f"EFR{min(at, 0xFC):X}",
            ),
            *(f"EW{at:02X},{rng.randrange(256):02X}", f"EUW{min(at, 0xF4):02X},{number:X}"),
            *(
                f"EFW{rng.randrange(0x20, 0x60):02X},{single}",
                "EW05,AC",
                "EW05,FF",
                f"EW01,{rng.randrange(11):02X}",
                "Q",
            ),
        )
        self.say(rng.choice("00007") + rng.choice(texts))

    def switch(self) -> None:
        """Switch outputs."""
        rng = self.rng
        number = rng.choice((0, 1, 300, 1000, 1001, rng.randint(0, 1000)))
        self.say(
            rng.choice(
                (
                    f"0O0,{rng.randrange(256):X}",
                    f"7V{number}",
                    "0O0,FF",
                    f"0EW01,0{rng.randrange(10)}",
                )
            )
        )

    def wrong(self) -> None:
        """Say something wrong."""
        rng = self.rng
        self.say(rng.choice("00000073") + rng.choice(WRONG))

    def damage(self) -> None:
        """Damage a line, or say something outside of one."""
        rng = self.rng
        text = f"!0{rng.choice(('V500', 'L10,10', 'C5', 'H', 'SR6', 'XA'))}"
        kind = rng.choice(("broken", "broken", "again", "stop", "outside", "sum", "long"))
        if kind == "broken":
            self.send(text + "\r", broken=rng.randrange(len(text) + 1))
        elif kind == "again":
            self.send(text[: rng.randrange(1, len(text))])
            self.tell("V300", wait=False)
        elif kind == "stop":
            self.send(text[: rng.randrange(1, len(text))])
            self.pause(1300)
        elif kind == "outside":
            self.send(rng.choice(("\n", "x", "0V5\r", "\r\r")))
        elif kind == "sum":
            self.send(text + rng.choice((",00", ",0", "", ",ZZ", ",F")) + "\r")
        else:
            self.send("!0V" + "0" * rng.choice((70, 76, 77, 78, 79, 90)) + "500\r")
        self.pause(rng.choice((150.0, 150.0, 200.0, 5.0)))

    def sums_switch(self) -> None:
        """Switch sums on or off."""
        text = f"!{self.rng.choice('007')}%{'-' if self.sums else '+'}"
        self.send((with_sum(text) if self.sums else text) + "\r")
        self.sums = not self.sums
        self.pause(3.0)

    def reset(self) -> None:
        """Reset the unit."""
        self.tell("J", wait=False)
        self.sums, self.accel = False, 20
        self.pause(READY_MS + self.rng.choice((5.0, 50.0)))

    def couple(self) -> None:
        """Couple A with another axis, for good: what A's own position is later, nobody tells."""
        self.tell("H")
        self.pause(self.rng.uniform(0, 300))
        self.tell("D")
        self.tell(f"EW0C,0{self.rng.choice((1, 2, 3))}")

    def crowd(self) -> None:
        """Fill the queue, nearly or more than that."""
        rng = self.rng
        self.tell(f"V{self.size(10, 300)}")
        for _ in range(2):
            count = rng.choice((20, 60, 64, 127, 128))
            self.tell("*S", wait=False)
            for _ in range(count):
                self.tell(f"C{rng.choice((1, -1, 2))},{rng.choice((0, 1))},0,0", wait=False)
            self.tell(f"*E{count}")
            self.pause(rng.choice((0.0, 50.0)))
        for _ in range(rng.choice((1, 3, 10))):
            self.tell(rng.choice(("C1,0,0,0", "C1,0,0,0", "F", "L1,0,0,0", "C0,0,0,0")))
            self.pause(rng.uniform(0, 200))
        if rng.random() < 0.7:
            self.tell(rng.choice(("XM1000", "V20000")))

    def wait(self) -> None:
        """Wait."""
        self.pause(self.rng.choice((5.0, 50.0, 400.0, self.rng.uniform(0, 700))))

    EPISODES: tuple[tuple[Callable[[Writer], None], int], ...] = (
        (modal, 14),
        (vectors, 22),
        (packet, 5),
        (hold, 14),
        (keep, 5),
        (override, 10),
        (read, 10),
        (status, 6),
        (number, 4),
        (interrupts, 7),
        (search, 4),
        (memory, 4),
        (switch, 3),
        (wrong, 5),
        (damage, 3),
        (sums_switch, 2),
        (reset, 1),
        (couple, 1),
        (crowd, 1),
        (wait, 8),
    )

    def session(self) -> Session:
        """Write a whole session."""
        rng = self.rng
        acts, weights = zip(*self.EPISODES, strict=True)
        if rng.random() < 0.03:
            self.cause = rng.choice(("watchdog", "watchdog", "crystal"))
        for act in rng.choices(acts, weights, k=rng.choice((3, 6, 10, 16))):
            act(self)
        self.pause(rng.choice((20.0, 300.0, 1300.0)))
        if rng.random() < 0.7:
            self.tell("P4")
            self.tell("SR6")
        return self.written()

    def written(self) -> Session:
        """Return the session that has been written."""
        rng = self.rng
        edges = sorted((e for e in self.edges), key=lambda edge: edge.tick)
        return Session(
            tuple(self.line),
            tuple(edge for edge in edges if edge.tick < self.tick),
            self.tick + 1200 * MS,
            rng.choice((0, rng.getrandbits(60))),
            rng.choice((0, 21_504, 42_000)),
            self.cause,
        )


def time_to(way: float, whole: float, speed: float, accel: float) -> float:
    """About how many ms a vector takes to a place, with an acceleration in 1000 pulses/s²."""
    way, per_s2 = max(0.0, min(way, whole)), accel * 1000
    ramp = min(speed**2 / 2 / per_s2, whole / 2)
    if way <= ramp:
        return 1000 * math.sqrt(2 * way / per_s2)
    top = math.sqrt(2 * ramp * per_s2)
    return 1000 * (top / per_s2 + (way - ramp) / top)


def session(seed: object) -> Session:
    """Return the session of a seed."""
    return Writer(seed).session()
