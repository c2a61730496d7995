"""What the commands that talk to a unit share: port and node, words, how an answer is printed."""

from __future__ import annotations

import json
import os
import sys
from argparse import Namespace
from typing import Any

from rkm04_tools.check import Checked, check_source, show_all
from rkm04_tools.failure import DONE, Failure
from rkm04_tools.frame import BROADCAST, NODES
from rkm04_tools.line import Motor
from rkm04_tools.messages import ALL_MOTORS
from rkm04_tools.source import read_source

OVERWRITTEN = (
    "the oldest commands were overwritten; jumps and loops do not find them any more; begin a "
    "program with \\ to empty it"
)
"""What has become of a memory that was full."""
PORT_VARIABLE, NODE_VARIABLE = "RKM04_PORT", "RKM04_NODE"


def named_port(options: Namespace, variable: str) -> str | None:
    """The port that is named by option or environment, if there is one.

    An option that is empty, as of a variable that is not set, must not mean another unit.
    """
    if options.port == "":
        raise Failure("--port is empty; name a port, or leave the option out")
    port: str | None = options.port
    return port or os.environ.get(variable)


def port_of(options: Namespace, variable: str = PORT_VARIABLE) -> str:
    """The port that is named by option or environment."""
    port = named_port(options, variable)
    if not port:
        raise Failure(
            "no port; name it with --port (COM5, /dev/ttyUSB0, socket://127.0.0.1:5000) "
            f"or in {variable}"
        )
    return port


def node_of(options: Namespace) -> int:
    """The address that is named by option or environment."""
    name, text = "--node", options.node
    if text is None:
        name, text = NODE_VARIABLE, os.environ.get(NODE_VARIABLE) or "1"
    if not (text.isascii() and text.isdigit() and int(text) in (BROADCAST, *NODES)):
        raise Failure(f"{name} {text}: write an address, 1 to 16, or 0 for all units")
    return int(text)


def reading_node_of(options: Namespace) -> int:
    """The same for what needs an answer."""
    node = node_of(options)
    if node == BROADCAST:
        raise Failure("node 0 means all units, and none of them answers; name one, 1 to 16")
    return node


def checked_file(file: str, but: str = "") -> Checked:
    """Check a program file and show on standard error what there is to say about it.

    `but` names a rule that does not matter here.
    """
    checked = check_source(read_source(file))
    show_all(checked, sys.stderr, but)
    return checked


def who(motor: Motor) -> dict[str, Any]:
    """Node and motor, for scripts."""
    return {"node": motor.unit.node, "motor": motor.number}


def name_of(motor: Motor) -> str:
    """A motor, or those that are meant, in words."""
    unit = "all units" if motor.unit.node == BROADCAST else f"unit {motor.unit.node}"
    return f"{unit}, {'all motors' if motor.number == ALL_MOTORS else f'motor {motor.number}'}"


def count_of(number: int, what: str) -> str:
    """A number of things, in words."""
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"


def tell(options: Namespace, answer: dict[str, Any], text: str) -> int:
    """Print an answer as the user wants it."""
    print(json.dumps(answer, indent=2) if options.json else text)
    return DONE
