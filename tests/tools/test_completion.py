"""Shells complete every command and every option."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from rkm04_tools.cli import make_parser
from rkm04_tools.completion import SHELLS, commands_of

LISTED = list(commands_of(make_parser()))


def completions_in_bash(script: Path, words: str) -> set[str]:
    """What bash offers behind these words, of which the last one has been begun."""
    code = (
        f"source {script}; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
        '_shtab_rkm04; printf "%s\\n" "${COMPREPLY[@]}"'
    )
    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.mark.parametrize("shell", SHELLS)
def test_every_command_and_option_is_completed(tool, shell):
    script = tool("completion", shell).out
    words = set(re.findall(r"[\w-]+", script))

    for name, command in LISTED:
        assert name in words
        for action in command._actions:
            for option in action.option_strings:
                # fish has them without dashes.
                assert {option, option.lstrip("-")} & words, (name, option)


def test_bash_offers_commands_options_and_choices(tool, tmp_path):
    script = tmp_path / "completion"
    script.write_text(tool("completion", "bash").out)

    assert completions_in_bash(script, "rkm04 st") == {"status", "stop", "store"}
    assert completions_in_bash(script, "rkm04 status --") == {
        "--help",
        "--json",
        "--node",
        "--port",
    }
    assert completions_in_bash(script, "rkm04 board b") == {"build"}
    assert completions_in_bash(script, "rkm04 sim --target s") == {"stm32"}


def test_a_shell_that_is_not_known_is_wrong_usage(tool):
    result = tool("completion", "csh")

    assert result.status == 2
    assert "choose from" in result.complaint
