"""The check of the Cortex-M4 objects finds each planted violation, and passes what is allowed."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from checks import arm_check

CORE = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=soft"]
FLAGS = ["-std=c11", *CORE, "-O2", "-fcallgraph-info=su"]


def compile_c(folder: Path, source: str, name: str = "planted") -> Path:
    path = folder / f"{name}.c"
    path.write_text("#include <stdint.h>\n#include <stdlib.h>\n" + source + "\n")
    subprocess.run(["arm-none-eabi-gcc", *FLAGS, "-c", path, "-o", f"{path}.obj"], check=True)
    return folder / f"{name}.c.obj"


@pytest.mark.parametrize(
    ("source", "complaint"),
    [
        ("float f(float x) { return x * 3; }", "floating point: calls __aeabi_fmul"),
        ("double f(int x) { return x; }", "floating point: calls __aeabi_i2d"),
        ("int f(double x, double y) { return x < y; }", "floating point: calls __aeabi_dcmplt"),
        ("double sqrt(double); double f(double x) { return sqrt(x); }", "calls sqrt"),
        (
            'void f(void) { __asm__(".fpu fpv4-sp-d16\\n vadd.f32 s0, s1, s2"); }',
            "floating point: vadd.f32 in f",
        ),
        ("void *f(void) { return malloc(4); }", "heap: calls malloc"),
        ("void f(void *p) { free(p); }", "heap: calls free"),
        ("int counter = 1;", "mutable file-level state: counter"),
        ("int counter;", "mutable file-level state: counter"),
        ("int f(void) { static int calls; return ++calls; }", "mutable file-level state: calls"),
        ("uint64_t f(uint64_t a, uint64_t b) { return a / b; }", "f -> __aeabi_uldivmod"),
        ("int64_t f(int64_t a, int64_t b) { return a % b; }", "f -> __aeabi_ldivmod"),
        ("int f(int n) { return n > 2 ? f(f(n - 1)) + f(n / 2) : n; }", "recursion: f -> f"),
        (
            "int g(int);\n"
            "__attribute__((noinline)) int f(int n) { return g(n) + 1; }\n"
            "__attribute__((noinline)) int g(int n) { return n > 0 ? f(n / 2) + 1 : 0; }",
            "recursion: g -> f -> g",
        ),
    ],
)
def test_a_planted_violation_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], source: str, complaint: str
) -> None:
    planted = compile_c(tmp_path, source)

    status = arm_check.main(["--stage", "engine/step", str(planted)])

    assert status == 1
    assert complaint in capsys.readouterr().err


def test_a_division_in_another_stage_counts_if_the_step_stage_calls_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    base = compile_c(tmp_path, "uint64_t d(uint64_t a, uint64_t b) { return a / b; }", "base")
    step = compile_c(tmp_path, "uint64_t d(uint64_t, uint64_t); int f(void) { return !d(9, 2); }")

    alone = arm_check.main(["--stage", "base", str(base)])
    called = arm_check.main(["--stage", "base", str(base), "--stage", "engine/step", str(step)])

    assert (alone, called) == (0, 1)
    assert "step: 64-bit division: f -> d -> __aeabi_uldivmod" in capsys.readouterr().err


def test_a_cycle_is_reported_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    planted = compile_c(
        tmp_path, "void g(int); int h(int); int f(int n) { if (n) g(n); return h(n); }\n"
        "void g(int n) { h(f(n)); }"
    )  # fmt: skip

    arm_check.main(["--stage", "base", str(planted)])

    assert capsys.readouterr().err.count("recursion") == 1


def test_a_clean_object_passes_and_its_sizes_are_reported(tmp_path: Path) -> None:
    clean = compile_c(
        tmp_path,
        "extern void use(volatile char *);\n"
        "static const int table[4] = {3, 1, 4, 1};\n"
        "int f(int n) { volatile char room[400]; use(room); return table[n & 3] / n; }",
    )
    report = tmp_path / "report.txt"

    status = arm_check.main(["--report", str(report), "--stage", "io", str(clean)])

    assert status == 0
    name, text, rodata, ram, stack, function = report.read_text().splitlines()[1].split()
    assert (name, rodata, ram, function) == ("io", "16", "0", "f")
    assert int(text) > 0
    assert int(stack) >= 400
