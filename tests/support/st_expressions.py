"""Variables and expressions of Structured Text as Python code, with their types checked."""

from __future__ import annotations

from typing import Any

from blark import transform as tree
from st_values import BITS, CONVERSION, INTEGERS, LITERAL, Unsuitable, converted

SECTIONS = {
    "InputDeclarations": "inputs",
    "OutputDeclarations": "outputs",
    "InputOutputDeclarations": "in-outs",
    "ExternalVariableDeclarations": "external",
    "VariableDeclarations": "own",
    "FunctionVariableDeclarations": "own",
    "structure": "own",
}
COMPARED = {"=": "==", "<>": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
LOGIC = {"AND": "&", "OR": "|", "XOR": "^"}
ARITHMETIC = ("+", "-", "*")  # of integers also MOD, of reals also /
# The standard block that the library uses, by its inputs and outputs.
R_TRIG = {"CLK": "BOOL", "Q": "BOOL"}

Typed = tuple[str, Any]  # Python code, and the type of what it gives


def python_name(name: str) -> str:
    """Names differ by letters only, whatever their case, and none is a word of Python."""
    return name.lower() + "_"


def literal(node: Any) -> Typed:
    """A number, TRUE or FALSE."""
    text = str(node.value).replace("_", "")
    if isinstance(node, tree.Boolean) and text.upper() in ("TRUE", "FALSE"):
        return text.capitalize(), "BOOL"
    if isinstance(node, tree.Real):
        return repr(float(text)), "LREAL"
    base = 16 if isinstance(node, (tree.HexInteger, tree.HexBitString)) else 10
    kind = getattr(node, "type_name", None)
    return str(int(text, base)), str(kind).upper() if kind else LITERAL


class Scope:
    """The variables that the body of a declaration sees."""

    def __init__(self, name: str, declared: dict[str, Any]) -> None:
        self.name = name
        self.declared = declared
        self.types: dict[str, Any] = {}  # (length, type) of an array
        self.values: dict[str, Any] = {}  # what stands behind := in a declaration
        self.references: set[str] = set()  # in-outs and externals
        self.signature: dict[str, dict[str, str]] = {s: {} for s in SECTIONS.values()}
        self.result = ""
        self.all_scopes: dict[str, Scope] = {}

    def declare(self, section: str, items: list[Any]) -> None:
        for item in items:
            if isinstance(item, tree.ExternalVariableDeclaration):
                names, kind, value = [str(item.name)], str(item.spec.type).upper(), None
            else:
                names = [str(v.variable.name) for v in item.variables]
                kind, value = self.kind_of(item.init)
            for name in names:
                self.types[name.upper()] = kind
                self.signature[SECTIONS[section]][name] = str(kind)
                if value is not None:
                    self.values[name.upper()] = value
                if SECTIONS[section] in ("in-outs", "external"):
                    self.references.add(name.upper())

    @staticmethod
    def kind_of(init: Any) -> tuple[Any, Any]:
        """The type of a declaration, and what stands behind :=."""
        if isinstance(init, tree.ArrayTypeInitialization):
            (bounds,) = init.spec.subranges
            if int(bounds.start.value) != 0:
                raise Unsuitable("an array that does not begin at 0")
            return (int(bounds.stop.value) + 1, str(init.spec.type.type_name).upper()), None
        return str(init.spec.type).upper(), init.value

    def member(self, kind: Any, name: str) -> Any:
        """The type of a variable of a structure or block."""
        if kind == "R_TRIG":
            return R_TRIG[name.upper()]
        try:
            return self.all_scopes[kind].types[name.upper()]
        except KeyError:
            raise Unsuitable(f"{self.name}: {kind} has no {name}") from None

    def variable(self, node: Any) -> Typed:
        """A variable, an element or a member of one."""
        first = node.name if isinstance(node, tree.MultiElementVariable) else node
        name = str(first.name)
        if name.upper() not in self.types:
            raise Unsuitable(f"{self.name}: {name} is not declared")
        code, kind = f"self.{python_name(name)}", self.types[name.upper()]
        for element in getattr(node, "elements", []):
            if isinstance(element, tree.SubscriptList):
                (subscript,) = element.subscripts
                index, index_kind = self.expression(subscript)
                if index_kind not in INTEGERS and index_kind != LITERAL:
                    raise Unsuitable(f"{self.name}: an index of type {index_kind}")
                code, kind = f"{code}[{index}]", kind[1]
            else:
                field = str(element.field.name)
                kind = self.member(kind, field)
                code = f"{code}.{python_name(field)}"
        return code, kind

    def expression(self, node: Any) -> Typed:
        if isinstance(node, tree.ParenthesizedExpression):
            code, kind = self.expression(node.expr)
            return f"({code})", kind
        if isinstance(node, tree.Literal):
            return literal(node)
        if isinstance(node, tree.FunctionCall):
            return self.call(node)
        if isinstance(node, tree.UnaryOperation):
            return self.unary(node)
        if isinstance(node, tree.BinaryOperation):
            return self.binary(node)
        if isinstance(node, (tree.SimpleVariable, tree.MultiElementVariable)):
            return self.variable(node)
        raise Unsuitable(f"{self.name}: {type(node).__name__}: {node}")

    def assigned(self, kind: str, node: Any) -> str:
        """The Python of a value for a variable of a type."""
        code, given = self.expression(node)
        if given == LITERAL and kind in (*INTEGERS, *BITS):
            return f"fitted({kind!r}, {code})"
        if given != kind:
            raise Unsuitable(f"{self.name}: {given} instead of {kind}: {node}")
        return code

    def unary(self, node: Any) -> Typed:
        code, kind = self.expression(node.expr)
        sign = str(node.op).upper()
        if sign == "NOT" and kind == "BOOL":
            return f"(not {code})", kind
        if sign == "-" and kind in ("LREAL", LITERAL):
            return f"(-{code})", kind
        raise Unsuitable(f"{self.name}: {sign} of {kind}")

    def binary(self, node: Any) -> Typed:
        """Both sides have one type; a number without a type takes that of the other side."""
        left, kind = self.expression(node.left)
        right, other = self.expression(node.right)
        sign = str(node.op).upper()
        if kind == LITERAL:
            kind = other
        if other not in (kind, LITERAL) or (other == LITERAL and kind not in {*INTEGERS, *BITS}):
            raise Unsuitable(f"{self.name}: {kind} {sign} {other}: {node}")
        if sign in COMPARED:
            return f"({left} {COMPARED[sign]} {right})", "BOOL"
        if sign in LOGIC and (kind == "BOOL" or kind in BITS):
            return f"({left} {LOGIC[sign]} {right})", kind
        if kind == "LREAL" and sign in (*ARITHMETIC, "/"):
            return f"({left} {sign} {right})", kind
        if kind in INTEGERS and sign in (*ARITHMETIC, "MOD"):
            return f"fitted({kind!r}, {left} {sign.replace('MOD', '%')} {right})", kind
        raise Unsuitable(f"{self.name}: {sign} of {kind}")

    def call(self, node: Any) -> Typed:
        """A function: a conversion, a shift, or one of the source."""
        name = str(node.name.name).upper()
        values = [parameter.value for parameter in node.parameters]
        if name in ("SHL", "SHR"):
            code, kind = self.expression(values[0])
            places, _ = self.expression(values[1])
            sign = "-" if name == "SHR" else ""
            return f"shifted({BITS[kind]}, {code}, {sign}{places})", kind
        if match := CONVERSION.match(name):
            (value,) = values
            return converted(match[1], match[2], self.assigned(match[1], value)), match[2]
        if name not in self.declared:
            raise Unsuitable(f"{self.name}: {name} is no function of the source")
        other = self.all_scopes[name]
        given = [
            f"{python_name(str(p.name.name))}="
            + self.assigned(other.types[str(p.name.name).upper()], p.value)
            for p in node.parameters
        ]
        return f"{python_name(name)}({', '.join(given)})", other.result
