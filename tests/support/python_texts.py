"""The texts that a source in Python may say."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

Pieces = list[str | None]
"""Of a text; None: what differs."""


def texts_of(path: Path, functions: set[str] | None) -> Iterator[Pieces]:
    """All but the documents; of these functions only, if they are named."""
    roots: list[ast.AST] = [ast.parse(path.read_text(encoding="utf-8"))]
    if functions is not None:
        roots = [
            each for each in ast.walk(roots[0])
            if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef) and each.name in functions
        ]  # fmt: skip
        assert len(roots) >= len(functions), path
    nodes = [node for root in roots for node in ast.walk(root)]
    documents = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    parts = {id(p) for node in nodes if isinstance(node, ast.JoinedStr) for p in node.values}
    for node in nodes:
        if id(node) in documents | parts:
            continue
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield [node.value]
        elif isinstance(node, ast.JoinedStr):
            yield [str(p.value) if isinstance(p, ast.Constant) else None for p in node.values]
