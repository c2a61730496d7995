"""The files of a simulation: what can be read, what can be written, before anything runs."""

from __future__ import annotations

import os
import re
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rkm04_tools.failure import Failure, reading_failed, writing_failed
from rkm04_tools.plot import require_format
from rkm04_tools.source import named, why_no_text

HEAD_BYTES = 65_536
SECONDS_MAX = 100_000_000
"""More than the longest move takes at 1 step/s."""

STANDARD = re.compile(r"/dev/std(in|out|err)|(/dev/fd|/proc/[^/]+/fd)/[0-2]")
PIPE = re.compile(r"(?:/dev/fd|/proc/self/fd)/(\d{1,6})")
NUMBER = re.compile(r"\d{1,9}(\.\d{1,9})?")


@dataclass(frozen=True)
class Outputs:
    """Where the files that were asked for go."""

    steps: Path | None
    trace: Path | None
    vcd: Path | None
    plot: Path | None
    xy: Path | None = None

    @property
    def pictures(self) -> list[Path]:
        """Those of them that are drawn from what the simulator writes."""
        return [p for p in (self.plot, self.xy) if p]

    @property
    def wanted(self) -> list[Path]:
        """Those that are wanted."""
        return [p for p in (self.steps, self.trace, self.vcd, *self.pictures) if p]


def path_of(options: Namespace, name: str) -> Path | None:
    """The file that an option names."""
    value: str | None = getattr(options, name)
    return None if value is None else named(value)


def require_seconds(text: str) -> None:
    """Refuse what is no time of a simulation."""
    if not NUMBER.fullmatch(text) or not 0 < float(text) <= SECONDS_MAX:
        raise Failure(f"--for {text}: write seconds, more than 0, at most {SECONDS_MAX}")


def require_inputs(path: Path | None) -> None:
    """Refuse an inputs file that is not there; what is in it is for the simulator to judge."""
    if path is None:
        return
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            return  # it can be read once only
        with path.open("rb") as file:
            wrong = why_no_text(file.read(HEAD_BYTES))
    except OSError as error:
        raise reading_failed(path, error) from None
    if wrong:
        raise Failure(f"{path}: {wrong.partition(';')[0]}; name a file with lines ms,input,level")


def plain(inputs: Path | None, folder: Path) -> Path | None:
    """The inputs as a file that can be read again and again, and by others."""
    if inputs is None or inputs.is_file():
        return inputs
    copy = folder / "inputs.csv"
    copy.write_bytes(inputs.read_bytes())
    return copy


def pipes(outputs: Outputs) -> list[int]:
    """The descriptors that a shell has opened for >(COMMAND), which the simulator must get."""
    found = (PIPE.fullmatch(str(path)) for path in outputs.wanted)
    return [int(match[1]) for match in found if match]


def _is_stream(path: Path) -> bool:
    """Whether a path names standard input or output: those of the simulator are others."""
    return STANDARD.fullmatch(str(path)) is not None


def require_outputs(outputs: Outputs, read: Sequence[Path]) -> None:
    """Refuse what cannot be written before anything runs."""
    for picture in outputs.pictures:
        require_format(picture)
    reader = "--plot" if outputs.plot else "--xy"
    for path in filter(None, (outputs.steps, outputs.trace)):
        if outputs.pictures:
            require_plain(path, f"{reader} reads it back")
    known = {path.resolve(): "is read by this very command" for path in read}
    for path in outputs.wanted:
        if path.is_dir():
            raise Failure(f"{path}: is a directory; name a file in it")
        if _is_stream(path):
            raise Failure(f"{path}: the summary goes there; name a file, or use >(COMMAND)")
        if not path.parent.is_dir():
            raise Failure(f"{path}: there is no folder {path.parent}; make it first")
        if not os.access(path if path.exists() else path.parent, os.W_OK):
            raise writing_failed(path, PermissionError("permission denied"))
        if path.resolve() in known:
            raise Failure(f"{path}: {known[path.resolve()]}; choose another name")
        known[path.resolve()] = "is named for two outputs"


def require_plain(path: Path, why: str) -> None:
    """Refuse what is no plain file."""
    if path.exists() and not path.is_file():
        raise Failure(f"{path}: {why}, so it must be a plain file")


def remove_parts(outputs: Sequence[Path]) -> None:
    """Remove what an interrupted simulator leaves of files that it had not finished."""
    for path in outputs:
        path.with_name(f"{path.name}.part").unlink(missing_ok=True)
