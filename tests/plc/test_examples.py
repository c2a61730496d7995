"""The two examples of the manual, as they stand in the library."""

from __future__ import annotations

from pathlib import Path

import pytest
from checks.plc import DOCUMENT, LIBRARY
from fake_positioning import CODES
from plc_cycle import Plc
from st_program import Blocks, Instance

UNIT_PAGE = Path(__file__).resolve().parents[2] / "firmware/positioning/docs/unit.md"

INIT, MODE, RESET = CODES["POS_INIT"], CODES["POS_MODE"], CODES["POS_RESET"]
FEED = 3000 << 16  # 50 mm/s
DECLARATIONS = """
VAR_EXTERNAL AXIS_1 : POS_AXIS; END_VAR
VAR
  Released, Button : BOOL;
  Start : R_TRIG;
  Fault : UINT;
  Power : MC_Power;
  Motion : MC_MoveRelative;
  Stop : MC_Stop;
END_VAR
"""


@pytest.fixture(params=[False, True], ids=["FC 23", "FC 16 and FC 3"])
def plc(request, make_plc) -> Plc:
    made: Plc = make_plc(split=request.param, jitter=3)
    made.until(lambda: made.axes[0]["Online"])
    return made


def begin_first(plc: Plc, draha: int) -> None:
    program = plc.add(
        "EXAMPLE_1", AXIS_4=plc.axes[3], POV_I=True,
        zelana_draha=draha, zelana_strmost=500, zelana_rychlost=FEED,
    )  # fmt: skip
    program["POSUN"] = True
    plc.run(1)


@pytest.mark.parametrize("draha", [10000, -2500, 0])
def test_the_first_example_moves_axis_4_and_clears_posun(draha, plc) -> None:
    begin_first(plc, draha)
    program, axis = plc.called[0], plc.unit.axes[3]
    plc.until(lambda: not program["POSUN"])
    assert axis.position == draha
    assert axis.executed == [INIT, MODE, RESET]
    assert not axis.has("DISP")
    plc.run(5)
    program["POSUN"] = True
    plc.run(1)
    plc.until(lambda: not program["POSUN"])
    assert axis.position == 2 * draha
    assert axis.executed == [INIT, MODE, RESET] * 2


def test_the_first_example_is_held_while_pov_i_is_false(plc) -> None:
    begin_first(plc, 50000)
    program, axis = plc.called[0], plc.unit.axes[3]
    plc.until(lambda: axis.position > 10000)
    program["POV_I"] = False
    plc.run(60)
    held = axis.position
    plc.run(60)
    assert axis.position == held < 50000
    assert program["POSUN"]
    program["POV_I"] = True
    plc.until(lambda: not program["POSUN"])
    assert axis.position == 50000


def test_the_first_example_changes_its_speed_under_way(plc) -> None:
    begin_first(plc, 50000)
    program, axis = plc.called[0], plc.unit.axes[3]
    plc.until(lambda: axis.speed > 49.9)
    program["zelana_rychlost"] = FEED // 5
    plc.until(lambda: axis.speed < 10.1)
    plc.until(lambda: not program["POSUN"])
    assert axis.position == 50000


def begin_second(plc: Plc) -> None:
    program = plc.add(
        "EXAMPLE_2", AXIS_X=plc.axes[0], ZRYCH_X=500, aktualni_rychlost=FEED,
    )  # fmt: skip
    program["LIMIT_C"] = True
    plc.run(1)


def test_the_second_example_goes_as_long_as_the_button_is_held(plc) -> None:
    begin_second(plc)
    program, axis = plc.called[0], plc.unit.axes[0]
    plc.until(lambda: axis.position > 20000)
    program["LIMIT_C"] = False
    plc.until(lambda: not program["MECH_POHYB_X"])
    assert not axis.has("JEDE")
    assert not axis.has("DISP")
    assert axis.executed == [INIT, MODE, RESET]
    stood = axis.position
    plc.run(50)
    assert axis.position == stood
    assert 20000 < stood < 30000
    program["LIMIT_C"] = True
    plc.until(lambda: axis.position > stood + 1000)


def test_the_second_example_ends_at_60_m(plc) -> None:
    begin_second(plc)
    program, axis = plc.called[0], plc.unit.axes[0]
    plc.until(lambda: axis.position > 1000)
    axis.position = 59990000.0
    plc.until(lambda: not program["MECH_POHYB_X"])
    assert axis.position == 60000000
    plc.run(50)
    assert axis.executed == [INIT, MODE, RESET]


@pytest.mark.parametrize("cycles", [1, 2, 3, 4, 5, 6, 8])
def test_a_button_that_is_let_go_at_once_leaves_nothing_moving(cycles, plc) -> None:
    begin_second(plc)
    program, axis = plc.called[0], plc.unit.axes[0]
    plc.run(cycles)
    program["LIMIT_C"] = False
    plc.until(lambda: not program["MECH_POHYB_X"])
    assert not axis.has("JEDE")
    assert axis.executed[-1] == RESET


def documented(document: Path) -> str:
    """The first program in Structured Text of a document."""
    text = document.read_text(encoding="utf-8")
    return text.partition("```iecst\n")[2].partition("```")[0]


def begin_documented(plc: Plc, program: str, name: str, **inputs: bool) -> Instance:
    plc.blocks = Blocks(LIBRARY.read_text(encoding="utf-8"), program)
    plc.restart()
    main = plc.add(name, AXIS_1=plc.axes[0], **inputs)
    plc.run(10)
    main["Button"] = True
    return main


def press(plc: Plc, main: Instance) -> None:
    """Lets the button go, and presses it."""
    for level in (False, True):
        main["Button"] = level
        plc.run(5)


def lose_the_line_for_a_while(plc: Plc) -> None:
    plc.cut = True
    plc.until(lambda: not plc.axes[0]["Online"])
    plc.cut = False
    plc.run(400)
    assert plc.axes[0]["Online"]


def test_the_first_move_of_the_unit_s_page_moves(make_plc) -> None:
    program = documented(UNIT_PAGE)
    assert program.count("\n") <= 10
    plc = make_plc()
    main = begin_documented(plc, program, "FIRST_MOVE")
    plc.until(lambda: main["Motion"]["Done"])
    lose_the_line_for_a_while(plc)
    for position in (10000, 20000):
        assert plc.unit.axes[0].position == position
        press(plc, main)
        plc.until(lambda: main["Motion"]["Done"])


def test_the_program_of_the_document_moves_an_axis(make_plc) -> None:
    program = f"PROGRAM DOCUMENTED {DECLARATIONS} {documented(DOCUMENT)} END_PROGRAM"
    plc = make_plc()
    main = begin_documented(plc, program, "DOCUMENTED")
    assert plc.axes[0]["Online"]
    main["Released"] = True
    plc.until(lambda: main["Power"]["Status"])
    plc.run(100)
    assert plc.unit.axes[0].position == 0
    press(plc, main)
    plc.until(lambda: main["Motion"]["Done"])
    lose_the_line_for_a_while(plc)
    assert plc.unit.axes[0].position == 12500
    press(plc, main)
    plc.until(lambda: plc.unit.axes[0].position > 15000)
    main["Released"] = False
    plc.until(lambda: main["Stop"]["Done"])
    assert plc.unit.axes[0].position < 25000
    assert main["Motion"]["CommandAborted"] or not main["Motion"]["Busy"]
