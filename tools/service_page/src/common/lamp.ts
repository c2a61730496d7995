/** Shows a lamp as a button: on, off or, with null, not known. */
export function showLamp(lamp: HTMLButtonElement, name: string, isOn: boolean | null, words: string): void {
    lamp.dataset.level = isOn === null ? "unknown" : isOn ? "1" : "0";
    lamp.textContent = name;
    lamp.title = words;
    lamp.setAttribute("aria-pressed", String(isOn === true));
    lamp.setAttribute("aria-label", `${name}: ${words}`);
}
