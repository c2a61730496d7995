"""Words of the client as a page has them: without advice that is of use at a command line only."""

from __future__ import annotations

import re
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.service.trouble import as_json

OF_COMMANDS = re.compile(r" \(gve134 [^)]*\)|(?:; |\b)gve134 [a-z]+ [^;]*")


def plain(text: str) -> str:
    """A text without the names of commands."""
    return OF_COMMANDS.sub("", text)


def told(failure: Failure) -> dict[str, Any]:
    """A failure, as `as_json` has it."""
    found = as_json(failure)
    return {**found, "cause": plain(found["cause"]), "next": plain(found["next"]).rstrip("; ")}
