"""`serve` keeps stored programs in a file, whatever ends it."""

from __future__ import annotations

import random
import signal
import time

import pytest
from frames import frame
from served import Talker, refusal

VERSION = b"\x01"
KILLS = 16
KILL_SEED = 20261121


def test_a_stored_program_starts_when_the_unit_is_switched_on_again(serve, tmp_path):
    flash = tmp_path / "unit.flash"
    served = serve("--flash", flash)
    talker = served.talker()
    talker.ask(b"\x022\\ S500 V1000 A60000 G-")
    assert talker.ask(b"\x032") == b"\x032\0"
    assert served.end() == (0, "")

    talker = serve("--flash", flash).talker()

    time.sleep(0.02)
    assert talker.position(2) < 0
    assert [path.name for path in tmp_path.iterdir()] == ["unit.flash"]


def test_a_stored_program_survives_a_kill_after_the_answer(serve, tmp_path):
    served = serve("--flash", tmp_path / "unit.flash")
    talker = served.talker()
    talker.ask(b"\x021F1")
    talker.ask(b"\x031")
    served.end(signal.SIGKILL)

    again = serve("--flash", tmp_path / "unit.flash")

    assert again.talker().ask(b"\x051") == b"\x051F1"


def seconds_of_storing(talker: Talker) -> float:
    started = time.monotonic()
    talker.ask(b"\x033")
    return time.monotonic() - started


def test_a_kill_at_any_moment_leaves_the_old_program_or_the_new_one(serve, tmp_path):
    flash = tmp_path / "unit.flash"
    rng = random.Random(KILL_SEED)
    seconds = 0.0
    expected = {b""}
    for count in range(1000, 1000 + KILLS):
        served = serve("--flash", flash)
        talker = served.talker()
        found = talker.ask(b"\x051")[2:]
        assert found in expected
        talker.ask(b"\x021\\W%d" % count)
        if not seconds:
            seconds = seconds_of_storing(talker)
        talker.send(frame(1, 99, b"\x031"))
        time.sleep(rng.uniform(0.0, 2 * seconds))
        served.end(signal.SIGKILL)
        expected = {found, b"W%d" % count}


def test_what_a_kill_has_left_half_written_is_not_used(serve, tmp_path):
    flash = tmp_path / "unit.flash"
    serve("--flash", flash).end()
    (tmp_path / "unit.flash.part").write_bytes(b"half")

    talker = serve("--flash", flash).talker()
    talker.ask(b"\x021F1")

    assert talker.ask(b"\x031") == b"\x031\0"
    assert [path.name for path in tmp_path.iterdir()] == ["unit.flash"]


def test_an_empty_file_begins_with_an_erased_flash(serve, tmp_path):
    (tmp_path / "unit.flash").touch()

    assert serve("--flash", tmp_path / "unit.flash").talker().ask(b"\x051") == b"\x051"


@pytest.mark.parametrize("stores", [False, True])
def test_a_second_serve_on_one_flash_file_is_refused(serve, tmp_path, stores):
    flash = tmp_path / "unit.flash"
    served = serve("--flash", flash)
    if stores:
        # Which puts a new file in the place of the one that was locked.
        served.talker().ask(b"\x021F1")
        served.talker().ask(b"\x031")

    status, complaint = refusal("--tcp", "0", "--flash", flash)

    assert status == 2
    assert complaint == (
        f"rkm04: {flash}: another rkm04 serve uses it; end that one, or name another file\n"
    )
    assert served.talker().ask(VERSION).startswith(b"\x01")
    served.end()
    assert serve("--flash", flash).talker().ask(b"\x051") == (b"\x051F1" if stores else b"\x051")


def test_a_device_is_no_flash_file():
    status, complaint = refusal("--tcp", "0", "--flash", "/dev/null")

    assert status == 2
    assert complaint == "rkm04: /dev/null: not a plain file; name another one\n"


def test_several_units_keep_their_programs_apart(serve, tmp_path):
    flash = tmp_path / "line.flash"
    served = serve("--node", 1, "--node", 5, "--flash", flash)
    talker = served.talker()
    for node in (1, 5):
        talker.ask(b"\x021F%d" % node, node=node)
        talker.ask(b"\x031", node=node)
    served.end()

    talker = serve("--node", 1, "--node", 5, "--flash", flash).talker()

    assert [talker.ask(b"\x051", node=node) for node in (1, 5)] == [b"\x051F1", b"\x051F5"]
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "line.flash.node1",
        "line.flash.node5",
    ]


@pytest.mark.parametrize("damage", [lambda old: old[:-1], lambda old: b"\0" + old[1:]])
def test_a_damaged_flash_file_is_refused(serve, tmp_path, damage):
    flash = tmp_path / "unit.flash"
    serve("--flash", flash).end()
    flash.write_bytes(damage(flash.read_bytes()))

    status, complaint = refusal("--tcp", "0", "--flash", flash)

    assert status == 2
    assert complaint.startswith(f"rkm04: {flash}: not the flash of a unit (")
