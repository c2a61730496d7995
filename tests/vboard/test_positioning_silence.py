"""When the positioning unit's image on the virtual board takes a frame: with T of silence.

As delivered the line has 19 200 Bd and 8E1. The first frame is for another unit, the second is the
request; who joins them has neither.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from pos_board import read, run_image, sealed

CHARACTER_MS = 11 / 19.2
T_MS = 3.5 * CHARACTER_MS
BEGIN_MS = 50.0
END_MS = 100.0
OTHERS = sealed(b"\x02\x06\x00\x01\x00\x01")
FRAME = read(0, 1)
LATE_MS = 0.1
"""Its interrupt, and what main does from the silence to the first byte of an answer."""
EARLY_MS = 0.5 / 19.2
"""A byte is in the register in the middle of its stop bit."""

Ask = Callable[..., list[tuple[float, str]]]


@pytest.fixture(params=["as the figure", "masked first"])
def ask(
    request: pytest.FixtureRequest, program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Ask:
    """Run the image with frames that begin at some times; what it has said, and when."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    options = () if request.param == "as the figure" else ("--exti-mask-first",)

    def run(*frames: tuple[float, bytes]) -> list[tuple[float, str]]:
        line = "".join(f"{at:.6f} {frame.hex()}\n" for at, frame in frames)
        run_image(program, tmp_path, line, END_MS, *options)
        rows = (tmp_path / "log.txt").read_text().splitlines()
        return [(float(ms), byte) for ms, byte in (row.split() for row in rows)]

    return run


def test_an_answer_begins_with_T_after_the_request(ask: Ask) -> None:
    end = BEGIN_MS + len(FRAME) * CHARACTER_MS

    begin = ask((BEGIN_MS, FRAME))[0][0]

    assert -EARLY_MS <= begin - (end + T_MS) <= LATE_MS


def test_a_byte_that_begins_just_before_T_goes_on_with_the_frame(ask: Ask) -> None:
    next_ms = BEGIN_MS + len(OTHERS) * CHARACTER_MS + T_MS - 0.1

    assert ask((BEGIN_MS, OTHERS), (next_ms, FRAME)) == []


def test_a_byte_that_begins_just_after_T_begins_another(ask: Ask) -> None:
    next_ms = BEGIN_MS + len(OTHERS) * CHARACTER_MS + T_MS + 0.1

    said = ask((BEGIN_MS, OTHERS), (next_ms, FRAME))

    assert [byte for _, byte in said][:3] == ["01", "03", "02"]
