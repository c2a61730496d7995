"""`bench --target stm32`: the figures of the image beside their goals, modelled."""

from __future__ import annotations

import json
import os
from argparse import Namespace
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools import (
    board_size,
    profile,
    step_time,
    target_figures,
    target_paths,
    target_reactions,
    target_run,
)
from rkm04_tools.bar import Bar
from rkm04_tools.failure import DONE
from rkm04_tools.table import rounded, table
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_reactions import Reaction, spread
from rkm04_tools.target_rows import NOTE, STACK, Goal, Row, merge, rows_of, rows_table, yes_no
from rkm04_tools.target_run import BESIDE, GATE, Model, Rig

WORKERS = 2
REACTIONS_HEAD = ("from an edge at an input, us, P = 3", "min", "median", "max", "goal", "met")

MEASURES: Mapping[str, Callable[[Rig], Figures]] = {
    "cycles": target_figures.step_cycles,
    "rates": target_paths.rates,
    "language": target_figures.load_language,
    "storm": target_figures.load_storm,
    "fast": target_figures.load_fast,
    "start": target_figures.start_up,
    "longest": step_time.figures,
    "borders": target_paths.borders,
    "changes": target_paths.changes,
    "wide": target_paths.wide,
    "stops": target_reactions.fast_stops,
}


FIGURES = [
    Goal("lone_step", "a step of one motor up to 16 000 steps/s", "cycles", 250,
         budget="lone_step_cycles"),
    Goal("together_step", "... of four together", "cycles", 200, budget="together_step_cycles"),
    Goal("fast_step", "... of four up to 200 000 steps/s", "cycles"),
    Goal("fastest_step", "... up to 400 000 steps/s", "cycles", 68),
    Goal("interrupt_max", "the step interrupt, four motors: most", "cycles"),
    Goal("rate_1", "highest rate without a late step, one motor", "steps/s", 1_000_000, False),
    Goal("rate_4_together", "... four, due at the same tick", "steps/s", 500_000, False),
    Goal("rate_4_apart", "... four, in every order", "steps/s", 500_000, False),
    Goal("load_16000", "load at 4 x 16 000 steps/s, ramps and line", "%", 10,
         budget="load_16000_percent"),
    Goal("load_16000_cruise", "... in the cruise", "%", 10),
    Goal("late_16000", "... late steps", "steps", 0),
    Goal("latency_16000", "... a step interrupt waited for at most", "cycles"),
    Goal("line_busy", "... the line was busy for", "%"),
    Goal("load_storm", "load at 4 x 16 000 steps/s, inputs that change 100 000 times a second",
         "%"),
    Goal("late_storm", "... late steps", "steps", 0),
    Goal("load_200000_together", "load at 4 x 200 000 steps/s, ramps and line, due together", "%",
         50),
    Goal("late_200000_together", "... late steps", "steps", 0),
    Goal("load_200000_apart", "... in every order", "%", 50),
    Goal("late_200000_apart", "... late steps", "steps", 0),
    Goal("longest_ramps", "... the step interrupt if all its ways were the longest, ramps", "%",
         100, budget="load_longest_percent"),
    Goal("longest_cruise", "... in the cruise", "%", 50),
    Goal("longest_due", "... the last of four motors due at once waits for its turn, ramps", "us",
         step_time.left_us()),
    Goal("load_path_alike", "load at 4 x 200 000 steps/s, 2000 vectors/s, axes alike, line", "%",
         50, budget="load_paths_percent"),
    Goal("late_path_alike", "... late steps", "steps", 0),
    Goal("time_path_alike", "... time of the path, 366.67 ideal", "ms"),
    Goal("border_alike", "... a border of an axis, all in all", "cycles"),
    Goal("border_step_alike", "... of it in the step interrupt", "cycles", 200),
    Goal("interrupt_path_alike", "... the step interrupt: most", "cycles"),
    Goal("load_path_apart", "load at the same, axes with shares of their own", "%", 50),
    Goal("late_path_apart", "... late steps", "steps", 0),
    Goal("time_path_apart", "... time of the path, 366.67 ideal", "ms"),
    Goal("border_apart", "... a border of an axis, all in all", "cycles"),
    Goal("border_step_apart", "... of it in the step interrupt", "cycles", 200),
    Goal("interrupt_path_apart", "... the step interrupt: most", "cycles"),
    Goal("pass_path", "... a pass of main: most", "us"),
    Goal("load_wide_alike", "load at 4 x 200 000 steps/s, pulses of 2.5 us, 2000 vectors/s, line, "
         "due together", "%", 50),
    Goal("late_wide_alike", "... late steps", "steps", 0),
    Goal("load_wide_passing", "... in every order", "%", 50),
    Goal("late_wide_passing", "... late steps", "steps", 0),
    Goal("width_wide", "... the shortest pulse", "us", 2.4, False),
    Goal("load_path_slow", "load at 4 x 50 000 steps/s, 500 vectors/s, line", "%", 50),
    Goal("late_path_slow", "... late steps", "steps", 0),
    Goal("add_packet", "vectors in packets: adding 32 at once, most", "us"),
    Goal("late_packets", "... late steps", "steps", 0),
    Goal("effect_speed", "another speed for 128 vectors, until it takes effect", "us", 500),
    Goal("late_speed", "... late steps", "steps", 0),
    Goal("effect_hold", "a hold, until it takes effect", "us", 500),
    Goal("late_hold", "... late steps", "steps", 0),
    Goal("stop_fast_1", "from an edge at an input to the ramp, one motor at 200 000 steps/s: most",
         "us", 100),
    Goal("stop_fast_4", "... the last of four that stop on one edge", "us", 100),
    Goal("late_stops", "... late steps, of all these stops", "steps", 0),
    Goal("start_short", "power-on to the first pulse, one short stored program", "ms", 100),
    Goal("start_full", "... four long ones", "ms", 100),
    Goal(STACK, "stack that was used in all runs", "bytes"),
]  # fmt: skip


