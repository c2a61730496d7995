"""What the manuals forbid ends the run with a complaint; what stands beside it is let pass."""

from __future__ import annotations

import struct

import pytest

RESERVED = "bits that are reserved"

FORBIDDEN = {
    1: "register of 32 bits, which must be written by words (RM0090 18.4)",
    4: f"(TIM3+34): it sets {RESERVED}",
    5: f"(TIM2+14): it sets {RESERVED}",
    6: "CCxNP must be kept cleared for an output (RM0090 18.4.9)",
    8: "a byte access",
    9: f"(SYSCFG+08): it sets {RESERVED}",
    10: f"(GPIOA+14): it sets {RESERVED}",
    11: "GPIOA_PUPDR: 3 is no pull (RM0090 8.4.4)",
    20: "accessed by words (PM0214 4.3, 4.4, 4.5)",
    22: f"e000e41c: it sets {RESERVED}",
    23: f"e000e108: it sets {RESERVED}",
    25: f"e000ed08: it sets {RESERVED}",
    26: "written without its key, and lost (PM0214 4.4.5)",
    28: "set and cleared at once (PM0214 4.4.3)",
    30: f"e000ed23: it sets {RESERVED}",
    31: f"e000e014: it sets {RESERVED}",
    32: "e000ef00: no register of the core that is modelled and can be written",
    33: "BASEPRI is 18: four bits of a priority are implemented, the upper ones (PM0214 2.1.3)",
    34: "accessed by words (PM0214 4.3, 4.4, 4.5)",  # not aligned: two halves
    35: f"e000ed0c: it sets {RESERVED}",
    40: "a cache is reset while it is on (RM0090 3.9.1)",
    41: "a cache is reset while it is on (RM0090 3.9.1)",
    43: f"(FLASH+00): it sets {RESERVED}",
    44: "a setting is written without the key, and lost (RM0090 21.3.2)",
    45: "1234 is no key (RM0090 21.4.1)",
    46: "the one before is not taken over (RM0090 21.4.2, 21.4.3)",
    47: "the one before is not taken over (RM0090 21.4.2, 21.4.3)",
    49: "a setting is written without the key, and lost (RM0090 21.3.2)",
    50: "BRR is changed while a character is sent (RM0090 30.3.4)",
    51: "switched off in a character (RM0090 30.3.2)",
    52: "switched off in a character (RM0090 30.3.2)",
    54: "BRR 000f is no rate (RM0090 30.3.4, 30.6.3)",
    55: "BRR 0348 is no rate (RM0090 30.3.4, 30.6.3)",
    56: f"(USART1+0c): it sets {RESERVED}",
    57: f"(USART1+04): it sets {RESERVED}",
}
ALLOWED = [0, 2, 3, 7, 12, 13, 21, 24, 27, 29, 42, 48, 53]


@pytest.fixture
def run_case(run_image):
    """Run one of images/forbidden.c."""
    return lambda number: run_image(
        "forbidden", "--set", f"which={struct.pack('<I', number).hex()}"
    )


@pytest.mark.parametrize("number", FORBIDDEN)
def test_what_the_manuals_forbid_is_told_with_its_place(run_case, number):
    run = run_case(number)

    assert run.status == 1
    assert FORBIDDEN[number] in run.told
    assert run.told.count("\n") == 1
    assert "(pc 08" in run.told


@pytest.mark.parametrize("number", ALLOWED)
def test_what_is_allowed_beside_it_passes_without_a_word(run_case, number):
    run = run_case(number)

    assert run.result[0] == 1
    assert run.told == ""
