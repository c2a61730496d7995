"""Another master of a positioning unit, such as a PLC."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from rkm04_tools.positioning.unit import open_unit

PATIENCE_SECONDS = 15.0


@contextmanager
def cycles(place: str, seconds: float = 0.02) -> Iterator[None]:
    """A PLC that writes permission and feed of axis 1 in each of its cycles."""
    over = threading.Event()

    def run() -> None:
        with open_unit(place) as unit:
            while not over.wait(seconds):
                unit.wire.write(105, [1, 3000, 0])

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join(PATIENCE_SECONDS)
