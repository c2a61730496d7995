"""The documents say what the firmware does: their programs, tables and messages are tried out."""

from __future__ import annotations

import csv
import itertools
import json
import os
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from chance import epoch

ROOT = Path(__file__).resolve().parents[2]
DOCS = sorted((ROOT / "firmware").rglob("*.md"))
VECTORS = ROOT / "tests" / "vectors" / "messages.json"
TICKS_PER_MS = 84_000
VERSION = "01.02,06.03.2009"
"""What message 1 tells in the manual's example."""

ROW = re.compile(r"X\((\w+), '(\\?.)', (\w+), (-?\d+), (-?\d+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
BYTES = re.compile(r"'(.)'|\"([^\"]*)\"|(\d+)|\s+|(.)")
FORMS = {"PLUS": "{}+", "MINUS": "{}-", "HIGH": "{}bHn", "LOW": "{}bLn", "NONE": "{}"}
"""How a command is written in the first column; the others are a letter and n."""

Exchange = dict[str, Any]


def program(name: str) -> str:
    return str(Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host")) / "bin" / name)


def run(*command: str, text: str | bytes = "") -> str:
    """What a program prints on this standard input."""
    given = text.encode() if isinstance(text, str) else text
    return subprocess.run(command, input=given, check=True, capture_output=True).stdout.decode()


@dataclass(frozen=True)
class Block:
    """A fenced block of a document, with what stands between the block before and it."""

    kind: str
    text: str
    before: str
    name: str


def all_blocks() -> Iterator[Block]:
    for path in DOCS:
        text = path.read_text(encoding="utf-8")
        end = 0
        for match in FENCE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            yield Block(match[1], match[2], text[end : match.start()], f"{path.name}:{line}")
            end = match.end()


def blocks(kind: str) -> list[Any]:
    """The blocks of one kind, each named by its file and line."""
    return [pytest.param(b.text, id=b.name) for b in all_blocks() if b.kind == kind]


def traced_programs() -> list[Any]:
    """Each program that a table of times follows, with that table."""
    found = []
    for program_block, trace in itertools.pairwise(all_blocks()):
        if trace.kind == "trace":
            assert (program_block.kind, trace.before) == ("rks", "\n\n"), trace.name
            found.append(pytest.param(program_block.text, trace.text, id=trace.name))
    return found


def tables(path: Path) -> Iterator[list[str]]:
    """The cells of all table rows of a document, the first one without its back quotes."""
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("| ") and not line.startswith("| ---"):
            first, *rest = (cell.strip() for cell in line.strip("|").split(" |"))
            yield [first.strip("`"), *rest]


@cache
def opcodes() -> list[tuple[str, str, str, int, int]]:
    """Rows of the table of commands: name, letter, form, smallest and largest number."""
    text = (ROOT / "firmware/rkm04/program/program_opcodes.def").read_text(encoding="utf-8")
    rows = ROW.findall(text)
    assert len(rows) == text.count("\nX(")
    return [(name, char[-1], form, int(low), int(high)) for name, char, form, low, high in rows]


def command_rows() -> list[list[str]]:
    """The rows of the tables of commands: command, range, example, meaning."""
    rows = [row for row in tables(ROOT / "firmware/rkm04/docs/language.md") if len(row) == 4]
    return [row for row in rows if row[0] != "command"]


def as_documented(letter: str, form: str, low: int, high: int) -> tuple[str, str]:
    """The first two cells of the row of a command."""

    def number(n: int) -> str:
        return f"{n:,}".replace(",", " ").replace("-", "−") if abs(n) > 999 else str(n)  # noqa: RUF001

    to = " to " if low < 0 else "–"  # noqa: RUF001
    span = number(low) if low == high else number(low) + to + number(high)
    if low == high != 0:
        return f"{letter}{low}", span
    return FORMS.get(form, "{}n").format(letter), "" if high == 0 else span


def test_each_command_has_one_row_with_its_letter_and_range() -> None:
    documented = [(command, span) for command, span, _, _ in command_rows()]

    expected = [as_documented(letter, form, low, high) for _, letter, form, low, high in opcodes()]
    assert sorted(documented) == sorted(expected)


def test_the_example_of_each_command_is_that_command_in_canonical_form() -> None:
    names = {(row[1], row[2], row[3], row[4]): row[0] for row in opcodes()}
    by_cells = {as_documented(*key): name for key, name in names.items()}

    for command, span, example, _ in command_rows():
        checked = json.loads(run(program("rkm04-host"), "check", "-", text=example.strip("`")))
        [found] = checked["commands"]
        assert (found["opcode"], f"`{found['text']}`") == (by_cells[command, span], example)


def test_the_errors_at_run_time_are_those_of_the_interpreter() -> None:
    header = (ROOT / "firmware/rkm04/interpreter/interpreter.h").read_text(encoding="utf-8")
    macro = header[header.index("#define INTERPRETER_ERRORS") :].split("\n\n")[0]
    texts = [text for text in re.findall(r'X\(\w+, "(.*?)"\)', macro) if text]

    unit = (ROOT / "firmware/rkm04/docs/unit.md").read_text(encoding="utf-8")
    section = unit[unit.index("## Errors at run time") :].split("\n## ")[0]
    documented = re.findall(r"^\| (.*?) \| ", section, re.MULTILINE)
    assert documented == ["error", "---", *texts]


@pytest.mark.parametrize("text", blocks("rks"))
def test_a_program_in_the_documents_is_free_of_errors(text: str) -> None:
    checked = json.loads(run(program("rkm04-host"), "check", "-", text=text))

    assert [p for p in checked["problems"] if p["severity"] == "error"] == []
    assert checked["commands"] != []


@pytest.mark.parametrize(("text", "times"), traced_programs())
def test_a_program_does_what_the_table_after_it_says(tmp_path: Path, text: str, times: str) -> None:
    source, trace = tmp_path / "a.rks", tmp_path / "trace.csv"
    source.write_text(text, encoding="utf-8")

    run(program("rkm04-host"), "sim", "--motor", f"1={source}", "--trace", str(trace))

    with trace.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["event"] not in ("start", "end")]
    told = [f"{int(r['tick']) / TICKS_PER_MS:.2f} ms {r['event']} {r['value']}" for r in rows]
    assert [" ".join(line.split()) for line in times.splitlines()] == told


def bytes_of(notation: str) -> str:
    """The bytes of a message as the documents write it, in hexadecimal."""
    message = bytearray()
    for match in BYTES.finditer(notation):
        character, text, number, wrong = match.groups()
        assert wrong is None, f"{wrong} in {notation}"
        message += (character or text or "").encode("ascii")
        message += bytes([int(number)]) if number else b""
    return message.hex()


def exchanges_of(block: str) -> list[Exchange]:
    """The requests of a block, each with its answer and the time that goes by before it."""
    exchanges: list[Exchange] = []
    after_ms = 0
    for line in block.replace("\n  ", " ").splitlines():
        if line.startswith("> "):
            exchanges.append({"after_ms": after_ms, "request": bytes_of(line[2:])})
            after_ms = 0
        elif line.startswith("< "):
            exchanges[-1]["answer"] = bytes_of(line[2:])
        else:
            [digits] = re.fullmatch(r"\.\.\. (\d+) ms", line).groups()  # type: ignore[union-attr]
            after_ms = int(digits)
    return exchanges


def conversations() -> list[dict[str, Any]]:
    """What the file of vectors holds: conversations, each with a unit that was just switched on."""
    loaded: list[dict[str, Any]] = json.loads(VECTORS.read_text(encoding="utf-8"))["conversations"]
    return loaded


def test_the_file_of_vectors_holds_the_messages_of_the_documents() -> None:
    found = [block for block in all_blocks() if block.kind == "messages"]
    # Those of a Czech document are compared with the English ones in test_czech_documents.py.
    documented = [exchanges_of(block.text) for block in found if ".cs.md:" not in block.name]

    assert documented == [talk["exchanges"] for talk in conversations()]


@pytest.mark.parametrize("talk", conversations(), ids=lambda talk: talk["name"])
def test_the_unit_answers_as_the_documents_say(talk: dict[str, Any]) -> None:
    asked = [f"+{each['after_ms']}\n{each['request']}\n" for each in talk["exchanges"]]

    answers = run(program("message-probe"), VERSION, str(epoch()), text="".join(asked)).split()

    assert answers == [each["answer"] for each in talk["exchanges"]]


def anchors(path: Path) -> set[str]:
    """The names by which headings can be linked to."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", each.lower()).replace(" ", "-") for each in headings}


@pytest.mark.parametrize("path", DOCS, ids=lambda path: path.name)
def test_links_lead_to_a_file_and_a_heading(path: Path) -> None:
    text = re.sub(r"```.*?```|`[^`\n]*`", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        name, _, anchor = target.partition("#")
        file = (path.parent / name).resolve() if name else path
        assert file.is_file(), target
        assert not anchor or anchor in anchors(file), target


@pytest.mark.parametrize("path", DOCS, ids=lambda path: path.name)
def test_sources_that_a_document_names_are_there(path: Path) -> None:
    for name in re.findall(r"`(\w+(?:/\w+)+\.(?:c|h|py))`", path.read_text(encoding="utf-8")):
        assert any((root / name).is_file() for root in (ROOT, ROOT / "tests")), name
