"""Mutation tests: changes a module's sources in small ways; do its unit tests see each change?

A mutant is compiled by itself and linked in front of the module's library, so that one takes half
a second. One whose object is that of the original is no change. Others that no test can see are in
tests/mutation/equivalent.txt by function and expression, with the reason; any other that survives
is a failure.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import random
import resource
import shlex
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from queue import SimpleQueue

from checks.c_changes import Change, Key, read_changes
from checks.c_source import source as parsed
from checks.mutation_operators import Mutant, mutants

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "host"
WORK = ROOT / "build" / "mutation"
TESTS = ROOT / "tests"
GROUPS = {"system/gve134": "gve134_unit"}  # as tests/CMakeLists.txt calls them
EQUIVALENT = ROOT / "tests" / "mutation" / "equivalent.txt"
MINUTES = 10
SEED = 1
SECONDS = 2  # of processor time that a test program may use; the longest needs a twentieth


@dataclass(frozen=True)
class Module:
    """Sources of one folder of firmware/, and the test programs that must see their changes."""

    name: str
    folder: str
    files: tuple[str, ...]
    programs: tuple[str, ...]  # none named: all of the folders of tests/
    tests: tuple[str, ...] = ()  # those folders; none named: that of the unit tests of the folder

    def sources(self) -> dict[str, Path]:
        """The test programs, each with its source."""
        folders = self.tests or (f"unit/{self.folder}",)
        paths = [path for each in folders for path in sorted((TESTS / each).glob("test_*.c"))]
        return {
            f"{group_of(path.parent)}.{name}": path
            for path in paths
            if (name := path.stem.removeprefix("test_")) in (self.programs or (name,))
        }


def group_of(folder: Path) -> str:
    """What the names of the test programs of a folder begin with."""
    kind, *names = folder.relative_to(TESTS).parts
    group = "_".join(names)
    return GROUPS.get(f"{kind}/{group}", group)


MODULES = (
    Module(
        "parser", "rkm04/program", ("program_parser.c",),
        ("program_parser", "program_check", "program_ranges"),
    ),
    Module(
        "link", "rkm04/link",
        ("link.c", "link_fcs.c", "link_frame.h", "link_receiver.c", "link_sender.c"),
        ("link", "link_errors", "link_fcs", "link_receiver", "link_sender"),
    ),
    Module(
        "step", "engine/step",
        (
            "step_generator.c", "step_generator.h", "step_lay.c", "step_lay.h", "step_channel.c",
            "step_channel.h", "step_channel_change.c", "step_channel_private.h",
        ), (),
    ),
    Module(
        "motion", "engine/motion",
        (
            "motion_corners.c", "motion_leg.c", "motion_legs.c", "motion_lookahead.c",
            "motion_order.c", "motion_plan.c", "motion_point.c", "motion_profile.c",
            "motion_replan.c", "motion_time.c",
        ),
        (),
    ),
    Module(
        "path", "engine/path",
        (
            "path.c", "path_divide.c", "path_fixed.c", "path_lay.c", "path_look.c", "path_root.c",
            "path_segment.c", "path_vector.c",
        ), (),
        ("unit/engine/path", "system/group"),
    ),
    Module("axis", "engine/axis", ("axis.c", "axis_state.c", "axis_stop.c"), ()),
    Module("gve-speeds", "gve134/speeds", ("gve_speeds.c",), ()),
    Module("gve-guards", "gve134/guards", ("gve_guards.c",), ()),
    Module("gve-outputs", "gve134/outputs", ("gve_outputs.c",), ()),
    Module(
        "gve-queue", "gve134/queue", ("gve_queue.c", "gve_queue_home.c", "gve_queue_stop.c"), (),
        ("unit/gve134/queue", "system/gve134"),
    ),
    Module(
        "gve-unit", "gve134",
        ("gve134.c", "gve134_execute.c", "gve134_packet.c", "gve134_private.h"), (),
        ("system/gve134",),
    ),
    Module("gve-command", "gve134/command", ("gve_command.c", "gve_table.c", "gve_words.c"), ()),
    Module(
        "gve-line", "gve134/line", ("gve_answer.c", "gve_line.c", "gve_receiver.c"), (),
        ("unit/gve134/line", "system/gve134"),
    ),
    Module(
        "gve-memory", "gve134/memory",
        ("gve_big.c", "gve_float_put.c", "gve_float_read.c", "gve_memory.c"), (),
    ),
    Module(
        "pos-modbus", "positioning/modbus",
        (
            "modbus.c", "modbus_crc.c", "modbus_identity.c", "modbus_receiver.c",
            "modbus_request.c",
        ), (),
    ),
    Module(
        "pos-registers", "positioning/registers",
        ("pos_registers.c", "pos_table.c", "pos_write.c"), (),
    ),
    Module("pos-measure", "positioning/measure", ("pos_measure.c",), ()),
    Module("pos-frame", "positioning/frame", ("pos_frame.c",), ()),
    Module(
        "pos-drive", "positioning/drive", ("pos_drive.c",), (),
        ("unit/positioning/drive", "system/positioning"),
    ),
    Module(
        "pos-axis", "positioning/axis",
        ("pos_axis.c", "pos_axis_home.c", "pos_axis_motion.c", "pos_watch.c"), (),
        ("system/positioning",),
    ),
    Module(
        "pos-settings", "positioning/settings", ("pos_settings.c",), (), ("system/positioning",)
    ),
    Module(
        "pos-unit", "positioning",
        ("positioning.c", "positioning_line.c", "positioning_plc.c"), (), ("system/positioning",),
    ),
    Module("group", "engine/group", ("group.c", "group_change.c"), (), ("system/group",)),
)  # fmt: skip


def run(command: list[str], seconds: int = resource.RLIM_INFINITY) -> int:
    """The status of a command in the build folder; it may use the processor for so long."""
    process = subprocess.Popen(
        command, cwd=BUILD, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )  # fmt: skip
    resource.prlimit(process.pid, resource.RLIMIT_CPU, (seconds, seconds))
    return process.wait()


class Bench:
    """Builds and runs the test programs of a module with a mutant in them, one at a time."""

    def __init__(self, module: Module, number: int) -> None:
        self.module = module
        self.folder = WORK / module.name / str(number)
        self.source = ROOT / "firmware" / module.folder
        database = json.loads((BUILD / "compile_commands.json").read_text())
        self.compile = {Path(entry["file"]): shlex.split(entry["command"]) for entry in database}
        self.tests = module.sources()
        self.programs = list(self.tests)
        self.link = {name: self.link_command(name) for name in self.programs}
        self.original: dict[str, bytes] = {}
        self.restore()

    def link_command(self, program: str) -> list[str]:
        """How the build links a program."""
        listed = subprocess.run(
            ["ninja", "-t", "commands", program],
            cwd=BUILD,
            capture_output=True,
            text=True,
            check=True,
        )
        return shlex.split(
            listed.stdout.splitlines()[-1].removeprefix(": && ").removesuffix(" && :")
        )

    def restore(self) -> None:
        """Put the module's sources into the work folder as they are."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for path in self.source.glob("*.[ch]"):
            (self.folder / path.name).write_text(path.read_text())

    def compile_one(self, original: Path, source: Path) -> Path | None:
        """Compile a source as the build does its original; None where that fails."""
        command = list(self.compile[original])
        while (
            not Path(command[0]).name.startswith(("gcc", "cc", "clang"))
            or Path(command[0]).name == "ccache"
        ):
            command.pop(0)
        target = self.folder / f"{original.stem}.o"
        command[command.index("-o") + 1] = str(target)
        command[command.index("-c") + 1] = str(source)
        command = [word for word in command if word not in ("-g", "-Werror")]
        command[1:1] = ["-w", f"-I{self.folder}"]
        return target if run(command) == 0 else None

    def compile_library(self, name: str) -> dict[Path, Path] | None:
        """Compile what a file of the module goes into: a header, into all of it."""
        names = [name]
        if name.endswith(".h"):
            names = [path.name for path in self.source.glob("*.c") if path in self.compile]
        objects = {}
        for one in names:
            target = self.compile_one(self.source / one, self.folder / one)
            if target is None:
                return None
            objects[self.source / one] = target
        return objects

    def add_test(self, program: str, objects: dict[Path, Path]) -> bool:
        """Compile the source of a test program too, as it includes the header that is changed."""
        test = self.tests[program]
        target = self.compile_one(test, test)
        if target is not None:
            objects[test] = target
        return target is not None

    def passes(self, program: str, objects: dict[Path, Path]) -> bool:
        """Link a test program with these objects, and run it."""
        command = list(self.link[program])
        target = self.folder / program
        command[command.index("-o") + 1] = str(target)
        test = self.tests[program]
        own = next(i for i, word in enumerate(command) if word.endswith(f"{test.name}.o"))
        command[own : own + 1] = [
            str(objects.get(test, command[own])),
            *(str(path) for original, path in objects.items() if original.parent == self.source),
        ]
        if run(command) != 0:
            return False
        return run([str(target)], SECONDS) == 0

    def is_sound(self) -> bool:
        """Whether all programs pass without a change."""
        failing = [program for program in self.programs if not self.passes(program, {})]
        for program in failing:
            print(f"{program} does not pass without a change")
        return not failing

    def kills(self, name: str, objects: dict[Path, Path]) -> bool:
        """Whether a program fails; the one that failed last is tried first."""
        for place, program in enumerate(self.programs):
            seen = name.endswith(".h") and not self.add_test(program, objects)
            if seen or not self.passes(program, objects):
                self.programs.insert(0, self.programs.pop(place))
                return True
        return False

    def learn(self, name: str) -> None:
        """Keep what a file is compiled to without a change."""
        objects = self.compile_library(name)
        assert objects is not None, f"{name} does not compile"
        if name.endswith(".h"):
            assert all(self.add_test(program, objects) for program in self.programs)
        self.original[name] = digest(objects)

    @contextmanager
    def changed(self, name: str, mutant: Mutant) -> Iterator[None]:
        """A file is a mutant."""
        path = self.folder / name
        original = path.read_text()
        path.write_text(mutant.apply(original))
        try:
            yield
        finally:
            path.write_text(original)

    def try_one(self, name: str, mutant: Mutant) -> str:
        """What becomes of a mutant: killed, survived, same, broken."""
        if name not in self.original:
            self.learn(name)
        with self.changed(name, mutant):
            objects = self.compile_library(name)
            if objects is None:
                return "broken"
            if digest(objects) == self.original[name]:
                return "same"
            if self.kills(name, objects):
                return "killed"
            return "same" if digest(objects) == self.original[name] else "survived"


