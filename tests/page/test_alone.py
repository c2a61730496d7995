"""The page without a service, as one file: it checks and simulates as the service does."""

from __future__ import annotations

import asyncio
import gzip
import json
import os
import re
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect
from rkm04_tools.failure import Failure
from rkm04_tools.service import static
from rkm04_tools.service.checking import check, examples
from rkm04_tools.service.curves import Curves, read_wanted
from wasm_build import build_wasm

GZIPPED_BYTES_MAX = 400_000
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


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The page in a folder of its own."""
    folder = tmp_path_factory.mktemp("alone") / "page"
    with pytest.MonkeyPatch.context() as patch:
        host = build_wasm().parents[1] / "host"
        patch.setenv("RKM04_BUILD", os.environ.get("RKM04_BUILD", str(host)))
        static.write(folder)
        yield folder / "index.html"


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
    yield page
    assert faults == []
    assert set(asked) <= {"file", "data", "blob"}
    page.close()


def answers(page: Page, orders: list[dict[str, Any]]) -> list[Any]:
    """What the worker of the page answers."""
    told = page.evaluate(WORK, [[{**order, "id": number} for number, order in enumerate(orders)]])
    assert [one["id"] for one in told] == list(range(len(orders)))
    return [one["answer"] for one in told]


def write(page: Page, text: str) -> None:
    page.locator(".cm-content").click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.insert_text(text)


def test_it_is_one_file_of_less_than_400_kb_gzipped(written):
    assert [path.name for path in written.parent.iterdir()] == ["index.html"]
    assert len(gzip.compress(written.read_bytes())) <= GZIPPED_BYTES_MAX


def test_a_folder_that_cannot_be_is_one_line(written):
    with pytest.raises(Failure, match=r"cannot be written \(.+\); name a folder of yours"):
        static.write(written)


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


def test_the_examples_are_there_with_their_inputs(alone):
    alone.locator("#examples").select_option(label="6-guards.rks")

    expect(alone.locator("#plan-inputs")).not_to_have_value("")
    expect(alone.locator("#plan")).to_have_attribute("data-pulses", re.compile("[1-9]"))


def test_it_says_that_there_is_no_unit_and_shows_nothing_that_would_act_on_one(alone):
    expect(alone.locator("#state")).to_contain_text("no unit")
    for place in ("#send", "#connect", "#resume", "#live", "#answers"):
        expect(alone.locator(place)).to_be_hidden()


def test_stop_is_there_and_never_says_that_anything_was_stopped(alone):
    expect(alone.locator("#stop")).to_be_visible()
    alone.keyboard.press("Escape")

    expect(alone.locator("#alarm")).to_have_attribute("data-kind", "failed")
    expect(alone.locator("#alarm")).to_contain_text("emergency stop")


def test_a_browser_without_webassembly_is_told_in_plain_words(context, written):
    page = context.new_page()
    page.add_init_script("delete globalThis.WebAssembly")
    page.goto(written.as_uri())
    write(page, "F1 R")

    expect(page.locator("#verdict")).to_contain_text("has no WebAssembly")
    page.close()
