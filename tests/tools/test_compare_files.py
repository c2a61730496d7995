"""`compare` reads what sigrok, Saleae's Logic and simulators write, and refuses the rest."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
from captures import (
    Analyser,
    Distortion,
    Move,
    csv_file,
    edges,
    names,
    pulses,
    samples,
    sr_file,
    steps_file,
    vcd_file,
)

DATA = Path(__file__).parent / "captures"
TRAIN = pulses([Move(60, 200, 2000, 30_000, 0.01), Move(-60, 200, 2000, 30_000)])
ANALYSER = Analyser(0.02, 40)
SEEN = edges(1, TRAIN, ANALYSER, Distortion())
EXPECTED = {"captured": 120, "both": 120, "missing": 0, "surplus": 0, "wrong_dir": 0}


@pytest.fixture
def steps(tmp_path: Path) -> Path:
    return steps_file(tmp_path / "steps.csv", {1: TRAIN})


def facts(result, rate="told", hz=24e6):
    """The counts of motor 1, when the two are the same and the sample rate is known."""
    told = result.json
    assert (result.status, result.err, told["same"]) == (0, "", True)
    assert (told["capture"]["sample_rate_from"], told["capture"]["sample_hz"]) == (rate, hz)
    assert told["rate_ppm"] == pytest.approx(40, abs=1)
    (motor,) = told["motors"]
    return {
        key: motor[key]["count"] if isinstance(motor[key], dict) else motor[key] for key in EXPECTED
    }


@pytest.mark.parametrize("unit", [1, 2, 3, 4, 8])
def test_a_session_of_sigrok_is_read(tool, steps, tmp_path, unit):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN), unit=unit)

    assert facts(tool("compare", path, steps, "--json")) == EXPECTED


def test_a_session_in_one_piece_is_read(tool, steps, tmp_path):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN), parts=1)
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(tmp_path / "b.sr", "w") as new:
        for name in old.namelist():
            new.writestr(name.removesuffix("-1-1") + "-1" * name.endswith("-1-1"), old.read(name))

    assert facts(tool("compare", tmp_path / "b.sr", steps, "--json")) == EXPECTED


def test_a_dump_of_sigrok_tells_its_sample_rate(tool, steps, tmp_path):
    path = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)

    assert facts(tool("compare", path, steps, "--json")) == EXPECTED


@pytest.mark.parametrize(("step", "direction"), [("X STEP", "X DIR"), ("STEP 1", "DIR 1 [0]")])
def test_names_in_a_dump_may_have_spaces(tool, steps, tmp_path, step, direction):
    path = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)
    text = path.read_text()
    for old, new in zip(names(SEEN), (step, direction), strict=True):
        text = text.replace(f" {old} $end", f" {new} $end")
    path.write_text(text)

    assert facts(tool("compare", path, steps, "--json")) == EXPECTED


def test_the_number_of_a_motor_may_stand_apart_in_a_dump(tool, tmp_path):
    path = vcd_file(tmp_path / "a.vcd", edges(2, TRAIN, ANALYSER, Distortion()), ANALYSER)
    path.write_text(path.read_text().replace("STEP2", "STEP 2").replace("DIR2", "DIR 2"))

    told = tool("compare", path, steps_file(tmp_path / "steps.csv", {2: TRAIN}), "--json").json

    assert (told["same"], [motor["motor"] for motor in told["motors"]]) == (True, [2])


def test_a_wire_whose_level_is_told_late_has_changed_then(tool, steps, tmp_path):
    path = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)
    text = path.read_text()
    begin = text[text.index("#0 ") : text.index("\n", text.index("#0 "))]
    path.write_text(text.replace(begin, "#0"))

    assert facts(tool("compare", path, steps, "--json")) == EXPECTED


def test_a_dump_may_have_vectors_and_reals_and_comments(tool, steps, tmp_path):
    path = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)
    head, mark, body = path.read_text().partition("$upscope")
    head += "$var wire 8 ! bus [7:0] $end\n$var real 64 R speed $end\n"
    body = body.replace("\n#", "\nr1.5 !\nb1010 !\n$comment 1! 0! $end\n#", 40)
    path.write_text(head.replace("wire 8 !", "wire 8 @") + mark + body)

    assert facts(tool("compare", path, steps, "--json")) == EXPECTED


@pytest.mark.parametrize("form", [{}, {"iso": True}, {"every": True}])
def test_raw_data_of_saleae_is_read_and_its_sample_rate_seen(tool, steps, tmp_path, form):
    path = csv_file(tmp_path / "a.csv", SEEN, **form)
    if form.get("every"):  # rows between samples hide the rate, if they were samples
        assert facts(tool("compare", path, steps, "--json", "--sample-rate", "24MHz"), "given")
        return

    assert facts(tool("compare", path, steps, "--json"), "seen") == EXPECTED


def test_a_rate_at_which_edges_could_not_be_seen_is_refused(tool, steps, tmp_path):
    path = csv_file(tmp_path / "a.csv", SEEN)

    result = tool("compare", path, steps, "--sample-rate", "24kHz")

    assert result.status == 2
    assert "--sample-rate 24000 Hz: the capture has edges of a wire" in result.complaint
    assert "nearer than two samples; write the rate at" in result.complaint


def test_a_dump_that_tells_another_rate_than_the_option_is_refused(tool, steps, tmp_path):
    path = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)

    result = tool("compare", path, steps, "--sample-rate", "8MHz")

    assert result.status == 2
    assert "--sample-rate 8 MHz: the capture itself tells 24 MHz" in result.complaint


def test_the_rate_that_the_file_tells_may_be_said_too(tool, steps, tmp_path):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN))

    assert facts(tool("compare", path, steps, "--json", "--sample-rate", "24M")) == EXPECTED


def test_the_rate_of_a_session_that_does_not_tell_it_is_said(tool, steps, tmp_path):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN))
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(tmp_path / "b.sr", "w") as new:
        for name in old.namelist():
            new.writestr(name, old.read(name).replace(b"samplerate=24 MHz\n", b""))

    result = tool("compare", tmp_path / "b.sr", steps, "--json", "--sample-rate", "24MHz")

    assert facts(result, "given") == EXPECTED


def test_rows_without_data_are_the_ends_of_a_recording(tool, steps, tmp_path):
    path = csv_file(tmp_path / "a.csv", SEEN)
    head, first, *rows = path.read_text().splitlines()
    path.write_text("\n".join([head, "-0.5,X,0", first, *rows, "9.5,X,X", ""]))

    assert facts(tool("compare", path, steps, "--json"), "seen") == EXPECTED

    path.write_text("\n".join([head, first, *rows[:40], rows[39][:11] + ",X,0", *rows[40:]]))
    assert "has a gap without data" in tool("compare", path, steps).complaint


def test_the_waves_of_the_simulator_are_steps_too(tool, write, tmp_path):
    program = write("S100 V2000 A9000 F300 R D R")
    waves, table = tmp_path / "a.vcd", tmp_path / "a.csv"
    tool("sim", program, "--steps", table, "--vcd", waves)

    for steps in (waves, table):
        result = tool("compare", waves, steps, "--no-rate", "--json")
        (motor,) = [m for m in result.json["motors"] if m["captured"]]
        assert (result.status, motor["both"], motor["wrong_dir"]["count"]) == (0, 600, 0)
        assert abs(motor["worst_ns"]) <= 1
        assert result.json["offset_seconds"] == pytest.approx(0, abs=1e-9)


def test_a_capture_by_a_pipe_is_read(start, steps, tmp_path):
    path = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)
    os.mkfifo(tmp_path / "pipe")
    content = path.read_bytes()
    Thread(target=(tmp_path / "pipe").write_bytes, args=[content], daemon=True).start()

    process = start("compare", tmp_path / "pipe", steps)
    out, err = process.communicate(timeout=60)

    assert (process.returncode, err) == (0, "")
    assert "the same: every pulse" in out


@pytest.mark.parametrize(
    ("named", "options"),
    [
        (["STEP_1", "dir 1"], []),
        (["m1_step", "M1_DIR"], []),
        (["X_STEP", "DIRX"], []),
        (["PUL", "Dir"], []),
        (["D0", "D1"], ["--channels", "STEP1=D0,DIR1=D1"]),
        (["STEP2", "b c"], ["--channels", "step_1=STEP2, dir1=b c"]),
    ],
)
def test_channels_are_found_by_their_names_or_as_told(tool, steps, tmp_path, named, options):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), named)

    assert facts(tool("compare", path, steps, "--json", *options)) == EXPECTED


def test_an_inverted_wire_is_turned_back(tool, steps, tmp_path):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER) ^ np.uint8(3), ["a", "b"])

    assert facts(tool("compare", path, steps, "--json", "--channels", "STEP1=!a,DIR1=!b")) == (
        EXPECTED
    )


@pytest.mark.parametrize(
    ("named", "options", "words"),
    [
        (["D0", "D1"], [], "its channels are D0, D1, and none is named as STEP1"),
        (["DIR1", "D1"], [], "none is named as STEP1"),
        (["STEP1", "m1_step"], [], "STEP1 and m1_step are both STEP1"),
        (["D0", "D1"], ["--channels", "STEP1=D7"], "has no channel D7; its channels are D0, D1"),
        (["D0", "D1"], ["--channels", "STEP1"], "--channels STEP1: write STEP1=NAME"),
        (["D0", "D1"], ["--channels", "STEP5=D0"], "--channels STEP5=D0: write STEP1=NAME"),
        (["D0", "D1"], ["--channels", "STEP1=D0,STEP1=D1"], "STEP1 is named twice"),
        (["D0", "D1"], ["--channels", "STEP1=D0,DIR2=D1"], "motor 2 has DIR and no STEP"),
        (["STEP1", "D1"], ["--sample-rate", "fast"], "--sample-rate fast: write a rate as 24MHz"),
        (["STEP1", "D1"], ["--sample-rate", "24"], "the capture itself tells 24 MHz; leave"),
        (["STEP1", "D1"], ["--sample-rate", "48MHz"], "--sample-rate 48 MHz: the capture its"),
        (["STEP1", "D1"], ["--limit", "-1"], "--limit -1: write nanoseconds"),
        (["STEP1", "D1"], ["--limit", "nan"], "--limit nan: write nanoseconds"),
        (["STEP1", "D1"], ["--limit", "10"], "--limit 10: the capture resolves 41.7 ns"),
    ],
)
def test_a_wrong_option_is_one_line(tool, steps, tmp_path, named, options, words):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), named)

    result = tool("compare", path, steps, *options)

    assert result.status == 2
    assert words in result.complaint


VCD_HEAD = "$timescale 1 ns $end\n$var wire 1 ! STEP1 $end\n$enddefinitions $end\n"
CSV_HEAD = "Time [s],STEP1\n"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is empty"),
        (b"\0" * 500_000, "is no capture: neither an .sr of sigrok nor a VCD"),
        (b"hello\n", "is no capture"),
        (b"time,level\n0,1\n", "is no capture"),
        (b"Time [s];STEP1\n0;1\n", "first line is Time [s] and names, commas between"),
        (b"name,type,start_time,duration\n", "use its Export Raw Data"),
        (b"PK\x03\x04 and no more", "its end is missing, so it was cut off"),
        (b"$timescale 1 ns $end\n", "its head has no $enddefinitions"),
        (b"$enddefinitions $end\n", "has no $timescale"),
        (b"$timescale 1 ns $end $var real 64 ! v $end $enddefinitions $end", "no wires of one bit"),
        (f"{VCD_HEAD}#5 1!\n#4 0!\n", "the time #4 after #5"),
        (f"{VCD_HEAD}#x 1!\n", "the time #x after #0"),
        (f"{VCD_HEAD}#0 0!\n#9\n", "has no pulse in STEP1"),
        (f"{VCD_HEAD}" + "1!\n0!\n" * 1_500_000, "time stands still at #0"),
        (f"{CSV_HEAD}0,0\n1,1\n1e300,0\n", "has times beyond 100 days"),
        (f"{CSV_HEAD}0,0\n1,0\n", "has no pulse in STEP1"),
        (f"{CSV_HEAD}0,0\n1,1\n0.5,0\n", ":4: the time is not after the one before it"),
        (f"{CSV_HEAD}0,0\n1\n", ":3: is no row of numbers; the file may have been cut off"),
        (f"{CSV_HEAD}0,0\nx,1\n", ":3: is no row of numbers"),
        (f"{CSV_HEAD}2026-02-30T00:00:00.5,0\n", "has a date that is none (Day out of range"),
        (f"{CSV_HEAD}0,0\n1,3.3\n", ":3: a level is neither 0 nor 1"),
        (f"{CSV_HEAD}0,0\nnan,1\n", ":3: the time is not after"),
        (f"{CSV_HEAD}0,0\n1,1\ninf,0\n2,1\n", ":4: the time is not after"),
        (f"{CSV_HEAD}nan,0\n1,1\n", ":2: the time is not after"),
        (CSV_HEAD, "has no data in the channels that are compared"),
        (f"{CSV_HEAD}" + "0,1\n" * 3_000_000, "time stands still"),
        (f"{CSV_HEAD}" + "0" * 10_000_000, "has a line of more than 4 MB"),
    ],
)
def test_a_file_that_is_no_capture_is_one_line(tool, steps, write, content, words):
    result = tool("compare", write(content, "a.bin"), steps)

    assert result.status == 2
    assert words in result.complaint


def test_a_file_that_is_not_there_or_a_folder_is_one_line(tool, steps, tmp_path):
    assert "no such file" in tool("compare", tmp_path / "none", steps).complaint
    assert "is a directory" in tool("compare", tmp_path, steps).complaint
    assert "is no capture" in tool("compare", "/dev/zero", steps).complaint


@pytest.mark.parametrize("kept", [0.2, 0.5, 0.9, 0.999])
def test_a_session_that_was_cut_off_is_one_line(tool, steps, tmp_path, kept):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN))
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * kept)])

    assert "cut off" in tool("compare", path, steps).complaint


def test_a_session_with_a_wrong_byte_is_one_line(tool, steps, tmp_path):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN))
    content = bytearray(path.read_bytes())
    for at in range(600, 660):
        content[at] ^= 0x55
    path.write_bytes(content)

    result = tool("compare", path, steps)

    assert result.status == 2
    assert "is damaged" in result.complaint


def test_a_session_whose_list_of_files_is_damaged_is_one_line(tool, steps, tmp_path):
    path = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN))
    content = bytearray(path.read_bytes())
    content[content.index(b"PK\1\2") + 6] = 117  # the version that is needed to take it out
    path.write_bytes(content)

    result = tool("compare", path, steps)

    assert result.status == 2
    assert "is damaged" in result.complaint


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("version", "3", "is of version 3 of sigrok's files"),
        ("version", None, "is a zip file without version"),
        ("metadata", None, "is a zip file without metadata"),
        ("metadata", "rubbish", "its metadata cannot be read"),
        ("metadata", "[global]\nx=1\n", "has no logic channels"),
        ("metadata", "[device 1]\ncapturefile=logic-1\nprobe1=STEP1\n", "does not tell its sample"),
        ("metadata", "[device 1]\ncapturefile=logic-1\nunitsize=99\n", "samples of 99 bytes"),
        ("metadata", "[device 1]\ncapturefile=logic-1\nprobe9=STEP1\n", "no bit for its channel"),
        ("logic-1-2", None, "part 2 of its samples is missing"),
    ],
)
def test_a_session_that_is_not_whole_is_one_line(tool, steps, tmp_path, name, content, words):
    whole = sr_file(tmp_path / "a.sr", samples(SEEN, ANALYSER), names(SEEN))
    with zipfile.ZipFile(whole) as old, zipfile.ZipFile(tmp_path / "b.sr", "w") as new:
        for each in old.namelist():
            if each != name:
                new.writestr(each, old.read(each))
        if content is not None:
            new.writestr(name, content)

    result = tool("compare", tmp_path / "b.sr", steps)

    assert result.status == 2
    assert words in result.complaint


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "is no steps file; tools/rkm04 sim PROGRAM --steps FILE writes one"),
        ("tick,motor,position\n", "is no steps file"),
        ("# tick_hz=fast\ntick,motor,position\n1,1,1\n", "does not begin as a steps file"),
        ("# tick_hz=84000000\n1,1,1\n", "does not begin as a steps file"),
        ("# tick_hz=84000000\ntick,motor,position\n", "no motor moves in it"),
        ("# tick_hz=84000000\ntick,motor,position\n1,1\n", "1,1 is no tick,motor,position"),
        (f"# tick_hz=84000000\ntick,motor,position\n1,1,{10**20}\n", "is no tick,motor,position"),
        ("# tick_hz=84000000\ntick,motor,position\n1,1,--1\n", "is no tick,motor,position"),
        ("# tick_hz=84000000\ntick,motor,position\n1,9,1\n", "not those of motors 1 to 4"),
        ("# tick_hz=84000000\ntick,motor,position\n9,1,1\n1,1,2\n", "not those of motors 1 to 4"),
    ],
)
def test_steps_that_are_none_are_one_line(tool, write, tmp_path, content, words):
    capture = vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER)

    result = tool("compare", capture, write(content, "steps.csv"))

    assert result.status == 2
    assert words in result.complaint


def test_a_session_of_other_data_does_not_fit(tool, steps, tmp_path):
    words = np.tile(np.repeat(np.array([0, 1], dtype=np.uint8), 5000), 200)
    path = sr_file(tmp_path / "a.sr", words, ["STEP1"])

    result = tool("compare", path, steps)

    assert result.status == 1
    assert "nothing fits: nowhere are the captured pulses the simulated ones" in result.out
    assert "not the same" in result.out


def test_a_capture_of_another_program_does_not_fit(tool, tmp_path):
    other = pulses([Move(900, 100, 700, 4_000, 0.3), Move(-900, 100, 700, 4_000)])
    steps = steps_file(tmp_path / "other.csv", {1: other})

    told = tool("compare", vcd_file(tmp_path / "a.vcd", SEEN, ANALYSER), steps, "--json").json

    (motor,) = told["motors"]
    assert (told["offset_seconds"], motor["both"]) == (None, 0)
    assert motor["missing"]["pulses"][0]["last"] == 1800
    assert motor["surplus"]["count"] == 120