def digest(objects: dict[Path, Path]) -> bytes:
    """What tells objects from others."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in sorted(objects.values()))).digest()


@dataclass
class Score:
    """What became of the mutants of a module."""

    counts: Counter[str] = field(default_factory=Counter)
    survivors: list[tuple[str, Mutant]] = field(default_factory=list)

    def __str__(self) -> str:
        seen = self.counts["killed"] + len(self.survivors)
        share = 100.0 * self.counts["killed"] / seen if seen else 100.0
        return (
            f"{share:.1f} % ({self.counts['killed']} killed, {len(self.survivors)} survived; "
            f"besides {self.counts['listed']} listed as equivalent, "
            f"{self.counts['same']} of the same code, {self.counts['broken']} that do not compile, "
            f"{self.counts['left']} not tried)"
        )


def equivalents() -> list[Change]:
    """The mutants that are listed, each with a reason."""
    listed = []
    for changes, reason in read_changes(EQUIVALENT.read_text()):
        assert reason, f"no reason: {changes[0]}"
        listed += changes
    return listed


def key_of(module: Module, name: str, mutant: Mutant) -> Change:
    """How a mutant is listed: by the smallest expression around what it changes."""
    path = f"firmware/{module.folder}/{name}"
    text = (ROOT / path).read_text()
    source = parsed(text)
    function = source.function_at(mutant.begin)
    begin, end = source.phrase(mutant.begin, mutant.end)
    old = text[begin:end]
    new = text[begin : mutant.begin] + mutant.new + text[mutant.end : end]
    places = source.find_all(function, old)
    number = places.index((begin, end)) + 1 if len(places) > 1 else 0
    return Change(path, function, number, old, new)


def mutants_of(module: Module, seed: int) -> list[tuple[str, Mutant]]:
    """All mutants of a module, in an order that the seed makes."""
    source = ROOT / "firmware" / module.folder
    work = [
        (name, mutant) for name in module.files for mutant in mutants((source / name).read_text())
    ]
    random.Random(seed).shuffle(work)
    return work


def mutate(
    module: Module, work: list[tuple[str, Mutant]], end: float, jobs: int, listed: set[Key]
) -> Score | None:
    """Try mutants of a module until an end, some at a time; survivors are shown as they appear."""
    score = Score()
    benches: SimpleQueue[Bench] = SimpleQueue()
    for number in range(jobs):
        bench = Bench(module, number)
        if not bench.is_sound():
            return None
        benches.put(bench)

    def become(one: tuple[str, Mutant]) -> str:
        if key_of(module, *one).key() in listed:
            return "listed"
        if time.monotonic() > end:
            return "left"
        bench = benches.get()
        try:
            return bench.try_one(*one)
        finally:
            benches.put(bench)

    with ThreadPoolExecutor(jobs) as pool:
        for (name, mutant), result in zip(work, pool.map(become, work), strict=True):
            score.counts[result] += 1
            if result == "survived":
                score.survivors.append((name, mutant))
                print(f"\n{key_of(module, name, mutant)}")
                sys.stdout.flush()
    return score


def main() -> int:
    parser = argparse.ArgumentParser(
        description="Changes sources in small ways that the unit tests must see."
    )
    parser.add_argument(
        "modules", nargs="*", metavar="MODULE", help=", ".join(one.name for one in MODULES)
    )
    parser.add_argument(
        "--seed",
        type=int,
        default=SEED,
        help="of the order in which mutants are tried (%(default)s)",
    )
    parser.add_argument(
        "--minutes", type=float, default=MINUTES, help="for all modules together (%(default)s)"
    )
    parser.add_argument("--file", help="only mutants of this file")
    parser.add_argument("--jobs", type=int, default=1, help="mutants at a time (%(default)s)")
    options = parser.parse_args()
    chosen = [one for one in MODULES if not options.modules or one.name in options.modules]
    if run(["ninja"]) != 0:
        print("the preset host is not built")
        return 1
    print(f"seed {options.seed}")
    listed = {each.key() for each in equivalents()}
    good = True
    end = time.monotonic() + options.minutes * 60
    for place, module in enumerate(chosen):
        work = mutants_of(module, options.seed)
        if options.file:
            work = [one for one in work if one[0] == options.file]
        now = time.monotonic()
        share = (end - now) / (len(chosen) - place)
        score = mutate(module, work, now + share, options.jobs, listed)
        if score is None:
            return 1
        print(f"{module.name}: {score}, {(time.monotonic() - now) / 60:.1f} minutes", flush=True)
        good = good and not score.survivors
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
