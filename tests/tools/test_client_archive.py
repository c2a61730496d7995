"""`backup`, `restore` and `diff`: the programs of a line as files, and back."""

from __future__ import annotations

from pathlib import Path

import fake_unit
import pytest
from fake_unit import FakeLine, FakeUnit
from rkm04_tools.line import Wait

LONG = b"S100" + b"F16000000R" * 120


@pytest.fixture
def units():
    return [FakeUnit(2, programs={1: b"S100F5R", 2: b"", 3: LONG, 4: b""}), FakeUnit(16)]


@pytest.fixture
def fake(units, monkeypatch):
    monkeypatch.setattr("rkm04_tools.line.SCANNING", Wait(0.1, 1))
    line = FakeLine(*units)
    monkeypatch.setenv("RKM04_PORT", line.port)
    yield line
    line.close()


@pytest.fixture
def folder(tool, fake, tmp_path):
    """A folder with a backup of the units."""
    path = tmp_path / "programs"
    assert tool("backup", path).status == 0
    return path


def test_backup_writes_a_file_for_each_program(folder):
    assert [path.name for path in sorted(folder.iterdir())] == [
        "unit-02-motor-1.rks",
        "unit-02-motor-3.rks",
    ]
    text = (folder / "unit-02-motor-1.rks").read_text()
    assert text == "\\ { unit 2, motor 1 }\nS100 F5 R\n"


def test_backup_writes_programs_without_errors_and_of_readable_width(tool, folder):
    assert tool("check", *folder.iterdir()).status == 0
    long = (folder / "unit-02-motor-3.rks").read_text()
    assert max(map(len, long.splitlines())) <= 100


def test_backup_tells_what_it_has_saved(tool, fake, tmp_path):
    result = tool("backup", tmp_path / "b", "--json")

    first, second = result.json["programs"]
    path = str(tmp_path / "b" / "unit-02-motor-1.rks")
    assert first == {"node": 2, "motor": 1, "file": path, "commands": 3}
    assert second["commands"] == 241


def test_backup_overwrites_no_backup(tool, folder):
    result = tool("backup", folder)

    assert result.status == 2
    assert "has programs of units already; choose another folder" in result.complaint


def test_backup_where_nobody_answers_is_no_connection(tool, fake, tmp_path, units):
    fake.units.clear()

    result = tool("backup", tmp_path / "b")

    assert result.status == 3
    assert not (tmp_path / "b").exists()


def test_backup_of_two_units_with_one_address_is_refused(tool, fake, tmp_path):
    fake.faults += [fake_unit.twice] * 2

    result = tool("backup", tmp_path / "b")

    assert result.status == 1
    assert "unit 2: answers twice" in result.complaint


def test_backup_needs_a_folder_that_can_be_written(tool, fake, write):
    result = tool("backup", write("a file") / "b")

    assert result.status == 2
    assert "cannot be written" in result.complaint


def test_restore_brings_back_and_stores_and_runs_nothing(tool, folder, units):
    units[0].programs = {1: b"H", 2: b"C100", 3: b"", 4: b""}
    units[0].done.clear()

    result = tool("restore", folder)

    assert result.status == 0
    assert result.out.splitlines()[-1].startswith("nothing runs: rkm04 resume starts a motor")
    assert units[0].programs == {1: b"[]S100F5R", 2: b"C100", 3: b"[]" + LONG, 4: b""}
    acts = [message for message in units[0].done if message[0] in (2, 3)]
    assert acts[:4] == [b"\x021\\[", b"\x021K", b"\x021]S100F5R", b"\x031"]
    assert not any(b"C75" in message for message in acts)


def test_what_was_restored_is_saved_as_it_was(tool, folder, tmp_path):
    assert tool("restore", folder).status == 0

    assert tool("backup", tmp_path / "again").status == 0

    first = {path.name: path.read_text() for path in folder.iterdir()}
    assert {path.name: path.read_text() for path in (tmp_path / "again").iterdir()} == first


def test_a_backup_names_unit_and_motor_in_the_file_too(folder):
    assert (folder / "unit-02-motor-3.rks").read_text().startswith("\\ { unit 2, motor 3 }\n")


def test_restore_stores_every_program_and_nothing_else(tool, folder, units):
    units[0].done.clear()

    assert tool("restore", folder).status == 0

    assert [done for done in units[0].done if done[0] == 3] == [b"\x031", b"\x033"]


