"""What is wrong with a machine file, in words that need no knowledge of schemas."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

TYPES = {
    "string": "a text",
    "integer": "a whole number",
    "number": "a number",
    "object": "an object { }",
    "array": "a list [ ]",
    "boolean": "true or false",
}
SHOWN_MAX = 40


def problem(error: Any) -> str:
    """The words for an error of jsonschema: the place first."""
    place = _place(list(error.absolute_path))
    return f"{place}{': ' if place else ''}{_what(error)}"


def _place(path: list[str | int]) -> str:
    """motor 2, limits, speed_max_steps_per_s"""
    if path[:1] == ["motors"] and len(path) > 1:
        return ", ".join([f"motor {int(path[1]) + 1}", *map(str, path[2:])])
    return ", ".join(map(str, path))


def _what(error: Any) -> str:
    wanted, found = error.validator_value, error.instance
    match error.validator:
        case "type":
            return f"must be {TYPES[wanted]}, found {_shown(found)}"
        case "required":
            return f"lacks {_listed(key for key in wanted if key not in found)}"
        case "additionalProperties":
            return _unknown(error)
        case "minimum":
            return f"{_shown(found)} is too small; {wanted} is the least"
        case "maximum":
            return f"{_shown(found)} is too large; {wanted} is the most"
        case "exclusiveMinimum":
            return f"{_shown(found)} must be more than {wanted}"
        case "minLength":
            return "must not be empty"
        case "maxLength":
            return f"has {len(found)} characters; {wanted} are the most"
        case "minItems" | "maxItems":
            return f"must be a list of {wanted}, one for each motor; found {len(found)}"
        case "not":
            return f"has both {' and '.join(wanted['required'])}; keep one"
    return str(error.message)


def _unknown(error: Any) -> str:
    known = list(error.schema["properties"])
    unknown = [key for key in error.instance if key not in known]
    meant = get_close_matches(unknown[0], known, n=1)
    question = f"; did you mean {meant[0]}?" if meant else ""
    return f"nothing is known of {_listed(unknown)}{question}"


def _listed(keys: Iterable[str]) -> str:
    return ", ".join(f'"{_cut(key)}"' for key in keys)


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return f'"{_cut(value)}"'
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "null"}[value]
    if isinstance(value, (dict, list)):
        return TYPES["object" if isinstance(value, dict) else "array"]
    return _cut(str(value))


def _cut(text: str) -> str:
    shown = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return shown if len(shown) <= SHOWN_MAX else f"{shown[:SHOWN_MAX]}…"
