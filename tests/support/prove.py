"""Proves the contracts in the *.acsl files of tests/proofs with Frama-C's WP.

    python tests/support/prove.py [--all] [--record] [--minutes N] [NAME...]

and the lemmas of the headers there. A file of contracts is C text, then parts that begin with a
`%` line:

    % prove FUNCTION...   these are proved, of the others the contract is used; without it all of
                          the sources are proved, and none of a header
    % unsigned            unsigned numbers must not wrap either
    % option OPTION...    one more for Frama-C
    % provers NAME...     these suffice for the code: a second one doubles the time
    % source PATH         a source of the firmware; what follows goes into a copy of it
    % ANCHOR              the text below goes where it says: see weave.py

If an anchor names nothing, or more than one thing, the source has changed and the proof has to
follow: the run fails.

proved.json says what has been proved: a digest of what Frama-C sees of each file and of all that it
includes and uses, and the number of its goals. What is as it was then is proved again with --all,
or if it is named; --record writes down what this run has proved. With --minutes, what has not been
begun by then is told and left out (status 77).
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from checks.c_source import Mismatch, essence, source
from weave import weave

ROOT = Path(__file__).resolve().parents[2]
PROOFS = ROOT / "tests/proofs"
BUILD = ROOT / "build/proofs"
RECORD = PROOFS / "proved.json"
PROVERS = ("cvc4", "z3")
# Z3 with its older arithmetic, for contracts with `% provers cvc4 z3-simplex`: where there are
# divisions, its newer one spends minutes on what Why3 says of them.
SIMPLEX_OPTIONS = "sat.random_seed=42 smt.random_seed=42 auto_config=false smt.arith.solver=2"
SIMPLEX = """
[prover]
name = "Z3"
alternative = "simplex"
version = "{version}"
command = "{path} -smt2 -T:%t {options} %f"
driver = "z3_471"
editor = ""
in_place = false
interactive = false
shortcut = "z3-simplex"
"""
SECONDS = 60  # for a goal and a prover; an idle machine needs 2
# A proof from what contradicts itself is none: WP tries to prove "false" after each requirement,
# call, loop and branch, which counts as one goal each and must fail within this time. That doubles
# the time of a proof; what is as it was proved has been tried.
SMOKE = ("-wp-smoke-tests", "-wp-smoke-timeout", "1")
VERSION = "25."  # of Frama-C: what it leaves to the provers differs from one to the next
COMMANDS = ("frama-c", "why3", "z3", "cvc4")
FOLDERS = (*sorted(path for path in (ROOT / "firmware").rglob("*") if path.is_dir()),
           ROOT / "hal/include", PROOFS)  # fmt: skip

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
CHECKED = re.compile(r"\bstatic_assert \(.*?\) ;")
DEFINED = re.compile(r"^#define (\w+)\b.*$\n?", re.MULTILINE)
LEMMA = re.compile(r"(?<!admit )\blemma (\w+)")
PROVED = re.compile(r"^\[wp\] Proved goals:\s+(\d+) / (\d+)$", re.MULTILINE)
# With one prover, what it said stands after the goal.
UNPROVED = re.compile(
    r"^\[wp\] \[(?:(?:Failed|Timeout|Unknown|Stepout)|[^]\n]*\] Goal \w+ : (?!Valid))[^\n]*$",
    re.MULTILINE,
)
DETECTED = re.compile(r'name = "Z3"\npath = "(.+)"\nversion = "(.+)"')
# Whatever makes WP assume more than it was told: each would hide a hole in a proof.
ASSUMED = re.compile(
    r"^.*(?:Missing RTE|No 'assigns'|Missing assigns|No code nor|Cast with incompatible|"
    r"Neither code nor|User Error|Hide sub-term|Assume|ignored).*$",
    re.MULTILINE,
)


@dataclass
class Contracts:
    """One file of contracts, put together with the sources that it names."""

    name: str
    proved: list[str] = field(default_factory=list)
    unsigned: bool = False
    options: list[str] = field(default_factory=list)
    provers: Sequence[str] = PROVERS
    text: str = ""


@dataclass(frozen=True)
class Result:
    """What WP said of one file."""

    name: str
    proved: int = 0
    goals: int = 0
    complaints: tuple[str, ...] = ()
    seconds: float = 0.0

    def __add__(self, other: Result) -> Result:
        return Result(
            self.name, self.proved + other.proved, self.goals + other.goals,
            self.complaints + other.complaints, self.seconds + other.seconds,
        )  # fmt: skip

    def is_good(self) -> bool:
        return self.goals > 0 and self.proved == self.goals and not self.complaints

    def __str__(self) -> str:
        return f"{self.name}: proved {self.proved} / {self.goals} ({self.seconds:.0f} s)"


def put_together(path: Path, root: Path = ROOT) -> Contracts:
    """Reads a file of contracts."""
    contracts = Contracts(path.stem)
    functions: list[str] = []
    pieces = re.split(r"^% *(\w+)(.*)\n", path.read_text(), flags=re.MULTILINE)
    done = [pieces[0]]
    firmware, texts = "", list[tuple[str, str]]()
    for word, argument, text in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        if _takes_setting(contracts, word, argument.split()):
            done.append(text)
        elif word == "source":
            done += [weave(source(firmware), texts), text]
            firmware, texts = (root / argument.strip()).read_text(), []
            functions += source(firmware).functions()
        else:
            texts.append((word + argument, text))
    contracts.text = "\n".join([*done, weave(source(firmware), texts), ""])
    contracts.proved = contracts.proved or functions
    headers = _headers(contracts.text, {}).values()
    there = [name for text in headers for name in source(text).functions()]
    if unknown := set(contracts.proved) - {*there, *functions}:
        raise Mismatch(f"there is no function {', '.join(sorted(unknown))}")
    return contracts


def _takes_setting(contracts: Contracts, word: str, values: list[str]) -> bool:
    """Whether a `%` line is about the whole file, and not an anchor."""
    if word == "prove":
        contracts.proved += values
    elif word == "unsigned":
        contracts.unsigned = True
    elif word == "option":
        contracts.options += values
    elif word == "provers":
        contracts.provers = values
    else:
        return False
    return True


def _headers(text: str, seen: dict[str, str]) -> dict[str, str]:
    """The project's headers that a text includes, and those that they include."""
    for name in INCLUDE.findall(text):
        found = [folder / name for folder in FOLDERS if (folder / name).is_file()]
        if name not in seen and found:
            seen[name] = found[0].read_text()
            _headers(seen[name], seen)
    return seen


