"""`completion`: what a shell needs to complete commands, options, ports and boards.

The scripts for the shells only ask `rkm04 completion --words ...` what can stand in place of the
last word, so ports are those that are plugged in, and all shells offer the same.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from rkm04_tools.board import names
from rkm04_tools.failure import DONE

WORDS = "--words"
EXAMPLE = (
    "source <(tools/rkm04 completion bash)                              # now, or in ~/.bashrc\n"
    "  tools/rkm04 completion zsh > ~/.zfunc/_rkm04                       # a folder of $fpath\n"
    "  tools/rkm04 completion fish > ~/.config/fish/completions/rkm04.fish"
)
ROOT = Path("/")
PORTS = ("dev/ttyUSB*", "dev/ttyACM*", "dev/serial/by-id/*")
VIRTUAL_PORT = "socket://127.0.0.1:5000"
"""Where `serve` listens unless told otherwise."""

# Where nothing is offered the shells offer files.
SCRIPTS = {
    "bash": """\
_rkm04() {
    local IFS=$'\\n'
    COMPREPLY=($('TOOL' completion --words "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
}
complete -o default -F _rkm04 rkm04
""",
    "zsh": """\
#compdef rkm04
_rkm04() {
    local -a found
    found=(${(f)"$('TOOL' completion --words "${(@)words[2,CURRENT]}" 2>/dev/null)"})
    if (( $#found )); then compadd -a found; else _files; fi
}
if [[ $funcstack[1] == _rkm04 ]]; then _rkm04; else compdef _rkm04 rkm04; fi
""",
    "fish": """\
complete -c rkm04 -a "('TOOL' completion --words (commandline -opc)[2..-1] (commandline -ct))"
""",
}


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    command.add_argument("shell", choices=list(SCRIPTS), help="the shell that is to complete")


def run(options: argparse.Namespace) -> int:
    """Print the script."""
    tool = Path(__file__).resolve().parents[1] / "rkm04"
    print(SCRIPTS[options.shell].replace("TOOL", str(tool)), end="")
    return DONE


def offered(parser: argparse.ArgumentParser, words: Sequence[str]) -> list[str]:
    """What can stand in place of the last word, after the others; it begins as that does."""
    *before, begun = words or [""]
    pending: argparse.Action | None = None
    for word in before:
        if pending:
            pending = None
        elif word.startswith("-"):
            action = parser._option_string_actions.get(word)
            pending = action if action and action.nargs != 0 else None
        else:
            parser = _commands(parser).get(word, parser)
    return [each for each in _choices(parser, pending, begun) if each.startswith(begun)]


def _choices(
    parser: argparse.ArgumentParser, pending: argparse.Action | None, begun: str
) -> list[str]:
    if pending:
        return _values(pending)
    if begun.startswith("-"):
        return sorted(option for option in parser._option_string_actions if option[:2] == "--")
    positional = (action for action in parser._actions if not action.option_strings)
    return [value for action in positional for value in _values(action)]


def _values(action: argparse.Action) -> list[str]:
    if action.choices is not None:
        return sorted(map(str, action.choices))
    if action.dest == "port":
        own = filter(None, [os.environ.get("RKM04_PORT"), VIRTUAL_PORT])
        return sorted({*own, *(str(path) for pattern in PORTS for path in ROOT.glob(pattern))})
    if action.dest == "node":
        return [str(node) for node in range(1, 17)]
    return names() if action.dest == "board" else []


def _commands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    found: dict[str, argparse.ArgumentParser] = {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            found.update(action.choices)
    return found


def commands_of(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """The commands of a parser, and those within them."""
    for name, command in _commands(parser).items():
        yield name, command
        yield from commands_of(command)
