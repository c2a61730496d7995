"""What the mutation tests change in a source, and what they leave alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from checks import mutation
from checks.mutation_operators import mutants

ROOT = Path(__file__).resolve().parents[2]


def changed(line: str) -> list[str]:
    """What becomes of a line in a function."""
    source = f"{{\n{line}\n}}"
    return [mutant.apply(source).split("\n")[1].strip() for mutant in mutants(source)]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("    if (a < b) {", ["if (a <= b) {", "if (a >= b) {"]),
        ("    return a && !b;", ["return a || !b;", "return a && b;"]),
        ("    return a + 8U;", ["return a - 8U;", "return a + 9U;", "return a + 7U;"]),
        ("    x = -y;", ["x = y;", ";"]),
        ("    return n == 0;", ["return n != 0;", "return n == 1;"]),
        ("    count++;", ["count--;", ";"]),
        ("    act(true);", ["act(false);", ";"]),
    ],
)
def test_a_line_is_changed_in_each_way(line: str, expected: list[str]) -> None:
    assert changed(line) == expected


@pytest.mark.parametrize(
    "line",
    [
        "    /* a < b */",
        '    say("a < b");',
        "    static_assert(a < 5, text);",
        "    assert(a < 5);",
        "    struct thing *other;",
        "#define A 5",
        "    uint32_t number;",
        "    return value;",
    ],
)
def test_comments_texts_assertions_and_declarations_are_left_alone(line: str) -> None:
    assert [text for text in changed(line) if text != ";"] == []


def test_a_line_that_goes_on_is_no_statement() -> None:
    source = "{\n    call(a,\n         b);\n}"

    assert list(mutants(source)) == []


def test_what_is_listed_as_equivalent_stands_in_its_file() -> None:
    for file, old, new in mutation.equivalents():
        found = mutants((ROOT / file).read_text())
        assert any((one.old.strip(), one.new.strip()) == (old, new) for one in found), (file, old)


def test_an_entry_without_a_reason_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "list.txt").write_text("a.c\n- x\n+ y\n")
    monkeypatch.setattr(mutation, "EQUIVALENT", tmp_path / "list.txt")

    with pytest.raises(AssertionError):
        mutation.equivalents()


def test_the_score_leaves_out_what_is_no_change() -> None:
    score = mutation.Score()
    score.counts.update({"killed": 9, "same": 5, "listed": 3, "broken": 2})
    score.survivors.append(("a.c", next(iter(mutants("{\n    x = -y;\n}")))))

    assert str(score).startswith("90.0 % (9 killed, 1 survived")
