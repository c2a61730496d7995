"""A Czech document has the structure, programs, numbers and links of the English one beside it.

Of the page of a board there is one chapter in Czech.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CZECH = sorted(path for top in ("firmware", "hal") for path in (ROOT / top).rglob("*.cs.md"))
BOARDS = ROOT / "hal/stm32/boards"
NAMES = [path.relative_to(ROOT).as_posix() for path in CZECH]
SUFFIX = ".cs.md"
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"``.*?``|`[^`\n]*`")
COMMENT = re.compile(r"\{[^}]*\}")
HEADING = re.compile(r"^(#+) (.*)$", re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
NAMED = re.compile(r"\(`[^`\n]*`\)")
NUMBER = re.compile(r"(?<![a-z\d])\d+(?:[.,]\d+)?")
PARAGRAPH_OR_ROW = re.compile(r"\n\n|\n(?=\||\s*[-*] )")
ROW_AND_NEXT = re.compile(r"^(\|.*)$(\n(?!\|))?", re.MULTILINE)

Target = tuple[Path, int]
"""The English document to which a link leads, and which of its headings; 0: the title, or none."""


def english(path: Path) -> Path:
    return path.with_name(path.name.replace(SUFFIX, ".md"))


def czech(path: Path) -> Path:
    return path.with_name(path.name.replace(".md", SUFFIX))


def text_of(path: Path) -> str:
    """A document; of the English page of a board what is in Czech, title and chapter."""
    text = path.read_text(encoding="utf-8")
    if path.name != "README.md" or path.parent.parent != BOARDS:
        return text
    chapter = text.partition("\n## Flashing\n")[2].partition("\n## ")[0]
    return f"{text.partition(chr(10))[0]}\n\n## Flashing\n{chapter}"


def prose(path: Path) -> str:
    """A document without its blocks of code."""
    return BLOCK.sub("", text_of(path))


def depths(path: Path) -> list[int]:
    return [len(signs) for signs, _ in HEADING.findall(prose(path))]


def anchors(path: Path) -> list[str]:
    """The names by which headings can be linked to."""
    titles = [title.lower() for _, title in HEADING.findall(prose(path))]
    return [re.sub(r"[^\w\- ]", "", each).replace(" ", "-") for each in titles]


def code(path: Path) -> list[tuple[str, str]]:
    """The language and the text of each block, without what stands in braces."""
    blocks = BLOCK.findall(text_of(path))
    return [(kind, COMMENT.sub("{}", text)) for kind, text in blocks]


def tables(path: Path) -> list[list[int]]:
    """The number of cells in each row of each table."""
    found: list[list[int]] = [[]]
    for row, end in ROW_AND_NEXT.findall(prose(path)):
        found[-1].append(len(CODE.sub("", row).split("|")) - 2)
        if end:
            found.append([])
    return found


def numbers(text: str) -> list[str]:
    """The numbers of a text, with a decimal point, in any order.

    Where its links lead is not text, nor is a name in parentheses, which an English one needs not.
    """
    text = NAMED.sub("", LINK.sub("]", text))
    return sorted(each.replace(",", ".") for each in NUMBER.findall(text))


def numbers_of_parts(path: Path) -> list[list[str]]:
    """Those of each heading, paragraph, item and row of a table that has any."""
    text = re.sub(r"^(#.*)$", r"\n\1\n", prose(path), flags=re.MULTILINE)
    return [found for part in PARAGRAPH_OR_ROW.split(text) if (found := numbers(part))]


def links(path: Path) -> list[Target]:
    """Where the links of a document lead; a file or heading that is not there is an error."""
    found = []
    for link in LINK.findall(CODE.sub("", prose(path))):
        name, _, anchor = link.partition("#")
        file = (path.parent / name).resolve() if name else path
        assert file.is_file(), link
        found.append((file, anchors(file).index(anchor) if anchor else 0))
    return found


def test_there_are_czech_documents_and_each_has_an_english_one() -> None:
    assert CZECH != []
    assert [path for path in CZECH if not english(path).is_file()] == []


def test_each_board_has_its_chapter_in_czech() -> None:
    boards = sorted(path.parent for path in BOARDS.glob("*/board.h"))
    assert boards == sorted(path.parent for path in CZECH if path.is_relative_to(BOARDS))
    for board in boards:
        assert "\n## Nahrání firmwaru\n" in text_of(board / "README.cs.md")
        assert "\n## Flashing\n" in (board / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", CZECH, ids=NAMES)
def test_the_headings_have_the_same_depths_in_the_same_order(path: Path) -> None:
    assert depths(path) == depths(english(path))


@pytest.mark.parametrize("path", CZECH, ids=NAMES)
def test_the_code_is_the_same_but_for_its_comments(path: Path) -> None:
    assert code(path) == code(english(path))


@pytest.mark.parametrize("path", CZECH, ids=NAMES)
def test_the_tables_have_the_same_rows_and_columns(path: Path) -> None:
    assert tables(path) == tables(english(path))


@pytest.mark.parametrize("path", CZECH, ids=NAMES)
def test_each_heading_paragraph_item_and_row_has_the_same_numbers(path: Path) -> None:
    assert numbers_of_parts(path) == numbers_of_parts(english(path))


@pytest.mark.parametrize("path", CZECH, ids=NAMES)
def test_links_lead_where_the_english_ones_do_in_czech_if_there_is_any(path: Path) -> None:
    wanted = [
        (czech(file) if czech(file) in CZECH else file, heading)
        for file, heading in links(english(path))
    ]
    assert sorted(links(path)) == sorted([*wanted, (english(path), 0)])


@pytest.mark.parametrize("path", CZECH, ids=NAMES)
def test_it_says_that_the_english_document_decides(path: Path) -> None:
    begin = prose(path).split("\n## ")[0]
    assert re.search(
        rf"\[anglického\s+dokumentu\]\({english(path).name}\), platí anglický\.", begin
    )
