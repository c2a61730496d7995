"""Checks a board's pins: each used once, on its package, and able to do what it is used for; and
that the tools read its header as the compiler does, which checks what the values are.

    python -m checks.board_pins hal/stm32/boards/NAME/board.h

The table of functions is that of ST's datasheet DS8626 (STM32F405xx, STM32F407xx), table 9; that of
packages its table 7.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

from rkm04_tools.board_form import form_errors
from rkm04_tools.board_header import Board, Pin, read_board

# Which pins can be a channel of a timer of 32 bits (alternate functions 1 and 2) or the line (7).
# Channel 4 of TIM2 calls the step interrupt.
TIMER_CHANNELS = {
    "TIM2_CH1": {"A0", "A5", "A15"},
    "TIM2_CH2": {"A1", "B3"},
    "TIM2_CH3": {"A2", "B10"},
    "TIM5_CH1": {"A0"},
    "TIM5_CH2": {"A1"},
    "TIM5_CH3": {"A2"},
    "TIM5_CH4": {"A3"},
}
# Those of the timer that turns DIR (2).
TURN_CHANNELS = {
    "TIM3_CH1": {"A6", "B4", "C6"},
    "TIM3_CH2": {"A7", "B5", "C7"},
    "TIM3_CH3": {"B0", "C8"},
    "TIM3_CH4": {"B1", "C9"},
}
# And of the one that makes the PWM (2).
PWM_CHANNELS = {
    "TIM4_CH1": {"B6", "D12"},
    "TIM4_CH2": {"B7", "D13"},
    "TIM4_CH3": {"B8", "D14"},
    "TIM4_CH4": {"B9", "D15"},
}
# And those of the timers with which the bring-up image captures pulses (1 and 2).
CAPTURE_CHANNELS = {"TIM1_CH1": {"A8", "E9"}, "TIM4_CH1": {"B6", "D12"}}
CHANNELS = {
    "STEP": TIMER_CHANNELS, "DIR": TURN_CHANNELS, "PWM": PWM_CHANNELS, "CAPTURE": CAPTURE_CHANNELS,
}  # fmt: skip
BY_CLASS = {"STEP": "GPIO", "DIR": "OUT"}
LINE_PINS = {
    "USART1": {"TX": {"A9", "B6"}, "RX": {"A10", "B7"}},
    "USART2": {"TX": {"A2", "D5"}, "RX": {"A3", "D6"}},
    "USART3": {"TX": {"B10", "C10", "D8"}, "RX": {"B11", "C11", "D9"}},
}

PORT_A_TO_C = {f"{port}{pin}" for port in "ABC" for pin in range(16)}
PORT_A_TO_G = {f"{port}{pin}" for port in "ABCDEFG" for pin in range(16)}
PACKAGES = {
    "LQFP64": PORT_A_TO_C | {"D2"},
    "LQFP100": PORT_A_TO_C | {f"{port}{pin}" for port in "DE" for pin in range(16)},
    "LQFP144": PORT_A_TO_G,
}
DEBUG = {"A13": "SWDIO", "A14": "SWCLK"}

SIGNALS = [
    *(f"{name}_{i}" for name in ("STEP", "DIR", "LED", "S1") for i in range(1, 5)),
    *(f"{name}_{i}" for name in ("BI", "BO") for i in range(1, 9)),
    *("LINE_DE", "LINE_TX", "LINE_RX"),
]
MAY_BE = {"PWM", "CAPTURE", *(f"LED_{i}" for i in range(5, 9))}
# The bring-up image has no PWM output.
APART = {"PWM", "CAPTURE"}
ENABLES = [["EN_ALL"], [f"EN_{i}" for i in range(1, 5)]]
INPUTS = {"BI", "S1"}

# RM0090 8.3.2: pins of the debug port that are pulled up from a reset on, until the firmware has
# set them up. What must be safe meanwhile cannot be there.
PULLED_UP = {"A15": "JTDI", "B4": "NJTRST"}
SAFE_AT_RESET = {"STEP", "DIR", "BO", "LINE", "PWM"}
# DS8626, output voltage characteristics: fed through the switch of the backup domain. They sink
# 3 mA and must feed nothing, so all that they can do is light an LED that is on at low.
WEAK = {"C13", "C14", "C15"}

LEVEL = re.compile(r"BOARD_(STEP|DIR|ENABLE|BI|BO|LED|S1|PWM)_LEVEL")
NUMBER = re.compile(r"0x[0-9a-fA-F]+|0|[1-9]\d*")


def value_errors(board: Board) -> Iterator[str]:
    """Values that the build takes from the header by itself."""
    for name, value in board.values.items():
        if LEVEL.fullmatch(name) and value not in ("0U", "1U"):
            yield f"{name} must be 0U or 1U, not {value}"
    if not NUMBER.fullmatch(loader := board.values.get("BOARD_LOADER_BYTES", "0")):
        yield f"BOARD_LOADER_BYTES must be a number as 0x8000, not {loader}"


def use_errors(pin: Pin, line: str, step_class: str) -> Iterator[str]:
    """Whether the pin can do what its signal needs."""
    kind, _, which = pin.signal.partition("_")
    channels = CHANNELS.get(kind, {})
    if kind in BY_CLASS and step_class == "2":
        if pin.use != (wanted := BY_CLASS[kind]):
            yield f"{pin.signal} must be {wanted}, as BOARD_STEP_CLASS says, not {pin.use}"
    elif channels:
        if pin.use not in channels:
            yield f"{pin.signal} must be one of {', '.join(channels)}, not {pin.use}"
        elif pin.pin not in channels[pin.use]:
            yield f"P{pin.pin} has no {pin.use}"
    elif pin.signal in ("LINE_TX", "LINE_RX"):
        if line not in LINE_PINS:
            return  # told once, of the board
        if pin.use != line:
            yield f"{pin.signal} must be {line}, as BOARD_USART says, not {pin.use}"
        elif pin.pin not in LINE_PINS[line][which]:
            yield f"P{pin.pin} has no {line}_{which}"
    elif pin.use not in ({"IN", "IN_UP"} if kind in INPUTS else {"OUT"}):
        yield f"{pin.signal} cannot be {pin.use}"


def place_errors(pin: Pin, values: dict[str, str]) -> Iterator[str]:
    """Whether the signal may be there: what the pin does in a reset, and what it can feed."""
    kind, _, _ = pin.signal.partition("_")
    waked = kind == "EN" and values.get("BOARD_ENABLE_LEVEL") == "1U"
    if (kind in SAFE_AT_RESET or waked) and pin.pin in PULLED_UP:
        yield f"{pin.signal}: P{pin.pin} is pulled up at reset as {PULLED_UP[pin.pin]}"
    sinks = kind == "LED" and values.get("BOARD_LED_LEVEL") == "0U"
    if pin.pin in WEAK and pin.use in ("OUT", "GPIO") and not sinks:
        yield f"{pin.signal}: P{pin.pin} must feed nothing (DS8626): no output but an LED on at low"


def enable_errors(names: list[str]) -> Iterator[str]:
    """A board may switch the drivers on: all by one pin, or each by one of its own."""
    found = sorted(name for name in names if name.startswith("EN_"))
    if found and found not in ENABLES:
        yield f"ENABLE is EN_ALL, or EN_1 to EN_4, not {', '.join(found)}"


def channel_errors(pins: list[Pin]) -> Iterator[str]:
    """A channel has one pin; that of the bring-up image may be one that only others have."""
    owners: dict[str, Pin] = {}
    for pin in pins:
        if "_CH" in pin.use and (owner := owners.setdefault(pin.use, pin)) is not pin:
            yield f"{pin.signal} and {owner.signal} are both {pin.use}"


def find_errors(text: str) -> Iterator[str]:
    board = read_board(text)
    package = board.values.get("BOARD_PACKAGE", "")
    if package not in PACKAGES:
        yield f"BOARD_PACKAGE must be one of {', '.join(PACKAGES)}"
    step_class = board.values.get("BOARD_STEP_CLASS", "1")
    if step_class not in ("1", "2"):
        yield "BOARD_STEP_CLASS must be 1 or 2"
    line = f"USART{board.values.get('BOARD_USART', '').rstrip('U')}"
    if line not in LINE_PINS:
        yield f"BOARD_USART must be 1, 2 or 3, as the line's driver has {', '.join(LINE_PINS)}"
    yield from form_errors(text)
    yield from value_errors(board)
    names = [pin.signal for pin in board.pins]
    yield from enable_errors(names)
    own = {name for name in names if not name.startswith("EN_")} - MAY_BE
    for name in sorted(own ^ set(SIGNALS)):
        yield f"{name} {'is not a signal' if name in names else 'has no pin'}"
    owners: dict[str, str] = {}
    for pin in board.pins:
        if pin.pin in owners and not {pin.signal, owners[pin.pin]} <= APART:
            yield f"P{pin.pin} is used twice: {owners[pin.pin]} and {pin.signal}"
        owners[pin.pin] = pin.signal
        if pin.pin not in PACKAGES.get(package, {pin.pin}):
            yield f"{pin.signal}: {package} has no P{pin.pin}"
        if occupant := board.taken.get(pin.pin) or DEBUG.get(pin.pin):
            yield f"{pin.signal}: P{pin.pin} belongs to {occupant}"
        yield from place_errors(pin, board.values)
        yield from use_errors(pin, line, step_class)
    yield from channel_errors([pin for pin in board.pins if pin.signal != "CAPTURE"])


def main(arguments: list[str]) -> int:
    (header,) = arguments
    status = 0
    for error in find_errors(Path(header).read_text()):
        print(f"{header}: {error}", file=sys.stderr)
        status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
