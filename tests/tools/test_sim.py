"""`sim` runs programs, writes what it was asked for, and says what happened."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "tools" / "examples"
LOOP = EXAMPLES / "4-loop.rks"


def test_the_summary_is_a_table_with_the_times_and_the_reason_of_the_end(tool):
    result = tool("sim", LOOP)

    head, row, blank, times, end = result.out.splitlines()
    assert (result.status, result.err) == (0, "")
    assert re.split(r"  +", head) == [
        "motor", "program", "moves", "pulses", "position", "peak steps/s", "moving s",
        "at the end",
    ]  # fmt: skip
    assert re.split(r"  +", row.strip()) == [
        "1", str(LOOP), "8", "5 000", "0", "600.0", "10.000", "done",
    ]  # fmt: skip
    assert blank == ""
    assert re.fullmatch(
        r"unit time 13\.60000\d s, real time \S+ s: [\d ]+ times faster than real time", times
    )
    assert end == "ended because every program has come to rest"


def test_the_columns_of_the_table_are_in_line(tool):
    programs = [f"--motor={motor}={EXAMPLES / name}" for motor, name in
                [(2, "4-loop.rks"), (4, "9-compound.rks")]]  # fmt: skip
    head, *rows = tool("sim", *programs).out.splitlines()[:3]

    end_of_pulses = head.index("pulses") + len("pulses")
    assert [row[:end_of_pulses].split()[-1] for row in rows] == ["000", "000"]
    assert all(row[head.index("at the end") :] == "done" for row in rows)


def test_json_is_one_object_with_the_same_facts(tool):
    result = tool("sim", LOOP, "--json")

    assert (result.status, result.err) == (0, "")
    assert result.json["ended"] == "idle"
    assert result.json["ratio"] > 0
    (motor,) = result.json["motors"]
    assert (motor["motor"], motor["program"], motor["moves"]) == (1, str(LOOP), 8)
    assert (motor["pulses"], motor["position"], motor["state"]) == (5000, 0, "idle")


def test_each_motor_can_have_a_program_of_its_own(tool, write):
    one, other = write("F10 R", "1.rks"), write("B20 R", "2.rks")

    result = tool("sim", one, "--motor", f"3={other}", "--json")

    told = [(m["motor"], m["position"]) for m in result.json["motors"]]
    assert told == [(1, 10), (3, -20)]


def test_a_simulation_ends_after_60_seconds_if_its_programs_do_not(tool, write):
    result = tool("sim", write("O01"))

    assert result.out.splitlines()[1].endswith("at O01, line 1")
    assert "unit time 60.000000 s" in result.out
    assert result.out.endswith("ended at the limit of 60 s; --for SECONDS sets another one\n")


def test_the_limit_of_time_can_be_set(tool, write):
    result = tool("sim", write("@1 F1 R J1"), "--for", "2.5", "--json")

    assert (result.status, result.json["ended"], result.json["seconds"]) == (0, "time", 2.5)


def test_an_error_of_the_program_is_shown_where_it_stands(tool, write):
    path = write("F10 R\n  L2 J5 E")

    result = tool("sim", path)

    assert result.status == 1
    assert result.err.splitlines()[-3:] == [
        f"{path}:2:6: error: motor 1: label not found",
        "  L2 J5 E",
        "     ^",
    ]
    assert result.out.splitlines()[1].split()[-6:] == ["1", "10", "10", "167.2", "0.073", "error"]


def test_the_place_of_an_error_counts_from_the_last_reset_without_what_is_ignored(tool, write):
    result = tool("sim", write("W1 \\ K F1 C75 R ."), "--json")

    assert result.status == 1
    (motor,) = result.json["motors"]
    assert (motor["error"], motor["line"], motor["column"]) == (". without a call", 1, 17)


def test_a_program_with_errors_does_not_run(tool, write, tmp_path):
    result = tool("sim", write("F10 R Q"), "--steps", tmp_path / "steps.csv")

    assert (result.status, result.out) == (1, "")
    assert result.err.startswith(f'{tmp_path}/a.rks:1:7: error: unknown command "Q"\n')
    assert not (tmp_path / "steps.csv").exists()


def test_warnings_go_to_standard_error_and_the_program_runs(tool, write):
    result = tool("sim", write("S500 V400 F1 R"))

    assert result.status == 0
    assert ":1:6: warning: V400 is below S500" in result.err


def test_a_program_may_use_the_manuals_call_characters(tool, write):
    result = tool(
        "sim", write("{ podprogram č. 3 } F10 \N{ACUTE ACCENT}3 W1 @1 O01 J1 @3 R ."), "--json"
    )

    assert (result.status, result.json["motors"][0]["position"]) == (0, 10)


def test_outputs_that_are_on_at_the_end_are_named(tool, write):
    result = tool("sim", write("T02 T05 F1 R"))

    assert result.out.endswith("\noutputs that are on: 2, 5\n")


def test_a_full_program_memory_is_told(tool, write):
    result = tool("sim", write("F1 " + "R " * 700))

    assert "motor 1: program memory was full" in result.out


def test_an_empty_program_is_at_rest_at_once(tool, write):
    result = tool("sim", write(""))

    assert result.status == 0
    assert "unit time 0.000000 s, real time" in result.out
    assert "times faster" not in result.out


def test_the_steps_file_has_a_line_for_each_pulse(tool, write, tmp_path):
    out = tmp_path / "steps.csv"

    assert tool("sim", write("F3 R"), "--steps", out).status == 0

    rate, head, *lines = out.read_text().splitlines()
    assert (rate, head) == ("# tick_hz=84000000", "tick,motor,position")
    assert [line.split(",")[1:] for line in lines] == [["1", "1"], ["1", "2"], ["1", "3"]]


def test_the_trace_tells_what_the_program_does(tool, write, tmp_path):
    out = tmp_path / "trace.csv"

    assert tool("sim", write("T03 F3 R W5 C03"), "--trace", out).status == 0

    head, *lines = out.read_text().splitlines()
    assert head == "tick,motor,event,value"
    assert [line.split(",", 2)[2] for line in lines] == [
        "start,0", "out,3", "move,3", "done,3", "wait,5", "out,-3", "end,0",
    ]  # fmt: skip


def test_two_runs_write_the_same_bytes(tool, tmp_path):
    names = ["steps.csv", "trace.csv", "waves.vcd", "plot.svg"]
    contents = []
    for _ in range(2):
        outputs = [tmp_path / name for name in names]
        flags = ["--steps", "--trace", "--vcd", "--plot"]
        pairs = zip(flags, outputs, strict=True)
        assert tool("sim", LOOP, *[each for pair in pairs for each in pair]).status == 0
        contents.append([path.read_bytes() for path in outputs])

    assert contents[0] == contents[1]


def test_the_waveforms_are_a_well_formed_file(tool, tmp_path):
    out = tmp_path / "waves.vcd"
    inputs = EXAMPLES / "6-guards.csv"

    assert tool("sim", EXAMPLES / "6-guards.rks", "--inputs", inputs, "--vcd", out).status == 0

    head, _, body = out.read_text().partition("$enddefinitions $end")
    declared = re.findall(r"\$var (\w+) \d+ (\S+) (\w+) \$end", head)
    kinds = {name: kind for kind, _, name in declared}
    names = {code: name for _, code, name in declared}
    assert len(names) == len(declared)
    assert "$timescale 1 ns $end" in " ".join(head.split())
    assert kinds == wires() | {f"m{m}_{what}": "real" for m in range(1, 5) for what in REALS}
    times = [int(t) for t in re.findall(r"^#(\d+)$", body, re.MULTILINE)]
    assert times == sorted(set(times))
    changes = re.findall(r"^(?:([01])|r(\S+) )(\S+)$", body, re.MULTILINE)
    keywords = re.findall(r"^\$\w+$", body, re.MULTILINE)
    assert keywords == ["$dumpvars", "$end"]
    assert len(changes) + len(times) + len(keywords) == len(body.strip().splitlines())
    assert {code for _, _, code in changes} <= set(names)
    rises = sum(1 for level, _, code in changes if level == "1" and names[code] == "m1_step")
    assert rises == int(tool("sim", EXAMPLES / "6-guards.rks", "--inputs", inputs,
                             "--json").json["motors"][0]["pulses"])  # fmt: skip


REALS = ("position", "speed")


def wires() -> dict[str, str]:
    """All one-bit signals of the waveforms."""
    names = [f"m{m}_{what}" for m in range(1, 5) for what in ("step", "dir", "led")]
    names += [f"b{way}{n}" for way in "io" for n in range(1, 9)]
    return dict.fromkeys(names, "wire")


BAD_INPUTS = [
    "5,1",
    "x,1,1",
    "5,9,1",
    "5,1,2",
    "-5,1,1",
    "5,1,1,1",
    "1" * 30 + ",1,1",
    "5,,1",
    "\1",
]


@pytest.mark.parametrize("line", BAD_INPUTS)
def test_a_malformed_inputs_file_is_refused_with_its_line(tool, write, line):
    inputs = write(f"# levels\n0,1,1\n{line}\n", "in.csv")

    result = tool("sim", LOOP, "--inputs", inputs)

    assert result.status == 2
    assert result.complaint.startswith(f"rkm04: {inputs}:3: ")


def test_inputs_may_have_comments_blank_lines_and_any_order(tool, write):
    inputs = write("# comment\n\n 20.5 , 1 , 0 # end\n10,1,1\r\n", "in.csv")

    result = tool("sim", write("O01 Z01"), "--inputs", inputs, "--json")

    assert result.json["ended"] == "idle"
    assert result.json["seconds"] == pytest.approx(0.0205, abs=0.001)


def expect_wrong_usage(result, words: str) -> None:
    assert result.status == 2
    assert result.complaint.startswith("rkm04: ")
    assert words in result.complaint


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "no program to run"),
        (["--motor", "5=a.rks"], "--motor 5=a.rks: write --motor N=FILE with N from 1 to 4"),
        (["--motor", "a.rks"], "write --motor N=FILE"),
        (["--motor", "1="], "write --motor N=FILE"),
        (["a.rks", "--motor", "1=b.rks"], "motor 1 has two programs"),
        (["--motor", "2=a.rks", "--motor", "2=b.rks"], "motor 2 has two programs"),
        (["no.rks"], "no.rks: no such file"),
        (["/"], "/: is a directory"),
        (["--unknown"], "--unknown"),
        (["a.rks", "b.rks"], "b.rks"),
        (["a.rks", "--for"], "--for"),
    ],
)
def test_wrong_usage_is_one_line_that_says_what_to_do(tool, arguments, words):
    expect_wrong_usage(tool("sim", *arguments), words)


@pytest.mark.parametrize("seconds", ["0", "x", "1e3", "0.0", "9" * 30, "inf", "100000001"])
def test_the_limit_of_time_must_be_a_number_above_0(tool, seconds):
    expect_wrong_usage(tool("sim", LOOP, "--for", seconds), "write seconds")


@pytest.mark.parametrize("flag", ["--steps", "--trace", "--vcd", "--plot"])
def test_an_output_in_no_folder_is_refused(tool, tmp_path, flag):
    path = tmp_path / "no" / "out.svg"

    expect_wrong_usage(tool("sim", LOOP, flag, path), f"{path}: there is no folder")


@pytest.mark.parametrize("flag", ["--steps", "--trace", "--vcd"])
def test_a_directory_is_no_output(tool, tmp_path, flag):
    expect_wrong_usage(tool("sim", LOOP, flag, tmp_path), "is a directory")


@pytest.mark.parametrize("flag", ["--steps", "--trace", "--vcd"])
def test_a_full_disk_is_told(tool, flag):
    expect_wrong_usage(tool("sim", LOOP, flag, "/dev/full"), "/dev/full: cannot be written")


def test_a_plot_that_cannot_be_written_is_told(tool, tmp_path):
    path = tmp_path / "full.svg"
    path.symlink_to("/dev/full")

    expect_wrong_usage(tool("sim", LOOP, "--plot", path), f"{path}: cannot be written")


def test_an_output_must_not_be_the_program(tool, write):
    path = write("F1 R")

    expect_wrong_usage(tool("sim", path, "--steps", path), "is read by this very command")
    assert path.read_text() == "F1 R"


def test_two_outputs_must_differ(tool, tmp_path):
    out = tmp_path / "out"

    expect_wrong_usage(tool("sim", LOOP, "--steps", out, "--vcd", out), "named for two outputs")


def test_a_missing_inputs_file_is_told(tool, tmp_path):
    expect_wrong_usage(tool("sim", LOOP, "--inputs", tmp_path / "no.csv"), "no.csv: no such file")


def test_a_plot_of_an_unknown_kind_is_refused_before_anything_runs(tool, tmp_path):
    steps = tmp_path / "steps.csv"

    result = tool("sim", LOOP, "--steps", steps, "--plot", tmp_path / "plot.pdf")

    expect_wrong_usage(result, "a plot is .svg or .png")
    assert not steps.exists()


def test_on_a_terminal_a_long_simulation_tells_per_cent(tool, write, monkeypatch):
    monkeypatch.setattr("rkm04_tools.host.PROGRESS_AFTER_SECONDS", 0.02)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)

    result = tool("sim", write("S2000 V16000 A60000 G+"), "--for", "600")

    told = [
        int(each) for each in re.findall(r"simulating \.\.\. 0 s, (\d+) % of 600 s", result.err)
    ]
    assert result.status == 0
    assert len(told) > 2
    assert told == sorted(told)
    assert 0 <= told[0] < told[-1] <= 100
    assert result.err.endswith("\r\x1b[K")
