import { byId } from "./dom";
import { Cell } from "./signal";

/** What a connection is to; another unit is another machine. */
interface Place {
    connected: boolean;
    port: string | null;
    node?: number | null;
}

/**
 * The box in which a user confirms to have read what is dangerous, once for each connection and opening of the page.
 * Nothing is moved by hand before; what stops never asks for it.
 */
export class Danger {
    readonly isConfirmed = new Cell(false);
    readonly #box: HTMLInputElement;
    #last: Place | null = null;

    constructor(box: string) {
        this.#box = byId(box, HTMLInputElement);
        this.#box.addEventListener("change", () => this.isConfirmed.set(this.#box.checked));
    }

    /** Takes in what is known of the connection; returns whether it is another one, of which nothing is confirmed. */
    setPlace(place: Place | null): boolean {
        const last = this.#last;
        this.#last = place;
        if (place?.connected === true && last?.connected === true && place.port === last.port && place.node === last.node) {
            return false;
        }
        this.#box.checked = false;
        this.isConfirmed.set(false);
        return true;
    }
}
