"""The static analysis finds what it is there for, and its baseline is a ratchet."""

from __future__ import annotations

import json
from typing import Any

import pytest
from checks import misra, static

TOO_COMPLEX = "int f(int a)\n{\n" + "    if (a) { a++; }\n" * 10 + "    return a;\n}\n"
SWITCH = (
    "int f(int a)\n{\n    switch (a) {\n"
    + "".join(f"    case {i}:\n        return {i + 1};\n" for i in range(40))
    + "    }\n    return 0;\n}\n"
)
NOTHING_FREED = """\
#include <stdlib.h>
int f(int a);
int f(int a)
{
    int *p = malloc(4);
    if (p == NULL) {
        return a;
    }
    *p = a;
    return 0;
}
"""
FREED_BY_ANOTHER = """
#include <stdlib.h>
static void drop(int *p, int count)
{
    for (int i = 0; i < count; i++) {
        p[i] = 0;
    }
    if (count > 1) {
        p[1] = 1;
    }
    free(p);
}

int f(int count)
{
    int *p = malloc(8);
    if (p == NULL) {
        return 0;
    }
    drop(p, count);
    return *p;
}
"""
BASELINE: dict[str, Any] = {"rules": {"15.5": {"count": 2, "reason": "because"}}, "left": []}


@pytest.fixture
def source(tmp_path):
    path = tmp_path / "a.c"

    def write(text: str) -> str:
        path.write_text(text)
        return str(path)

    return write


def returns(count: int, rule: str = "15.5") -> list[misra.Found]:
    return [misra.Found("a.c", line, rule, "") for line in range(1, count + 1)]


def test_a_function_with_more_than_ten_paths_is_found(source):
    [found] = static.complexities([source(TOO_COMPLEX)])

    assert "f has a cyclomatic complexity of 11, more than 10" in found


def test_a_flat_switch_counts_once(source):
    assert list(static.complexities([source(SWITCH)])) == []


@pytest.mark.parametrize("deep", [False, True])
def test_what_clang_tidy_finds_is_found(source, deep):
    found = list(static.analyse([source(NOTHING_FREED)], deep))

    assert any("[clang-analyzer-unix.Malloc]" in each for each in found), found


def test_what_goes_through_another_function_is_found_in_the_deep(source):
    text = source(FREED_BY_ANOTHER)

    assert list(static.analyse([text], deep=False)) == []
    assert any("after it is freed" in each for each in static.analyse([text], deep=True))


def test_a_file_that_does_not_compile_is_found(source):
    assert list(static.analyse([source("int f(\n")], deep=False)) != []


def test_what_is_left_is_left_in_its_file_only():
    (check, file), _ = next(iter(static.LEFT.items()))
    said = f"{static.ROOT}/{{}}:1:2: warning: words [{check},-warnings-as-errors]\n"

    assert list(static.findings(said.format(file))) == []
    assert list(static.findings(said.format("a.c"))) == [f"a.c:1: words [{check}]"]


def test_cppcheck_is_read_once_for_each_place():
    said = "a.c:3:misra-c2012-15.5:misra violation\n" * 2 + "b.c:4:nullPointer:Null: it is\n"

    assert misra.parse(said) == [
        misra.Found("a.c", 3, "15.5", ""),
        misra.Found("b.c", 4, "nullPointer", "Null: it is"),
    ]


def test_as_many_deviations_as_recorded_are_good():
    assert misra.judge(returns(2), BASELINE) == ([], [])


def test_one_more_is_wrong():
    [wrong], _ = misra.judge(returns(3), BASELINE)

    assert wrong.startswith("rule 15.5: 3 deviations, 2 are in the baseline")


def test_one_less_is_told():
    wrong, better = misra.judge(returns(1), BASELINE)

    assert wrong == []
    assert "1 deviations, fewer than the 2" in better[0]


def test_a_new_rule_is_wrong_until_it_has_a_reason():
    found = [*returns(2), *returns(1, "8.7")]
    new = misra.updated(found, BASELINE)

    wrong, _ = misra.judge(found, new)

    assert new["rules"]["15.5"] == BASELINE["rules"]["15.5"]
    assert wrong == ["rule 8.7: has no reason in misra_baseline.json"]


def test_what_cppcheck_finds_itself_is_wrong_unless_it_is_left():
    found = [misra.Found("a.c", 1, "nullPointer", "Null")]
    left = {"rules": {}, "left": [{"file": "a.c", "id": "nullPointer", "reason": "it is not"}]}

    assert misra.judge(found, {"rules": {}, "left": []})[0] == ["a.c:1: Null [nullPointer]"]
    assert misra.judge(found, left)[0] == []


def test_every_deviation_of_the_baseline_has_a_reason():
    baseline = json.loads(misra.BASELINE.read_text())

    assert all(entry["count"] > 0 and entry["reason"] for entry in baseline["rules"].values())
    assert all(entry["reason"] for entry in baseline["left"])
