"""The page without a service, as one file: it checks and simulates as the service, with a unit."""

from __future__ import annotations

import asyncio
import gzip
import json
import os
import re
import signal
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from alone_page import steps, write, write_alone
from page_looks import AXE, CUT, OUTSIDE, OVER, SIZES, VIOLATIONS
from playwright.sync_api import Browser, BrowserContext, Page, expect
from rkm04_tools import static_pages
from rkm04_tools.failure import Failure
from rkm04_tools.service.checking import check, examples
from rkm04_tools.service.curves import Curves, read_wanted
from rkm04_tools.service.orders import TEXT_MAX

GZIPPED_BYTES_MAX = 400_000
REAL_TIME_SECONDS = 3
ASLEEP_SECONDS = 4
LOAD_MAX = 0.5
"""Of one core, with motors as fast as they can be; far more than is needed on an idle machine."""
WORK = """async ([orders]) => {
    const brought = JSON.parse(document.getElementById("alone").textContent);
    const script = new Blob([brought.worker], { type: "text/javascript" });
    const worker = new Worker(URL.createObjectURL(script));
    const bytes = Uint8Array.from(atob(brought.program), (c) => c.charCodeAt(0));
    worker.postMessage({ kind: "program", bytes });
    const told = [];
    return new Promise((take) => {
        worker.onmessage = ({ data }) => told.push(data) === orders.length && take(told);
        orders.forEach((order) => worker.postMessage(order));
    });
}"""
UNIT = """([orders, seconds]) => {
    const brought = JSON.parse(document.getElementById("alone").textContent);
    const script = new Blob([brought.worker], { type: "text/javascript" });
    const worker = new Worker(URL.createObjectURL(script));
    const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    worker.postMessage({ kind: "program", bytes: bytes(brought.program) });
    worker.postMessage({ kind: "unit", bytes: bytes(brought.unit), names: brought.names });
    const told = [];
    return new Promise((take) => {
        const end = () => { worker.terminate(); take(told); };
        worker.onmessage = ({ data }) => {
            told.push({ ...JSON.parse(data), at_s: performance.now() / 1000 });
            told.length === 1 && setTimeout(end, 1000 * seconds);
        };
        worker.postMessage("");
        orders.forEach((order) => worker.postMessage(JSON.stringify(order)));
    });
}"""
"""What another unit tells in some seconds from its first word on, after it was given orders."""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page in a folder of its own."""
    return write_alone(tmp_path_factory.mktemp("alone") / "page")


@pytest.fixture(scope="module")
def context(browser: Browser) -> Iterator[BrowserContext]:
    context = browser.new_context()
    yield context
    context.close()


@pytest.fixture
def alone(context: BrowserContext, written: Path) -> Iterator[Page]:
    page = context.new_page()
    faults: list[str] = []
    asked: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: asked.append(request.url.split(":")[0]))
    page.on("websocket", lambda socket: asked.append(socket.url))
    page.goto(written.as_uri())
    expect(page.locator("#plan")).to_have_attribute("data-drawn", re.compile(r"\d+"))
    expect(page.locator("body")).to_have_attribute("data-connected", "true")
    yield page
    assert faults == []
    assert set(asked) <= {"file", "data", "blob"}
    page.close()


def answers(page: Page, orders: list[dict[str, Any]]) -> list[Any]:
    """What the worker of the page answers."""
    told = page.evaluate(WORK, [[{**order, "id": number} for number, order in enumerate(orders)]])
    assert [one["id"] for one in told] == list(range(len(orders)))
    return [one["answer"] for one in told]


def test_each_page_is_one_file_of_less_than_400_kb_gzipped(written):
    found = sorted(path.name for path in written.parent.iterdir())
    assert found == sorted(page.name for page in static_pages.PAGES)
    for name in found:
        assert len(gzip.compress((written.parent / name).read_bytes())) <= GZIPPED_BYTES_MAX


def test_a_folder_that_cannot_be_is_one_line(written):
    with pytest.raises(Failure, match=r"cannot be written \(.+\); name a folder of yours"):
        static_pages.write(written)


TEXTS = (
    "", "\\ F100 R", "V0 Q", "{ p\u0159\u00edklad }\r\n F1 \N{ACUTE ACCENT}3", "@1 J1",
    "F1 \u201e81 \u00a0 \U0001f600Q", "q\n" * 1500, "{ open",
)  # fmt: skip


def test_it_finds_in_programs_what_the_service_finds(alone):
    told = answers(alone, [{"kind": "check", "text": text} for text in TEXTS])

    for text, verdict in zip(TEXTS, told, strict=True):
        ours = check(text)
        found = [{name: one[name] for name in ours["problems"][0]} for one in verdict["problems"]
                 ] if ours["problems"] else verdict["problems"]  # fmt: skip
        assert {**verdict, "problems": found} == ours


def served(body: dict[str, Any]) -> Any:
    """The curve of the service; in a thread, as this one has the event loop of the browser."""
    with ThreadPoolExecutor(1) as pool:
        made = pool.submit(lambda: asyncio.run(Curves().make(read_wanted(body)))).result()
    return json.loads(json.dumps(made))


def test_it_draws_the_curves_that_the_service_draws(alone):
    known = json.loads(json.dumps(examples()))
    bodies = [
        {"programs": {"1": one["text"]}, "inputs": one["inputs"], "seconds": 60, "points": 2000}
        for one in known
    ]
    bodies.append({**bodies[0], "programs": {"2": known[0]["text"], "4": "L3 F10 R E [ Q"}})
    bodies.append({**bodies[0], "programs": {"2": known[0]["text"], "4": "L3 F10 R E ["}})
    bodies.append({**bodies[0], "range": [0.5, 0.75]})
    told = answers(alone, [{"kind": "curve", "request": body} for body in bodies])

    for body, curve in zip(bodies, told, strict=True):
        ours = served(body)
        for motor, line in curve["motors"].items():
            wanted = ours["motors"][motor]
            assert {name: line[name] for name in line if name != "motor"} == {
                name: wanted[name] for name in wanted if name not in ("state", "place", "overflow")
            }
        for name in ("seconds", "ended", "outputs", "error"):
            assert curve[name] == ours[name]
        assert set(curve["motors"]) == set(ours["motors"])


def test_a_program_is_checked_and_drawn_while_it_is_typed(alone):
    write(alone, "S100 V600 A2000 F777 R")
    expect(alone.locator("#plan")).to_have_attribute("data-pulses", "777")
    expect(alone.locator("#verdict")).to_have_attribute("data-kind", "good")

    write(alone, "S100 V20000")
    expect(alone.locator("#verdict")).to_have_attribute("data-kind", "error")
    expect(alone.locator("#plan")).to_have_attribute("data-state", "old")


def test_it_leads_to_the_pages_of_the_other_units(alone):
    names = [link.get_attribute("href") for link in alone.locator("#pages a").all()]
    assert names == [page.name for page in static_pages.PAGES]


def test_the_examples_are_there_with_their_inputs(alone):
    alone.locator("#examples").select_option(label="6-guards.rks")

    expect(alone.locator("#plan-inputs")).not_to_have_value("")
    expect(alone.locator("#plan")).to_have_attribute("data-pulses", re.compile("[1-9]"))


def test_a_text_that_is_no_program_any_more_is_refused_as_the_service_refuses_it(alone):
    text = "F1 R\n" * (TEXT_MAX // 5 + 1)
    body = {"programs": {"1": text}, "inputs": [], "seconds": 60, "points": 2000}
    orders: list[dict[str, Any]] = [
        {"kind": "check", "text": text},
        {"kind": "curve", "request": body},
    ]
    told = alone.evaluate(
        WORK.replace("told.push(data)", "told.push(data.trouble ?? data.answer.error)"),
        [[{**order, "id": number} for number, order in enumerate(orders)]],
    )

    assert told == [f"the text is too long; {TEXT_MAX} characters are the most"] * 2


def test_a_program_is_sent_runs_and_is_stored(alone):
    write(alone, "\\ C100 S100 V2000 A4000 F300 R")
    alone.locator("#send").click()
    expect(alone.locator("#position-1")).to_have_text("300")
    expect(alone.locator("#state-1")).to_contain_text("rests")
    expect(alone.locator("#log .log-item").first).to_contain_text("sent and accepted")

    for message, words in (
        ("store", "commands stored: 6"),
        ("program", "C100S100V2000A4000F300R"),
        ("position", "motor 1: 300"),
        ("version", "version 01.01"),
        ("table", "no move in progress"),
        ("progress", "command number"),
    ):
        alone.locator("#message").select_option(message)
        alone.locator("#send").click()
        expect(alone.locator("#log .log-item").first).to_contain_text(words)


def test_a_speed_that_cannot_be_changed_is_not_told_as_changed(alone):
    for program, words in (
        ("\\ C100 S100 )1", "motor 1 keeps its speed: it is in a limit run"),
        ("\\ C100 S100 V500 G+", "speed 900 steps/s, until the move ends: motor 1"),
    ):
        write(alone, program)
        alone.locator("#send").click()
        expect(alone.locator("#log .log-item").first).to_contain_text("sent and accepted")
        expect(alone.locator("#state-1")).to_contain_text("moves")
        alone.locator("#speed").fill("900")
        alone.locator("#speed-form button").click()
        expect(alone.locator("#log .log-item").first).to_contain_text(words)


def test_all_programs_start_together_and_escape_stops_them_until_resume(alone):
    for motor in (1, 2):
        alone.locator(f"#tab-{motor}").click()
        write(alone, "\\ C100 S500 V500 A1000 F100000 R")
    alone.locator("#together").check()
    alone.locator("#send-all").click()
    expect(alone.locator("#log .log-item").first).to_contain_text("started together")
    for motor in (1, 2):
        expect(alone.locator(f"#state-{motor}")).to_contain_text("moves")

    alone.keyboard.press("Escape")

    expect(alone.locator("#alarm")).to_have_attribute("data-kind", "done")
    expect(alone.locator("#state-2")).to_have_text("stopped by K")
    assert alone.locator("#position-1").inner_text() == alone.locator("#position-2").inner_text()
    alone.locator("#resume").click()
    expect(alone.locator("#alarm")).to_be_hidden(timeout=1500)
    expect(alone.locator("#state-1")).to_contain_text("moves")


def test_what_is_left_of_a_program_that_was_cut_short_is_not_released_by_the_next(alone):
    last = alone.locator("#log .log-item").first
    write(alone, "\\ C100 [ F9 R")
    alone.locator("#send").click()
    expect(last).to_contain_text("sent and accepted")

    write(alone, "F3 R")
    alone.locator("#together").check()
    alone.locator("#send-all").click()
    expect(last).to_contain_text("motor 1 waits at [ in another program and would start too")
    write(alone, "F2 R ]")
    alone.locator("#send").click()

    expect(alone.locator("#position-1")).to_have_text("11")


def test_an_error_is_shown_in_the_program_and_nothing_is_sent(alone):
    write(alone, "F1 R\nV20000")
    alone.locator("#send").click()

    expect(alone.locator("#log .log-item").first).to_contain_text("found 20000")
    expect(alone.locator("#position-1")).to_have_text("0")


def test_an_input_is_clicked(alone):
    write(alone, "\\ C100 O3 F7 R")
    alone.locator("#send").click()
    expect(alone.locator("#state-1")).to_have_text("waits for input 3 = 1")
    third = alone.locator("#live-inputs .lamp").nth(2)
    expect(third).to_be_enabled()

    third.click()

    expect(third).to_have_attribute("data-level", "1")
    expect(alone.locator("#position-1")).to_have_text("7")


def test_the_unit_keeps_real_time_with_four_motors_at_16000_steps_per_s(alone):
    fast = "\\ C100 S2000 V16000 A60000 F16000000 R"
    texts = {str(motor): fast for motor in range(1, 5)}
    order = {"type": "request", "id": 1, "message": "send_all", "motor": 0, "texts": texts}
    told = alone.evaluate(UNIT, [[order], REAL_TIME_SECONDS])

    lives = [one for one in told if one["type"] == "live" and one["time_s"] > 1]
    first, last = lives[0], lives[-1]
    passed = last["time_s"] - first["time_s"]
    print(f"load {last['unit']['clock']['load']:.3f}")
    assert passed == pytest.approx(last["at_s"] - first["at_s"], abs=0.5)
    for before, after in zip(first["motors"], last["motors"], strict=True):
        assert after["position"] - before["position"] == pytest.approx(16_000 * passed, abs=2)
    assert last["unit"]["late_steps"] == 0
    assert last["unit"]["clock"]["stood_s"] == 0
    assert last["unit"]["clock"]["load"] <= LOAD_MAX


@pytest.mark.parametrize("lets_go", [False, True])
def test_a_page_that_falls_silent_while_it_holds_a_button_has_all_motors_stopped(alone, lets_go):
    text = "\\S200 V2000 A8000 G+"
    orders: list[dict[str, Any]] = [
        {"type": "hold", "held": True},
        {"type": "request", "id": 1, "message": "send", "motor": 1, "text": text},
    ]
    orders += [{"type": "hold", "held": False}] if lets_go else []
    told = alone.evaluate(UNIT, [orders, 2])

    stops = [one for one in told if one.get("message") == "stop"]
    last = [one for one in told if one["type"] == "live"][-1]
    assert len(stops) == (0 if lets_go else 1)
    assert last["motors"][0]["moving"] == lets_go


def test_what_was_asked_long_ago_is_not_done_but_a_stop_is(alone):
    beat = -1
    told = alone.evaluate(
        UNIT,
        [
            [
                {
                    "type": "request",
                    "id": 1,
                    "message": "send",
                    "motor": 1,
                    "text": "F9 R",
                    "beat": beat,
                },
                {"type": "input", "input": 3, "level": 1, "beat": beat},
                {"type": "stop", "id": 2, "nodes": [], "beat": beat},
            ],
            0.5,
        ],
    )

    answers_ = [one for one in told if one["type"] == "answer"]
    assert [(one["message"], (one["error"] or {}).get("kind")) for one in answers_] == [
        ("send", "Late"),
        ("stop", None),
    ]
    last = [one for one in told if one["type"] == "live"][-1]
    assert last["motors"][0]["position"] == 0
    assert last["inputs"] == [0] * 8


def test_axe_finds_nothing_serious_and_nothing_lies_over_something_else(alone):
    alone.evaluate(AXE.read_text())
    for width, height in (SIZES[0], SIZES[-1]):
        alone.set_viewport_size({"width": width, "height": height})
        assert alone.evaluate(VIOLATIONS) == [], width
        for finds in (OUTSIDE, OVER, CUT):
            assert alone.evaluate(finds) == [], width


def test_without_webassembly_there_is_no_unit_and_stop_confirms_nothing(context, written):
    page = context.new_page()
    page.add_init_script("delete globalThis.WebAssembly")
    page.goto(written.as_uri())
    write(page, "F1 R")

    expect(page.locator("#verdict")).to_contain_text("has no WebAssembly")
    expect(page.locator("#state")).to_contain_text("no unit")
    for place in ("#send", "#connect", "#resume", "#live", "#answers"):
        expect(page.locator(place)).to_be_hidden()
    page.keyboard.press("Escape")
    expect(page.locator("#alarm")).to_have_attribute("data-kind", "failed")
    expect(page.locator("#alarm")).to_contain_text("emergency stop")
    page.close()


FORBIDDEN = """() => {
    const deny = { get() { throw new DOMException("denied", "SecurityError"); } };
    ["localStorage", "sessionStorage"].forEach((name) => Object.defineProperty(window, name, deny));
    Object.defineProperty(document, "cookie", { ...deny, set: deny.get });
}"""


@pytest.mark.parametrize("name", [page.name for page in static_pages.PAGES])
def test_a_browser_that_lets_no_page_keep_anything_shows_all_the_same(context, written, name):
    page = context.new_page()
    faults: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.add_init_script(f"({FORBIDDEN})()")
    page.goto(written.with_name(name).as_uri())

    expect(page.locator("#state")).to_have_attribute("data-kind", "good")
    page.locator("#language").select_option("cs")
    expect(page.locator("html")).to_have_attribute("lang", "cs")
    assert faults == []
    page.close()


def test_the_language_that_was_chosen_stays_for_the_pages_of_a_disk(browser, written):
    context = browser.new_context(locale="en-GB")
    page = context.new_page()
    page.goto(written.as_uri())
    page.locator("#language").select_option("cs")
    page.goto(written.with_name("positioning.html").as_uri())
    expect(page.locator("html")).to_have_attribute("lang", "cs")
    context.close()


def renderers(browser: Browser) -> list[int]:
    told = browser.new_browser_cdp_session().send("SystemInfo.getProcessInfo")
    return [one["id"] for one in told["processInfo"] if one["type"] == "renderer"]


def test_a_page_that_slept_says_that_the_time_of_the_unit_stood(alone, browser):
    write(alone, "\\ C100 S1000 V1000 A1000 F1000000 R")
    alone.locator("#send").click()
    expect(alone.locator("#state-1")).to_contain_text("moves")
    asleep = renderers(browser)
    before = steps(alone)
    for process in asleep:
        os.kill(process, signal.SIGSTOP)
    time.sleep(ASLEEP_SECONDS)
    for process in asleep:
        os.kill(process, signal.SIGCONT)

    expect(alone.locator("#live-facts")).to_contain_text("time stood for")
    assert steps(alone) < before + 1000 * ASLEEP_SECONDS
    expect(alone.locator("#state-1")).to_contain_text("moves")
