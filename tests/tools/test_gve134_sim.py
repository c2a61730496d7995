"""`gve134 sim` plays the host of a unit in virtual time, and tells what was answered and made."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from gve_sim import Play, player
from hypothesis import given, settings
from hypothesis import strategies as st
from rkm04_tools.cli import run_tool
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.cli import make_parser

ROOT = Path(__file__).resolve().parents[2]
TICKS_PER_MS = 84_000
BITS_PER_BYTE = 10

# Section 12 of the sheet, with L0,0,0,0 where the host has to wait for the axes.
SHEET = """\
V2000
L20000,0,0
@1500 H
L0,0,0,0     ; waits until H has been answered, and longer
"""
SQUARE = "V10000\nA100\nL2000,0\nC0,2000\nC-2000,0\nC0,-2000\n"


@pytest.fixture
def play(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Play:
    """Play a text to the simulated unit."""

    def read() -> tuple[str, str]:
        told = capsys.readouterr()
        return told.out, told.err

    return player(tmp_path, read)


# ---- what is told -------------------------------------------------------------------------------


def test_an_axis_without_a_pulse_has_not_moved_where_the_time_ends_first(play: Play) -> None:
    x, y, *_ = play("L2147483647\n", "--for", "1", "--json").json["axes"]

    assert x["seconds_moving"] > 0.9
    assert y["seconds_moving"] == 0


@pytest.mark.parametrize(
    ("text", "refusal"),
    [
        ("V10\nL100\nK\n", "K was answered by 7: not while a vector runs"),
        ("H\nEW10,01\nWX9,10,1,10\n", "was answered by F: not after a stop or a fault: D comes"),
    ],
)
def test_a_refusal_by_state_tells_which_state_it_was(play: Play, text: str, refusal: str) -> None:
    assert refusal in play(text).err + play(text).out


def test_the_summary_is_a_table_of_the_axes_with_the_times(play: Play) -> None:
    played = play("V1000\nL100,-50\n")

    head, x, y, z, a, blank, counts, times, end = played.lines
    assert (played.status, played.err, blank) == (0, "", "")
    assert re.split(r"  +", head) == ["axis", "pulses", "position", "peak steps/s", "moving s"]
    assert x.split() == ["X", "100", "100", "1000.0", "0.150"]
    assert y.split() == ["Y", "50", "-50", "500.0", "0.150"]
    assert (z.split(), a.split()) == (
        ["Z", "0", "0", "0.0", "0.000"],
        ["A", "0", "0", "0.0", "0.000"],
    )
    assert counts == "2 commands, 1 vectors"
    assert re.fullmatch(r"unit time 0\.15\d+ s, real time \S+ s: [\d ]+ times .*", times)
    assert end == "ended because every line has been answered and the axes stand"


def test_the_answer_for_scripts_has_the_same_facts(play: Play) -> None:
    played = play("V1000\nL100,-50\n?\n", "--json")

    told = played.json
    assert (played.status, played.err) == (0, "")
    assert (told["ended"], told["refused"], told["late_steps"]) == ("idle", 0, 0)
    assert (told["commands"], told["vectors"], told["stuck"]) == (3, 1, None)
    assert told["file"].endswith("a.gve")
    assert played.axis("Y") == {
        "axis": "Y", "motor": 2, "pulses": 50, "position": -50, "peak_speed": 500.0,
        "seconds_moving": pytest.approx(0.15, abs=1e-6),
    }  # fmt: skip
    (answer,) = told["answers"]
    assert (answer["line"], answer["command"], answer["refused"]) == (3, "?", False)
    assert answer["answer"].startswith("0,IP134/200")


def test_answers_with_values_are_shown_with_their_lines(play: Play) -> None:
    played = play("L100,-50\nL0,0,0,0\nPF\n!7V300\n!7ER05\n")
    assert played.lines[:3] == ["a.gve:3: PF: 0,100,-50,0", "a.gve:5: ER05: 0,FF", ""]
    assert played.lines[-2:] == ["outputs that are on: 1, 5", "spindle at 30 %"]


def test_a_refusal_is_shown_with_its_line_and_its_meaning(play: Play) -> None:
    played = play("V1000\n  G ; at rest\nL10\n")

    meaning = "there is nothing to go on with"
    assert (played.status, played.err) == (1, f"a.gve:2: error: G was answered by 6: {meaning}\n")
    assert played.lines[1].split()[:2] == ["X", "10"]


def test_a_switch_that_is_not_found_is_told(play: Play) -> None:
    played = play("WX-100,1000,10,100\n")
    assert played.status == 1
    assert played.err == (
        "a.gve:1: error: WX-100,1000,10,100 was answered by D: "
        "the reference switch was not found, or not let go\n"
    )


@pytest.mark.parametrize(("levels", "goes_to"), [("0,1,0\n400,1,1\n", 40), ("0,1,0\n", 100)])
def test_a_reference_run_that_begins_at_its_switch_goes_off_it(
    play: Play, tmp_path: Path, levels: str, goes_to: int
) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text(levels)

    played = play("A2000\nWX-1000,1000,100,100\nP\n", "--inputs", inputs)

    found = goes_to < 100
    assert played.status == (0 if found else 1)
    assert ("not found, or not let go" in played.err) is not found
    code, x, y = played.lines[0].rpartition(" ")[2].split(",")
    assert (code, y) == ("0" if found else "8", "0")
    assert int(x) == pytest.approx(goes_to, abs=1)


def test_standard_input_is_a_file_too(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-P", "-m", "rkm04_tools.gve134", "sim", "-", "--json"],
        input="L7\n", capture_output=True, text=True, cwd=tmp_path,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["axes"][0]["position"] == 7


# ---- the host that is played --------------------------------------------------------------------


def test_vectors_that_find_no_room_are_sent_again(play: Play) -> None:
    played = play(["V20000", "A500", *(["C40,3", "C40,-3"] * 150), "L0,0,0,0", "P"], "--json")

    told = played.json
    assert (told["vectors"], told["refused"], told["ended"]) == (301, 0, "idle")
    assert told["repeats"] > 100
    assert played.positions() == [12_000, 0, 0, 0]
    assert played.answers == [(304, "0,12000,0")]


def test_each_line_waits_for_the_answer_to_the_one_before(play: Play) -> None:
    played = play("V1000\nL500\nH\nP\n@2000 G\n", "--json")

    answer = played.json["answers"][0]
    assert played.answers[0] == (4, "8,0,0")
    assert answer["ms"] < 1
    assert played.positions()[0] == 500


def test_a_packet_is_taken_as_a_whole_and_sent_again_as_a_whole(play: Play) -> None:
    vectors = [f"C{40 + i % 3},1" for i in range(100)]
    packet = ["*S", *vectors, "*E100"]
    played = play(["V20000", "A500", *packet, *packet, *packet, "L0,0,0,0", "P4"], "--json")

    told = played.json
    assert (told["vectors"], told["refused"]) == (301, 0)
    assert told["commands"] == 2 + 3 * 102 + 2
    assert told["repeats"] > 0
    assert played.positions()[:2] == [3 * sum(40 + i % 3 for i in range(100)), 300]


def test_the_packet_of_the_sheet_is_a_quarter_of_a_circle(play: Play) -> None:
    played = play((ROOT / "tools/examples/gve/packet.gve").read_text(), "--json")
    assert played.positions()[:2] == [6128, 2858]
    assert played.json["refused"] == 0


def test_the_sheets_example_of_a_stop_is_played(play: Play) -> None:
    played = play((ROOT / "tools/examples/gve/stop.gve").read_text(), "--json")
    assert (played.json["refused"], played.json["ended"]) == (0, "idle")
    assert played.positions() == [0, 0, 0, 0]


def test_a_line_with_a_time_goes_beside_the_others(play: Play, tmp_path: Path) -> None:
    trace = tmp_path / "trace.csv"

    played = play(SHEET + "@3000 G\n", "--trace", trace, "--json")

    (stop,) = (row.split(",") for row in trace.read_text().splitlines() if ",stop," in row)
    assert stop[1:] == ["0", "stop", "halt"]
    assert 1500 * TICKS_PER_MS <= int(stop[0]) <= 1501 * TICKS_PER_MS
    assert (played.status, played.axis("X")["position"]) == (0, 20_000)


def test_lines_with_a_time_keep_their_order(play: Play) -> None:
    played = play("@20 EW10,03\n@10 EW10,02\n@10 ER10\n@30 ER10\n@15 ER10\n", "--json")
    assert played.answers == [(3, "0,02"), (5, "0,02"), (4, "0,03")]


def test_a_line_with_a_time_that_finds_no_room_is_sent_again(play: Play) -> None:
    played = play("V1000\nL1000\n@100 L0,500\n", "--json")
    assert played.positions()[:2] == [1000, 500]
    assert played.json["repeats"] > 100


def test_what_waits_when_j_comes_has_no_answer(play: Play) -> None:
    played = play("V1000\nL5000\nL0,0,0\nWX-100000,1000,10,100\n@6000 J\nP\nV2000\nL10\n", "--json")

    told = played.json
    assert (told["unanswered"], told["refused"], told["ended"]) == (1, 0, "idle")
    assert played.answers == [(6, "0,0,0")]
    assert told["answers"][0]["ms"] == pytest.approx(6100, abs=1)
    assert played.positions()[0] == 10


def test_an_answer_before_that_of_j_is_not_taken_for_it(play: Play) -> None:
    played = play("V1000\nL100\n@500 PF\n@500 EW10,07\n@500 J\n@500 ER10\n", "--json")

    assert played.answers == [(3, "0,100,0,0"), (6, "0,07")]
    assert (played.json["unanswered"], played.json["refused"]) == (0, 0)


def test_the_host_of_checksums_reckons_them(play: Play) -> None:
    played = play("%+\nPF\n!7V300\n*S\nC10\nC20\n*E2\nSR7\n@900 J\n@1100 PF\n", "--json")

    assert (played.status, played.json["refused"]) == (0, 0)
    assert played.answers == [(2, "0,0,0,0"), (8, "0,00"), (10, "0,0,0,0")]
    assert played.axis("X")["pulses"] == 30


def test_checksums_can_be_switched_off_again(play: Play) -> None:
    played = play("%+\nP\n%-\nP\nL5,0\n", "--json")
    assert (played.answers, played.positions()[0]) == ([(2, "0,0,0"), (4, "0,0,0")], 5)


def test_the_last_answer_again_is_not_for_the_host_to_obey(play: Play) -> None:
    played = play("V100\nL100\n@10 L50\n@10.2 >\n", "--json")
    assert [each["command"] for each in played.json["answers"]] == [">"]


def test_bytes_take_their_time_where_a_rate_is_given(play: Play) -> None:
    lines = "\n".join(["EW10,01"] * 50) + "\nER10\n"

    without, slow, fast = (
        play(lines, "--json", *rate).json["answers"][0]["ms"]
        for rate in ([], ["--baud", "38400"], ["--baud", "921600"])
    )

    sent = len("!0EW10,01\r0\r") * 50 + len("!0ER10\r0,01\r")
    assert slow == pytest.approx(sent * BITS_PER_BYTE / 38.4, rel=0.02)
    assert fast == pytest.approx(sent * BITS_PER_BYTE / 921.6, rel=0.02)
    assert without < fast


COMMANDS = st.sampled_from(
    ["P4", "SR6", "H", "G", "D", "K", "R", "XU", "XM50", "V900", "A10", "%+", "%-", "@", ">", "J",
     "N", "SW0,01", "L0,0,0", "L7,-9", "C30,40", "WX50,500,10,100", "EW20,01", "!7V5",
     "*S\nC9\nB10\n*E2"]
)  # fmt: skip
TIMED = st.tuples(
    st.integers(0, 2_000_000), COMMANDS.filter(lambda command: "*" not in command)
).map(lambda line: f"@{line[0] / 1000} {line[1]}")


@settings(max_examples=20, deadline=None)
@given(st.lists(COMMANDS | TIMED, max_size=30), st.sampled_from([[], ["--baud", "115200"]]))
def test_every_line_has_its_answer_whatever_stands_in_the_file(
    lines: list[str], rate: list[str]
) -> None:
    text = "\n".join(lines) + "\n"
    done = subprocess.run(
        [host.program_path(), "sim", "-", "--for", "20", *rate],
        input=text, capture_output=True, text=True, check=True,
    )  # fmt: skip
    told = json.loads(done.stdout)
    answers = [(each["line"], each["answer"][:1]) for each in told["answers"]]
    assert [each for each in answers if each[0] == 0 or each[1] in "2A"] == []
    if told["ended"] == "idle":
        assert told["commands"] + told["unanswered"] == (text.count("\n") if lines else 0)
    else:
        assert told["stuck"]["reason"] in ("no_room", "time")


def test_the_time_at_the_start_changes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "a.gve"
    file.write_text(SQUARE + "@100 H\n@200 G\n")

    def run(epoch: int) -> tuple[str, bytes]:
        steps = tmp_path / "steps.csv"
        done = subprocess.run(
            [host.program_path(), "sim", file, "--steps", steps, "--epoch", str(epoch)],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        told = re.sub(r'"real_seconds":[^,]*,"ratio":[^,]*,', "", done.stdout)
        return told, steps.read_bytes()

    assert run(0) == run(2**32 - 5_000_000) == run(10**15 + 7)


# ---- inputs -------------------------------------------------------------------------------------


def test_inputs_are_open_until_the_file_closes_them(play: Play, tmp_path: Path) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("# RefX, the plate\n10,1,0\n20,8,0\n30,1,1\n")

    lines = [f"@{ms} I{port}" for ms in (5, 15, 25, 35) for port in (1, 2)]
    played = play(lines, "--inputs", inputs, "--json")

    assert [answer for _, answer in played.answers] == [
        "0,FF", "0,FF", "0,FE", "0,FF", "0,FE", "0,7F", "0,FF", "0,7F",
    ]  # fmt: skip


def test_a_switch_interrupts_the_path(play: Play, tmp_path: Path) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("500,2,0\n")

    played = play("SW0,02\nV1000\nL2000\n@2000 SR4\n", "--inputs", inputs, "--json")

    told = played.json
    assert played.answers == [(4, "8,02")]
    assert (told["interrupted"], told["waiting"], told["ended"]) == (True, True, "idle")
    assert 450 < played.positions()[0] < 550


def test_it_is_told_that_the_rest_waits(play: Play) -> None:
    assert play(SHEET, "--for", "3").lines[-2:] == [
        "line 4, L0,0,0,0, was answered by 1 (no room) until the end",
        "the rest of the vectors waits for G",
    ]


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ("1,5,0\n", ":1: the input must be 1 to 4, 7 or 8, then a comma; "),
        ("1,1,0\n2,6,0\n", ":2: the input must be 1 to 4, 7 or 8, then a comma; "),
        ("1,9,0\n", ":1: the input must be 1 to 4, 7 or 8, then a comma; "),
        ("1,1,2\n", ":1: the level must be 0 or 1, then the end of the line; "),
        ("x\n", ":1: the time must be milliseconds from 0 "),
    ],
)
def test_a_wrong_line_of_inputs_is_named(
    play: Play, tmp_path: Path, content: str, complaint: str
) -> None:
    inputs = tmp_path / "inputs.csv"
    inputs.write_text(content)

    played = play("L10\n", "--inputs", inputs)

    assert (played.status, played.out) == (2, "")
    assert f"inputs.csv{complaint}" in played.err
    assert played.err.count("\n") == 1


# ---- what is refused before anything is played --------------------------------------------------


def test_a_missing_file_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    status = run_tool(make_parser(), ["sim", "part.gve"])
    told = capsys.readouterr()
    assert (status, told.out) == (2, "")
    assert told.err == "gve134: part.gve: no such file; check the name and the folder\n"


def test_a_wrong_line_is_shown_and_nothing_is_played(play: Play, tmp_path: Path) -> None:
    steps = tmp_path / "steps.csv"

    played = play("L100\n  V9 ; too slow\n", "--steps", steps)

    assert (played.status, played.out) == (1, "")
    assert played.err.splitlines() == [
        "a.gve:2:4: error: V takes a number from 10 to 200000 as parameter 1, found 9",
        "  V9 ; too slow",
        "   ^",
        "a.gve: 1 error",
    ]
    assert not steps.exists()


@pytest.mark.parametrize("time", ["1.1234567", "5.", "1" * 14])
def test_a_time_that_is_none_is_an_error(play: Play, time: str) -> None:
    played = play(f"@{time} H\n")
    assert played.status == 1
    assert played.err.startswith("a.gve:1:1: error: the time has more than 6 decimals")


def test_the_program_in_c_refuses_the_first_wrong_line_too(tmp_path: Path) -> None:
    file = tmp_path / "a.gve"
    file.write_text("V1000\nL1,2,3,4,5\n")
    done = subprocess.run([host.program_path(), "sim", file], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"gve134-host: {file}:2:")


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--baud", "9600"], "--baud 9600: no rate of the unit; write 38400, "),
        (["--for", "0"], "--for 0: write seconds"),
        (["--xy", "path.pdf"], "path.pdf: a plot is .svg or .png"),
        (["--steps", "x.csv", "--trace", "x.csv"], "x.csv: is named for two outputs"),
        (["--inputs", "none.csv"], "none.csv: no such file"),
        (["--node", "1"], "unrecognized arguments: --node 1"),
    ],
)
def test_wrong_options_are_told(play: Play, options: list[str], complaint: str) -> None:
    played = play("L10\n", *options)
    assert (played.status, played.out) == (2, "")
    assert complaint in played.err
    assert played.err.count("\n") == 1


def test_a_file_that_never_ends_ends_at_the_limit(play: Play) -> None:
    played = play("V10\nL2147483647\nL1\n", "--for", "2.5")

    assert played.status == 0
    assert played.lines[-2:] == [
        "ended at the limit of 2.5 s; --for SECONDS sets another one",
        "line 3, L1, was answered by 1 (no room) until the end",
    ]


def test_a_line_that_is_not_answered_is_told_at_the_limit(play: Play) -> None:
    told = play("WX-100000,10,10,10\n", "--for", "1", "--json").json
    assert told["stuck"] == {"line": 1, "command": "WX-100000,10,10,10", "reason": "no_answer"}


def test_a_line_that_is_not_due_is_told_at_the_limit(play: Play) -> None:
    told = play("L10\n@5000 H\n", "--for", "1", "--json").json
    assert told["stuck"] == {"line": 2, "command": "H", "reason": "time"}
