"""What tools/test makes of the fuzzers, with a program that stands in for them."""

from __future__ import annotations

from pathlib import Path

import pytest
from checks import fuzz

FILES_MAX = 200
BYTES_MAX = 200_000


def stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch, status: int) -> None:
    """Put a program in the place of every fuzzer that has made 1000 runs and ends like this."""
    monkeypatch.setattr(fuzz, "BUILD", folder)
    (folder / "bin").mkdir()
    for name in fuzz.INPUT_BYTES_MAX:
        program = folder / "bin" / f"fuzz-{name}"
        program.write_text(
            f"#!/bin/sh\necho broken promise\necho stat::number_of_executed_units: 1000\n"
            f"exit {status}\n"
        )
        program.chmod(0o755)


def test_runs_of_replay_and_exploration_are_added_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stand_in(tmp_path, monkeypatch, 0)

    assert fuzz.explore(1) == 0

    assert "20 000 runs of fuzzers" in capsys.readouterr().out


def test_without_time_the_corpora_are_only_replayed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stand_in(tmp_path, monkeypatch, 0)

    assert fuzz.explore(0) == 0

    assert "10 000 runs of fuzzers" in capsys.readouterr().out


def test_what_a_fuzzer_finds_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stand_in(tmp_path, monkeypatch, 77)

    assert fuzz.explore(0) == len(fuzz.INPUT_BYTES_MAX)

    assert "broken promise" in capsys.readouterr().out


@pytest.mark.parametrize("name", fuzz.INPUT_BYTES_MAX)
def test_a_corpus_is_there_and_small(name: str) -> None:
    sizes = [path.stat().st_size for path in (fuzz.CORPUS / name).iterdir()]
    assert 0 < len(sizes) < FILES_MAX
    assert sum(sizes) < BYTES_MAX
