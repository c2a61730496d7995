"""`console`: commands as they are typed, answers in words."""

from __future__ import annotations

import json
import re
import signal
import sys
from argparse import Namespace
from contextlib import suppress
from dataclasses import asdict, dataclass

from rkm04_tools.failure import DONE, INTERRUPTED, NOT_SO, Failure
from rkm04_tools.gve134 import answers, host
from rkm04_tools.gve134.answers import Answer, canonical
from rkm04_tools.gve134.client_base import unit_of
from rkm04_tools.gve134.job import COMMENT, LINE_OWN
from rkm04_tools.gve134.sending import LONG_SECONDS
from rkm04_tools.gve134.stopping import halt_at_signal
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.line_errors import LineError, PortError
from rkm04_tools.stopper import Stopper, nudged
from rkm04_tools.typed import forget_typed

TYPED = re.compile(r"(?:!7)?[\x20\x22-\x7e]+")
PROMPT = "> "
READLINE = ("tab: complete", "set show-all-if-ambiguous on", "set enable-bracketed-paste off")
SPINDLE, SPINDLE_ONLY = 2, "!7"
"""What the table calls address 7, and how its commands are typed."""
SUM_CHARACTERS = 4
"""Address, comma and two digits, within the characters of a line."""


def run_console(options: Namespace) -> int:
    """Talk until the end of input; of a script whether all was done."""
    is_typed = sys.stdin.isatty()
    with unit_of(options) as unit, Stopper(unit.link.wire) as stopper:
        unit.link.connect()
        completes = "Tab completes, " if is_typed and _complete() else ""
        print(f"{unit.link.version}; {completes}Ctrl-D ends, Ctrl-C halts", file=sys.stderr)
        console = Console(unit, options.json)
        while True:
            try:
                line = _line(stopper, is_typed)
                if not line:
                    break
                console.take(line.strip())
            except KeyboardInterrupt:
                status = halt_at_signal(unit, stopper)
                if not is_typed or status != INTERRUPTED or stopper.number != signal.SIGINT:
                    return status
            except PortError:
                raise
            except LineError as error:
                if not is_typed:
                    raise
                print(f"gve134: {error}", file=sys.stderr)
                forget_typed()  # while nobody answered: it was meant for then
    return DONE if is_typed or not console.refused else NOT_SO


def _line(stopper: Stopper, is_typed: bool) -> str:
    """The next line; empty: there is none."""
    with stopper.at_once():
        if not is_typed:
            return sys.stdin.readline()
        try:
            with nudged():
                return input(PROMPT) + "\n"
        except EOFError:
            return ""


def _complete() -> bool:
    """Let Tab complete what is typed, where a terminal can do that."""
    try:
        import readline
    except ImportError:  # on Windows
        return False
    names: list[str] = []
    with suppress(Failure):
        names = names_typed(host.commands())

    def nth(begun: str, number: int) -> str | None:
        found = [name for name in names if name.startswith(begun.upper())]
        return found[number] if number < len(found) else None

    readline.set_completer(nth)
    readline.set_completer_delims("")
    for setting in READLINE:
        readline.parse_and_bind(setting)
    return bool(names)


def names_typed(commands: list[host.Command]) -> list[str]:
    """The names of the table's commands as they are typed."""
    both = {command.text for command in commands if command.address != SPINDLE}
    spindle = {SPINDLE_ONLY + command.text for command in commands if command.address & SPINDLE}
    return sorted(both) + sorted(spindle)


@dataclass
class Console:
    """Sends what is typed. `refused` counts the answers that were not `done`."""

    unit: Unit
    as_json: bool = False
    refused: int = 0
    _packet: list[str] | None = None

    def take(self, line: str) -> None:
        """Send a line, and show what comes back."""
        text = canonical(line.partition(COMMENT)[0].strip().removeprefix("!0"))
        if not text:
            return
        if wrong := self._wrong(text):
            shown = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
            print(f"{shown}: {wrong}", file=sys.stderr)
            self.refused += 1
            return
        answer = self._in_packet(text)
        if answer is None:
            return
        self.refused += answer.code != answers.DONE
        words = answer.words
        if text.startswith("W") and answer.code == answers.BOUNDS and answer.inta:
            words = f"{answers.SWITCH_NOT_FOUND}, INTA is set"
        told = {"command": text, **asdict(answer), "words": words}
        print(json.dumps(told) if self.as_json else f"{answer.text}  {words}", flush=True)

    def _wrong(self, text: str) -> str:
        """Why a line is not sent; empty: it is."""
        if not TYPED.fullmatch(text):
            return "not sent: a command has letters, digits and signs, and ! only before 0 or 7"
        if len(text) > answers.TEXT_CHARACTERS_MAX - SUM_CHARACTERS:
            return "not sent: it is longer than a line of the unit"
        if text in LINE_OWN[:2]:
            if not self.unit.link.sums:
                return "not sent: checksums are the line's; this console began without them"
            return "not sent: checksums are the line's; --no-sums begins a console without them"
        return ""

    def _in_packet(self, text: str) -> Answer | None:
        """What is between *S and *E is sent at once; None: it is kept until then."""
        if text == "*S":
            self._packet = []
            return None
        if self._packet is not None and text.startswith("*E"):
            packet, self._packet = self._packet, None
            if text != f"*E{len(packet)}":
                print(f"the packet has {len(packet)} commands; nothing was sent", file=sys.stderr)
                self.refused += 1
                return None
            return self.unit.link.send_packet(packet)
        if self._packet is not None and text not in ("H", "J"):
            self._packet.append(text)
            return None
        self._packet = None
        return self._ask(text)

    def _ask(self, text: str) -> Answer:
        link = self.unit.link
        if text == "H":
            self.unit.halt()
            return Answer(answers.DONE, inta=True)
        if text in ("J", "!7J"):
            return link.reset(answers.addressed(text)[0])
        if text.startswith("W"):
            return link.ask_long(text, LONG_SECONDS)
        return link.ask(text)
