import { make } from "../dom";
import { numberText } from "../language";
import { t } from "./i18n";
import { feedOf, feedValue } from "./numbers";
import { FEED_PER_MM_MIN } from "./protocol";

const STEPS = 1000;
/** Slow feeds have more of the slider than fast ones. */
const BEND = 3;
const TOP = 65_535;
const FIRST = 600;
/** What was set here is not set back by a look that began before. */
const HELD_MS = 2000;

/** A slider and a field for a feed, mm/min; `send` is called when either is set. */
export class FeedField {
    readonly root: HTMLElement;
    readonly #slider: HTMLInputElement;
    readonly #field: HTMLInputElement;
    #top = TOP;
    #set_ms = -Infinity;

    constructor(axis: number, send: (feed: number) => void) {
        this.#slider = make("input", { type: "range", min: "0", max: String(STEPS), id: `feed-${axis}`, class: "feed-slider" });
        this.#field = make("input", { type: "number", min: "0", max: String(TOP), step: "any", id: `feed-value-${axis}`, class: "number", required: "" });
        this.#field.value = String(FIRST);
        this.#slider.addEventListener("input", () => {
            const mm_min = this.#top * (Number(this.#slider.value) / STEPS) ** BEND;
            this.#field.value = String(mm_min < 100 ? Number(mm_min.toFixed(1)) : Math.round(mm_min));
            this.#tell();
        });
        this.#slider.addEventListener("change", () => send(this.feed));
        this.#field.addEventListener("input", () => this.#follow());
        this.#field.addEventListener("change", () => this.#field.reportValidity() && send(this.feed));
        this.#field.addEventListener("wheel", () => this.#field.blur()); // scrolling the page sets no feed
        for (const part of [this.#slider, this.#field]) {
            part.addEventListener("input", () => (this.#set_ms = performance.now()));
        }
        this.root = make("div", { class: "row tight feed" }, this.#slider, this.#field, make("span", { class: "hint" }, "mm/min"));
        this.#follow();
    }

    get feed(): number {
        return feedOf(Number(this.#field.value));
    }

    /** Whether it can be sent; the browser says what is wrong. */
    isValid(): boolean {
        return this.#field.reportValidity();
    }

    /** The unit has a feed that was not set here; 0 is no wish of anybody. */
    take(feed: number): void {
        const isSet = this.root.contains(document.activeElement) || performance.now() - this.#set_ms < HELD_MS;
        if (feed > 0 && !isSet && feed !== this.feed) {
            this.#field.value = feedValue(feed);
            this.#follow();
        }
    }

    setTop(mm_min: number): void {
        const top = Math.max(1, Math.min(TOP, Math.round(mm_min)));
        if (top !== this.#top) {
            this.#top = top;
            this.#follow();
        }
    }

    name(axis: number): void {
        this.#slider.setAttribute("aria-label", t("feed.slider", { axis }));
        this.#field.setAttribute("aria-label", t("feed.value", { axis }));
        this.#slider.title = t("feed.hint");
    }

    #follow(): void {
        const share = Math.min(Math.max(Number(this.#field.value) / this.#top, 0), 1);
        this.#slider.value = String(Math.round(STEPS * share ** (1 / BEND)));
        this.#tell();
    }

    #tell(): void {
        this.#slider.setAttribute("aria-valuetext", `${numberText(this.feed / FEED_PER_MM_MIN, 1)} mm/min`);
    }
}
