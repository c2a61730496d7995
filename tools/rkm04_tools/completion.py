"""`completion`: what a shell needs to complete commands, options, ports and boards.

The scripts for the shells only ask the tool, `rkm04 completion --words ...`, what can stand in
place of the last word, so ports are those that are plugged in, and all shells offer the same.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from rkm04_tools.board import names
from rkm04_tools.failure import DONE
from rkm04_tools.tree import IS_INSTALLED
from rkm04_tools.tree import ROOT as TREE

WORDS = "--words"
TITLE = "print what a shell needs to complete commands, options, ports and boards"
EXAMPLE = (
    "source <(tools/NAME completion bash)                              # now, or in ~/.bashrc\n"
    "  tools/NAME completion zsh > ~/.zfunc/_NAME                       # a folder of $fpath\n"
    "  tools/NAME completion fish > ~/.config/fish/completions/NAME.fish"
)
ROOT = Path("/")
PORTS = ("dev/ttyUSB*", "dev/ttyACM*", "dev/serial/by-id/*")
VIRTUAL_PORT = "socket://127.0.0.1:5000"
"""Where `serve` listens unless told otherwise."""

# Where nothing is offered the shells offer files.
SCRIPTS = {
    "bash": """\
_NAME() {
    local IFS=$'\\n'
    COMPREPLY=($('TOOL' completion --words "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
}
complete -o default -F _NAME NAME
""",
    "zsh": """\
#compdef NAME
_NAME() {
    local -a found
    found=(${(f)"$('TOOL' completion --words "${(@)words[2,CURRENT]}" 2>/dev/null)"})
    if (( $#found )); then compadd -a found; else _files; fi
}
if [[ $funcstack[1] == _NAME ]]; then _NAME; else compdef _NAME NAME; fi
""",
    "fish": """\
complete -c NAME -a "('TOOL' completion --words (commandline -opc)[2..-1] (commandline -ct))"
""",
}


def add_command(commands: Any, tool: str, add: Callable[..., argparse.ArgumentParser]) -> None:
    """Add the command to those of a tool; `add` is `cli.add_command`."""
    example = EXAMPLE.replace("NAME", tool)
    command = add(commands, "completion", run, TITLE, example, has_json=False)
    command.add_argument("shell", choices=list(SCRIPTS), help="the shell that is to complete")
    command.set_defaults(tool=tool)


def run(options: argparse.Namespace) -> int:
    """Print the script."""
    tool = options.tool if IS_INSTALLED else TREE / "tools" / options.tool
    script = SCRIPTS[options.shell].replace("TOOL", str(tool))
    print(script.replace("NAME", options.tool), end="")
    return DONE


def offered(parser: argparse.ArgumentParser, words: Sequence[str]) -> list[str]:
    """What can stand in place of the last word, after the others; it begins as that does."""
    *before, begun = words or [""]
    tool = parser.prog
    pending: argparse.Action | None = None
    for word in before:
        if pending:
            pending = None
        elif word.startswith("-"):
            action = parser._option_string_actions.get(word)
            pending = action if action and action.nargs != 0 else None
        else:
            parser = _commands(parser).get(word, parser)
    return [each for each in _choices(parser, pending, begun, tool) if each.startswith(begun)]


def _choices(
    parser: argparse.ArgumentParser, pending: argparse.Action | None, begun: str, tool: str
) -> list[str]:
    if pending:
        return _values(pending, tool)
    if begun.startswith("-"):
        return sorted(option for option in parser._option_string_actions if option[:2] == "--")
    positional = (action for action in parser._actions if not action.option_strings)
    return [value for action in positional for value in _values(action, tool)]


def _values(action: argparse.Action, tool: str) -> list[str]:
    if action.choices is not None:
        return sorted(map(str, action.choices))
    if action.dest == "port":
        own = filter(None, [os.environ.get(f"{tool.upper()}_PORT"), VIRTUAL_PORT])
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
