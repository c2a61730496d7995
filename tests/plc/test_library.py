"""The ST library has the blocks that are agreed on, and the numbers of the registers."""

from __future__ import annotations

import re

import pytest
from blark.parse import parse_source_code
from checks import plc, registers
from st_program import Blocks
from st_values import Unsuitable

EXECUTE = {"Execute": "BOOL"}
ENABLE = {"Enable": "BOOL"}
ERROR = {"Error": "BOOL", "ErrorID": "UINT"}
WORK = {"Busy": "BOOL", "Done": "BOOL", **ERROR}
MC = {**WORK, "CommandAborted": "BOOL"}
READ = {"Valid": "BOOL", "Busy": "BOOL", **ERROR}
STATUS = ["Jede", "Smer", "Pol", "Disp", "Prog", "Err"]
STATES = [
    "ErrorStop", "Disabled", "Stopping", "Homing", "Standstill", "DiscreteMotion",
    "ContinuousMotion", "SynchronizedMotion",
]  # fmt: skip
MOVE = {"Velocity": "LREAL", "Acceleration": "LREAL"}

# Of each block, its inputs and its outputs.
AGREED: dict[str, tuple[dict[str, str], dict[str, str]]] = {
    "POS_INIT": ({**EXECUTE, "Space": "UINT"}, WORK),
    "POS_RESET": (EXECUTE, WORK),
    "POS_MODE": ({**EXECUTE, "Way": "DINT", "Accel": "UINT"}, WORK),
    "POS_CONTROL": (
        {"Feed": "UDINT", "Mp": "BOOL", "Nil": "BOOL"},
        {**dict.fromkeys(STATUS, "BOOL"), "ErrorID": "UINT"},
    ),
    "MC_Power": (ENABLE, {"Status": "BOOL", "Busy": "BOOL", **ERROR}),
    "MC_MoveRelative": ({**EXECUTE, "Distance": "LREAL", **MOVE}, MC),
    "MC_MoveAbsolute": ({**EXECUTE, "Position": "LREAL", **MOVE}, MC),
    "MC_Halt": (EXECUTE, MC),
    "MC_Stop": (EXECUTE, MC),
    "MC_Home": (
        {**EXECUTE, "Position": "LREAL", "Acceleration": "LREAL", "HomingMethod": "UINT"},
        MC,
    ),
    "MC_SetPosition": ({**EXECUTE, "Position": "LREAL"}, MC),
    "MC_TouchProbe": (EXECUTE, {**MC, "RecordedPosition": "LREAL"}),
    "MC_SetOverride": (
        {**ENABLE, "VelFactor": "LREAL"},
        {"Enabled": "BOOL", "Busy": "BOOL", **ERROR},
    ),
    "MC_ReadStatus": (ENABLE, {**READ, **dict.fromkeys(STATES, "BOOL")}),
    "MC_ReadActualPosition": (ENABLE, {**READ, "Position": "LREAL"}),
    "MC_ReadAxisError": (ENABLE, {**READ, "AxisErrorID": "UINT"}),
    "MC_Reset": (EXECUTE, MC),
}
DEFAULTS = {
    ("POS_INIT", "Space"): 0, ("POS_CONTROL", "Mp"): True, ("POS_CONTROL", "Nil"): False,
    ("MC_Home", "HomingMethod"): 21, ("MC_SetOverride", "VelFactor"): 1.0,
}  # fmt: skip
BIT_OF_FIRMWARE = re.compile(r"^    POS_(?:STV|FLAG)_(\w+) = (\d+),", re.MULTILINE)
FIRST_BYTE = ("JEDE", "SMER", "POL")
TEXT = registers.TABLE.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", AGREED)
def test_a_block_has_the_inputs_and_outputs_that_are_agreed_on(name, plc_blocks) -> None:
    signature = plc_blocks.signature(name)
    inputs, outputs = AGREED[name]
    assert signature["inputs"] == inputs
    assert signature["outputs"] == outputs
    assert signature["in-outs"] == {"Axis": "POS_AXIS"}


@pytest.mark.parametrize(("block", "name"), DEFAULTS)
def test_an_input_that_is_left_out_has_its_default(block, name, plc_blocks) -> None:
    assert plc_blocks.make(block)[name] == DEFAULTS[block, name]


def test_there_are_no_other_blocks_for_programs(plc_blocks) -> None:
    inside = {name for name in plc_blocks.declared if "Inside the library" in comment(name)}
    others = {"POS_AXIS", "POS_JOINED", "POS_SCALED", "EXAMPLE_1", "EXAMPLE_2"}
    assert set(plc_blocks.declared) - inside - others == {name.upper() for name in AGREED}


