"""`bringup`: where nothing was seen, nothing is said to be good."""

from __future__ import annotations

import socket

import pytest
from rkm04_tools.bringup.plan import STEPS
from rkm04_tools.failure import NO_CONNECTION, NOT_SO


@pytest.mark.parametrize("walk", [["n"], ["y", *["s" for _ in STEPS]]], ids=["ended", "left out"])
def test_a_walk_in_which_nothing_was_seen_is_not_good(tool, monkeypatch, tmp_path, walk):
    typed = tmp_path / "typed"
    typed.write_text("\n".join([*walk, ""]))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = f"socket://127.0.0.1:{listener.getsockname()[1]}"
        with typed.open() as lines:
            monkeypatch.setattr("sys.stdin", lines)
            told = tool("bringup", "--port", port, "--json")
        with typed.open() as lines:
            monkeypatch.setattr("sys.stdin", lines)
            words = tool("bringup", "--port", port)

    assert (told.status, told.json["good"], told.json["complete"]) == (NOT_SO, False, False)
    assert "\nnothing was seen; NOT DONE: line, part" in words.out


def test_a_port_that_is_absent_is_not_good(tool, monkeypatch, tmp_path):
    typed = tmp_path / "typed"
    typed.write_text("y\n")
    with typed.open() as lines:
        monkeypatch.setattr("sys.stdin", lines)
        told = tool("bringup", "--port", tmp_path / "absent", "--json")

    assert told.status == NO_CONNECTION
    assert (told.json["good"], told.json["complete"]) == (False, False)
