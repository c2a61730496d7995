"""Words of a client as a page has them: without advice that is of use at a command line only."""

from __future__ import annotations

import re
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.service.trouble import as_json


class Words:
    """Those of the commands of a `tool`."""

    def __init__(self, tool: str) -> None:
        self.tool = tool
        self._of_commands = re.compile(
            rf" \({tool} [^)]*\)|(?:; |\b){tool} [a-z]+ [^;]*| \(--[^)]*\)"
        )

    def plain(self, text: str) -> str:
        """A text without the names of commands and options."""
        return self._of_commands.sub("", text)

    def told(self, failure: Failure) -> dict[str, Any]:
        """A failure, as `as_json` has it."""
        found = as_json(failure)
        cause, advice = self.plain(found["cause"]), self.plain(found["next"]).rstrip("; ")
        return {**found, "cause": cause, "next": advice}
