"""Tables of text in columns."""

from __future__ import annotations

from collections.abc import Sequence

GAP = "  "


def table(rows: Sequence[Sequence[str]], right: str) -> str:
    """Lay rows out in columns; `right` has one letter a column: r = right-aligned, l = left."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        GAP.join(
            cell.rjust(width) if side == "r" else cell.ljust(width)
            for cell, width, side in zip(row, widths, right, strict=True)
        ).rstrip()
        for row in rows
    )


def thousands(number: int) -> str:
    """A number with its digits in groups of three."""
    return f"{number:,}".replace(",", " ")


def rounded(number: float) -> str:
    """A number to three digits, in groups of three where it is large."""
    if abs(number) >= 100:
        return thousands(round(number))
    return f"{number:.3g}"
