const PRESS_MS = 600;
/** A touch or a mouse press stops at once; the click that follows it is not another stop. */
const SAME_PRESS_MS = 1000;

/** Calls back when the button is pressed, not when it is let go, and whenever Escape is. */
export function listenForStop(button: HTMLButtonElement, stop: () => void): void {
    let pressed_ms = -Infinity;
    const press = (): void => {
        pressed_ms = performance.now();
        button.dataset.pressed = "true";
        window.setTimeout(() => delete button.dataset.pressed, PRESS_MS);
        stop();
    };
    button.addEventListener("pointerdown", (event) => {
        if (event.button === 0) {
            press();
        }
    });
    button.addEventListener("click", () => {
        if (performance.now() - pressed_ms > SAME_PRESS_MS) {
            press();
        }
    });
    listenToEscape(press);
    // A file that is dropped beside the editor would take the place of the page, and so of its stop.
    for (const kind of ["dragover", "drop"] as const) {
        window.addEventListener(kind, (event) => event.dataTransfer?.types.includes("Files") && event.preventDefault());
    }
}

/**
 * Escape means STOP wherever the focus is. An open list of a select element keeps the key for itself and lets
 * only its release through, so a release without a press counts, too.
 */
function listenToEscape(press: () => void): void {
    let isDown = false;
    const listen = (kind: "keydown" | "keyup", action: (event: KeyboardEvent) => void): void =>
        window.addEventListener(kind, (event) => event.key === "Escape" && action(event), { capture: true });
    listen("keydown", (event) => {
        if (!event.repeat || !isDown) {
            press();
        }
        isDown = true;
    });
    listen("keyup", () => {
        if (!isDown) {
            press();
        }
        isDown = false;
    });
    window.addEventListener("blur", () => (isDown = false));
}