def comment(name: str) -> str:
    """What stands before a block."""
    library = plc.LIBRARY.read_text(encoding="utf-8")
    match = re.search(rf"(\(\*[^*]*\*\))\nFUNCTION(_BLOCK)? {name}\b", library, re.IGNORECASE)
    return match[1] if match else ""


def test_an_axis_is_as_long_as_its_registers(plc_blocks) -> None:
    axis = plc_blocks.make("POS_AXIS")
    rows = [row for row in registers.read_registers(TEXT) if row.scope == "A"]
    written = max(r.number + r.words for r in rows if r.number < plc.IN_FIRST)
    read = max(r.number + r.words for r in rows if r.use == "READ") - plc.IN_FIRST
    assert (len(axis["Out"]), len(axis["In"])) == (written, read)


def test_the_constants_and_requests_are_those_of_the_firmware() -> None:
    assert plc.main([]) == 0


def test_the_program_for_openplc_is_parsed() -> None:
    program = plc.OPENPLC.read_text(encoding="utf-8").partition("\nCONFIGURATION ")[0]
    assert parse_source_code(program).exception is None


def test_a_register_that_has_moved_is_seen(monkeypatch, capsys, tmp_path) -> None:
    table = tmp_path / "registers.def"
    table.write_text(TEXT.replace("A(DONE, 12,", "A(DONE, 28,"), encoding="utf-8")
    monkeypatch.setattr(registers, "TABLE", table)
    assert plc.main([]) == 1
    assert "run checks.plc --update" in capsys.readouterr().out


def test_a_constant_that_is_not_there_is_told() -> None:
    with pytest.raises(SystemExit, match=r"has no in 'SPEED_OF_LIGHT'"):
        plc.renewed_library("(* made: in SPEED_OF_LIGHT *)\n(* end *)\n", TEXT)


def test_the_document_has_the_codes_and_bits_of_the_table() -> None:
    document = registers.DOCUMENT.read_text(encoding="utf-8")
    for name, code in plc.read_instructions(TEXT).items():
        assert f"| {code} | {name} |" in document
    for name, (register, bit) in plc.read_bits(TEXT).items():
        if register == "STATUS":
            assert f"| {1 << bit:04X}h | {name}: " in document


def test_the_codes_and_bits_are_those_that_the_firmware_uses() -> None:
    folder = registers.TABLE.parents[1]
    line = (folder / "positioning_line.c").read_text(encoding="utf-8")
    records = (folder / "axis/pos_records.h").read_text(encoding="utf-8")
    codes = re.findall(r"^    CODE_(\w+),$", line, re.MULTILINE)
    assert {f"POS_{name}": code for code, name in enumerate(codes) if code} == (
        plc.read_instructions(TEXT)
    )
    firmware = {name: int(value) for name, value in BIT_OF_FIRMWARE.findall(records)}
    for name, (register, bit) in plc.read_bits(TEXT).items():
        value = firmware[name] << 8 if name in FIRST_BYTE else firmware[name]
        assert value == 1 << bit, (register, name)


def test_no_constant_of_the_library_goes_unused() -> None:
    library = plc.LIBRARY.read_text(encoding="utf-8")
    for block in re.split(r"^END_FUNCTION_BLOCK$", library, flags=re.MULTILINE):
        for name in re.findall(r"^  ((?:IN|OUT|DO|BIT)_\w+) :", block, re.MULTILINE):
            assert len(re.findall(rf"\b{name}\b", block)) > 1, name


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("A := B;", "B is not declared"),
        ("A := 1.5;", "LREAL instead of UINT"),
        ("A := A + C;", r"UINT \+ WORD"),
        ("A := 70000;", "does not fit UINT"),
        ("IF A THEN A := 1; END_IF;", "UINT instead of BOOL"),
        ("A := 65535; A := A + 1;", "65536 does not fit UINT"),
        ("WHILE A < 3 DO A := A + 1; END_WHILE;", "WhileStatement"),
    ],
)
def test_text_that_a_compiler_would_refuse_is_refused(text, complaint) -> None:
    source = f"FUNCTION_BLOCK X VAR A : UINT; C : WORD; END_VAR {text} END_FUNCTION_BLOCK"
    with pytest.raises(Unsuitable, match=complaint):
        Blocks(source).make("X").run()
