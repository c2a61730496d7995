"""`machine`, and `sim` of a machine file: a whole machine in one file."""

from __future__ import annotations

import json
import re
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rkm04_tools.failure import Failure
from rkm04_tools.machine.machine import FILE_BYTES_MAX, parse_machine

ROOT = Path(__file__).resolve().parents[2]
FEED = "{ feed, žlutý }\r\n\\ C100 S100 V500 A2000\r\nF400 R\r\n"
CLAMP = "\\ C100 O03 F50 R"
INPUTS = "# the door\n500,3,1\n"


def content(**more: Any) -> dict[str, Any]:
    """A machine with two programs."""
    return {
        "format": "rkm04-machine",
        "version": 1,
        "name": "Podavač",
        "notes": "grease it\nevery week",
        "motors": [
            {"name": "feed", "program": FEED, "steps_per_mm": 200},
            {"program": CLAMP, "steps_per_degree": 8.5},
            {"program": "{ nothing yet }"},
            {"program": ""},
        ],
        "inputs": INPUTS,
        "input_names": {"3": "door"},
        "output_names": {"1": "lamp"},
        **more,
    }


def with_motor(number: int = 1, **more: Any) -> dict[str, Any]:
    """The same with more about a motor."""
    changed = content()
    changed["motors"][number - 1] |= more
    return changed


@pytest.fixture
def put(write):
    """Write a machine file."""

    def write_machine(told: Any, name: str = "a.rkm"):
        return write(json.dumps(told), name)

    return write_machine


def test_a_machine_is_checked_with_its_programs_and_inputs(tool, put):
    result = tool("machine", "check", put(content()))

    assert (result.status, result.err) == (0, "")
    words = "Podavač: motor 1: 6 commands, motor 2: 4 commands; no errors\n"
    assert result.out.endswith(words)


def test_every_error_of_every_program_is_told_with_its_place(tool, put):
    file = put(with_motor(2, program="\\ V20000\nq R"))

    result = tool("machine", "check", file, "--json")

    assert result.status == 1
    assert f"{file}: motor 2:1:3: error: V" in result.err
    assert f"{file}: motor 2:2:1: error: " in result.err
    assert result.json["files"][0]["ok"] is False


def test_a_speed_above_the_limit_of_its_motor_is_an_error_at_its_place(tool, put):
    limits = {"speed_max_steps_per_s": 499}
    file = put(with_motor(limits=limits))

    result = tool("machine", "check", file)

    assert result.status == 1
    assert f"{file}: motor 1:2:13: error: V500 is above the limit of motor 1 (feed)" in result.err
    at_limit = put(with_motor(limits={"speed_max_steps_per_s": 500}))
    assert tool("machine", "check", at_limit).status == 0


@pytest.mark.parametrize(
    ("program", "moves"),
    [
        ("\\ C100 F300 R", ["R"]),
        ("\\ F10 Y V500 F20 Y R", ["Y"]),
        ("\\ V500 F300 R \\ G10", ["G10"]),
        ("\\ V500 F300 R", []),
        ("F300 R", []),
    ],
)
def test_so_is_a_move_with_the_speed_that_programs_start_with(tool, put, program, moves):
    file = put(with_motor(program=program, limits={"speed_max_steps_per_s": 999}))

    result = tool("machine", "check", file)

    words = [line for line in result.err.splitlines() if "above the limit" in line]
    assert [line.split("error: ")[1].split(",")[0] for line in words] == moves
    assert all("with V1000 from the start, is above the limit of motor 1" in line for line in words)


def test_inputs_that_the_simulator_refuses_are_named(tool, put):
    result = tool("machine", "check", put(content(inputs="500,9,1")))

    assert result.status == 1
    assert "a.rkm: inputs:1" in result.complaint


