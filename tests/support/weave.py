"""Puts annotations into a copy of a source, at functions and statements that they name.

An anchor is one of

    contract FUNCTION           before its definition, or before its declaration if that is all
    begin FUNCTION [BLOCK]      after the opening brace
    end FUNCTION [BLOCK]        before the closing brace
    before FUNCTION STATEMENT   before its first line
    after FUNCTION STATEMENT    after its last line

where a BLOCK is the body of an `if`, `else`, `loop` or `switch`, and a STATEMENT one of these, or

    set NAME                    gives this variable or member a value: declaration, assignment, ++
    call NAME                   calls this function, and does nothing else
    return, break

each with its number in the function after it, from 1, if there are several such.
"""

from __future__ import annotations

from checks.c_source import KINDS, Mismatch, Source
from tree_sitter import Node

BLOCKS = ("if", "else", "loop", "switch")
BODIES = ("body", "consequence")  # how the parser calls them


def line_of(source: Source, anchor: str) -> int:
    """The line, from 0, before which the text of an anchor goes."""
    word, _, rest = anchor.partition(" ")
    function, *what = rest.split()
    if word == "contract" and not what:
        return _before(source, source.head(function).start_byte, anchor)
    if word in ("begin", "end"):
        node = _statement(source, function, what, BLOCKS) if what else source.definition(function)
        block = _block(node, anchor)
        return (
            _after(source, block.start_byte + 1, anchor) if word == "begin"
            else _before(source, block.end_byte - 1, anchor)
        )  # fmt: skip
    if word in ("before", "after"):
        node = _statement(source, function, what, (*KINDS, "set", "call"))
        if word == "before":
            return _before(source, node.start_byte, anchor)
        return _after(source, node.end_byte, anchor)
    raise Mismatch(f"`{anchor}` means nothing")


def weave(source: Source, texts: list[tuple[str, str]]) -> str:
    """The source with texts, each at its anchor; of the same place, in their order."""
    lines = source.text.splitlines()
    put: dict[int, list[str]] = {}
    for anchor, text in texts:
        put.setdefault(line_of(source, anchor), []).extend(text.splitlines())
    woven: list[str] = []
    for number, line in enumerate(lines):
        woven += [*put.get(number, []), line]
    return "\n".join(woven)


def _statement(source: Source, function: str, what: list[str], kinds: tuple[str, ...]) -> Node:
    """The statement that `KIND [NAME] [NUMBER]` names."""
    number = int(what.pop()) if what and what[-1].isdecimal() else 0
    kind, *name = what or [""]
    if kind not in kinds or len(name) != (kind in ("set", "call")):
        raise Mismatch(f"`{' '.join([kind, *name])}` is no statement that could be named")
    return source.statement(function, kind, "".join(name), number)


def _block(node: Node, anchor: str) -> Node:
    """The braces of a function, a loop or a branch."""
    fields = [node.child_by_field_name(field) for field in BODIES]
    for block in [*fields, *(node.named_children if node.type == "else_clause" else [])]:
        if block is not None and block.type == "compound_statement":
            return block
    raise Mismatch(f"`{anchor}`: there are no braces")


def _before(source: Source, place: int, anchor: str) -> int:
    """The line of a place, before which there must be nothing else in it."""
    begin = source.code.rfind(b"\n", 0, place) + 1
    if source.code[begin:place].strip():
        raise Mismatch(f"`{anchor}`: it does not begin a line")
    return source.code.count(b"\n", 0, place)


def _after(source: Source, place: int, anchor: str) -> int:
    """The line below a place, after which there must be nothing but a comment in it."""
    end = source.code.find(b"\n", place)
    rest = source.code[place:end].strip()
    if rest and not (rest.startswith(b"/*") and rest.endswith(b"*/")):
        raise Mismatch(f"`{anchor}`: it does not end a line")
    return source.code.count(b"\n", 0, place) + 1
