"""C sources by function, statement and token: for what is tied to these, and not to lines of text.

Proofs, planted bugs, equivalent mutants and unreachable sides name a place in a function. Neither
blanks, comments and line ends nor what is changed in other functions matter to them. What names
nothing, or more than one thing, is a Mismatch.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import TypeVar

import tree_sitter_c
from tree_sitter import Language, Node, Parser

Found = TypeVar("Found")
PARSER = Parser(Language(tree_sitter_c.language()))

COMMENT = r"/\*.*?\*/|//[^\n]*"
TEXT = r'"(?:\\.|[^"\\\n])*"|' + r"'(?:\\.|[^'\\\n])*'"
TOKEN = re.compile(
    rf"(?P<skipped>\s+|{COMMENT})|{TEXT}|[A-Za-z_]\w*|\.?\d[\w.]*|->|\+\+|--|\.\.\.|(?:<<|>>|[-+*/%&|^<>=!])="
    r"|<<|>>|&&|\|\||##|\S",
    re.DOTALL,
)
# What the parser must not see, as it knows no preprocessor: directives, and macros that stand
# where a declaration begins.
UNPARSED = re.compile(
    r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$|^[A-Z][A-Z0-9_]+(?=\s)|(?P<kept>" + COMMENT + ")",
    re.DOTALL | re.MULTILINE,
)
# Annotations of Frama-C are comments too, and kept.
REMARK = re.compile(rf"(?P<kept>{TEXT}|/\*@.*?\*/)|{COMMENT}", re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$", re.MULTILINE)

LOOPS = ("for_statement", "while_statement", "do_statement")
KINDS = {
    "loop": LOOPS, "if": ("if_statement",), "else": ("else_clause",),
    "switch": ("switch_statement",), "return": ("return_statement",),
    "break": ("break_statement",),
}  # fmt: skip


class Mismatch(Exception):
    """What names nothing in a source, or more than one thing."""


def tokens(text: str) -> list[tuple[str, int, int]]:
    """The tokens of a C text, each with its first and last place."""
    found = TOKEN.finditer(text)
    return [(each[0], each.start(), each.end()) for each in found if not each["skipped"]]


def words(text: str) -> str:
    """The tokens of a C text, with one blank between them."""
    return " ".join(token for token, _, _ in tokens(text))


def essence(text: str) -> str:
    """What a compiler and Frama-C see: tokens and directives, without comments and layout."""
    code = REMARK.sub(lambda match: match["kept"] or " ", text)
    code = code.replace("/*@", " @< ").replace("*/", " >@ ")
    lines, end = [], 0
    for match in DIRECTIVE.finditer(code):
        lines += [words(code[end : match.start()]), " ".join(match[0].split())]
        end = match.end()
    return "\n".join(line for line in [*lines, words(code[end:])] if line)


def _blank_out(match: re.Match[str]) -> str:
    return match["kept"] or re.sub(r"[^\n]", " ", match[0])


def _walk(node: Node) -> Iterator[Node]:
    yield node
    for child in node.named_children:
        yield from _walk(child)


class Source:
    """The functions of one source; places are those of characters."""

    def __init__(self, text: str) -> None:
        self.text = text
        code = UNPARSED.sub(_blank_out, text)
        self.code = code.encode("ascii", "replace")  # a byte for each character
        self.root = PARSER.parse(self.code).root_node
        self.definitions: dict[str, list[Node]] = {}
        self.declarations: dict[str, list[Node]] = {}
        for node in _walk(self.root):
            if node.type == "function_declarator" and node.parent is not None:
                self._enter(node)

    def _enter(self, declarator: Node) -> None:
        """Knows a function by its declarator, which stands in the declarator of a pointer where it
        returns one."""
        name, whole = declarator.child_by_field_name("declarator"), declarator.parent
        while whole is not None and whole.type == "pointer_declarator":
            whole = whole.parent
        if name is None or name.type != "identifier" or whole is None:
            return
        known = {"function_definition": self.definitions, "declaration": self.declarations}
        if whole.type in known:
            known[whole.type].setdefault(_text(name), []).append(whole)

    def functions(self) -> list[str]:
        """The names of what is defined here."""
        return list(self.definitions)

    def definition(self, function: str) -> Node:
        """Where a function is defined."""
        node = _only(self.definitions.get(function, []), f"function {function}")
        if node.has_error:
            raise Mismatch(f"{function}: the parser does not understand it")
        return node

    def head(self, function: str) -> Node:
        """Where a function is defined, or else declared."""
        if function in self.definitions:
            return self.definition(function)
        return _only(self.declarations.get(function, []), f"function {function}")

    def statement(self, function: str, kind: str, name: str = "", number: int = 0) -> Node:
        """A statement of a function by its kind, by what it calls or sets, and its number among
        such ones, from 1; 0 if there is no other."""
        what = " ".join(filter(None, (kind, name)))
        found = [
            node
            for node in _walk(self.definition(function))
            if kind_of(node) == kind and (not name or name in names_of(node))
        ]
        if number == 0:
            return _only(found, f"`{what}` in {function}")
        if number > len(found):
            raise Mismatch(f"there is no `{what} {number}` in {function}: {len(found)} such ones")
        return found[number - 1]

    def function_at(self, place: int) -> str:
        """The function around a place, or nothing."""
        for name, nodes in self.definitions.items():
            if any(node.start_byte <= place < node.end_byte for node in nodes):
                return name
        return ""

    def phrase(self, begin: int, end: int) -> tuple[int, int]:
        """The smallest expression around a part of it, or the declaration or statement."""
        node = self.root.descendant_for_byte_range(begin, end)
        if node is not None and node.type in STATEMENTS:
            return begin, end
        while node is not None and node.parent is not None:
            if node.type in PHRASES and (node.start_byte, node.end_byte) != (begin, end):
                break
            node = node.parent
        assert node is not None
        return node.start_byte, node.end_byte

    def find_all(self, function: str, wanted: str) -> list[tuple[int, int]]:
        """Where these tokens stand in a function, or in the source if no function is named."""
        first, last = 0, len(self.text)
        if function:
            node = self.definition(function)
            first, last = node.start_byte, node.end_byte
        there, pattern = tokens(self.text[first:last]), [token for token, _, _ in tokens(wanted)]
        if not pattern:
            raise Mismatch("nothing is looked for")
        return [
            (first + there[i][1], first + there[i + len(pattern) - 1][2])
            for i in range(len(there) - len(pattern) + 1)
            if [token for token, _, _ in there[i : i + len(pattern)]] == pattern
        ]

    def find(self, function: str, wanted: str, number: int = 0) -> tuple[int, int]:
        """Where these tokens stand in a function; the number, from 1, tells which of several."""
        found = self.find_all(function, wanted)
        where = f" in {function}" if function else ""
        if number == 0:
            return _only(found, f"`{wanted}`{where}")
        if number > len(found):
            raise Mismatch(f"`{wanted}`{where}: there are {len(found)}, not {number}")
        return found[number - 1]


STATEMENTS = ("expression_statement", "declaration")
PHRASES = (
    "binary_expression", "unary_expression", "update_expression", "assignment_expression",
    "conditional_expression", "call_expression", "subscript_expression", "init_declarator",
    "initializer_pair", "initializer_list", "enumerator", "field_declaration", "declaration",
    "array_declarator", "pointer_expression", "return_statement", "expression_statement",
    "case_statement", "function_definition",
)  # fmt: skip


@lru_cache(maxsize=256)
def source(text: str) -> Source:
    """A source that has been parsed; the same text is parsed once."""
    return Source(text)


def kind_of(node: Node) -> str:
    """How a statement is called: one of KINDS, set or call; nothing if it is no statement."""
    for kind, types in KINDS.items():
        if node.type in types:
            return kind
    if node.type == "declaration":
        return "set" if names_of(node) else ""
    inner = _expression(node)
    if inner is None:
        return ""
    return {
        "assignment_expression": "set", "update_expression": "set", "call_expression": "call",
    }.get(inner.type, "")  # fmt: skip


def names_of(node: Node) -> list[str]:
    """What a statement calls, or gives a value."""
    if node.type == "declaration":
        return [_name(each) for each in node.named_children if each.type == "init_declarator"]
    inner = _expression(node)
    return [_name(inner)] if inner is not None else []


def _expression(node: Node) -> Node | None:
    """What an expression statement is, without a `(void)`."""
    if node.type != "expression_statement" or not node.named_children:
        return None
    inner: Node | None = node.named_children[0]
    while inner is not None and inner.type == "cast_expression":
        inner = inner.child_by_field_name("value")
    return inner


# By type of node: the field in which the name is looked for.
NAMED_BY = {
    "init_declarator": "declarator", "pointer_declarator": "declarator",
    "array_declarator": "declarator", "assignment_expression": "left",
    "update_expression": "argument", "pointer_expression": "argument",
    "subscript_expression": "argument", "field_expression": "field", "call_expression": "function",
}  # fmt: skip


def _name(node: Node) -> str:
    """The variable or the member that an expression is about."""
    if node.type in NAMED_BY:
        inner = node.child_by_field_name(NAMED_BY[node.type])
        return _name(inner) if inner is not None else ""
    if node.type == "parenthesized_expression":
        return _name(node.named_children[0])
    return _text(node)


def _text(node: Node) -> str:
    return (node.text or b"").decode()


def _only(found: list[Found], what: str) -> Found:
    if len(found) != 1:
        raise Mismatch(f"there are {len(found)} of {what}" if found else f"there is no {what}")
    return found[0]
