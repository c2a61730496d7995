"""Bad input on the line of a GVE134 unit, every kind of it, beside the model of its contract.

After each bad line the host goes on: what is asked then tells whether the unit has stayed in step
and whether something was done in part.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import pytest
from gve_course import MS
from gve_model import compare
from gve_probe import Probe
from gve_sessions import Writer
from gve_words import STEPS_MAX, with_sum

REQUEST_WORDS = """
L10,-5 L3 C5,5,5,5 T5 $512 A50 V10000 B5000 VK VN VL25000,25000,30000,10000 VJ500,500,200,0 XA XU
XD XM200 P PF P4 PL N NX100 N WY-20,1000,20,500 H G D K R SR2 SR6 SW0,1A SW6,00 F I1 I2 O0,FB ER05
EUR10 EFR10 EW20,09 EUW10,3FC00000 EFW10,1.5 @ > ? Q *S *E0 %+ %- J
"""
REQUESTS = REQUEST_WORDS.split()
PACKET = ("*S", "C6,3,0,0", "B500", "C2,-2,1,0", "*E3")
VALUES = "\0\x01\x7f\x80\xff!\n\r,- 0z"
"""What a byte is turned into: also NUL, eight bits, and what the line itself is made of."""

DAMAGE_MS, SILENCE_MS = 130, 1250


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    with Probe() as running:
        yield running


class Host(Writer):
    """A host that sends one line after the other, with sums or without."""

    def __init__(self, sums: bool = False) -> None:
        super().__init__("bad lines")
        self.tick = 150 * MS
        if sums:
            self.send("!0%+\r")
            self.pause(3)
        self.sums = sums

    def right(self, text: str) -> str:
        """A request as it is right."""
        return (with_sum(f"!{text}") if self.sums else f"!{text}") + "\r"

    def ask(self, *texts: str) -> None:
        """Send lines that are right, each when the answer to the one before has come."""
        for text in texts:
            self.send(self.right(text))
            self.pause(4)

    def look(self) -> None:
        """See what there is, when what was damaged is over and what moves stands."""
        self.pause(DAMAGE_MS)
        self.ask("0SR6", "0P4")

    def begin_anew(self) -> None:
        """The unit is reset; what it had before does not count."""
        self.ask("0J")
        self.pause(DAMAGE_MS)
        if self.sums:
            self.send("!0%+\r")
            self.pause(3)

    def held(self, probe: Probe) -> int:
        """Hold what the unit does against the model; return how often it has answered."""
        session = self.written()
        done = probe.run(session)
        compare(session, done)
        return len(done.answers)


def settle(host: Host) -> None:
    """Leave a state that the next line begins from, whatever has been done."""
    host.look()
    host.begin_anew()


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("text", REQUESTS)
def test_each_command_that_is_cut_off_anywhere_is_damage(
    probe: Probe, text: str, sums: bool
) -> None:
    """By silence, and by the next line."""
    host = Host(sums)
    whole = host.right(f"0{text}")
    for end in range(1, len(whole)):
        for silent in (True, False):
            host.send(whole[:end])
            host.pause(SILENCE_MS if silent else 0)
            host.ask("0V777")
            host.look()
    host.held(probe)


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("text", REQUESTS)
def test_a_byte_that_is_another_one_or_broken_is_told(probe: Probe, text: str, sums: bool) -> None:
    host = Host(sums)
    whole = host.right(f"0{text}")
    for place in range(len(whole)):
        for value in VALUES:
            host.send(whole[:place] + value + whole[place + 1 :])
            settle(host)
        host.send(whole, broken=place)
        settle(host)
    host.held(probe)


def test_every_byte_in_a_name_and_in_a_number_is_told(probe: Probe) -> None:
    host = Host()
    for value in range(256):
        for text in ("!0{}10\r", "!0V1{}0\r", "!{}V10\r", "{}!0V10\r"):
            host.send(text.format(chr(value)))
            host.look()
    assert host.held(probe) > 3 * 256 * 3


def test_every_wrong_sum_is_damage(probe: Probe) -> None:
    host = Host(sums=True)
    right = host.right("0V123")
    for value in range(256):
        host.send(f"!0V123,{value:02X}\r")
        host.look()
    for wrong in ("", ",", ",5", ",055", ",G5", ",5G", ",-5", ", 5", ",,", right[-3:-1]):
        host.send(f"!0V124{wrong}\r")
        host.look()
    host.held(probe)


@pytest.mark.parametrize("sums", [False, True])
def test_a_packet_with_any_wrong_number_is_not_taken(probe: Probe, sums: bool) -> None:
    host = Host(sums)
    for number in (*range(129), 129, 200, 999999999999, -1, -3, "003", "", "x", "3,0", "3 "):
        for text in (*PACKET[:-1], f"*E{number}"):
            host.send(host.right(f"0{text}"))
        settle(host)
    host.held(probe)


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("place", range(1, len(PACKET)))
def test_no_other_command_is_executed_in_a_packet(probe: Probe, place: int, sums: bool) -> None:
    host = Host(sums)
    others = [f"0{text}" for text in (*REQUESTS, "Z", "", "L", "C1,x", "B9", "C2147483648", "*E")]
    for other in (*others, "7V300", "7?", "7J", "7C1", "7*E3", "1V500"):
        for text in PACKET[:place]:
            host.send(host.right(f"0{text}"))
        host.send(host.right(other))
        host.pause(DAMAGE_MS if "J" in other else 0)
        host.sums = sums and "J" not in other
        for text in PACKET[place:]:
            host.send(host.right(f"0{text}"))
        host.look()
        host.ask("0J")
        host.pause(DAMAGE_MS)
        if sums:
            host.send("!0%+\r")
            host.pause(3)
        host.sums = sums
    host.held(probe)


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("harm", ["broken", "\0", "\xff", "!", "\r", "lost", "dies"])
def test_a_packet_that_comes_to_harm_at_any_byte_is_not_taken(
    probe: Probe, harm: str, sums: bool
) -> None:
    """Noise, a byte that is lost, or a host that dies there, and comes back later."""
    host = Host(sums)
    whole = "".join(host.right(f"0{text}") for text in PACKET)
    for place in range(len(whole)):
        before, after = whole[:place], whole[place + 1 :]
        if harm == "broken":
            host.send(whole, broken=place)
        elif harm == "dies":
            host.send(before)
            host.pause(SILENCE_MS)
        else:
            host.send(before + ("" if harm == "lost" else harm) + after)
            host.pause(SILENCE_MS)
        settle(host)
    host.held(probe)


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("length", [78, 79, 80, 81, 82, 127, 128, 255, 256, 257, 1000, 40000])
def test_a_line_that_is_too_long_is_told(probe: Probe, length: int, sums: bool) -> None:
    """So many characters between the ! and the CR, of all kinds; alone, and in a packet."""
    host = Host(sums)
    sum_length = 3 if sums else 0
    texts = [f"0{name}{{}}5" for name in ("V", "P", "Z", "L1,")] + ["3V{}5", "{}"]
    for text in texts if length < 40000 else texts[:1]:
        filler = "0" * (length - len(text.format("")) - sum_length)
        for begin, end in (((), ()), (("*S", "C1,2,3,4"), ("*E2",))):
            for each in begin:
                host.send(host.right(f"0{each}"))
            host.send(host.right(text.format(filler)))
            for each in end:
                host.send(host.right(f"0{each}"))
            settle(host)
    host.held(probe)


LIMITS: dict[str, tuple[tuple[int, int], ...]] = {
    "L": ((-STEPS_MAX, STEPS_MAX),) * 4,
    "C": ((-STEPS_MAX, STEPS_MAX),) * 4,
    "T": ((1, 24),),
    "$": ((1, STEPS_MAX),),
    "A": ((1, 8000),),
    "V": ((10, 200_000),),
    "B": ((10, 200_000),),
    "VL": ((10, 200_000),) * 4,
    "VJ": ((0, 200_000),) * 4,
    "XM": ((1, 1000),),
    "NX,": ((-STEPS_MAX, STEPS_MAX),),
    "WX,": ((-STEPS_MAX, STEPS_MAX), (10, 200_000), (1, STEPS_MAX), (10, 200_000)),
    "SR": ((0, 7),),
    "SW": ((0, 6), (0, 0xFF)),
    "O": ((0, 0), (0, 0xFF)),
    "ER": ((0, 0xFF),),
    "EUR": ((0, 0xFC),),
    "EFR": ((0, 0xFC),),
    "EW": ((0, 0xFF), (0, 0xFF)),
    "EUW": ((0, 0xFC), (0, 0xFFFFFFFF)),
    "*E": ((0, 128),),
    "7V": ((0, 1000),),
}
HEXADECIMAL = ("ER", "EUR", "EFR", "EW", "EUW")
"""All of their numbers; of SW and O the last one."""


def written(name: str, place: int, number: int) -> str:
    """A number as a parameter of a command."""
    in_hex = name in HEXADECIMAL or (name in ("SW", "O") and place == 1)
    return f"{number:X}" if in_hex and number >= 0 else str(number)


def numbers_at(name: str, place: int, low: int, high: int) -> Iterable[str]:
    """The limits, one past each, and what is no number or none of 32 bits."""
    near = (low - 1, low, low + 1, high - 1, high, high + 1)
    far = (2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**32 + low, 2**63, 2**64, 2**64 + low, 10**40)
    yield from (written(name, place, number) for number in (*near, *far, *(-each for each in far)))
    yield from ("", "-", "+1", "--1", "1-", "0x1", "1.0", "-0", f"000{written(name, place, high)}")


@pytest.mark.parametrize("name", LIMITS)
def test_every_number_at_its_limits_and_past_them_has_its_code(probe: Probe, name: str) -> None:
    host = Host()
    limits = LIMITS[name]
    address = "" if name == "7V" else "0"
    for place, (low, high) in enumerate(limits):
        right = [written(name, at, max(least, 0)) for at, (least, _) in enumerate(limits)]
        for number in numbers_at(name, place, low, high):
            text = ",".join((*right[:place], number, *right[place + 1 :]))
            host.ask("0V200", f"{address}{name}{text}", "0SR6", "0J")
            host.pause(DAMAGE_MS)
    host.held(probe)


@pytest.mark.parametrize("sums", [False, True])
@pytest.mark.parametrize("turn", range(12))
def test_commands_that_are_sent_without_waiting_are_executed_in_order(
    probe: Probe, turn: int, sums: bool
) -> None:
    """What waits never comes to 256 bytes."""
    host = Host(sums)
    host.rng.seed(turn)
    texts = [text for text in REQUESTS if text[0] not in "W%J*"]
    for _ in range(30):
        for text in host.rng.sample(texts, 8):
            host.send(host.right(host.rng.choice("00000007") + text))
        host.pause(400)
    host.look()
    host.held(probe)
