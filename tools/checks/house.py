"""Checks the limits of the house on every file of the project; prints FILE:LINE: what is wrong.

Functions have at most 60 lines, sources at most 500, lines 120 columns. A flat opcode switch may be
longer if the comment above its function says `house: flat switch`. In firmware/ a header may
include by a path, and only from a stage in the DEPS of its own.
"""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FUNCTION_LINES = 60
FILE_LINES = 500
COLUMNS = 120
EXEMPTION = "house: flat switch"

LONG_LINE = re.compile(rf"^.{{{COLUMNS + 1},}}$", re.MULTILINE)
C_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
C_FUNCTION = re.compile(r"^\{\n(.*?)^\}", re.DOTALL | re.MULTILINE)
C_FLOAT = re.compile(r"\b(?:float|double)\b")
C_PATH_INCLUDE = re.compile(r'^#include "([^"\n]*/)[^"/\n]*"', re.MULTILINE)
STAGE_DEPS = re.compile(r"\bDEPS\b([^)]*)")
TOP_LEVEL = {
    "CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md",
    "firmware", "hal", "tests", "tools",
}  # fmt: skip
C_TYPEDEF = re.compile(r"\btypedef (?:struct|enum|union)\b")
# A path of somebody's machine, or a link that only works from one.
MACHINE_PATH = re.compile(rf"{re.escape(str(ROOT))}\b|(?<![\w.])/(?:home|Users|root|mnt)/\w")
FOREIGN_HOST = re.compile(
    r"https?://(?!github\.com/|www\.w3\.org/|127\.0\.0\.1|localhost)(?![{$])[\w.]+"
)

Finding = tuple[int, str]  # offset in the text, what is wrong there


def project_files() -> list[Path]:
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    names = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [ROOT / name for name in sorted(set(names.split("\0"))) if (ROOT / name).is_file()]


def strangers(files: list[Path]) -> list[str]:
    """What lies at the top level and has no business there."""
    tops = {path.relative_to(ROOT).parts[0] for path in files}
    return sorted(name for name in tops - TOP_LEVEL if not name.startswith("."))


def check_source(text: str) -> Iterator[Finding]:
    if (lines := text.count("\n")) > FILE_LINES:
        yield len(text) - 1, f"the file has {lines} lines, more than {FILE_LINES}"
    for match in LONG_LINE.finditer(text):
        yield match.start(), f"the line has {len(match[0])} columns, more than {COLUMNS}"
    for match in FOREIGN_HOST.finditer(text):
        yield match.start(), f"a source names the host {match[0]}"


def check_c(text: str) -> Iterator[Finding]:
    for match in C_FUNCTION.finditer(text):
        heading = text[: match.start()].rpartition("\n}\n")[2]
        if (lines := match[1].count("\n")) > FUNCTION_LINES and EXEMPTION not in heading:
            yield match.start(), f"the function has {lines} lines, more than {FUNCTION_LINES}"


def check_firmware(text: str) -> Iterator[Finding]:
    code = C_COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment[0]), text)
    for match in C_FLOAT.finditer(code):
        yield match.start(), "floating point in the firmware"
    for match in C_TYPEDEF.finditer(code):
        yield match.start(), "a typedef hides what kind of type it is"


def check_path_includes(path: Path, text: str) -> Iterator[Finding]:
    """A path leads past the include folders that a stage was given."""
    rules = path.parent / "CMakeLists.txt"
    deps = STAGE_DEPS.search(rules.read_text(encoding="utf-8")) if rules.is_file() else None
    for match in C_PATH_INCLUDE.finditer(text):
        stage = os.path.relpath(path.parent / match[1], ROOT / "firmware")
        if path.suffix != ".h":
            yield match.start(), "a source includes by a path"
        elif deps is None or stage.replace("/", "_") not in deps[1].split():
            yield (
                match.start(),
                f"the header includes from {stage}, which is not in the stage's DEPS",
            )


def check_python(text: str) -> Iterator[Finding]:
    starts = [0, *(match.end() for match in re.finditer("\n", text))]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            lines = (node.end_lineno or node.lineno) - node.lineno
            if lines > FUNCTION_LINES:
                yield starts[node.lineno - 1], f"{node.name} has {lines} lines"


def check_file(path: Path) -> Iterator[Finding]:
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return  # a picture
    name = path.relative_to(ROOT).as_posix()
    for match in MACHINE_PATH.finditer(text):
        yield match.start(), f"names a path of this machine: {match[0]}"
    if path.suffix in (".c", ".h", ".py", ".def", ".cmake") or text.startswith("#!"):
        yield from check_source(text)
    if path.suffix in (".c", ".h"):
        yield from check_c(text)
    if path.suffix in (".c", ".h") and name.startswith(("firmware/", "hal/include/")):
        yield from check_firmware(text)
    if path.suffix in (".c", ".h") and name.startswith("firmware/"):
        yield from check_path_includes(path, text)
    if path.suffix == ".py":
        yield from check_python(text)


def main() -> int:
    found = 0
    files = project_files()
    for name in strangers(files):
        print(f"{name}: the top level has nothing but {', '.join(sorted(TOP_LEVEL))}")
        found += 1
    for path in files:
        for offset, what in check_file(path):
            line = path.read_text(encoding="utf-8").count("\n", 0, offset) + 1
            print(f"{path.relative_to(ROOT)}:{line}: {what}")
            found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
