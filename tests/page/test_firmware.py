"""The firmware's way into a board: exact commands, and by USB on a model of the chip's loader."""

from __future__ import annotations

import base64
import random
import shlex
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect
from rkm04_tools import board, image_suffix
from service_page import Service, shown

FAKE = Path(__file__).resolve().parents[1] / "support" / "fake_loader.js"
FLASH = 0x0800_0000
SECTOR_10 = 768 * 1024
UNTOUCHED = 0xA5
SEEN = """([address]) => {
    const { memory, left, erased } = window.fakeLoader;
    const kept = memory.slice(address).every((byte) => byte === 0xa5);
    const image = Array.from(memory.slice(0, 131072), (byte) => String.fromCharCode(byte));
    return { image: btoa(image.join("")), kept, left, erased };
}"""


def image_of(size: int, address: int = FLASH) -> bytes:
    """Random bytes with a stack and vectors."""
    start = address + size // 2 | 1
    head = struct.pack("<4I", 0x2000_1180, start, start, start)
    return head + random.Random(size).randbytes(size - len(head))


@pytest.fixture(scope="module")
def usb_page(browser: Browser, service: Service) -> Iterator[Page]:
    """The panel, with a model of the loader at USB."""
    with shown(browser, service.url) as page:
        page.page.add_init_script(FAKE.read_text())
        yield page.page


@pytest.fixture
def panel(usb_page: Page) -> Page:
    usb_page.reload()
    usb_page.locator("#firmware").evaluate("(panel) => (panel.open = true)")
    usb_page.locator("#firmware-board").select_option("weact-f405")
    return usb_page


def choose_file(panel: Page, content: bytes) -> None:
    file = {"name": "rkm04.bin", "mimeType": "application/octet-stream", "buffer": content}
    panel.locator("#firmware-file").set_input_files(file)  # type: ignore[arg-type]


def choose(panel: Page, image: bytes, name: str = "rkm04-weact-f405") -> None:
    choose_file(panel, image_suffix.suffixed(image, name))
    panel.locator("#firmware-confirm").check()
    panel.locator("#firmware-write").click()


def seen_in(panel: Page) -> dict[str, Any]:
    """What has become of the board."""
    seen: dict[str, Any] = panel.evaluate(SEEN, [SECTOR_10])
    return {**seen, "image": base64.b64decode(seen["image"])}


def said(panel: Page, *words: str) -> None:
    for each in words:
        expect(panel.locator("#firmware-said")).to_contain_text(each)


