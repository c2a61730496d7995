const PREFIX = "rkm04.";
const YEAR_SECONDS = 365 * 24 * 3600;

/**
 * Keeps a draft: for this tab of the browser, and for tabs that are opened later. Storage that is full or
 * forbidden is no reason to stop working.
 */
export function keep(name: string, value: unknown): void {
    const text = JSON.stringify(value);
    for (const storage of [sessionStorage, localStorage]) {
        try {
            storage.setItem(PREFIX + name, text);
        } catch {
            return;
        }
    }
}

export function recall<T>(name: string, otherwise: T): T {
    const text = sessionStorage.getItem(PREFIX + name) ?? localStorage.getItem(PREFIX + name);
    if (text === null) {
        return otherwise;
    }
    try {
        return JSON.parse(text) as T;
    } catch {
        return otherwise;
    }
}

/** Preferences live in a cookie: unlike storage, it outlives a change of the service's port. */
export function keepPreference(name: string, value: string): void {
    document.cookie = `rkm04_${name}=${value}; max-age=${YEAR_SECONDS}; path=/; SameSite=Strict`;
}

export function recallPreference(name: string): string | null {
    const start = `rkm04_${name}=`;
    const found = document.cookie.split("; ").find((part) => part.startsWith(start));
    return found?.slice(start.length) ?? null;
}