def why3_configuration() -> Path:
    """Why3's list of the provers on this machine, in the build folder and not in the user's."""
    path = BUILD / "why3.conf"
    if not path.exists():
        subprocess.run(
            ["why3", "config", "detect", "-C", path],
            check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
    text = path.read_text()
    found = DETECTED.search(text)
    if found and "z3-simplex" not in text:
        entry = SIMPLEX.format(path=found[1], version=found[2], options=SIMPLEX_OPTIONS)
        path.write_text(text + entry)
    return path


def prove(
    contracts: Contracts, seconds: int = SECONDS, extra: Sequence[str] = (), smoke: bool = True
) -> Result:
    """Lets WP prove one file: the code, then its lemmas, which it leaves out with `-wp-fct`."""
    functions = f"-wp-fct={','.join(contracts.proved)}"
    provers = f"-wp-prover={','.join(contracts.provers)}"
    tried = SMOKE if smoke else ()
    code, said = _run(contracts, seconds, [functions, provers, "-wp-prop=-@lemma", *tried, *extra])
    assumed = tuple(each for each in ASSUMED.findall(said) if _matters(each, contracts))
    code = replace(code, complaints=code.complaints + assumed)
    return code if extra else code + prove_lemmas(contracts, seconds)


def prove_lemmas(contracts: Contracts, seconds: int = SECONDS) -> Result:
    """The lemmas of one file, without those of the headers, which are proved where they stand."""
    if not LEMMA.search(contracts.text):
        return Result(contracts.name)
    known = LEMMA.findall("".join(_headers(contracts.text, {}).values()))
    only = ",".join(["-wp-prop=@lemma", *(f"-{name}" for name in known)])
    lemmas = replace(contracts, name=f"{contracts.name}.lemmas")
    result, _ = _run(lemmas, seconds, [f"-wp-prover={','.join(PROVERS)}", only])
    return replace(result, name=contracts.name)


def read(path: Path) -> Contracts:
    """A file of contracts, or a header for its lemmas."""
    if path.suffix == ".h":
        return Contracts(path.name, text=path.read_text())
    return put_together(path)


def digest(contracts: Contracts) -> str:
    """Of all that a proof depends on, but the provers and this file: not of comments and layout,
    of macros that nothing uses, or of what is checked when it is compiled."""
    headers = sorted(_headers(contracts.text, {}).items())
    asked = (contracts.proved, contracts.unsigned, contracts.options, list(contracts.provers))
    texts = [contracts.text, *(text for _, text in headers)]
    text = _used("\n".join(essence(each) for each in texts))
    what = (VERSION, asked, text, [name for name, _ in headers])
    return hashlib.sha256(repr(what).encode()).hexdigest()


def _used(text: str) -> str:
    """Without static_assert, and without the macros whose names stand nowhere else."""
    text = CHECKED.sub("", text)
    words = Counter(re.findall(r"\w+", text))
    used = DEFINED.sub(lambda match: match[0] if words[match[1]] > 1 else "", text)
    return used if used == text else _used(used)


def recorded() -> dict[str, dict[str, str | int]]:
    """By file: the digest and the goals of what was proved."""
    if not RECORD.exists():
        return {}
    record: dict[str, dict[str, str | int]] = json.loads(RECORD.read_text())
    return record


def files(names: Sequence[str] = ()) -> list[Path]:
    """What there is to prove: headers that have lemmas, files of contracts; of these names."""
    headers = [path for path in sorted(PROOFS.glob("*.h")) if LEMMA.search(path.read_text())]
    contracts = sorted(PROOFS.glob("*.acsl"))
    return [path for path in [*headers, *contracts] if not names or path.stem in names]


def _run(contracts: Contracts, seconds: int, extra: Sequence[str]) -> tuple[Result, str]:
    BUILD.mkdir(parents=True, exist_ok=True)
    path = BUILD / f"{contracts.name}.c"
    path.write_text(contracts.text)
    includes = " ".join(f"-I{folder}" for folder in FOLDERS)
    unsigned = ["-warn-unsigned-overflow"] if contracts.unsigned else []
    command = [
        "frama-c", "-session", str(BUILD / "session"), "-no-autoload-plugins",
        "-load-module", "wp,rtegen", "-c11", "-machdep", "gcc_x86_32", "-wp", "-wp-rte",
        "-wp-timeout", str(seconds),
        "-wp-par", str(min(os.cpu_count() or 1, 2)), "-wp-cache", "update",
        f"-cpp-extra-args={includes}", *unsigned, *contracts.options, *extra, str(path),
    ]  # fmt: skip
    environment = {**os.environ, "WHY3CONFIG": str(why3_configuration())}
    started = time.monotonic()
    done = subprocess.run(
        command, cwd=BUILD, env=environment, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    (BUILD / f"{contracts.name}.log").write_text(done.stdout)
    counts = PROVED.search(done.stdout)
    complaints = UNPROVED.findall(done.stdout)
    if not counts:
        complaints += done.stdout.splitlines()[-8:]
    proved, goals = map(int, counts.groups()) if counts else (0, 0)
    spent = time.monotonic() - started
    return Result(contracts.name, proved, goals, tuple(complaints), spent), done.stdout


def _matters(complaint: str, contracts: Contracts) -> bool:
    """Whether a complaint is about the code that is proved, not about what only headers call."""
    unknown = re.search(r"Neither code nor specification for function (\w+)", complaint)
    return not unknown or unknown[1] in contracts.text


def missing() -> list[str]:
    """What is not installed of what the proofs need."""
    absent = [command for command in COMMANDS if not shutil.which(command)]
    if "frama-c" not in absent:
        done = subprocess.run(["frama-c", "-version"], capture_output=True, text=True)
        if not done.stdout.startswith(VERSION):
            absent.append(f"frama-c {VERSION} (this is {done.stdout.strip()})")
    return absent


def main() -> int:
    parser = argparse.ArgumentParser(prog="prove.py", description="Proves the contracts.")
    parser.add_argument("names", nargs="*", help="files, without .acsl or .h; all if none")
    parser.add_argument(
        "--all", action="store_true", help="also what is as it was proved, that without smoke tests"
    )
    parser.add_argument("--record", action="store_true", help="write down what is proved")
    parser.add_argument("--seconds", type=int, default=SECONDS, help="for each goal and prover")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="begin none after that")
    parser.add_argument("--wp", action="append", default=[], help="one more option for Frama-C")
    options = parser.parse_args()
    if absent := missing():
        print(f"not installed: {', '.join(absent)}")
        return 77
    if unknown := set(options.names) - {path.stem for path in files()}:
        parser.error(f"nothing to prove in {', '.join(sorted(unknown))}")
    good, left_out = True, False
    end = time.monotonic() + 60 * options.minutes
    before, proved = recorded(), {}
    for path in files(options.names):
        try:
            contracts = read(path)
        except Mismatch as error:
            print(f"{path.name}: {error}")
            good = False
            continue
        known = before.get(path.name, {})
        is_known = known.get("digest") == digest(contracts)
        if is_known and not options.all and not options.names:
            print(f"{path.name}: as it was proved ({known['goals']} goals)", flush=True)
            proved[path.name] = known
            continue
        if time.monotonic() > end:
            print(f"skipped: {path.name} has changed since it was proved")
            left_out = True
            continue
        is_header = path.suffix == ".h"
        result = (
            prove_lemmas(contracts, options.seconds) if is_header
            else prove(contracts, options.seconds, options.wp, bool(options.names) or not is_known)
        )  # fmt: skip
        print(result, flush=True)
        for complaint in result.complaints:
            print(f"    {complaint}")
        if result.is_good() and not options.wp:
            now: dict[str, str | int] = {"digest": digest(contracts), "goals": result.goals}
            proved[path.name] = known if is_known else now
        good = good and result.is_good()
    if options.record:
        there = {path.name for path in files()}
        kept = {name: entry for name, entry in {**before, **proved}.items() if name in there}
        RECORD.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n")
    return (77 if left_out else 0) if good else 1


if __name__ == "__main__":
    sys.exit(main())
