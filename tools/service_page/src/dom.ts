/** The element of the page with this id; its absence is an error of index.html. */
export function byId<T extends HTMLElement>(id: string, kind: new () => T): T {
    const found = document.getElementById(id);
    if (!(found instanceof kind)) {
        throw new Error(`index.html has no ${kind.name} with the id ${id}`);
    }
    return found;
}

/** A new element with attributes and children. */
export function make<K extends keyof HTMLElementTagNameMap>(
    tag: K,
    attributes: Record<string, string> = {},
    ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        element.setAttribute(name, value);
    }
    element.append(...children);
    return element;
}

/** The current value of a custom property of style.css. */
export function styleValue(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Calls back at most once per `wait_ms`, that long after the last call. */
export function debounced(wait_ms: number, action: () => void): () => void {
    let timer: number | undefined;
    return () => {
        window.clearTimeout(timer);
        timer = window.setTimeout(action, wait_ms);
    };
}
