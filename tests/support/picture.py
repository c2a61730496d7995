"""A plot read back from its SVG file, in the numbers that a person reads off its axes."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

Point = tuple[float, float]
SVG = "{http://www.w3.org/2000/svg}"
SPEED, POSITION, LEVEL = "#0b3d91", "#8a3b12", "#222222"


@dataclass(frozen=True)
class Line:
    """A line in pixels."""

    colour: str
    is_dotted: bool
    points: list[Point]


@dataclass(frozen=True)
class Panel:
    """A panel: what stands beside it, its ticks with their pixels, its lines and notes."""

    label: list[str]
    x_ticks: list[tuple[str, float]]
    y_ticks: list[tuple[str, float]]
    lines: list[Line]
    notes: list[tuple[str, float]]
    left: float
    right: float

    def heights(self, colour: str) -> list[Line]:
        """The lines of a colour, their heights as the vertical axis says."""
        (low, low_y), (high, high_y) = self.y_ticks[0], self.y_ticks[-1]
        unit = (number(high) - number(low)) / (high_y - low_y)

        def read(y: float) -> float:
            return number(low) + (y - low_y) * unit

        return [
            Line(line.colour, line.is_dotted, [(x, read(y)) for x, y in line.points])
            for line in self.lines
            if line.colour == colour
        ]


@dataclass(frozen=True)
class Picture:
    """All panels from the top; the last one has the time."""

    title: str
    panels: list[Panel]

    def seconds(self, x: float) -> float:
        """The time that the axis says at a pixel."""
        ticks = self.panels[-1].x_ticks
        (first, first_x), (last, last_x) = ticks[0], ticks[-1]
        return number(first) + (x - first_x) * (number(last) - number(first)) / (last_x - first_x)

    def panel(self, *label: str) -> Panel:
        """The one panel with this beside it."""
        (found,) = [panel for panel in self.panels if panel.label == list(label)]
        return found

    def curve(self, panel: Panel, colour: str) -> list[Point]:
        """The one line of a colour, in seconds and what the vertical axis says."""
        (line,) = panel.heights(colour)
        return [(self.seconds(x), y) for x, y in line.points]


def number(label: str) -> float:
    """What a tick says; its thousands are apart."""
    return float(label.replace(" ", ""))


def read_picture(path: Path) -> Picture:
    """Read a plot; the library keeps texts as comments beside their outlines."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.parse(path, parser).getroot()
    figure = root.find(f"{SVG}g[@id='figure_1']")
    assert figure is not None
    groups = {each.get("id", ""): each for each in figure.findall(f"{SVG}g")}
    panels = [_panel(each) for name, each in groups.items() if name.startswith("axes")]
    titles = [_texts(each) for name, each in groups.items() if name.startswith("text")]
    return Picture(titles[0][0] if titles else "", panels)


def _panel(axes: ElementTree.Element) -> Panel:
    parts = axes.findall(f"{SVG}g")
    horizontal, vertical = (p for p in parts if p.get("id", "").startswith("matplotlib.axis"))
    own = [part for part in parts if part not in (horizontal, vertical)]
    box = _points(axes.find(f"{SVG}g/{SVG}path"))
    lines = [_line(each) for each in own if each.get("id", "").startswith("line2d")]
    notes = [
        (_texts(each)[0], _place(each)[0]) for each in own if each.get("id", "").startswith("text")
    ]
    label = [text for each in vertical.findall(f"{SVG}g") for text in _own_texts(each)]
    left, right = min(x for x, _ in box), max(x for x, _ in box)
    return Panel(label, _ticks(horizontal, "x"), _ticks(vertical, "y"), lines, notes, left, right)


def _ticks(axis: ElementTree.Element, name: str) -> list[tuple[str, float]]:
    found = []
    for tick in axis.findall(f"{SVG}g"):
        marks = [each.get(name) for each in tick.iter(f"{SVG}use") if each.get(name)]
        if not tick.get("id", "").startswith(f"{name}tick") or not _texts(tick):
            continue
        # A tick without a line is where its text stands.
        at = float(marks[0] or "") if marks else _place(tick)["xy".index(name)]
        found.append((_texts(tick)[0], at))
    return found


def _own_texts(group: ElementTree.Element) -> list[str]:
    return _texts(group) if group.get("id", "").startswith("text") else []


def _texts(group: ElementTree.Element) -> list[str]:
    return [
        (each.text or "").strip()
        for each in group.iter()
        if each.tag is ElementTree.Comment  # type: ignore[comparison-overlap]
    ]


def _place(group: ElementTree.Element) -> Point:
    """Where the text of a group stands: its left end, and its base line."""
    for each in group.iter(f"{SVG}g"):
        if match := re.match(r"translate\(([\d.]+) ([\d.]+)\)", each.get("transform", "")):
            return float(match[1]), float(match[2])
    return float("nan"), float("nan")


def _line(group: ElementTree.Element) -> Line:
    path = group.find(f"{SVG}path")
    style = "" if path is None else path.get("style", "")
    colour = re.search(r"stroke: (#\w+)", style)
    return Line(colour[1] if colour else "", "dasharray" in style, _points(path))


def _points(path: ElementTree.Element | None) -> list[Point]:
    text = "" if path is None else path.get("d", "")
    return [(float(x), float(y)) for x, y in re.findall(r"[ML] ([\d.-]+) ([\d.-]+)", text)]