def test_restore_does_not_say_that_nothing_runs_in_a_unit_that_has_restarted(
    tool, fake, folder, units
):
    def restart(answer: bytes) -> bytes:
        stored = [message for message in units[0].done if message[0] == 3]
        if len(stored) == 2 and units[0].done[-1][0] == 5:
            units[0].restart()
        return answer

    fake.faults += [restart] * 1000

    result = tool("restore", folder)

    assert result.status == 1
    node = units[0].node
    assert f"unit {node} has restarted meanwhile, and runs what it has stored" in result.complaint
    assert f"rkm04 stop --node {node} stops it" in result.complaint
    assert "nothing runs" not in result.out


def test_restore_ends_where_a_unit_holds_another_program(tool, folder, units, monkeypatch):
    def execute(unit: FakeUnit, message: bytes) -> bytes:
        answer = original(unit, message)
        if message == b"\x031":
            unit.programs[1] = b"[]S100F6R"
        return answer

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)

    result = tool("restore", folder)

    assert result.status == 1
    assert "unit-02-motor-1.rks: the unit holds another program; restore again" in result.complaint


def test_a_backup_that_cannot_be_finished_leaves_no_half_file(tool, fake, tmp_path, monkeypatch):
    def write(path: Path, text: str, **more: str) -> int:
        whole(path, text[:5], **more)
        raise OSError(28, "No space left on device")

    whole = Path.write_text
    monkeypatch.setattr(Path, "write_text", write)

    result = tool("backup", tmp_path / "b")

    assert result.status == 2
    assert "no space left on device" in result.complaint
    assert not list((tmp_path / "b").glob("*.rks"))


def test_a_backup_that_finds_no_room_for_one_program_leaves_none_of_the_others(
    tool, fake, tmp_path, monkeypatch
):
    def write(path: Path, text: str, **more: str) -> int:
        if "motor-3" in path.name:
            raise OSError(28, "No space left on device")
        return whole(path, text, **more)

    whole = Path.write_text
    monkeypatch.setattr(Path, "write_text", write)

    assert tool("backup", tmp_path / "b").status == 2
    assert not list((tmp_path / "b").iterdir())


def test_restore_changes_nothing_if_a_unit_is_missing(tool, fake, folder, units):
    (folder / "unit-09-motor-1.rks").write_text("\\ F1 R")
    units[0].done.clear()

    result = tool("restore", folder)

    assert result.status == 3
    assert "unit 9 does not answer" in result.complaint
    assert result.complaint.rstrip().endswith("; nothing was restored")
    assert set(units[0].done) == {b"\x01"}


def test_restore_changes_nothing_if_a_file_has_an_error(tool, folder, units):
    (folder / "unit-16-motor-4.rks").write_text("\\ F1\nQ")
    units[0].done.clear()

    result = tool("restore", folder)

    assert result.status == 1
    assert 'unit-16-motor-4.rks:2:1: unknown command "Q"; nothing was restored' in result.complaint
    assert units[0].done == []


@pytest.mark.parametrize(("name", "words"), [("", "has no file like"), ("none", "no such file")])
def test_restore_needs_a_folder_with_programs(tool, fake, tmp_path, name, words):
    result = tool("restore", tmp_path / name)

    assert result.status == 2
    assert words in result.complaint


@pytest.mark.parametrize("text", ["\\ S0100 F5 {five} R", "S100F5R"])
def test_diff_of_the_same_program_is_status_0(tool, fake, write, text):
    path = write(text)

    result = tool("diff", path, "--node", "2")

    assert (result.status, result.out) == (0, f"unit 2, motor 1: the same as {path}\n")


def test_diff_shows_the_commands_that_differ(tool, fake, write):
    path = write("S100 F6 R")

    result = tool("diff", path, "--node", "2")

    assert result.status == 1
    assert result.out.splitlines() == [
        f"--- {path}",
        "+++ unit 2, motor 1",
        "@@ -1,3 +1,3 @@",
        " S100",
        "-F6",
        "+F5",
        " R",
    ]


def test_diff_needs_one_motor(tool, fake, write):
    assert "name one with --motor" in tool("diff", write("R"), "--motor", "0").complaint


def test_a_memory_that_is_not_understood_is_told(tool, fake, units, write):
    units[0].programs[1] = b"S100?"

    result = tool("diff", write("S100"), "--node", "2")

    assert result.status == 1
    assert "does not understand" in result.complaint
