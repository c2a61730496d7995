"""Where the annotations of a proof go, and which anchors are refused."""

from __future__ import annotations

import pytest
from checks.c_source import Mismatch, Source
from weave import line_of, weave

SOURCE = """\
#include "a.h"

void declared(int a);

/* A comment; it is no loop: for (;;) { } */
HERE_IS_A_MACRO
static struct thing *first(struct thing *it, int many)
{
    int left = many;
    for (int i = 0; i < many &&
             i < 10; i++) {
        left--;
        (void)note(it,
                   i); /* both */
    }
    if (left > 0) {
        it->list[left].next = it;
    } else {
        *it = (struct thing){
            .left = left,
        };
        return 0;
    }
    while (left < 0) {
        left++;
    }
    return it; left = 1;
}

int second(void)
{
    return 2;
}
"""
LINES = SOURCE.splitlines()


def line(text: str) -> int:
    """The only line that begins so."""
    [number] = [number for number, each in enumerate(LINES) if each.strip().startswith(text)]
    return number


@pytest.mark.parametrize(
    ("anchor", "where"),
    [
        ("contract declared", line("void declared")),
        ("contract first", line("static struct")),
        ("contract second", line("int second")),
        ("begin first", line("int left")),
        ("end second", line("return 2") + 1),
        ("before first loop 1", line("for")),
        ("begin first loop 1", line("left--")),
        ("end first loop 1", line("if (left") - 1),
        ("before first loop 2", line("while")),
        ("after first set left 1", line("for")),
        ("before first set left 2", line("left--")),
        ("after first set left 3", line("left++") + 1),
        ("after first call note", line("i); /*") + 1),
        ("before first call note", line("(void)note")),
        ("before first if", line("if (left")),
        ("after first if", line("while")),
        ("begin first if", line("it->list")),
        ("end first if", line("} else")),
        ("begin first else", line("*it =")),
        ("end first else", line("while") - 1),
        ("before first set next", line("it->list")),
        ("after first set it", line("return 0")),
        ("before first return 1", line("return 0")),
        ("before first return 2", line("return it")),
        ("before second return", line("return 2")),
    ],
)
def test_an_anchor_is_a_function_and_a_statement_in_it(anchor: str, where: int) -> None:
    assert line_of(Source(SOURCE), anchor) == where


@pytest.mark.parametrize(
    ("anchor", "why"),
    [
        ("contract third", "no function third"),
        ("end declared", "no function declared"),
        ("before first loop", "2 of `loop`"),
        ("before first loop 3", "no `loop 3`"),
        ("before first loop 0x1", "no statement"),
        ("before first set", "no statement"),
        ("before first set right", "no `set right`"),
        ("before first call second", "no `call second`"),
        ("before first if left", "no statement"),
        ("before first set i", "does not begin a line"),
        ("before first else", "does not begin a line"),
        ("after first return 2", "does not end a line"),
        ("begin first return 1", "no statement"),
        ("before first", "no statement"),
        ("contract first if", "means nothing"),
        ("behind first if", "means nothing"),
        ("before int second(void)", "no statement"),
    ],
)
def test_an_anchor_that_names_nothing_or_several_is_refused(anchor: str, why: str) -> None:
    with pytest.raises(Mismatch, match=why):
        line_of(Source(SOURCE), anchor)


def test_a_function_that_stands_twice_is_ambiguous() -> None:
    with pytest.raises(Mismatch, match="2 of function second"):
        line_of(Source(SOURCE + "int second(void)\n{\n}\n"), "begin second")


def test_a_function_that_the_parser_does_not_understand_is_told() -> None:
    with pytest.raises(Mismatch, match="does not understand"):
        line_of(Source("int second(void)\n{\n    X(a b) c d;\n}\n"), "begin second")


def test_texts_of_one_place_stand_in_their_order() -> None:
    source = Source("int f(void)\n{\n    int a = 1;\n    return a;\n}\n")

    woven = weave(source, [("before f return", "three\n"), ("begin f", "one\ntwo\n"),
                           ("after f set a", "four\n")])  # fmt: skip

    assert woven.splitlines() == [
        "int f(void)", "{", "one", "two", "    int a = 1;", "three", "four", "    return a;", "}",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("right", "other"),
    [
        ("int left = many;", "int left = many + 1;"),
        ("for (int i = 0; i < many &&\n             i < 10; i++) {", "for (;;) {"),
        ("left > 0", "left >\n        0"),
        ("(void)note(it,\n                   i)", "note(it, i)"),
        ("it->list[left].next", "it->inner.list[right].next"),
        ("int second", "int f(void)\n{\n    return 1;\n}\n\nint second"),
    ],
)
def test_anchors_outlive_what_does_not_concern_them(right: str, other: str) -> None:
    assert right in SOURCE
    texts = [
        ("before first loop 1", "A"), ("after first call note", "B"), ("begin first else", "C"),
        ("after first set next", "D"), ("before second return", "E"),
    ]  # fmt: skip

    woven = weave(Source(SOURCE.replace(right, other)), texts)

    below = dict(zip(woven.splitlines(), woven.splitlines()[1:], strict=False))
    above = dict(zip(woven.splitlines()[1:], woven.splitlines(), strict=False))
    assert below["A"].startswith("    for (")
    assert above["B"].split("/*")[0].strip().endswith("i);")
    assert above["C"] == "    } else {"
    assert ".next = it;" in above["D"]
    assert below["E"] == "    return 2;"
