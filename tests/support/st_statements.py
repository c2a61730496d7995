"""Statements of Structured Text as lines of Python."""

from __future__ import annotations

from typing import Any

from blark import transform as tree
from st_expressions import Scope, python_name
from st_values import Unsuitable

STEP = "    "


def body_lines(body: Any, scope: Scope, indent: str) -> list[str]:
    """The lines of a list of statements; at least one."""
    lines = [
        line
        for statement in (body.statements if body else [])
        for line in statement_lines(statement, scope, indent)
    ]
    return lines or [f"{indent}pass"]


def statement_lines(node: Any, scope: Scope, indent: str) -> list[str]:
    if isinstance(node, tree.AssignmentStatement):
        (variable,) = node.variables
        target, kind = scope.variable(variable)
        return [f"{indent}{target} = {scope.assigned(kind, node.expression)}"]
    if isinstance(node, tree.FunctionCallStatement):
        return call_lines(node, scope, indent)
    if isinstance(node, tree.IfStatement):
        return if_lines(node, scope, indent)
    raise Unsuitable(f"{scope.name}: {type(node).__name__}")


def call_lines(node: Any, scope: Scope, indent: str) -> list[str]:
    """A call of a block: inputs, then its body. An in-out must be given each time."""
    target, kind = scope.variable(node.name)
    inputs = {"CLK": "BOOL"} if kind == "R_TRIG" else parameters(scope.all_scopes[kind])
    lines, given = [], set()
    for parameter in node.parameters:
        name = str(parameter.name.name)
        if name.upper() not in inputs:
            raise Unsuitable(f"{scope.name}: {kind} has no input {name}")
        code = scope.assigned(inputs[name.upper()], parameter.value)
        lines.append(f"{indent}{target}.{python_name(name)} = {code}")
        given.add(name.upper())
    if kind != "R_TRIG" and (left := scope.all_scopes[kind].references - given):
        raise Unsuitable(f"{scope.name}: {kind} is called without {', '.join(left)}")
    return [*lines, f"{indent}{target}.run()"]


def parameters(scope: Scope) -> dict[str, str]:
    """What may be given to a block when it is called."""
    parts = [scope.signature["inputs"], scope.signature["in-outs"]]
    return {name.upper(): kind for part in parts for name, kind in part.items()}


def if_lines(node: Any, scope: Scope, indent: str) -> list[str]:
    branches = [(node.if_expression, node.statements)]
    branches += [(branch.if_expression, branch.statements) for branch in node.else_ifs]
    lines, word = [], "if"
    for condition, body in branches:
        lines.append(f"{indent}{word} {scope.assigned('BOOL', condition)}:")
        lines += body_lines(body, scope, indent + STEP)
        word = "elif"
    if node.else_clause is not None:
        lines.append(f"{indent}else:")
        lines += body_lines(node.else_clause.statements, scope, indent + STEP)
    return lines
