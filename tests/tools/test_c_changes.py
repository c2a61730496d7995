"""How a change of a source is listed, and where it goes."""

from __future__ import annotations

import pytest
from checks.c_changes import Change, read_changes
from checks.c_source import Mismatch, essence, words

SOURCE = """\
static int f(int a)
{
    /* a + 1 */
    say("a + 1");
    return a + 1;
}

int g(int a)
{
    return a+1 + a + 1;
}
"""


def changed(function: str, number: int = 0, old: str = "a + 1", new: str = "b") -> str:
    """A line of the source that a change has changed."""
    after = Change("a.c", function, number, old, new).apply(SOURCE)
    [line] = [
        line
        for line, before in zip(after.splitlines(), SOURCE.splitlines(), strict=True)
        if line != before
    ]
    return line.strip()


def test_a_change_is_looked_for_by_tokens_in_its_function() -> None:
    assert changed("f") == "return b;"
    assert changed("f", 0, "a+1") == "return b;"
    assert changed("g", 1) == "return b + a + 1;"
    assert changed("g", 2) == "return a+1 + b;"
    assert changed("", 3) == "return a+1 + b;"
    assert changed("", 0, "static int f(int a)", "int f(void)") == "int f(void)"


@pytest.mark.parametrize(
    ("function", "number", "old", "why"),
    [
        ("g", 0, "a + 1", "a.c: there are 2 of `a \\+ 1` in g"),
        ("g", 3, "a + 1", "there are 2, not 3"),
        ("g", 0, "a + 2", "there is no `a \\+ 2` in g"),
        ("", 0, "a + 2", "there is no `a \\+ 2`$"),
        ("h", 0, "a + 1", "there is no function h"),
        ("g", 0, "", "nothing is looked for"),
    ],
)
def test_a_change_of_nothing_or_of_several_places_is_refused(
    function: str, number: int, old: str, why: str
) -> None:
    with pytest.raises(Mismatch, match=why):
        Change("a.c", function, number, old, "b").apply(SOURCE)


def test_a_block_lists_changes_of_one_function() -> None:
    text = """\
# What this is.

a.c f 2
- x - 1
+ x
+
- y(
  z)
+ - z
A reason.
More of it.

b.def
- X(a)
+ X(b)
"""

    first, second = read_changes(text)

    assert first[0] == [
        Change("a.c", "f", 2, "x - 1", "x"), Change("a.c", "f", 2, "x - 1", ""),
        Change("a.c", "f", 2, "y(\n  z)", "- z"),
    ]  # fmt: skip
    assert first[1] == "A reason.\nMore of it."
    assert second == ([Change("b.def", "", 0, "X(a)", "X(b)")], "")


@pytest.mark.parametrize(
    "text", ["a.c f", "a.c f\n- x", "a.c f\n+ x", "a.c f\n+ x\n- y", "a.c f g\n- x\n+ y",
             "a.c f\nwhy\n- x\n+ y"]
)  # fmt: skip
def test_a_block_that_is_no_change_is_refused(text: str) -> None:
    with pytest.raises(Mismatch, match=r"^a place"):
        list(read_changes(text))


def test_tokens_are_those_of_c() -> None:
    assert words("a->b.c+=1.5e3F;/* x */ d++ - -'\\''") == "a -> b . c += 1.5e3F ; d ++ - - '\\''"


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("f(a,\n  b);", "f(a, b); /* why */", True),
        ("/*@ requires a; */ f();", "/*@ requires\n  a; */\nf();", True),
        ("/*@ requires a; */ f();", "/*@ requires b; */ f();", False),
        ("/*@ requires a; */ f();", "/* requires a; */ f();", False),
        ("a--b", "a - -b", False),
        ("#define A(b) 1\nA", "#define A (b) 1\nA", False),
        ("#define A 1 /* why */\nA", "#define A   1\nA", True),
        ("#define A 1\nB", "#define A 1 B", False),
        ('"a  b"', '"a b"', False),
        ('"/* a */"', '"/* b */"', False),
    ],
)
def test_comments_and_layout_do_not_count(one: str, other: str, same: bool) -> None:
    assert (essence(one) == essence(other)) is same
