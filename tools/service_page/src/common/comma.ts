/**
 * A comma that is typed or pasted into the field of a number is its decimal point. Where the browser's own language
 * has no comma in numbers, Chromium leaves it out, and 1,5 would be 15.
 */
export function readCommas(): void {
    document.addEventListener("beforeinput", (event) => {
        const text = event.data ?? event.dataTransfer?.getData("text/plain") ?? "";
        const isNumber = event.target instanceof HTMLInputElement && event.target.type === "number";
        if (isNumber && /^[^.,]*,[^.,]*$/.test(text)) {
            event.preventDefault();
            document.execCommand("insertText", false, text.replace(",", "."));
        }
    });
}