def run(options: Namespace) -> int:
    """Measure what is asked for and print it."""
    with TemporaryDirectory() as folder:
        rig = target_run.rig(Path(folder))
        if options.profile:
            return _profile(rig, Path(options.profile), options.json)
        figures, reactions = measure(rig)
        rows = rows_of(FIGURES, figures, asdict(board_size.measure(rig.elf, rig.image.folder)))
    if options.json:
        print(json.dumps(_as_json(rows, reactions), indent=2))
        return DONE
    print(f"{rows_table(rows)}\n\n{reactions_table(reactions[GATE])}\n\n{NOTE}")
    return DONE


def measure(rig: Rig) -> tuple[dict[Model, Figures], dict[Model, list[Reaction]]]:
    """Make all figures with both models, two runs at a time."""
    figures: dict[Model, Figures] = {GATE: {}, BESIDE: {}}
    reactions: dict[Model, list[Reaction]] = {}
    pool = ThreadPoolExecutor(min(WORKERS, os.cpu_count() or 1))
    with pool, Bar("measuring") as bar:
        tasks: dict[Any, tuple[Model, str]] = {}
        for model in (GATE, BESIDE):
            apart = rig.beside(f"reactions-{model.refill}", model)
            tasks[pool.submit(target_reactions.measure, apart)] = (model, "")
            for name, function in MEASURES.items():
                apart = rig.beside(f"{name}-{model.refill}", model)
                tasks[pool.submit(function, apart)] = (model, name)
        for done, task in enumerate(as_completed(tasks)):
            bar.show(done + 1, len(tasks))
            model, name = tasks[task]
            if name:
                merge(figures[model], task.result())
            else:
                reactions[model] = task.result()
    for model, found in reactions.items():
        merge(figures[model], {STACK: max(reaction.stack_used for reaction in found)})
    return figures, reactions


def reactions_table(reactions: list[Reaction]) -> str:
    """The times until the ramp begins, and until the first pulse at another time."""
    rows = []
    for reaction in reactions:
        times = spread(reaction.begins)
        goal = f"at most {rounded(reaction.goal)}"
        ends = (*(rounded(time) for time in times.values()), goal, yes_no(reaction.met))
        rows.append((reaction.name, *ends))
        if changes := spread(reaction.changes):
            cells = tuple(rounded(time) for time in changes.values())
            rows.append(("... the first pulse at another time", *cells, "", ""))
    return table([REACTIONS_HEAD, *rows], "lrrrrl")


def _as_json(rows: list[Row], reactions: Mapping[Model, list[Reaction]]) -> dict[str, Any]:
    told = [
        {
            "model": model.name,
            "kind": reaction.kind,
            "steps_per_s": reaction.speed,
            "motors": reaction.motors,
            "edges": len(reaction.begins) // reaction.motors,
            "us_until_ramp": spread(reaction.begins),
            "us_until_changed_pulse": spread(reaction.changes),
            "goal_us": reaction.goal,
            "met": reaction.met,
        }
        for model, found in reactions.items()
        for reaction in found
    ]
    figures = [{**asdict(row), "met": row.met} for row in rows]
    models = {"measured": asdict(GATE), "beside": asdict(BESIDE)}
    return {"note": NOTE, "models": models, "figures": figures, "reactions": told}


def _profile(rig: Rig, listing: Path, as_json: bool) -> int:
    """Where the cycles of a step go."""
    listings, answer = [], {}
    for motors, title in ((1, "one motor"), (4, "four motors, due at the same tick")):
        ran = target_figures.ramps(rig, motors, profile=True)
        found = profile.of_run(ran.profile_file, rig.elf, ran.pulses)
        answer[title] = found.as_json()
        listings.append(f"{title}\n\n{found.text()}\n\n{found.listing()}\n")
        if not as_json:
            print(f"== {title}\n{found.text()}\n")
    listing.write_text("\n".join(listings))
    print(json.dumps(answer, indent=2) if as_json else NOTE)
    return DONE
