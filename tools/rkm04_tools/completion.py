"""`completion`: what a shell needs to complete commands and options, written by shtab."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from rkm04_tools.failure import DONE

SHELLS = ("bash", "zsh", "fish")
EXAMPLE = (
    "source <(tools/rkm04 completion bash)                              # now, or in ~/.bashrc\n"
    "  tools/rkm04 completion zsh > ~/.zfunc/_rkm04                       # a folder of $fpath\n"
    "  tools/rkm04 completion fish > ~/.config/fish/completions/rkm04.fish"
)
FILE_WORDS = ("FILE", "INPUTS", "OUT")
FOLDER_WORDS = ("FOLDER",)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    command.add_argument("shell", choices=SHELLS, help="the shell that is to complete")


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The completions of all commands, to be sourced by the shell."""
    import shtab  # here, as no other command needs it

    for action in _actions(parser):
        word = str(action.metavar).partition(".")[0]
        if word in FILE_WORDS:
            action.complete = shtab.FILE  # type: ignore[attr-defined]
        elif word in FOLDER_WORDS:
            action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
    text: str = shtab.complete(parser, shell=shell)
    return text


def run(parser: argparse.ArgumentParser, options: argparse.Namespace) -> int:
    """Print the script."""
    print(script(parser, options.shell))
    return DONE


def commands_of(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """The commands of a parser, and those within them."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, command in action.choices.items():
                yield name, command
                yield from commands_of(command)


def _actions(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    for _, command in [("", parser), *commands_of(parser)]:
        yield from command._actions
