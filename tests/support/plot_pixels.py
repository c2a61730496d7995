"""What is drawn in the plots of the page, by the colours of its pixels."""

from __future__ import annotations

from service_page import ServicePage

PIXELS = """([canvas_of, colour]) => {
    const probe = document.createElement("span");
    probe.style.color = `var(${colour})`;
    document.body.append(probe);
    const wanted = getComputedStyle(probe).color.match(/\\d+/g).map(Number);
    probe.remove();
    const canvas = document.querySelector(canvas_of);
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let [count, top, bottom] = [0, canvas.height, 0];
    for (let i = 0; i < data.length; i += 4) {
        if (wanted.every((value, k) => Math.abs(value - data[i + k]) < 8) && data[i + 3] > 200) {
            const row = Math.floor(i / 4 / canvas.width);
            [count, top, bottom] = [count + 1, Math.min(top, row), Math.max(bottom, row)];
        }
    }
    return [count, (bottom - top) / canvas.height];
}"""


def pixels(page: ServicePage, plot: str, motor: int) -> int:
    """Pixels of a plot that have the colour of a motor."""
    return coloured(page, f"#{plot} canvas", f"--motor-{motor}")


def coloured(page: ServicePage, canvas: str, colour: str) -> int:
    count: int = page.page.evaluate(PIXELS, [canvas, colour])[0]
    return count


def height(page: ServicePage, plot: str, motor: int) -> float:
    """The part of a plot's height over which the line of a motor goes, from 0 to 1."""
    part: float = page.page.evaluate(PIXELS, [f"#{plot} canvas", f"--motor-{motor}"])[1]
    return part
