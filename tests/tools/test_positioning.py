"""The documents of the positioning unit say what it does, and another Modbus understands it."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from checks import registers
from hypothesis import given, settings
from hypothesis import strategies as st
from pymodbus.framer import FramerRTU
from pymodbus.pdu import DecodePDU, ModbusPDU
from pymodbus.pdu.mei_message import ReadDeviceInformationRequest, ReadDeviceInformationResponse
from pymodbus.pdu.register_message import (
    ReadHoldingRegistersRequest,
    ReadInputRegistersRequest,
    ReadWriteMultipleRegistersRequest,
    WriteMultipleRegistersRequest,
    WriteSingleRegisterRequest,
)

ROOT = Path(__file__).resolve().parents[2]
LINE = ROOT / "firmware/positioning/docs/line.md"
BLOCK = re.compile(r"^```modbus\n(.*?)^```$", re.MULTILINE | re.DOTALL)
UNIT = 1
WORD = st.integers(0, 0xFFFF)

MASTER = FramerRTU(DecodePDU(False))
ROWS = registers.read_registers(registers.TABLE.read_text(encoding="utf-8"))


def probe(lines: list[str]) -> list[bytes]:
    """What a unit that has just been switched on answers to frames, in hexadecimal."""
    build = Path(os.environ.get("RKM04_BUILD", ROOT / "build" / "host"))
    command = [str(build / "bin" / "modbus-probe")]
    text = "".join(f"{line}\n" for line in lines)
    done = subprocess.run(command, input=text, check=True, capture_output=True, text=True)
    return [bytes.fromhex(line) for line in done.stdout.splitlines()]


def ask(*requests: ModbusPDU) -> list[ModbusPDU]:
    """The answers of a unit that has just been switched on, as another master reads them."""
    answers = []
    for answer in probe([MASTER.buildFrame(request).hex() for request in requests]):
        used, pdu = MASTER.handleFrame(answer, UNIT, 0)
        assert used == len(answer)
        assert pdu is not None
        answers.append(pdu)
    return answers


def words(value: int, row: registers.Register) -> list[int]:
    """A value as registers of the line."""
    return [value >> 16 & 0xFFFF, value & 0xFFFF] if row.words == 2 else [value & 0xFFFF]


def test_the_tables_of_the_registers_are_those_of_the_firmware() -> None:
    text = registers.TABLE.read_text(encoding="utf-8")
    document = registers.DOCUMENT.read_text(encoding="utf-8")

    assert registers.renewed(document, text) == document


def test_a_document_without_a_place_for_a_table_is_told() -> None:
    with pytest.raises(SystemExit, match="needs one place each for axis, images, unit"):
        registers.renewed("no table\n", registers.TABLE.read_text(encoding="utf-8"))


def test_a_row_of_another_form_is_told() -> None:
    with pytest.raises(SystemExit, match="a row has another form"):
        registers.tables('U(LAYOUT, 0, U16, READ, ANY, 0, 0, "")\n')


def frames(block: str) -> list[tuple[bytes, bytes]]:
    """The requests of a block with their answers."""
    found: list[tuple[bytes, bytes]] = []
    for line in block.splitlines():
        if line.startswith("> "):
            found.append((bytes.fromhex(line[2:]), b""))
        else:
            assert line.startswith("< ")
            found[-1] = (found[-1][0], bytes.fromhex(line[2:]))
    return found


def told(answer: bytes) -> list[str]:
    """What must stand in the registers of axis 1, so that an answer with its status comes."""
    word = [int.from_bytes(answer[i : i + 2], "big") for i in range(3, len(answer) - 2, 2)]
    if answer[1:2] == b"\x04":
        status, error, done, result, _, _, high, low = word
        values = {110: status, 111: error, 112: done, 113: result, 116: high << 16 | low}
    elif answer[1:2] == b"\x17":
        values = {110: word[0], 111: word[1], 116: word[2] << 16 | word[3]}
    else:
        values = {}
    return [f"={number} {value}" for number, value in values.items()]


@pytest.mark.parametrize("block", BLOCK.findall(LINE.read_text(encoding="utf-8")))
def test_the_frames_of_the_document_are_answered_so(block: str) -> None:
    exchanges = frames(block)
    lines = [line for request, answer in exchanges for line in (*told(answer), request.hex())]

    assert probe(lines) == [answer for _, answer in exchanges]


def test_another_master_reads_every_register_with_what_is_there_at_the_start() -> None:
    numbers = [row.number + (100 if row.scope == "A" else 0) for row in ROWS]
    requests = [
        ReadHoldingRegistersRequest(address=n, count=row.words, dev_id=UNIT)
        for n, row in zip(numbers, ROWS, strict=True)
    ]

    answers = ask(*requests)

    assert [a.registers for a in answers] == [words(row.start, row) for row in ROWS]


def test_another_master_is_refused_as_input_register_what_can_be_written() -> None:
    numbers = [row.number + (100 if row.scope == "A" else 0) for row in ROWS]
    answers = ask(
        *(
            ReadInputRegistersRequest(address=n, count=row.words, dev_id=UNIT)
            for n, row in zip(numbers, ROWS, strict=True)
        )
    )

    assert [a.isError() for a in answers] == [row.use != "READ" for row in ROWS]
    assert {a.exception_code for a in answers if a.isError()} == {2}


@given(st.lists(WORD, min_size=2, max_size=2), st.sampled_from([1, 2, 3, 4]))
@settings(max_examples=20, deadline=None)
def test_another_master_writes_and_reads_back(values: list[int], axis: int) -> None:
    first = 100 * axis + 2
    written, both, read, one = ask(
        WriteMultipleRegistersRequest(address=first, registers=values, dev_id=UNIT),
        ReadWriteMultipleRegistersRequest(
            read_address=first, read_count=2, write_address=first + 2,
            write_registers=values[:1], dev_id=UNIT,
        ),
        ReadHoldingRegistersRequest(address=first, count=3, dev_id=UNIT),
        WriteSingleRegisterRequest(address=first - 1, registers=values[1:], dev_id=UNIT),
    )  # fmt: skip

    assert (written.address, written.count) == (first, 2)
    assert both.registers == values
    assert read.registers == [*values, values[0]]
    assert (one.address, one.registers) == (first - 1, values[1:])


def test_another_master_learns_what_the_unit_is() -> None:
    [everything] = ask(ReadDeviceInformationRequest(read_code=1, object_id=0, dev_id=UNIT))

    assert isinstance(everything, ReadDeviceInformationResponse)
    assert everything.information == {0: b"open firmware", 1: b"POS4", 2: b"01.00"}
