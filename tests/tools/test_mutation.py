"""What the mutation tests change in a source, and what they leave alone."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from checks import mutation
from checks.mutation_operators import Mutant, mutants

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


def test_what_is_listed_as_equivalent_is_a_mutant_of_its_file() -> None:
    modules = {
        f"firmware/{one.folder}/{name}": one for one in mutation.MODULES for name in one.files
    }
    there = {
        file: {
            mutation.key_of(modules[file], Path(file).name, one).key()
            for one in mutants((ROOT / file).read_text())
        }
        for file in {change.file for change in mutation.equivalents()}
    }

    listed = mutation.equivalents()

    assert len({change.key() for change in listed}) == len(listed)
    assert [str(change) for change in listed if change.key() not in there[change.file]] == []


SOURCE = """\
enum { MANY = 3 };

int f(int a)
{
    int b = a + 1;
    call(b);
    return a + 1;
}

int g(int a)
{
    return a + 1;
}
"""


def keys(source: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """How the mutants of a source are listed."""
    monkeypatch.setattr(mutation, "ROOT", tmp_path)
    path = tmp_path / "firmware/rkm04/link/a.c"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)
    module = mutation.Module("link", "rkm04/link", ("a.c",), ())
    return [str(mutation.key_of(module, "a.c", one)) for one in mutants(source)]


def test_a_mutant_is_named_by_function_and_expression(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = keys(SOURCE, tmp_path, monkeypatch)

    assert len(set(named)) == len(named)
    assert named[0] == "firmware/rkm04/link/a.c\n- MANY = 3\n+ MANY = 4"
    assert "firmware/rkm04/link/a.c f 1\n- a + 1\n+ a - 1" in named
    assert "firmware/rkm04/link/a.c f 2\n- a + 1\n+ a + 0" in named
    assert "firmware/rkm04/link/a.c f\n- call(b);\n+ ;" in named
    assert "firmware/rkm04/link/a.c g\n- a + 1\n+ a - 1" in named


def test_the_name_of_a_mutant_outlives_what_does_not_concern_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = SOURCE.replace("int b = a + 1;", "uint32_t c = a + 1; /* why */").replace("MANY", "FEW")
    other = other.replace("call(b)", "call(\n        c,\n        MANY)")

    before, after = (keys(text, tmp_path, monkeypatch) for text in (SOURCE, other))

    assert [key for key in before if key not in after] == [
        key for key in before if "MANY" in key or "call" in key
    ]


class NoBench:
    """Sees no mutant."""

    def __init__(self, module: mutation.Module, number: int) -> None:
        pass

    def is_sound(self) -> bool:
        return True

    def try_one(self, name: str, mutant: Mutant) -> str:
        return "survived"


def test_a_mutant_that_is_listed_is_not_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = keys("int f(int a)\n{\n    return a < 2;\n}\n", tmp_path, monkeypatch)[0]
    (tmp_path / "list.txt").write_text(f"{key}\n+ a  >=  2\nNo test sees it.\n")
    monkeypatch.setattr(mutation, "EQUIVALENT", tmp_path / "list.txt")
    monkeypatch.setattr(mutation, "Bench", NoBench)
    listed = {change.key() for change in mutation.equivalents()}
    module = mutation.Module("link", "rkm04/link", ("a.c",), ())

    score = mutation.mutate(module, mutation.mutants_of(module, 1), math.inf, 1, listed)

    assert score is not None
    assert sorted(one.new for _, one in score.survivors) == ["1", "3"]
    assert score.counts["listed"] == 2


def test_an_entry_without_a_reason_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "list.txt").write_text("a.c f\n- x\n+ y\n")
    monkeypatch.setattr(mutation, "EQUIVALENT", tmp_path / "list.txt")

    with pytest.raises(AssertionError):
        mutation.equivalents()


def test_the_score_leaves_out_what_is_no_change() -> None:
    score = mutation.Score()
    score.counts.update({"killed": 9, "same": 5, "listed": 3, "broken": 2})
    score.survivors.append(("a.c", next(iter(mutants("{\n    x = -y;\n}")))))

    assert str(score).startswith("90.0 % (9 killed, 1 survived")
