"""Checks the models in tests/proofs, the line, the ring of segments, its recall and the edges that
the DMA moves, with Spin: every run of them, to the end.

    python tests/support/line_model.py [--all]

The variants that must hold are explored completely; those with a planted error must fail. A model
that is the same as when that was last found, of which tests/proofs/explored.json has a digest, is
not explored once more but with --all, which writes that file.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

MODELS = Path(__file__).resolve().parents[2] / "tests/proofs"
RING = "ring.pml"
EDGES = "edges.pml"
RECALL = "recall.pml"
TWO_AXES = ("AXES=2", "STOPS=0", "PUSHES=2", "FIRST=1")
NO_STOPS = ("STOPS=0", "CHANGES=2", "PUSHES=4")
GROUP = ("STOPS=2", "FAULTS", "RESUMES=1", "CHANGES=0", "PUSHES=1", "FIRST=1")
COMMANDS = ("spin", "gcc")
EXPLORED = MODELS / "explored.json"

ERRORS = re.compile(r"errors: (\d+)")
STATES = re.compile(r"^\s*(\d+) states, stored", re.MULTILINE)
INCOMPLETE = ("Search not completed", "max search depth too small", "out of memory", "memory limit")


@dataclass(frozen=True)
class Variant:
    """A way to build the model, and what is said of it."""

    claim: str
    switches: tuple[str, ...] = ()
    cycles: bool = False  # looks for runs without an end instead of violated assertions
    model: str = "line.pml"


HOLD = (
    Variant("executed once, answered by its own answer; nobody blocks", ("ACTIONS=3",)),
    Variant(
        "executed once, answered by its own answer, if answers come late", ("ACTIONS=2", "LATE")
    ),
    Variant("the master comes to an end", ("ACTIONS=2",), cycles=True),
    Variant("each pulse made once, in order; a way back; a stop; rest in the end", model=RING),
    Variant(
        "the same without stops, with more segments and replacements",
        ("PUSHES=4", "REPLACEMENTS=2", "STOPS=0"),
        model=RING,
    ),
    Variant("each edge made once, at its tick; none of what was taken back", model=EDGES),
    Variant("the same with two changes", ("PULSES=4", "CHANGES=2"), model=EDGES),
    Variant("the same with a full ring", ("PULSES=8", "CHANGES=0", "FAR"), model=EDGES),
    Variant(
        "late pulses are counted, none is missing", ("PULSES=4", "CHANGES=0", "LATE"), model=EDGES
    ),
    Variant("the same with a change", ("PULSES=3", "LATE"), model=EDGES),
    Variant("a path recalled twice: each pulse made once, as intended", NO_STOPS, model=RECALL),
    Variant("the same with a stop at any time, which wins", model=RECALL),
    Variant("the same with a halt of all", ("ABORTS=1", "STOPS=0"), model=RECALL),
    Variant("all axes are recalled or none, and go on at once", TWO_AXES, model=RECALL),
    Variant("a stop is told, planned, hardened and taken back", GROUP, model=RECALL),
)
FAIL = (
    Variant("planted: a unit that has started refuses nothing", ("ACTIONS=1", "PLANT_NO_REFUSAL")),
    Variant("planted: what was refused is sent again", ("ACTIONS=1", "PLANT_SENT_AGAIN")),
    Variant(
        "planted: a session begins with one Version", ("ACTIONS=2", "LATE", "PLANT_ONE_VERSION")
    ),
    Variant("planted: no memory of the last request", ("ACTIONS=1", "PLANT_NO_MEMORY")),
    Variant("planted: number not compared", ("ACTIONS=2", "PLANT_NUMBER_NOT_COMPARED")),
    Variant("planted: FCS not checked", ("ACTIONS=1", "PLANT_NO_CHECK")),
    Variant("planted: a new number for a repeat", ("ACTIONS=1", "PLANT_NEW_NUMBER")),
    Variant(
        "planted: a session begins without Version",
        ("ACTIONS=2", "UNIT_STARTS=0", "PLANT_NO_VERSION", "PLANT_NO_REFUSAL"),
    ),
    Variant("planted: a broadcast leaves a long answer", ("ACTIONS=2", "PLANT_ANSWER_KEPT")),
    Variant("planted: room for one more", ("PLANT_ROOM_FOR_ONE_MORE",), model=RING),
    Variant(
        "planted: seen before it is written",
        ("STOPS=0", "PLANT_PUSH_WITHOUT_HOLD", "PLANT_SEEN_BEFORE_WRITTEN"),
        model=RING,
    ),
    Variant("planted: room from the younger place", ("PLANT_TAKEN_FROM_YOUNGER",), model=RING),
    Variant("planted: a place kept that is not passed", ("PLANT_KEPT_TOO_SOON",), model=RING),
    Variant("planted: taken back under a kept place", ("PLANT_KEPT_NOT_MOVED",), model=RING),
    Variant("planted: a way back past what was cut", ("PLANT_QUEUED_COPY_KEPT",), model=RING),
    Variant("planted: a way back over a brake", ("PLANT_WAY_BACK_OVER_BRAKE",), model=RING),
    Variant("planted: all taken for taken back", ("PLANT_ALL_TAKEN_BACK",), model=RING),
    Variant("planted: laid pulses counted as made", ("PLANT_WAITING_COUNTED",), model=RING),
    Variant("planted: a rest while pulses wait", ("PLANT_REST_WHILE_WAITING",), model=RING),
    Variant("planted: a brake that leaves the queue", ("PLANT_LAID_AFTER_CLOSE",), model=RING),
    Variant("planted: a halt that leaves the queue", ("PLANT_HALT_KEEPS_QUEUE",), model=RING),
    Variant("planted: a halt too late that rests", ("PLANT_HALT_RESTS",), model=RING),
    Variant("planted: a halt too late, and nobody asks", ("PLANT_HALT_NOT_RUN",), model=RING),
    Variant("planted: taken back, and nobody asks", ("PLANT_BACK_NOT_RUN",), model=RING),
    Variant("planted: a replacement without hold", ("PLANT_REPLACED_WITHOUT_HOLD",), model=RING),
    Variant("planted: a replacement in the past", ("PLANT_NOT_LOOKED_AGAIN",), model=RING),
    Variant("planted: not started again", ("PLANT_NOT_STARTED_AGAIN",), model=RING),
    Variant("planted: a wrap inside the ring", ("PLANT_COUNTERS_WRAP_BETWEEN",), model=RING),
    Variant("planted: a push into a closed ring", ("PLANT_CLOSED_NOT_SEEN",), model=RING),
    Variant("planted: a push without hold", ("PLANT_PUSH_WITHOUT_HOLD",), model=RING),
    Variant("planted: closed seen before the hold", ("PLANT_CLOSED_SEEN_BEFORE_HOLD",), model=RING),
    Variant("planted: a replacement after a brake", ("PLANT_REPLACED_AFTER_BRAKE",), model=RING),
    Variant("planted: a replacement that does not open", ("PLANT_NOT_OPENED",), model=RING),
    Variant("planted: no edge that is never", ("PLANT_NO_LAST_EDGE",), model=EDGES),
    Variant("planted: what is loaded is cut", ("PLANT_LOADED_IS_CUT",), model=EDGES),
    Variant("planted: a cut too late", ("PLANT_CUT_TOO_LATE",), model=EDGES),
    Variant("planted: taken back too late", ("PLANT_TAKEN_BACK_TOO_LATE",), model=EDGES),
    Variant("planted: a stop in a pulse", ("PLANT_PULSE_NOT_AWAITED",), model=EDGES),
    Variant("planted: a stop that leaves the pin", ("PLANT_PIN_LEFT",), model=EDGES),
    Variant("planted: a stop before the last edge", ("PLANT_END_NOT_AWAITED",), model=EDGES),
    Variant("planted: a pulse that rises counted as made", ("PLANT_MADE_TOO_SOON",), model=EDGES),
    Variant("planted: a stream begun where it was", ("PLANT_COUNT_KEPT",), model=EDGES),
    Variant(
        "planted: a ring laid over",
        ("PULSES=8", "CHANGES=0", "FAR", "PLANT_RING_OVERRUN"),
        model=EDGES,
    ),
    Variant("planted: laid too late", ("PULSES=4", "LATE", "PLANT_NOT_IN_TIME"), model=EDGES),
    Variant(
        "planted: what was loaded too soon is not seen",
        ("PULSES=4", "LATE", "PLANT_LOADED_NOT_CHECKED"),
        model=EDGES,
    ),
    Variant("planted: laid over the place", (*NO_STOPS, "PLANT_PLACE_LAID_OVER"), model=RECALL),
    Variant(
        "planted: nothing laid while frozen",
        (*NO_STOPS, "PLANT_NOTHING_LAID_WHILE_FROZEN"),
        model=RECALL,
    ),
    Variant("planted: a rest while frozen", (*NO_STOPS, "PLANT_REST_WHILE_FROZEN"), model=RECALL),
    Variant(
        "planted: what is recalled stays queued", (*NO_STOPS, "PLANT_QUEUE_KEPT"), model=RECALL
    ),
    Variant(
        "planted: a way back over a place", (*NO_STOPS, "PLANT_WAY_BACK_OVER_PLACE"), model=RECALL
    ),
    Variant("planted: recalled and counted", (*NO_STOPS, "PLANT_COUNT_KEPT"), model=RECALL),
    Variant("planted: thawed where it was laid", (*NO_STOPS, "PLANT_CURSOR_LEFT"), model=RECALL),
    Variant("planted: thawed, and nobody asks", (*NO_STOPS, "PLANT_NOT_RUN"), model=RECALL),
    Variant("planted: frozen without room", (*NO_STOPS, "PLANT_ROOM_NOT_LOOKED_AT"), model=RECALL),
    Variant(
        "planted: refused in part, and frozen", (*NO_STOPS, "PLANT_FROZEN_IN_PART"), model=RECALL
    ),
    Variant(
        "planted: a motor at rest that stays so", (*NO_STOPS, "PLANT_REST_NOT_LEFT"), model=RECALL
    ),
    Variant("planted: recalled twice over", (*NO_STOPS, "PLANT_RECALLED_KEPT"), model=RECALL),
    Variant("planted: halted while frozen", (*NO_STOPS, "PLANT_HALTED_WHILE_FROZEN"), model=RECALL),
    Variant("planted: thawed one by one", (*TWO_AXES, "PLANT_THAWED_APART"), model=RECALL),
    Variant("planted: planned without one axis", (*TWO_AXES, "PLANT_ONE_LEFT_OUT"), model=RECALL),
    Variant(
        "planted: refused, and others frozen", (*TWO_AXES, "PLANT_OTHERS_STAY_FROZEN"), model=RECALL
    ),
    Variant(
        "planted: a stop that is interrupted", (*GROUP, "PLANT_STOP_WITHOUT_HOLD"), model=RECALL
    ),
    Variant("planted: a fault taken back", (*GROUP, "PLANT_FAULT_TAKEN_BACK"), model=RECALL),
    Variant(
        "planted: a new stop's cause forgotten", (*GROUP, "PLANT_CAUSE_FORGOTTEN"), model=RECALL
    ),
    Variant(
        "planted: a fault planned as a pause", (*GROUP, "PLANT_CAUSE_NOT_COMPARED"), model=RECALL
    ),
)


@dataclass(frozen=True)
class Explored:
    """What the search has found."""

    errors: int
    states: int
    complete: bool

    def holds(self) -> bool:
        return self.complete and self.errors == 0 and self.states > 0


def _run(command: Sequence[str | Path], folder: str) -> str:
    done = subprocess.run(
        list(map(str, command)), cwd=folder, check=True, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    return done.stdout


def explore(variant: Variant, level: int = 2) -> Explored:
    """Builds a variant and searches all of its states, up to the first error."""
    kind = "-DNP" if variant.cycles else "-DSAFETY"
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(MODELS / variant.model, folder)
        _run(["spin", *(f"-D{switch}" for switch in variant.switches), "-a", variant.model], folder)
        _run(["gcc", f"-O{level}", "-w", kind, "-DMEMLIM=4000", "-o", "pan", "pan.c"], folder)
        search = ["./pan", "-m100000", "-w24", *(["-l"] if variant.cycles else [])]
        output = _run(search, folder)
    errors, states = ERRORS.search(output), STATES.search(output)
    return Explored(
        int(errors[1]) if errors else -1,
        int(states[1]) if states else 0,
        not any(text in output for text in INCOMPLETE),
    )


def missing() -> list[str]:
    """What is not installed of what the model needs."""
    return [command for command in COMMANDS if not shutil.which(command)]


def is_right(variant: Variant) -> bool:
    """Whether a variant does what it must, which is told."""
    started = time.monotonic()
    must_hold = variant in HOLD
    explored = explore(variant, 1 if must_hold else 0)
    verdict = "holds" if explored.holds() else "fails" if explored.errors > 0 else "unknown"
    right = verdict == ("holds" if must_hold else "fails")
    print(
        f"{variant.model}: {'' if right else 'WRONG: '}{verdict}: {variant.claim} "
        f"({explored.states} states, {time.monotonic() - started:.0f} s)",
        flush=True,
    )
    return right


def digest(model: str, variants: Sequence[Variant]) -> str:
    """Of all that an exploration follows from."""
    text = (MODELS / model).read_text(encoding="utf-8")
    return hashlib.sha256(f"{text}\n{variants!r}".encode()).hexdigest()


def main() -> int:
    parser = argparse.ArgumentParser(description="Explores the models in tests/proofs with Spin.")
    parser.add_argument("--all", action="store_true", help="also those that have not changed")
    options = parser.parse_args()
    if absent := missing():
        print(f"not installed: {', '.join(absent)}")
        return 77
    known = {} if options.all else json.loads(EXPLORED.read_text(encoding="utf-8"))
    found = {}
    for model in sorted({variant.model for variant in HOLD}):
        variants = [variant for variant in (*HOLD, *FAIL) if variant.model == model]
        now = digest(model, variants)
        if now == known.get(model):
            print(f"{model}: {len(variants)} variants, as when they were explored")
            found[model] = now
        elif all(map(is_right, variants)):
            found[model] = now
    if options.all:
        EXPLORED.write_text(f"{json.dumps(found, indent=2)}\n", encoding="utf-8")
    return 0 if len(found) == len({variant.model for variant in HOLD}) else 1


if __name__ == "__main__":
    sys.exit(main())
