"""Measures the pages that need no service, in Debian's headless Chromium: `bench --target page`."""

from __future__ import annotations

import contextlib
import gzip
import json
import statistics
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rkm04_tools import static_pages
from rkm04_tools.failure import Failure
from rkm04_tools.tree import ROOT

try:
    from playwright.sync_api import Browser, Page, sync_playwright
except ImportError:
    sys.exit("what drives a browser is not there: run tools/setup test")

CHROMIUM = Path("/usr/bin/chromium-headless-shell")
OPENINGS = 9
TIMES = 15
COMMANDS_MAX = 700
SIMULATED_SECONDS = 60
WATCHED_SECONDS = 10
SETTLING_SECONDS = 1
FULL = "S100 V600 A2000\n" + "F500 R { forth }\n" * ((COMMANDS_MAX - 3) // 2)
"""As many commands as a motor holds."""
BUSY = "S2000 V16000 A60000\nL40\nF16000 R W50 B16000 R\nE\n"
"""Moves at the highest speed, for longer than is simulated."""
FAST = "\\ C100 S2000 V16000 A60000 F16000000 R"
DRAWN = "document.getElementById('plan')?.dataset.drawn !== undefined"
OPENED = f"""() => new Promise((take) => {{
    const look = () => {DRAWN} ? take(performance.now()) : requestAnimationFrame(look);
    look();
}})"""
"""When the first curve was drawn, ms after the page was asked for."""
ANSWERED = """async ([orders]) => {
    const brought = JSON.parse(document.getElementById("alone").textContent);
    const script = new Blob([brought.worker], { type: "text/javascript" });
    const worker = new Worker(URL.createObjectURL(script));
    const bytes = Uint8Array.from(atob(brought.program), (c) => c.charCodeAt(0));
    worker.postMessage({ kind: "program", bytes });
    const told = [];
    for (const [id, order] of orders.entries()) {
        const begin_ms = performance.now();
        const { data } = await new Promise((take) => {
            worker.onmessage = take;
            worker.postMessage({ ...order, id });
        });
        told.push({ ms: performance.now() - begin_ms, data });
    }
    worker.terminate();
    return told;
}"""
"""What a worker of the page answers to orders, one after the other, and how long each took."""
WATCHED = """([order, seconds]) => {
    const brought = JSON.parse(document.getElementById("alone").textContent);
    const script = new Blob([brought.worker], { type: "text/javascript" });
    const worker = new Worker(URL.createObjectURL(script));
    const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    worker.postMessage({ kind: "program", bytes: bytes(brought.program) });
    worker.postMessage({ kind: "unit", bytes: bytes(brought.unit), names: brought.names });
    const told = [];
    worker.onmessage = ({ data }) => {
        const { type, motors, unit } = JSON.parse(data);
        type === "live" && told.push({ at_s: performance.now() / 1000, motors, unit });
    };
    worker.postMessage("");
    worker.postMessage(JSON.stringify(order));
    return new Promise((take) => setTimeout(() => {
        worker.terminate();
        take(told);
    }, 1000 * seconds));
}"""
"""What a unit in a worker tells in some seconds after an order."""


def _first_curve_seconds(browser: Browser, url: str) -> float:
    """In a browser that has never seen the page; the middle of several."""
    found = []
    for _ in range(OPENINGS):
        context = browser.new_context()
        page = context.new_page()
        page.goto(url, wait_until="commit")
        found.append(float(page.evaluate(OPENED)) / 1000)
        context.close()
    return statistics.median(found)


def _answered_ms(page: Page, order: dict[str, Any]) -> tuple[float, Any]:
    """The middle of several times until an order was answered, and the last answer."""
    told: list[dict[str, Any]] = page.evaluate(ANSWERED, [[order] * (TIMES + 1)])
    return statistics.median(float(one["ms"]) for one in told[1:]), told[-1]["data"]["answer"]


def _check_ms(page: Page) -> float:
    ms, verdict = _answered_ms(page, {"kind": "check", "text": FULL})
    assert COMMANDS_MAX - 2 <= verdict["commands"] <= COMMANDS_MAX, verdict["commands"]
    return ms


def _simulation_ms(page: Page) -> dict[str, float]:
    """Nothing where the page has given up, as it does after half a second."""
    programs = {str(motor): BUSY for motor in range(1, 5)}
    request = {"programs": programs, "inputs": "", "seconds": SIMULATED_SECONDS, "points": 2000}
    ms, curve = _answered_ms(page, {"kind": "curve", "request": request})
    if curve["seconds"] < SIMULATED_SECONDS:
        told = f"after {ms:.0f} ms of it only {curve['seconds']} s were computed"
        print(f"the machine is too busy to measure a simulation: {told}", file=sys.stderr)
        return {}
    return {"simulation_ms": ms}


def _real_time(page: Page) -> dict[str, float]:
    """How fast the unit's time goes, by its pulses, and what it needs of a core."""
    texts = {str(motor): FAST for motor in range(1, 5)}
    order = {"type": "request", "id": 1, "message": "send_all", "motor": 0, "texts": texts}
    told = page.evaluate(WATCHED, [order, SETTLING_SECONDS + WATCHED_SECONDS])
    begin = told[0]["at_s"] + SETTLING_SECONDS
    first, *_, last = (one for one in told if one["at_s"] > begin)
    made = min(
        after["position"] - before["position"]
        for before, after in zip(first["motors"], last["motors"], strict=True)
    )
    return {
        "real_time": made / 16_000 / (last["at_s"] - first["at_s"]),
        "late_steps": last["unit"]["late_steps"],
        "load_percent": 100 * last["unit"]["clock"]["load"],
    }


def measure(folder: Path) -> dict[str, float]:
    """All figures of the pages that are written into a folder."""
    with contextlib.redirect_stdout(sys.stderr):
        static_pages.write(folder)
    sizes = [len(gzip.compress(path.read_bytes())) for path in folder.iterdir()]
    url = (folder / static_pages.PAGES[0].name).as_uri()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        first_curve_seconds = _first_curve_seconds(browser, url)
        page = browser.new_page()
        page.goto(url)
        page.wait_for_function(DRAWN)
        figures = {
            "gzipped_kb": max(sizes) / 1000,
            "first_curve_seconds": first_curve_seconds,
            "check_ms": _check_ms(page),
            **_simulation_ms(page),
            **_real_time(page),
        }
        browser.close()
    wheels = [path.stat().st_size for path in (ROOT / "build/wheels").glob("*.whl")]
    return figures | ({"wheel_mb": max(wheels) / 1e6} if wheels else {})


def main() -> int:
    """Measure and print one JSON object."""
    if not CHROMIUM.exists():
        print(f"{CHROMIUM} is not there: install Debian's package {CHROMIUM.name}", file=sys.stderr)
        return 1
    try:
        with TemporaryDirectory() as folder:
            figures = measure(Path(folder))
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    print(json.dumps(figures))
    return 0


if __name__ == "__main__":
    sys.exit(main())