@pytest.mark.parametrize(
    ("told", "words"),
    [
        (content(version=2), "was written by later tools (format 2, and these know 1)"),
        (content(version="1"), 'lacks "version": 1'),
        (content(version=True), 'lacks "version": 1'),
        (content(format="rks"), 'it lacks "format": "rkm04-machine"'),
        ([content()], 'it lacks "format": "rkm04-machine"'),
        (content(colour="red"), 'nothing is known of "colour"'),
        (content(input_name={}), '"input_name"; did you mean input_names?'),
        (content(name=5), "name: must be a text, found 5"),
        (content(name=""), "name: must not be empty"),
        (content(motors=content()["motors"][:3]), "motors: must be a list of 4, one for each"),
        (content(motors={}), "motors: must be a list [ ], found an object { }"),
        (with_motor(program=None), "motor 1, program: must be a text, found null"),
        (with_motor(steps_per_mm=0), "motor 1, steps_per_mm: 0 must be more than 0"),
        (with_motor(steps_per_mm="8"), 'motor 1, steps_per_mm: must be a number, found "8"'),
        (with_motor(steps_per_degree=1), "motor 1: has both steps_per_mm and steps_per_degree"),
        (with_motor(2, speed=1), 'motor 2: nothing is known of "speed"'),
        (with_motor(program="{" * 200_001), "has 200001 characters; 200000 are the most"),
        (content(input_names={"9": "x"}), 'input_names: nothing is known of "9"'),
        (with_motor(limits={"speed_max_steps_per_s": 16_001}), "16001 is too large; 16000 is"),
        (with_motor(limits={"position_min_steps": 1.5}), "must be a whole number, found 1.5"),
        (
            with_motor(limits={"position_min_steps": 2, "position_max_steps": 1}),
            "motor 1, limits: position_min_steps 2 is above position_max_steps 1",
        ),
        ({"format": "rkm04-machine", "version": 1}, 'lacks "name", "motors"'),
    ],
)
def test_what_is_no_machine_is_refused_in_plain_words(tool, put, told, words):
    result = tool("machine", "show", put(told))

    assert result.status == 1
    assert words in result.complaint


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "a.rkm:1:1: is not JSON"),
        (b'{"format": "rkm04-machine", ', "is not JSON"),
        (b"[" * 100_000, "nested too deep"),
        (b'{"a": 1, "a": 2}', '"a" stands there twice'),
        (b'{"a": NaN}', "NaN is no number"),
        (b'{"a": "\\ud800"}', "half a character"),
        (b'{"a": ' + b"9" * 5000 + b"}", "too many digits"),
        ('{"name": "č"}'.encode("utf-16"), "is not UTF-8"),
        (b" " * (FILE_BYTES_MAX + 1), "larger than 2000000 bytes"),
        (b"{}" + b" " * 10_000_000, "larger than 2000000 bytes"),
    ],
)
def test_a_file_that_is_damaged_or_huge_is_refused_in_plain_words(tool, write, data, words):
    result = tool("machine", "check", write(data, "a.rkm"))

    assert result.status in (1, 2)
    assert words in result.complaint


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=8,
)


@settings(deadline=None)
@given(st.sampled_from(sorted(content())), json_values)
def test_whatever_a_field_holds_it_is_taken_or_refused_in_one_line(key, value):
    told = {**content(), key: value}
    try:
        taken, words = parse_machine(json.dumps(told).encode(), "a.rkm"), ""
    except Failure as failure:
        taken, words = told, str(failure)
    assert taken == told
    assert re.fullmatch(r"(a\.rkm: .+)?", words)


def test_show_tells_names_units_limits_and_notes(tool, put):
    file = put(with_motor(limits={"position_max_steps": 60_000}))
    result = tool("machine", "show", file)

    assert result.out.startswith("Podavač\n\ngrease it\nevery week\n\nBI3  door\n\nBO1  lamp\n")
    (row,) = [line for line in result.out.splitlines() if line.startswith("    1")]
    assert row.split() == ["1", "feed", "mm:", "200", "60", "000", "3", "lines"]
    assert tool("machine", "show", file, "--json").json == json.loads(file.read_bytes())


