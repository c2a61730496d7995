"""What `bench --target stm32` of every unit but the RKM04 does alike: measure, and tell."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from typing import Any

from rkm04_tools.bar import Bar
from rkm04_tools.failure import DONE
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_rows import NOTE, Row, merge, rows_table
from rkm04_tools.target_run import BESIDE, GATE, Model, Rig

WORKERS = 2

Measure = Callable[[Rig], Figures]


def measure(measures: Mapping[str, tuple[Rig, Measure]]) -> dict[Model, Figures]:
    """Make all figures, each on its rig, with both models, two runs at a time."""
    figures: dict[Model, Figures] = {GATE: {}, BESIDE: {}}
    with ThreadPoolExecutor(min(WORKERS, os.cpu_count() or 1)) as pool, Bar("measuring") as bar:
        tasks: dict[Any, Model] = {}
        for model in (GATE, BESIDE):
            for name, (rig, function) in measures.items():
                apart = rig.beside(f"{name}-{model.refill}", model)
                tasks[pool.submit(function, apart)] = model
        for done, task in enumerate(as_completed(tasks)):
            bar.show(done + 1, len(tasks))
            merge(figures[tasks[task]], task.result())
    return figures


def tell(rows: list[Row], as_json: bool) -> int:
    """Print the figures beside their goals."""
    if as_json:
        figures = [{**asdict(row), "met": row.met} for row in rows]
        models = {"measured": asdict(GATE), "beside": asdict(BESIDE)}
        print(json.dumps({"note": NOTE, "models": models, "figures": figures}, indent=2))
    else:
        print(f"{rows_table(rows)}\n\n{NOTE}")
    return DONE
