"""`check`: whether scripts can be read."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools.failure import DONE, Failure
from rkm04_tools.positioning import host
from rkm04_tools.positioning.source import read_source
from rkm04_tools.source import Source


def checked(source: Source, folder: Path) -> tuple[Path, int]:
    """A script as a file for the C program, and its lines; else a Failure with the place."""
    script = folder / "script.csv"
    script.write_text(source.text, "utf-8", "surrogatepass", newline="")
    try:
        return script, host.check(script)
    except Failure as failure:
        raise Failure(str(failure).replace(str(script), source.name), failure.status) from None


def run(options: Namespace) -> int:
    """Check all files; the status is that of the worst one."""
    host.program_path()
    status, answers = DONE, []
    for path in options.files:
        try:
            source = read_source(path)
            with TemporaryDirectory(prefix="positioning-") as folder:
                _, lines = checked(source, Path(folder))
        except Failure as failure:
            print(f"positioning: {failure}", file=sys.stderr)
            status = max(status, failure.status)
            answers.append({"file": path, "ok": False, "error": str(failure)})
            continue
        answers.append({"file": source.name, "ok": True, "lines": lines})
        if not options.json:
            print(f"{source.name}: {lines or 'no'} instruction{'' if lines == 1 else 's'}")
    if options.json:
        print(json.dumps({"files": answers}, indent=2))
    return status
