"""Vector files by chance, which the unit takes without a word."""

from __future__ import annotations

import random


def drawn_file(chance: random.Random) -> str:
    """Ways, speeds, positions that are set, and what is for the host; some seconds of motion."""
    lines = []
    for _ in range(chance.randrange(1, 20)):
        way = ",".join(str(chance.randrange(-3000, 3000)) for _ in range(4))
        short = way[: way.rindex(",")]
        speed = chance.randrange(1000, 20000)
        more = (f"V{speed}", "N", f"NY,{chance.randrange(-99, 99)}")
        lines.append(
            chance.choice(
                (f"C{way}", f"c{short} ; x", f"!0L{way}", *more, ";@wait 0.5", f"B{speed}")
            )
        )
    return chance.choice(("\n", "\r\n")).join(lines)