def test_a_machine_is_made_of_files_and_taken_apart_into_the_same_again(tool, write, tmp_path):
    feed, inputs = write(FEED, "feed.rks"), write(INPUTS, "in.csv")
    file, folder = tmp_path / "Feeder.rkm", tmp_path / "parts"

    made = tool("machine", "new", file, "--motor", f"2={feed}", "--inputs", inputs)

    assert (made.status, made.err) == (0, "")
    assert json.loads(file.read_bytes())["name"] == "Feeder"
    assert tool("machine", "unpack", file, folder).status == 0
    assert (folder / "motor2.rks").read_bytes() == feed.read_bytes()
    assert (folder / "inputs.csv").read_bytes() == inputs.read_bytes()
    assert len(list(folder.iterdir())) == 2


def test_a_program_with_an_error_makes_no_machine(tool, write, tmp_path):
    file = tmp_path / "Feeder.rkm"

    result = tool("machine", "new", file, "--motor", f"2={write('V0', 'bad.rks')}")

    assert result.status == 1
    assert "motor 2:1:1: error" in result.err
    assert f"{file}: Feeder: errors in the program of motor 2; nothing was written" in result.err
    assert not file.exists()


def test_nothing_that_is_there_is_overwritten(tool, put, tmp_path):
    file = put(content())
    before = file.read_bytes()

    for arguments in (("new", file), ("unpack", file, tmp_path)):
        result = tool("machine", *arguments)
        assert result.status == 2
        assert "is there already" in result.complaint
    assert file.read_bytes() == before
    assert tool("machine", "new", tmp_path / "a.json").status == 2


def test_the_part_for_a_gve134_unit_is_kept(tool, put):
    axis = {"speed_steps_per_s": 5000, "accel_steps_per_s2": 20_000, "jump_steps_per_s": 200}
    told = content(gve134={"axes": {"x": axis}, "probe": {"interrupt": 15}})

    assert tool("machine", "show", put(told), "--json").json == told
    assert tool("machine", "check", put(told)).status == 0
    shown = tool("machine", "show", put(told)).out.splitlines()[-1]
    assert shown.split() == ["X", "5", "000", "20", "000", "200", "none"]


