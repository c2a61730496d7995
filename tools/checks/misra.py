"""MISRA C:2012 on the firmware, as a ratchet: what deviates is counted, and may only become less.

    PYTHONPATH=tools build/venv/bin/python -m checks.misra            compare with the baseline
    PYTHONPATH=tools build/venv/bin/python -m checks.misra --update   write the counts as they are
    PYTHONPATH=tools build/venv/bin/python -m checks.misra 15.5       show the places of a rule

The baseline is misra_baseline.json; an update keeps its reasons, and new rules get none.

cppcheck and its addon find the deviations. The baseline has for each rule how many there are and
why. The check fails when a rule has more of them than there, or has no reason. What cppcheck finds
without the addon has no baseline: it is mended, or is in `left`, each with the reason.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from typing import Any

from checks.static import ARM_FOLDERS, ROOT, includes, tool

BASELINE = ROOT / "tools" / "checks" / "misra_baseline.json"
SCOPE = ("firmware", "hal/stm32", "-ihal/stm32/bench", "-ihal/stm32/bringup")
RULE_NUMBER = re.compile(r"\d+\.\d+")
RULE = re.compile(r"misra-c2012-(\d+\.\d+)")
ARGUMENTS = [
    "--enable=warning,style,performance,portability", "--addon=misra", "--std=c11",
    "--platform=unix32", "-D__GNUC__", "--quiet", "-j2", "--template={file}:{line}:{id}:{message}",
    "--suppress=missingIncludeSystem",
]  # fmt: skip


@dataclass(frozen=True)
class Found:
    """A place and what is there; `rule` is a MISRA rule, or what cppcheck calls it."""

    file: str
    line: int
    rule: str
    text: str

    @property
    def is_misra(self) -> bool:
        return self.rule[0].isdigit()

    def __str__(self) -> str:
        what = f"MISRA C:2012 rule {self.rule}" if self.is_misra else f"{self.text} [{self.rule}]"
        return f"{self.file}:{self.line}: {what}"


def parse(text: str) -> list[Found]:
    """What cppcheck has said, each finding once."""
    found = set()
    for row in text.splitlines():
        parts = row.split(":", 3)
        if len(parts) == 4 and parts[1].isdigit():
            match = RULE.fullmatch(parts[2])
            rule = match[1] if match else parts[2]
            found.add(Found(parts[0], int(parts[1]), rule, parts[3] if not match else ""))
    return sorted(found, key=lambda each: (each.file, each.line, each.rule))


def run_cppcheck() -> list[Found]:
    done = subprocess.run(
        [tool("cppcheck"), *ARGUMENTS, *includes(ARM_FOLDERS), *SCOPE],
        cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True,
    )  # fmt: skip
    if done.returncode:
        raise SystemExit(f"cppcheck failed: {done.stdout.strip()[-400:]}")
    return parse(done.stderr)


def key(rule: str) -> tuple[int, ...]:
    return tuple(map(int, rule.split(".")))


def judge(found: list[Found], baseline: dict[str, Any]) -> tuple[list[str], list[str]]:
    """What is wrong, and what may be tightened."""
    wrong, better = [], []
    left = {(each["file"], each["id"]) for each in baseline["left"]}
    others = [each for each in found if not each.is_misra]
    wrong += [str(each) for each in others if (each.file, each.rule) not in left]
    counts = Counter(each.rule for each in found if each.is_misra)
    rules = baseline["rules"]
    for rule in sorted({*counts, *rules}, key=key):
        entry = rules.get(rule, {"count": 0, "reason": ""})
        if counts[rule] > entry["count"]:
            wrong.append(
                f"rule {rule}: {counts[rule]} deviations, {entry['count']} are in the baseline; "
                f"mend the new one (checks.misra {rule} shows all places), or run checks.misra "
                "--update and give the reason"
            )
        elif counts[rule] < entry["count"]:
            better.append(
                f"rule {rule}: {counts[rule]} deviations, fewer than the {entry['count']} of the "
                "baseline; run checks.misra --update to keep it so"
            )
        if counts[rule] and not entry["reason"]:
            wrong.append(f"rule {rule}: has no reason in {BASELINE.name}")
    return wrong, better


def updated(found: list[Found], baseline: dict[str, Any]) -> dict[str, Any]:
    counts = Counter(each.rule for each in found if each.is_misra)
    rules = {
        rule: {"count": counts[rule], "reason": baseline["rules"].get(rule, {}).get("reason", "")}
        for rule in sorted(counts, key=key)
    }
    return {"rules": rules, "left": baseline["left"]}


def main(arguments: list[str]) -> int:
    found = run_cppcheck()
    if arguments and RULE_NUMBER.fullmatch(arguments[0]):
        print("\n".join(str(each) for each in found if each.rule == arguments[0]))
        return 0
    baseline = json.loads(BASELINE.read_text(encoding="utf-8"))
    if arguments == ["--update"]:
        BASELINE.write_text(json.dumps(updated(found, baseline), indent=1) + "\n", encoding="utf-8")
        return 0
    wrong, better = judge(found, baseline)
    print("\n".join([*better, *wrong]) or f"{len(found)} deviations, as recorded")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
