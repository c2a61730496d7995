"""Shells complete every command and option, and ports and boards that there are."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from rkm04_tools import board, completion
from rkm04_tools.cli import make_parser
from rkm04_tools.completion import SCRIPTS, commands_of, offered

ROOT = Path(__file__).resolve().parents[2]
PARSER = make_parser()
LISTED = list(commands_of(PARSER))
NAME = board.names()[-1]


def at(words: str) -> list[str]:
    """What is offered after `rkm04` and these words."""
    return offered(PARSER, words.split(" "))


def test_every_command_is_offered():
    names = {name for name, _ in LISTED}

    assert set(at("")) | set(at("board ")) | set(at("machine ")) == names
    assert {"check", "sim", "send", "board", "completion"} <= set(at(""))


@pytest.mark.parametrize("command", [command for _, command in LISTED], ids=lambda c: c.prog)
def test_every_option_is_offered(command):
    options = {o for action in command._actions for o in action.option_strings if o[:2] == "--"}
    words = command.prog.removeprefix(PARSER.prog).lstrip()

    assert set(at(f"{words} --")) == options


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("st", ["status", "stop", "store"]),
        ("board b", ["build"]),
        ("board build --board ", board.names()),
        ("sim --target ", ["host", "stm32"]),
        ("sim a.rks --tar", ["--target"]),
        ("send --node 1", ["1", "10", "11", "12", "13", "14", "15", "16"]),
        ("stop --motor ", ["0", "1", "2", "3", "4"]),
        ("completion ", ["bash", "fish", "zsh"]),
        ("sim ", []),
        ("sim --steps ", []),
        ("nonsense x --y ", None),
    ],
)
def test_what_is_offered(words, found):
    assert at(words) == (at("") if found is None else found)


def test_ports_are_those_that_are_plugged_in(tmp_path, monkeypatch):
    (tmp_path / "dev").mkdir()
    for name in ("ttyUSB0", "ttyUSB1", "null"):
        (tmp_path / "dev" / name).touch()
    monkeypatch.setattr(completion, "ROOT", tmp_path)
    monkeypatch.setenv("RKM04_PORT", "/dev/ttyS7")

    assert at("send a.rks --port ") == [
        "/dev/ttyS7", f"{tmp_path}/dev/ttyUSB0", f"{tmp_path}/dev/ttyUSB1", "socket://127.0.0.1:5000",
    ]  # fmt: skip


def test_bash_completes(tool, tmp_path):
    script = tmp_path / "completion"
    script.write_text(tool("completion", "bash").out)
    code = (
        f"source {script}; complete -p rkm04; "
        f"COMP_WORDS=(tools/rkm04 board flash --board {NAME[:-1]}); "
        'COMP_CWORD=4; _rkm04; printf "%s\\n" "${COMPREPLY[@]}"'
    )

    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=True)

    assert done.stdout.splitlines() == [
        "complete -o default -F _rkm04 rkm04",
        NAME,
    ]


@pytest.mark.parametrize("shell", SCRIPTS)
def test_every_script_asks_the_tool(tool, shell):
    assert f"'{ROOT / 'tools' / 'rkm04'}' completion --words " in tool("completion", shell).out


def test_a_shell_that_is_not_known_is_wrong_usage(tool):
    result = tool("completion", "powershell")

    assert result.status == 2
    assert "choose from" in result.complaint
