/** A page says several times a second that its button is held; if it is silent for longer, it has let go. */
const HOLD_MS = 700;

/** A button that makes a motor run as long as it is held. */
export class Grip {
    #end_ms: number | null = null;

    set(isHeld: boolean, now_ms: number): void {
        this.#end_ms = isHeld ? now_ms + HOLD_MS : null;
    }

    /** Whether the page has fallen silent while it held the button; told once. */
    isLost(now_ms: number): boolean {
        const isLost = this.#end_ms !== null && now_ms >= this.#end_ms;
        this.#end_ms = isLost ? null : this.#end_ms;
        return isLost;
    }
}
