/**
 * A button that acts as long as it is held: by pointer, by Space, or by a key of its own anywhere among `within`. It is
 * let go when the pointer or the focus leaves it, another key is pressed, or the window is no longer seen or used.
 */
export class HoldButton {
    readonly #button: HTMLButtonElement;
    readonly #on: { press: () => void; release: () => void };
    #isHeld = false;

    constructor(
        button: HTMLButtonElement, within: HTMLElement, key: string, on: { press: () => void; release: () => void },
    ) {
        this.#button = button;
        this.#on = on;
        this.#listenToPointer();
        within.addEventListener("keydown", (event) => this.#keyDown(event, key));
        window.addEventListener("keyup", ({ key: up }) => (up === " " || up === key) && this.release());
        button.addEventListener("blur", () => this.release());
        window.addEventListener("blur", () => this.release());
        window.addEventListener("pagehide", () => this.release());
        document.addEventListener("visibilitychange", () => document.hidden && this.release());
    }

    /** Lets go, whoever still holds it. */
    release(): void {
        if (this.#isHeld) {
            this.#isHeld = false;
            delete this.#button.dataset.held;
            this.#on.release();
        }
    }

    #press(): void {
        if (!this.#isHeld && !this.#button.matches(":disabled")) {
            this.#button.focus();
            this.#isHeld = true;
            this.#button.dataset.held = "true";
            this.#on.press();
        }
    }

    #listenToPointer(): void {
        const button = this.#button;
        button.addEventListener("pointerdown", (event) => {
            if (event.button === 0 && event.isPrimary) {
                event.preventDefault();
                // A finger is captured by what it touches first, and would never be seen to leave it.
                button.releasePointerCapture(event.pointerId);
                this.#press();
            }
        });
        for (const kind of ["pointerup", "pointerleave", "pointercancel"]) {
            button.addEventListener(kind, () => this.release());
        }
        window.addEventListener("pointerup", () => this.release());
        // While one button of a mouse is down, what becomes of the others is told as a move.
        window.addEventListener("pointermove", ({ button: changed }) => changed !== -1 && this.release());
        // A finger that stays for long would open a menu.
        button.addEventListener("contextmenu", (event) => event.preventDefault());
    }

    #keyDown(event: KeyboardEvent, key: string): void {
        const isMine = event.key === key || (event.key === " " && document.activeElement === this.#button);
        if (!isMine) {
            this.release();
            return;
        }
        event.preventDefault();
        if (!event.repeat && !event.ctrlKey && !event.altKey && !event.metaKey) {
            this.#press();
        }
    }
}
