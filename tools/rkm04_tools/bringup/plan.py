"""The steps, in the order in which a new board is tried."""

from __future__ import annotations

from rkm04_tools.bringup import deeds, part, pulses, together, wires
from rkm04_tools.bringup.step import Step

SAFETY = """\
This program asks the bring-up image of a board what it finds, and has it switch pins, one at a
time. Each step says first what to connect and what will happen; it does so when you say so.

  - Motors unpowered, best disconnected. Nothing at the outputs but lamps or a meter.
  - The bring-up image flashed: tools/rkm04 board flash --board {board} --image bringup
  - The line connected: a serial adapter or a transceiver, as the board's page says.

Nothing has been sent yet."""

ONE_BY_ONE = "A lamp or a meter at each. They go on one after the other, until you answer."

STEPS = (
    Step("line", "Power on. The image is asked for its name.",
         "it answers", part.look_at_line),
    Step("part", "Nothing to do: the part tells what it is. Option bytes are read only.",
         "an STM32F405 or F407 with 1 MB of flash", part.look_at_part),
    Step("start", "Nothing to do: why the part has started.",
         "power-on or reset pin", part.look_at_start),
    Step("clocks", "Nothing to do: what drives the processor, and the watchdog; 5 s.",
         "the crystal, by the PLL, 168 MHz", part.look_at_clocks),
    Step("supply", "Nothing to do: the part measures its supply by its own reference.",
         "3.3 V", part.look_at_supply),
    Step("inputs",
         "Set each input to 1 and back to 0, one after the other, in any order (by a switch or\n"
         "jumper, see the board's page). It ends when all have been, or nothing new comes.",
         "each goes to 1 and back, alone", wires.look_at_inputs),
    Step("address switch",
         "Set switch S1 as you like; it was read when you see the address. A contact is tried\n"
         "when it was seen open and closed, so all open and all closed: r, once more.",
         "its address", wires.look_at_switch),
    Step("outputs", f"{ONE_BY_ONE}\nFirst BO_1.", "each on alone", wires.walk("BO")),
    Step("LEDs", f"{ONE_BY_ONE}\nFirst LED_1.", "each on alone", wires.walk("LED")),
    Step("directions", f"The DIR pins, motors still unpowered.\n{ONE_BY_ONE}\nFirst DIR_1.",
         "each on alone", wires.walk("DIR")),
    Step("enables",
         "The ENABLE pins: a driver that is on lets current through a motor, so motors and their\n"
         f"supply still off.\n{ONE_BY_ONE}\n"
         "A wire from one to an input or to CAPTURE shows it as well. The first is EN_1 or EN_ALL.",
         "each on alone", wires.walk("EN")),
    Step("pulses",
         "The STEP pins, one after the other: you lead a wire from it to CAPTURE, and a second\n"
         "timer measures 16 pulses, 60 to 135 us apart. Where none comes, the other STEP pins get\n"
         "pulses, and outputs, LEDs, DIR and ENABLE go on one by one, to see where the wire leads.",
         "all pulses, on their ticks, as wide as the board says", pulses.measure),
    Step("all motors",
         "Motors still unpowered, nothing to connect: 200 short bursts of the narrowest pulses at\n"
         "all STEP pins at once. Nothing is measured there: the driver counts what it makes.",
         "each edge in time", together.try_together),
    Step("interrupts", "Nothing to do: how long the interrupts have taken, in cycles.",
         "they come", wires.look_at_cycles),
    Step("watchdog", "The image hangs on purpose; the watchdog must reset the part.",
         "it starts again in a second or so, and tells the watchdog", deeds.try_watchdog),
    Step("stack guard", "The image lets its stack overflow; the handler of faults must reset it.",
         "it starts again at once, and tells a fault", deeds.try_stack),
)  # fmt: skip
