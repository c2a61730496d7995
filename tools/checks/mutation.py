"""Mutation tests: changes a module's sources in small ways; do its unit tests see each change?

A mutant is compiled by itself and linked in front of the module's library, so that one takes a
second at most. One whose object is that of the original is no change. Others that no test can see
are in tests/mutation/equivalent.txt, with the reason; any other that survives is a failure in a
module whose mutants have all been looked at.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import random
import shlex
import subprocess
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from checks.mutation_operators import Mutant, mutants

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "host"
WORK = ROOT / "build" / "mutation"
EQUIVALENT = ROOT / "tests" / "mutation" / "equivalent.txt"
MINUTES = 10
SEED = 1
SECONDS_MIN = 2.0  # that a test may take, and five times what it takes without a change


@dataclass(frozen=True)
class Module:
    """Sources of one folder of firmware/, and the test programs that must see their changes."""

    name: str
    folder: str
    files: tuple[str, ...]
    programs: tuple[str, ...]  # none named: all of the folder
    strict: bool  # a survivor that is not listed is a failure


MODULES = (
    Module(
        "parser", "program", ("program_parser.c",),
        ("program_parser", "program_check", "program_ranges"), True,
    ),
    Module(
        "link", "link",
        ("link.c", "link_fcs.c", "link_frame.h", "link_receiver.c", "link_sender.c"),
        ("link", "link_errors", "link_fcs", "link_receiver", "link_sender"), True,
    ),
    Module(
        "step", "step",
        ("step_generator.c", "step_generator.h", "step_channel.c", "step_channel.h"), (), False,
    ),
    Module(
        "motion", "motion",
        ("motion_leg.c", "motion_plan.c", "motion_point.c", "motion_profile.c", "motion_time.c",
         "mover.c"), (), False,
    ),
)  # fmt: skip


def run(command: list[str], seconds: float | None = None) -> int:
    """The status of a command in the build folder; 124 if it took too long."""
    try:
        return subprocess.run(
            command, cwd=BUILD, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, timeout=seconds,
        ).returncode  # fmt: skip
    except subprocess.TimeoutExpired:
        return 124


class Bench:
    """Builds and runs the test programs of a module with a mutant in them."""

    def __init__(self, module: Module) -> None:
        self.module = module
        self.folder = WORK / module.name
        self.source = ROOT / "firmware" / module.folder
        database = json.loads((BUILD / "compile_commands.json").read_text())
        self.compile = {Path(entry["file"]): shlex.split(entry["command"]) for entry in database}
        names = module.programs or tuple(
            path.stem.removeprefix("test_")
            for path in sorted((ROOT / "tests/unit" / module.folder).glob("test_*.c"))
        )
        self.programs = [f"{module.folder}.{name}" for name in names]
        self.link = {name: self.link_command(name) for name in self.programs}
        self.seconds: dict[str, float] = {}
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

    def test_source(self, program: str) -> Path:
        """The source of a test program."""
        stage, _, name = program.partition(".")
        return ROOT / "tests" / "unit" / stage / f"test_{name}.c"

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

    def build(self, name: str) -> dict[Path, Path] | None:
        """Compile what a file of the module goes into: a header, all of it and the tests too."""
        units = {self.source / name: self.folder / name}
        if name.endswith(".h"):
            units = {path: self.folder / path.name for path in self.source.glob("*.c")}
            units |= {path: path for path in map(self.test_source, self.programs)}
        objects = {}
        for original, source in units.items():
            target = self.compile_one(original, source)
            if target is None:
                return None
            objects[original] = target
        return objects

    def passes(self, program: str, objects: dict[Path, Path]) -> bool:
        """Link a test program with these objects, and run it."""
        command = list(self.link[program])
        target = self.folder / program
        command[command.index("-o") + 1] = str(target)
        test = self.test_source(program)
        own = next(i for i, word in enumerate(command) if word.endswith(f"{test.name}.o"))
        command[own : own + 1] = [
            *([str(objects[test])] if test in objects else [command[own]]),
            *(str(path) for original, path in objects.items() if original.parent == self.source),
        ]
        if run(command) != 0:
            return False
        return run([str(target)], self.seconds.get(program)) == 0

    def measure(self) -> bool:
        """Whether all programs pass without a change; how long they may take."""
        for program in self.programs:
            started = time.monotonic()
            if not self.passes(program, {}):
                print(f"{program} does not pass without a change")
                return False
            self.seconds[program] = SECONDS_MIN + 5 * (time.monotonic() - started)
        return True

    def killer(self, objects: dict[Path, Path]) -> str:
        """The first program that fails; those that have failed before are tried first."""
        for place, program in enumerate(self.programs):
            if not self.passes(program, objects):
                self.programs.insert(0, self.programs.pop(place))
                return program
        return ""


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


Key = tuple[str, str, str]


def equivalents() -> set[Key]:
    """The mutants that are listed: file, line, changed line; each with a reason."""
    listed = set()
    for block in EQUIVALENT.read_text().split("\n\n"):
        lines = [line for line in block.splitlines() if not line.startswith("#")]
        if lines:
            assert len(lines) >= 4, f"a file, a line, a changed line, a reason: {block}"
            listed.add(
                (lines[0], lines[1].removeprefix("- ").strip(), lines[2].removeprefix("+ ").strip())
            )
    return listed


def try_one(bench: Bench, name: str, mutant: Mutant, originals: dict[str, bytes]) -> str:
    """What becomes of a mutant: killed, survived, same, broken."""
    path = bench.folder / name
    original = path.read_text()
    path.write_text(mutant.apply(original))
    try:
        objects = bench.build(name)
        if objects is None:
            return "broken"
        if digest(objects) == originals[name]:
            return "same"
        return "killed" if bench.killer(objects) else "survived"
    finally:
        path.write_text(original)


def mutate(module: Module, seed: int, seconds: float, listed: set[Key]) -> Score | None:
    """Try the mutants of a module in an order that the seed makes, for a limited time."""
    score = Score()
    bench = Bench(module)
    if not bench.measure():
        return None
    originals = {}
    work = []
    for name in module.files:
        objects = bench.build(name)
        assert objects is not None, f"{name} does not compile"
        originals[name] = digest(objects)
        work += [(name, mutant) for mutant in mutants((bench.source / name).read_text())]
    random.Random(seed).shuffle(work)
    end = time.monotonic() + seconds
    for name, mutant in work:
        if time.monotonic() > end:
            score.counts["left"] += 1
            continue
        if (f"firmware/{module.folder}/{name}", mutant.old.strip(), mutant.new.strip()) in listed:
            score.counts["listed"] += 1
            continue
        result = try_one(bench, name, mutant, originals)
        score.counts[result] += 1
        if result == "survived":
            score.survivors.append((name, mutant))
    return score


def show(module: Module, score: Score) -> None:
    for name, mutant in sorted(score.survivors, key=lambda one: (one[0], one[1].line)):
        print(f"\nfirmware/{module.folder}/{name}\n- {mutant.old.strip()}\n+ {mutant.new.strip()}")
        print(f"(line {mutant.line + 1})")
    print(f"{module.name}: {score}", flush=True)


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
    options = parser.parse_args()
    chosen = [one for one in MODULES if not options.modules or one.name in options.modules]
    if run(["ninja"]) != 0:
        print("the preset host is not built")
        return 1
    print(f"seed {options.seed}")
    listed = equivalents()
    good = True
    for module in chosen:
        score = mutate(module, options.seed, options.minutes * 60 / len(chosen), listed)
        if score is None:
            return 1
        show(module, score)
        good = good and not (module.strict and score.survivors)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
