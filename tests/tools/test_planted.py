"""The planted bugs still fit the sources, and each names a test that there is."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from checks import mutation, planted
from checks.c_source import Mismatch, source, words
from checks.mutation_operators import mutants

ROOT = Path(__file__).resolve().parents[2]
BUGS = planted.bugs()
BUG = """\
a-name: Something is wrong.
Caught by: ctest x.y
a.c f
- a + 1
+ a
"""
SOURCE = "int f(int a)\n{\n    return a + 1;\n}\n"


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: str(bug.name))
def test_a_planted_bug_still_fits_the_sources(bug: planted.Bug) -> None:
    for path, text in planted.changed(bug, ROOT).items():
        assert words(text) != words(path.read_text())


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: str(bug.name))
def test_a_planted_bug_names_a_test_that_there_is(bug: planted.Bug) -> None:
    if bug.runner == "ctest":
        library, _, module = bug.test.partition(".")
        sources = (ROOT / "tests").glob(f"*/**/test_{module}.c")
        assert any(mutation.group_of(source.parent) == library for source in sources)
    else:
        file, _, function = bug.test.partition("::")
        name = function.partition("[")[0]
        assert re.search(rf"^def {name}\b", (ROOT / file).read_text(), re.MULTILINE)


def test_there_are_planted_bugs_all_over_the_tree() -> None:
    touched = {change.file.split("/")[0] for bug in BUGS for change in bug.changes}

    assert len(BUGS) >= 24
    assert {"firmware", "hal"} <= touched


def test_each_planted_bug_has_a_name_of_its_own() -> None:
    assert [name for name, count in Counter(bug.name for bug in BUGS).items() if count > 1] == []


def test_the_documents_say_how_many_there_are() -> None:
    assert f"{len(BUGS)} planted bugs" in (ROOT / "README.md").read_text()
    assert f"{len(BUGS)} bugs" in (ROOT / "firmware/docs/reliability.md").read_text()


def test_a_bug_goes_into_its_function_and_leaves_the_rest_alone(tmp_path: Path) -> None:
    (tmp_path / "a.c").write_text(SOURCE + SOURCE.replace(" f(", " g("))

    after = planted.changed(planted.read(BUG), tmp_path)

    assert after == {tmp_path / "a.c": SOURCE.replace("a + 1", "a") + SOURCE.replace(" f(", " g(")}


def test_a_bug_may_change_several_places_of_several_files(tmp_path: Path) -> None:
    (tmp_path / "a.c").write_text(SOURCE)
    (tmp_path / "b.c").write_text(SOURCE)
    bug = BUG + "a.c\n- int f\n+ long f\nb.c f\n- return a + 1;\n+ a++;\n  return a;\n"

    after = planted.changed(planted.read(bug), tmp_path)

    assert after[tmp_path / "a.c"] == SOURCE.replace("a + 1", "a").replace("int f", "long f")
    assert words(after[tmp_path / "b.c"]) == words("int f(int a) { a++; return a; }")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (None, "no file a.c"),
        (SOURCE.replace(" f(", " g("), "no function f"),
        (SOURCE.replace("a + 1", "a + 2"), "no `a \\+ 1` in f"),
        (SOURCE.replace("a + 1", "a + 1 + a + 1"), "2 of `a \\+ 1` in f"),
    ],
)
def test_a_bug_that_does_not_fit_is_told(tmp_path: Path, text: str | None, why: str) -> None:
    if text is not None:
        (tmp_path / "a.c").write_text(text)

    with pytest.raises(Mismatch, match=why):
        planted.changed(planted.read(BUG), tmp_path)


@pytest.mark.parametrize(
    "block",
    [
        "", "a: A bug.", "a: A bug.\nCaught by: luck\na.c f\n- b\n+ c",
        "a: A bug\nCaught by: ctest x.y\na.c f\n- b\n+ c", "a: A bug.\nCaught by: ctest x.y",
        "a: A bug.\nCaught by: ctest x.y\na.c f\n- b",
        "A bug.\nCaught by: ctest x.y\na.c f\n- b\n+ c",
    ],
)  # fmt: skip
def test_a_bug_that_does_not_say_what_it_has_to_is_refused(block: str) -> None:
    with pytest.raises(Mismatch):
        planted.read(block)


def test_a_name_that_there_is_not_is_told() -> None:
    with pytest.raises(Mismatch, match="no bug nobody"):
        planted.bugs(["nobody"])


def test_a_bug_is_taken_out_again_although_its_test_does_not_see_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.c").write_text(SOURCE)
    seen = []

    def passes(bug: planted.Bug) -> bool:
        seen.append((tmp_path / "a.c").read_text())
        return False

    monkeypatch.setattr(planted, "COPY", tmp_path)
    monkeypatch.setattr(planted, "build", lambda targets: "")
    monkeypatch.setattr(planted, "test_fails", passes)

    complaint = planted.plant(planted.read(BUG))

    assert complaint == "x.y does not see it"
    assert seen == [SOURCE.replace("a + 1", "a")]
    assert (tmp_path / "a.c").read_text() == SOURCE


def test_no_planted_bug_is_a_mutant_that_is_tried_anyway() -> None:
    files = {f"firmware/{one.folder}/{name}" for one in mutation.MODULES for name in one.files}

    again = []
    for bug in BUGS:
        change = bug.changes[0]
        if change.file in files and change.function:
            text = (ROOT / change.file).read_text()
            node = source(text).definition(change.function)
            code = text[node.start_byte : node.end_byte]
            planted_code = words(change.apply(text)[node.start_byte :])
            again += [
                bug.name for one in mutants(code) if planted_code.startswith(words(one.apply(code)))
            ]

    assert again == []