@pytest.mark.parametrize("size", [20, 2048, 41_144, 65_536])
def test_an_image_is_written_read_back_and_started_and_stored_programs_stay(panel, size):
    size -= size % 4
    image = image_of(size)
    choose(panel, image)
    said(panel, "rkm04-weact-f405: written, read back without a difference, and started.")
    panel.wait_for_function("window.fakeLoader.left")
    seen = seen_in(panel)
    assert seen["image"][: len(image)] == image
    assert seen["kept"]
    assert seen["erased"] == list(range(-(-len(image) // 16_384)))


def test_an_image_after_a_loader_of_the_board_leaves_that_alone(panel):
    panel.locator("#firmware-board").select_option("skr-pro-1.2")
    image = image_of(40_000, FLASH + 0x8000)
    choose(panel, image, "rkm04-skr-pro-1.2")
    said(panel, "rkm04-skr-pro-1.2: written")
    seen = seen_in(panel)
    assert seen["image"][0x8000 : 0x8000 + len(image)] == image
    assert set(seen["image"][:0x8000]) == {UNTOUCHED}
    assert seen["erased"] == [2, 3, 4]


def damaged(content: bytes, place: int) -> bytes:
    changed = bytearray(content)
    changed[place] ^= 1
    return bytes(changed)


WHOLE = image_suffix.suffixed(image_of(41_144), "rkm04-weact-f405")


NOT_WHOLE = {
    "empty": b"",
    "text": b"no image",
    "zeros": bytes(5000),
    "without its name": image_of(41_144),
    "a byte short": WHOLE[:-1],
    "half": WHOLE[:20_000],
    "a byte more": WHOLE + b"\0",
    "no first byte": WHOLE[1:],
    "other stack": damaged(WHOLE, 0),
    "other code": damaged(WHOLE, 30_000),
    "other name": damaged(WHOLE, 41_150),
    "other sum": damaged(WHOLE, -1),
    "too long": image_suffix.suffixed(image_of(70_000), "rkm04-weact-f405"),
}


def test_what_is_no_whole_image_is_told_when_it_is_chosen_and_refused(panel):
    for content in NOT_WHOLE.values():
        choose_file(panel, WHOLE)
        expect(panel.locator("#firmware-said")).to_have_text("rkm04-weact-f405, whole.")
        choose_file(panel, content)
        said(panel, "rkm04.bin: no image of this project, or not whole", "nothing was written")
        panel.locator("#firmware-confirm").check()
        panel.locator("#firmware-write").click()
        said(panel, "rkm04.bin: no image of this project, or not whole", "nothing was written")
        assert panel.evaluate("window.fakeLoader.orders") == 0


def test_an_image_of_another_board_is_refused_before_anything_is_asked(panel):
    for name in ("rkm04-f405", "rkm04-skr-pro-1.2", "weact-f405", "rkm04-weact"):
        choose(panel, image_of(41_144), name)
        said(panel, f"this is {name}, no image for WeAct", "nothing was written")
        assert panel.evaluate("window.fakeLoader.orders") == 0


def test_what_a_file_is_is_told_when_it_is_chosen_and_anew_for_another_board(panel):
    choose_file(panel, WHOLE)
    expect(panel.locator("#firmware-said")).to_have_text("rkm04-weact-f405, whole.")
    panel.locator("#firmware-board").select_option("f405")
    said(panel, "this is rkm04-weact-f405, no image for")
    panel.locator("#firmware-board").select_option("weact-f405")
    expect(panel.locator("#firmware-said")).to_have_text("rkm04-weact-f405, whole.")


def test_an_image_of_another_unit_is_written_but_told_as_that_before(panel):
    content = image_suffix.suffixed(image_of(41_144), "gve134-weact-f405")
    choose_file(panel, content)
    said(panel, "gve134-weact-f405, whole. Mind: an image of ANOTHER UNIT")
    panel.locator("#firmware-confirm").check()
    panel.locator("#firmware-write").click()
    said(panel, "gve134-weact-f405: written")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("refuses = true", ["No board was chosen", "nothing was written"]),
        ("name = '@Option Bytes  /0x1FFFC000/01*016 e'", ["not the loader", "Nothing was written"]),
        ("name = '@Internal Flash  /0x08000000/04*016Kg,01*064Kg,03*128Kg'",
         ["512 kB of flash", "Nothing was written"]),
        ("pulled = 30", ["The board was lost", "not whole", "motors unpowered"]),
        ("spoils = 5000", ["differs at 0x8001000", "not whole"]),
        ("denies = 'Unable to claim interface.'",
         ["does not open (Unable to claim interface.)", "another window", "Nothing was written"]),
        ("pulled = 1", ["The board was lost", "Nothing was written"]),
        ("pulled = 3", ["The board was lost", "not whole"]),
        ("pulled = 4", ["The board was lost", "not whole"]),
        ("guarded = true", ["protected against reading", "Nothing was written"]),
    ],
)  # fmt: skip
def test_what_goes_wrong_is_told_with_what_is_in_the_board_then(panel, change, words):
    panel.evaluate(f"() => {{ window.fakeLoader.{change}; }}")
    choose(panel, image_of(41_144))
    said(panel, *words)
    assert not panel.evaluate("window.fakeLoader.left")
    expect(panel.locator("#firmware-write")).to_be_enabled()


def orders_of_a_whole_write(panel: Page, image: bytes) -> int:
    """How many orders it takes, and the panel as before."""
    choose(panel, image)
    said(panel, "written, read back")
    orders: int = panel.evaluate("window.fakeLoader.orders")
    panel.reload()
    panel.locator("#firmware").evaluate("(panel) => (panel.open = true)")
    return orders


@pytest.mark.parametrize(
    ("change", "before"), [("pulled", 2), ("pulled", 3), ("pulled", 4), ("stalls", 1)]
)
def test_an_image_that_is_whole_but_not_known_to_run_is_told_as_that(panel, change, before):
    image = image_of(20_000)
    orders = orders_of_a_whole_write(panel, image)
    panel.evaluate(f"() => {{ window.fakeLoader.{change} = {orders - before}; }}")
    choose(panel, image)
    said(panel, "read back without a difference, but is not known to run", "reset it")
    expect(panel.locator("#firmware-said")).not_to_contain_text("not whole")
    expect(panel.locator("#firmware-write")).to_be_enabled()
    seen = seen_in(panel)
    assert seen["image"][: len(image)] == image


def test_a_loader_that_answers_no_more_is_not_waited_for_without_end(panel):
    panel.evaluate("() => { window.fakeLoader.hangs = 30; }")
    choose(panel, image_of(41_144))
    expect(panel.locator("#firmware-said")).to_contain_text("not whole", timeout=20_000)
    said(panel, "does not come to an end")
    expect(panel.locator("#firmware-write")).to_be_enabled()


def test_a_file_that_was_changed_since_it_was_chosen_is_told(panel):
    panel.evaluate("""() => { Blob.prototype.arrayBuffer = async () => {
        throw new DOMException("The requested file could not be read", "NotReadableError");
    }; }""")
    choose(panel, image_of(41_144))
    said(panel, "rkm04.bin: cannot be read", "choose it again; nothing was written")
    expect(panel.locator("#firmware-write")).to_be_enabled()


def test_a_second_press_begins_no_second_writing(panel):
    panel.evaluate("""() => {
        const { usb } = navigator;
        window.asked = 0;
        const request = usb.requestDevice;
        usb.requestDevice = async (options) => {
            window.asked += 1;
            await new Promise((done) => setTimeout(done, 500));
            return request(options);
        };
    }""")
    choose(panel, image_of(20_000))
    expect(panel.locator("#firmware-write")).to_be_disabled()
    panel.locator("#firmware-form").evaluate("(form) => form.requestSubmit()")
    said(panel, "written, read back")
    assert panel.evaluate("window.asked") == 1


def test_nothing_is_written_before_the_motors_are_said_to_be_unpowered(panel):
    choose_file(panel, WHOLE)
    expect(panel.locator("#firmware-write")).to_be_disabled()
    panel.locator("#firmware-confirm").check()
    expect(panel.locator("#firmware-write")).to_be_enabled()


@pytest.mark.parametrize("name", board.names())
def test_the_commands_of_every_board_are_those_of_the_tool(panel, name):
    panel.locator("#firmware-board").select_option(name)
    lines = panel.locator("#firmware-commands").inner_text().splitlines()
    image = board.Image(name, Path())
    command = board.flash_command("dfu-util", image, "stlink", "")
    by_usb = [f"tools/rkm04 board flash --board {name} --tool dfu-util"]
    by_usb.append(shlex.join([*command[:-1], image.file("bin").name]))
    assert lines[1:-1] == ([] if name == "skr-pro-1.2" else by_usb)
    address = f"{FLASH + board.loader_bytes(name):#010x}"
    assert lines[-1] == f"st-flash --reset write {image.file('bin').name} {address}"
    assert lines[0] == f"tools/rkm04 board flash --board {name}"


@pytest.mark.parametrize("name", board.names())
def test_what_the_page_of_every_board_says_is_shown_in_the_language_of_the_page(panel, name):
    panel.locator("#firmware-board").select_option(name)
    text = panel.locator("#firmware-page")
    shown = {}
    for language in ("cs", "en"):
        panel.locator("#language").select_option(language)
        expect(text).to_have_attribute("lang", language)
        shown[language] = text.inner_text()
    assert "loader" in shown["en"]
    assert "avaděč" in shown["cs"]
    assert "loader" not in shown["cs"].replace("bootloader", "")
    assert shown["cs"].count("tools/rkm04 board") == shown["en"].count("tools/rkm04 board") > 0


def test_a_browser_without_usb_says_what_to_take(page):
    page.page.locator("#firmware").evaluate("(panel) => (panel.open = true)")
    has_usb = page.page.evaluate("'usb' in navigator")
    expect(page.page.locator("#firmware-usb")).to_be_visible(visible=has_usb)
    expect(page.page.locator("#firmware-no-usb")).to_be_visible(visible=not has_usb)
