"""`gcode`: turns a program into a vector file, and tells what came of it."""

from __future__ import annotations

import json
import os
from argparse import Namespace
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools.bar import Bar
from rkm04_tools.client_base import count_of
from rkm04_tools.failure import DONE, NOT_SO, Failure, finished_or_absent, writing_failed
from rkm04_tools.gve134.gcode.axes import LETTERS, PARTS, Mill, read_mill
from rkm04_tools.gve134.gcode.preview import Preview, Previewed, draw_course
from rkm04_tools.gve134.gcode.reading import lines_of
from rkm04_tools.gve134.gcode.turning import Problem, Start, Turned, turn_file
from rkm04_tools.source import Place, Source, named
from rkm04_tools.table import thousands

MACHINE_VARIABLE = "GVE134_MACHINE"
SHOWN_MAX = 50
KIND_WORDS = {"rapid": "rapid", "feed": "lines", "arc": "arcs", "probe": "probing"}

Put = Callable[[str], object]


class Unfit(Exception):
    """Has a file removed that is not to be used."""


def run(options: Namespace) -> int:
    """Turn a program; the vector file is written whole or not at all."""
    path, mill = named(options.file), read_mill(machine_of(options))
    output = None if options.check or options.output is None else named(options.output)
    if output is not None and output.exists() and path.exists() and output.samefile(path):
        raise Failure(f"{output}: is the program itself; name another file for the vectors")
    picture = _picture(options)
    with TemporaryDirectory(prefix="gve134-") as folder:
        course = Path(folder) / "course" if picture else None
        with Preview(mill, not options.check, course) as preview:
            preview.put(_begin(mill, options.start))
            turned = _turn(options, path, mill, output, preview)
            previewed = preview.end() if turned.is_good else None
        if picture and course and previewed:
            draw_course(course, path.name, picture)
    if options.json:
        print(json.dumps(_as_json(str(path), turned, previewed, output), indent=2))
    else:
        _report(str(path), turned, previewed, output)
    return DONE if turned.is_good else NOT_SO


def machine_of(options: Namespace) -> str:
    """The machine file that is named."""
    name = options.machine or os.environ.get(MACHINE_VARIABLE)
    if not name:
        raise Failure(
            f"which machine? name its file with --machine or {MACHINE_VARIABLE}; "
            "tools/examples/gve/mill.rkm is one to begin with"
        )
    return str(name)


def _begin(mill: Mill, start: Start) -> str:
    """Tell the planner where X and Y are; the unit knows by itself, or need not know."""
    places = zip(mill.axes[:2], start[:2], strict=True)
    return "".join(f"N{axis.letter}{axis.steps_of(round(at * PARTS))}\n"
                   for axis, at in places if axis)  # fmt: skip


def _picture(options: Namespace) -> Path | None:
    """What is to be drawn; the libraries for it are imported only then."""
    if options.check or options.xy is None:
        return None
    from rkm04_tools.plot import require_format

    path = named(options.xy)
    require_format(path)
    return path


def _turn(
    options: Namespace, path: Path, mill: Mill, output: Path | None, preview: Preview
) -> Turned:
    turned = Turned()
    with suppress(Unfit), Bar("turning") as bar, _written(output) as put:

        def put_both(text: str) -> None:
            put(text)
            preview.put(text)

        lines = lines_of(path, bar.show)
        turned = turn_file(lines, path.name, mill, put_both, options.tolerance, options.start)
        if not turned.is_good:
            raise Unfit
    return turned


@contextmanager
def _written(path: Path | None) -> Iterator[Put]:
    """A file that is there if the block ends well."""
    if path is None:
        yield len
        return
    try:
        with finished_or_absent(path) as part, part.open("w", encoding="utf-8", newline="") as file:
            yield file.write
    except OSError as error:
        raise writing_failed(path, error) from None


def _report(name: str, turned: Turned, previewed: Previewed | None, output: Path | None) -> None:
    """Print errors and warnings, each with its line and a caret, then what there is."""
    for kind, problems in (("error", turned.problems), ("warning", turned.warnings)):
        for problem in problems[:SHOWN_MAX]:
            print(f"{name}:{problem.line}:{problem.column}: {kind}: {problem.message}")
            print(Source(name, problem.text).excerpt(Place(1, problem.column)))
        if (more := len(problems) - SHOWN_MAX) > 0:
            print(f"{name}: and {count_of(more + turned.more_problems, f'more {kind}')}")
    if turned.problems:
        total = len(turned.problems) + turned.more_problems
        print(f"{name}: {count_of(total, 'error')}; nothing was written")
        return
    for line in _summary(turned, previewed):
        print(line)
    print(f"{output}: written" if output else f"{name}: no errors")


def _summary(turned: Turned, previewed: Previewed | None) -> Iterator[str]:
    yield f"lines      {thousands(turned.lines)}"
    yield f"vectors    {thousands(turned.vectors)}"
    for kind, length in turned.lengths.items():
        if length:
            yield f"{KIND_WORDS[kind]:9}  {length:.3f} mm"
    if turned.degrees:
        yield f"A alone    {turned.degrees:.3f} degrees"
    if previewed is None:
        return
    yield f"time       {clock(previewed.seconds + turned.dwelt_s)}{_left_out(previewed)}"
    if turned.dwelt_s:
        yield f"dwells     {turned.dwelt_s:.3f} s of it"
    yield f"peak       {thousands(round(60 * previewed.peak_mm_per_s))} mm/min"
    peaks = [f"{letter} {thousands(round(peak))}"
             for letter, peak in zip(LETTERS, previewed.peaks, strict=True) if peak]  # fmt: skip
    if peaks:
        yield f"           {', '.join(peaks)} pulses/s"


def _left_out(previewed: Previewed) -> str:
    """What nobody knows beforehand."""
    left = [count_of(previewed.runs, "reference run")] if previewed.runs else []
    left += [count_of(previewed.pauses, "pause")] if previewed.pauses else []
    return f", without {' and '.join(left)}" if left else ""


def _as_json(
    name: str, turned: Turned, previewed: Previewed | None, output: Path | None
) -> dict[str, object]:
    return {
        "file": name,
        "ok": turned.is_good,
        "written": str(output) if output and turned.is_good else None,
        "lines": turned.lines,
        "vectors": turned.vectors,
        "length_mm": turned.lengths,
        "degrees": turned.degrees,
        "dwell_s": turned.dwelt_s,
        "preview": previewed and asdict(previewed),
        "warnings": [_told(each) for each in turned.warnings],
        "errors": [_told(each) for each in turned.problems],
        "more_errors": turned.more_problems,
    }


def _told(problem: Problem) -> dict[str, object]:
    return {"line": problem.line, "column": problem.column, "message": problem.message}


def clock(seconds: float) -> str:
    """Seconds, and from a minute on the usual way to tell them."""
    if seconds < 60:
        return f"{seconds:.3f} s"
    minutes, rest = divmod(seconds, 60)
    hours, minutes = divmod(int(minutes), 60)
    told = f"{hours} h {minutes} min" if hours else f"{minutes} min"
    return f"{told} {rest:.1f} s"
