/** A value that tells its listeners when it is set. */
export class Cell<T> {
    #value: T;
    readonly #listeners: ((value: T) => void)[] = [];

    constructor(value: T) {
        this.#value = value;
    }

    get value(): T {
        return this.#value;
    }

    set(value: T): void {
        this.#value = value;
        for (const listener of this.#listeners) {
            listener(value);
        }
    }

    /** Calls the listener at once and on every later change. */
    watch(listener: (value: T) => void): void {
        this.#listeners.push(listener);
        listener(this.#value);
    }

    /** Calls the listener on later changes only. */
    onChange(listener: (value: T) => void): void {
        this.#listeners.push(listener);
    }
}
