const PREFIX = "rkm04.";
const YEAR_SECONDS = 365 * 24 * 3600;

/** What a browser does that may forbid a page to keep anything, or have no room for it; null: it does not do it. */
function attempted<Got>(work: () => Got): Got | null {
    try {
        return work();
    } catch {
        return null;
    }
}

/**
 * Keeps a draft, or what must not be forgotten: for this tab of the browser, and for tabs that are opened later. Storage
 * that is full or forbidden is no reason to stop working.
 */
export function keep(name: string, value: unknown): void {
    const text = JSON.stringify(value);
    attempted(() => {
        sessionStorage.setItem(PREFIX + name, text);
        localStorage.setItem(PREFIX + name, text);
    });
}

export function recall<T>(name: string, otherwise: T): T {
    return attempted(() => {
        const text = sessionStorage.getItem(PREFIX + name) ?? localStorage.getItem(PREFIX + name);
        return text === null ? null : (JSON.parse(text) as T);
    }) ?? otherwise;
}

/**
 * Preferences live in a cookie: unlike storage, it outlives a change of the service's port. A page that was opened from
 * a disk has no cookies, but storage.
 */
export function keepPreference(name: string, value: string): void {
    attempted(() => localStorage.setItem(PREFIX + name, value));
    attempted(() => (document.cookie = `rkm04_${name}=${value}; max-age=${YEAR_SECONDS}; path=/; SameSite=Strict`));
}

export function recallPreference(name: string): string | null {
    const start = `rkm04_${name}=`;
    const found = attempted(() => document.cookie.split("; ").find((part) => part.startsWith(start)));
    return found?.slice(start.length) ?? attempted(() => localStorage.getItem(PREFIX + name));
}