def test_the_example_of_the_document_is_a_good_machine(tool, write):
    document = (ROOT / "tools/rkm04_tools/machine/README.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"^```json\n(.*?)^```$", document, re.MULTILINE | re.DOTALL)
    file = write(example, "a.rkm")

    for action in (("machine", "check"), ("sim",)):
        result = tool(*action, file)
        assert (result.status, result.err) == (0, "")


def test_two_machines_are_compared_in_programs_and_all_else(tool, put):
    one, two = put(content()), put(with_motor(2, program=CLAMP + "\nW5", name="clamp"), "b.rkm")

    same, other = tool("machine", "diff", one, one), tool("machine", "diff", one, two)

    assert (same.status, other.status) == (0, 1)
    lines = other.out.splitlines()
    assert f"+++ {two}: motor 2" in lines
    assert "+W5" in lines
    assert any('"name": "clamp"' in line for line in lines)
    assert f"+++ {two}: motor 1" not in lines


def test_a_machine_is_sent_compared_and_stored(tool, put, serve):
    served, file = serve(), put(content())
    unit = ("--port", served.place)

    assert tool("machine", "diff", file, *unit).status == 1
    refused = tool("machine", "store", file, *unit)
    assert refused.status == 1
    assert "nothing was stored" in refused.complaint
    sent = tool("machine", "send", file, *unit)
    assert (sent.status, sent.err) == (0, "")
    assert "motor 1: commands 6, motor 2: commands 4" in sent.out
    assert "left as they are, without a program in the file: 3, 4" in sent.out
    assert tool("machine", "diff", file, *unit).status == 0
    stored = tool("machine", "store", file, *unit, "--json")
    assert [each["motor"] for each in stored.json["motors"]] == [1, 2]


def test_motors_without_a_program_in_the_file_are_compared_too(tool, put, write, serve):
    served = serve()
    unit = ("--port", served.place)
    file = put(content())
    tool("machine", "send", file, *unit, "--together")
    assert tool("machine", "diff", file, *unit).status == 0
    tool("send", write("\\ @1 W1 J1", "other.rks"), "--motor", "3", *unit)

    result = tool("machine", "diff", file, *unit)

    assert result.status == 1
    assert result.out.splitlines()[:2] == [f"--- {file}: motor 3", "+++ unit 1, motor 3"]
    assert "+@1" in result.out.splitlines()


def test_a_machine_that_starts_together_changes_no_program_of_other_motors(tool, put, write, serve):
    served = serve()
    unit = ("--port", served.place)
    full = write("\\ @1 S1000 V1000 F10 " + "R " * 695 + "J1", "full.rks")
    tool("send", full, "--motor", "4", *unit)

    result = tool("machine", "send", put(content()), "--together", *unit)

    assert result.status == 1
    assert "motor 4 holds another program" in result.complaint
    assert tool("diff", full, "--motor", "4", *unit).status == 0
    assert not any(m["failed"] for m in tool("status", "--json", *unit).json["motors"])


def until_at_rest(tool, *unit: str) -> None:
    """What has run may be overwritten."""
    end = time.monotonic() + 20
    while any(each["running"] for each in tool("status", "--json", *unit).json["motors"]):
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.mark.parametrize("together", [[], ["--together"]])
def test_a_machine_that_overwrites_what_a_motor_had_is_told(tool, put, write, serve, together):
    served = serve()
    unit = ("--port", served.place)
    tool("send", write("\\" + "T01 C01" * 350, "full.rks"), *unit)
    until_at_rest(tool, *unit)
    motors = [{"program": "F100 R"}, *[{"program": ""}] * 3]

    result = tool("machine", "send", put(content(motors=motors)), *together, *unit)

    assert result.status == 0
    assert result.err.count("\n") == 1
    assert "warning: the program memory was full (motor 1), the oldest commands were" in result.err
    until_at_rest(tool, *unit)
    again = tool("machine", "send", put(content(motors=motors)), *together, *unit, "--json")
    assert (again.json["overflow"], again.json["full"]) == (True, [1])


def test_of_a_machine_with_one_wrong_program_none_is_sent(tool, put, serve):
    served = serve()

    result = tool("machine", "send", put(with_motor(2, program="V0")), "--port", served.place)

    assert result.status == 1
    assert "motor 2:1:1: error" in result.err
    held = tool("program", "--port", served.place, "--json").json
    assert {each["program"] for each in held["motors"]} == {""}


def test_a_machine_without_programs_is_not_sent(tool, put):
    motors = [{"program": ""}] * 4
    result = tool("machine", "send", put(content(motors=motors)), "--port", "socket://127.0.0.1:1")

    assert result.status == 1
    assert "no motor has a program" in result.complaint


def test_sim_runs_a_machine_with_its_own_inputs(tool, put):
    result = tool("sim", put(content()), "--json")

    assert (result.status, result.err) == (0, "")
    assert [motor["position"] for motor in result.json["motors"]] == [400, 50]
    assert result.json["seconds"] > 0.5


def test_sim_tells_where_a_motor_leaves_its_limits_in_its_own_unit(tool, put, tmp_path):
    limits = {"position_min_steps": 0, "position_max_steps": 399}
    result = tool("sim", put(with_motor(limits=limits)), "--plot", tmp_path / "a.svg")

    assert result.status == 1
    words = "motor 1 (feed) goes up to 400 steps (2 mm), above its limit of 399 steps (1.995 mm)"
    assert words in result.err
    limits["position_max_steps"] = 400
    assert tool("sim", put(with_motor(limits=limits))).status == 0


def test_programs_are_not_named_beside_a_machine(tool, put, write):
    result = tool("sim", put(content()), "--motor", f"1={write(FEED)}")

    assert "leave --motor out" in result.complaint


def test_a_machine_file_in_place_of_a_program_says_what_it_is(tool, put):
    result = tool("check", put(content()))

    assert "is a machine file; rkm04 machine --help" in result.complaint
