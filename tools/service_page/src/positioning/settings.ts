import { byId, make } from "../dom";
import { numberText } from "../language";
import type { Trouble } from "../protocol";
import { servedWords } from "../common/files";
import { told, troubleText } from "../common/told";
import { isAlone, language, t } from "./i18n";
import { feedOf, feedValue } from "./numbers";
import { AXES, FEED_PER_MM_MIN, STATUS, type Part, type Row, type Values } from "./protocol";
import { readText, type AllSettings } from "./settings_file";
import type { Unit } from "./unit";

const FEED_UNIT = "mm/min/65536";
const UNITS: Record<string, string> = { um: "µm", "mm/s2": "mm/s²", [FEED_UNIT]: "mm/min" };
/** Settings of which there are few values, with their words. */
const CHOICES: Record<string, [number, string][]> = {
    RATE: [96, 192, 384, 576, 1152].map((rate) => [rate, `${rate * 100} Bd`]),
    FORMAT: ["8E1", "8O1", "8N1", "8N2"].map((form, index) => [index, form]),
};
const SURE_MS = 4000;
const PARTS: readonly Part[] = ["unit", "axis1", "axis2", "axis3", "axis4"];

type Field = HTMLInputElement | HTMLSelectElement;

/** All settings: read, changed, written, stored, and kept in a file. */
export class SettingsPanel {
    readonly #unit: Unit;
    readonly #rows = byId("setting-rows", HTMLElement);
    readonly #words = byId("settings-words", HTMLElement);
    readonly #write = byId("settings-write", HTMLButtonElement);
    readonly #deliver = byId("settings-deliver", HTMLButtonElement);
    readonly #file = byId("settings-file", HTMLInputElement);
    #all: Row[] = [];
    #fields = new Map<string, { row: Row; field: Field; root: HTMLElement }>();
    /** What differs from the unit, by part and name, as the unit has values. */
    readonly #edits = new Map<Part, Map<string, number>>(PARTS.map((part) => [part, new Map()]));
    #trouble = "";
    #sure = 0;

    constructor(unit: Unit) {
        this.#unit = unit;
        unit.link.on("rows", ({ rows }) => {
            this.#all = rows;
            this.#build();
        });
        unit.settings.onChange(() => this.#dropDone());
        unit.watch(() => this.#show());
        for (const choice of document.querySelectorAll<HTMLInputElement>("input[name=part]")) {
            choice.addEventListener("change", () => this.#build());
        }
        this.#write.addEventListener("click", () => this.#send());
        byId("settings-undo", HTMLButtonElement).addEventListener("click", () => this.#forget());
        byId("settings-read", HTMLButtonElement).addEventListener("click", () => unit.ask("settings"));
        byId("settings-store", HTMLButtonElement).addEventListener("click", () => unit.ask("store"));
        this.#deliver.addEventListener("click", () => this.#takeDelivered());
        byId("settings-save", HTMLButtonElement).addEventListener("click", () => this.#save());
        byId("settings-open", HTMLButtonElement).addEventListener("click", () => this.#file.click());
        this.#file.addEventListener("change", () => void this.#open());
        language.onChange(() => this.#build());
    }

    get #part(): Part {
        return (document.querySelector<HTMLInputElement>("input[name=part]:checked")?.value ?? "axis1") as Part;
    }

    #valueOf(part: Part, name: string): number | null {
        return this.#edits.get(part)?.get(name) ?? this.#unit.settings.value.values?.[part][name] ?? null;
    }

    #build(): void {
        this.#fields.clear();
        const kind = this.#part === "unit" ? "unit" : "axis";
        const roots = this.#all.filter(({ part }) => part === kind).map((row) => {
            const field = CHOICES[row.name] ? make("select", {}, ...choices(row.name)) : make("input", { type: "number", class: "number", ...limits(row), required: "" });
            field.id = `setting-${row.name}`;
            field.addEventListener("input", () => this.#edit(row, field));
            const unit = UNITS[row.unit] ?? told(row.unit);
            const range = CHOICES[row.name] ? "" : rangeText(row);
            const about = make("small", {}, [unit, range, told(row.text)].filter((each) => each !== "").join(" · "));
            const root = make("div", { class: "setting" }, make("label", { for: field.id }, row.name), field, about);
            this.#fields.set(row.name, { row, field, root });
            return root;
        });
        this.#rows.replaceChildren(...roots);
        this.#show();
    }

    #edit(row: Row, field: Field): void {
        if (!field.checkValidity()) {
            this.#show();
            return;
        }
        const value = row.unit === FEED_UNIT ? feedOf(Number(field.value)) : Number(field.value);
        this.#put(this.#part, row.name, value);
        this.#show();
    }

    #put(part: Part, name: string, value: number): void {
        const edits = this.#edits.get(part);
        if (value === this.#unit.settings.value.values?.[part][name]) {
            edits?.delete(name);
        } else {
            edits?.set(name, value);
        }
    }

    /** What the unit has by now is no change any more. */
    #dropDone(): void {
        for (const [part, edits] of this.#edits) {
            edits.forEach((value, name) => this.#put(part, name, value));
        }
        this.#show();
    }

    #forget(): void {
        this.#edits.forEach((edits) => edits.clear());
        this.#trouble = "";
        this.#fields.forEach(({ field }) => field.blur());
        this.#show();
    }

    /** Axes that do not let settings of a part be written, in the last look. */
    #taken(part: Part): number[] {
        const axes = this.#unit.now?.axes ?? [];
        const concerned = part === "unit" ? [...AXES] : [PARTS.indexOf(part)];
        return axes.filter(({ axis, status }) => concerned.includes(axis) && status & (STATUS.DISP | STATUS.JEDE)).map(({ axis }) => axis);
    }

    #show(): void {
        const part = this.#part;
        const isKnown = this.#unit.now !== null && this.#unit.settings.value.values !== null;
        const taken = this.#taken(part);
        this.#fields.forEach(({ row, field, root }) => {
            const value = this.#valueOf(part, row.name);
            const isBad = !field.checkValidity() && document.activeElement === field;
            if (document.activeElement !== field || field instanceof HTMLSelectElement) {
                field.value = value === null ? "" : row.unit === FEED_UNIT ? feedValue(value) : String(value);
            }
            field.disabled = !isKnown || taken.length > 0;
            field.setAttribute("aria-invalid", String(isBad));
            root.dataset.changed = String(this.#edits.get(part)?.has(row.name) === true);
        });
        const changed = PARTS.filter((each) => (this.#edits.get(each)?.size ?? 0) > 0);
        const count = changed.reduce((sum, each) => sum + (this.#edits.get(each)?.size ?? 0), 0);
        const inTheWay = [...new Set(changed.flatMap((each) => this.#taken(each)))];
        const anyTaken = this.#taken("unit").length > 0;
        const set = (id: string, isOn: boolean): void => void (byId(id, HTMLButtonElement).disabled = !isOn);
        this.#write.textContent = count === 0 ? t("settings.write") : t("settings.writeCount", { count });
        this.#deliver.textContent = t(this.#sure === 0 ? "settings.deliver" : "settings.deliverSure");
        this.#deliver.classList.toggle("danger", this.#sure !== 0);
        set("settings-write", isKnown && count > 0 && inTheWay.length === 0);
        set("settings-undo", count > 0);
        set("settings-read", this.#unit.now !== null);
        set("settings-store", isKnown && !anyTaken);
        set("settings-deliver", isKnown && !anyTaken);
        set("settings-save", this.#unit.settings.value.file !== null);
        set("settings-open", isKnown);
        const axes = (inTheWay.length > 0 ? inTheWay : taken).join(", ");
        const why = axes === "" ? "" : t("settings.taken", { axes });
        const where = changed.length === 0 ? "" : t("settings.changed", { where: changed.map(partName).join(", ") });
        this.#words.textContent = [this.#trouble, why, where].filter((words) => words !== "").join(" ");
        this.#words.dataset.kind = this.#trouble !== "" ? "bad" : "none";
    }

    #send(): void {
        const bad = [...this.#fields.values()].find(({ field }) => !field.reportValidity());
        if (bad) {
            return;
        }
        const values: Values = {};
        this.#edits.forEach((edits, part) => {
            if (edits.size > 0) {
                values[part] = Object.fromEntries(edits);
            }
        });
        this.#unit.link.send({ type: "write", id: this.#unit.link.nextId(), values });
    }

    /** It takes two presses: a question in a window of its own would keep Escape, which is STOP. */
    #takeDelivered(): void {
        const isSure = this.#sure !== 0;
        window.clearTimeout(this.#sure);
        this.#sure = 0;
        if (isSure) {
            this.#unit.ask("deliver");
        } else {
            this.#sure = window.setTimeout(() => {
                this.#sure = 0;
                this.#show();
            }, SURE_MS);
        }
        this.#show();
    }

    #save(): void {
        const url = URL.createObjectURL(new Blob([this.#unit.settings.value.file ?? ""], { type: "application/json" }));
        make("a", { href: url, download: "positioning.json" }).click();
        URL.revokeObjectURL(url);
    }

    /** Shows what a file has otherwise; nothing is written yet. */
    async #open(): Promise<void> {
        const file = this.#file.files?.[0];
        this.#file.value = "";
        if (!file) {
            return;
        }
        this.#trouble = "";
        try {
            const found = await (isAlone ? this.#readHere(file) : readByService(file));
            if (typeof found === "string") {
                this.#trouble = found;
            } else {
                this.#forget();
                PARTS.forEach((part) => Object.entries(found[part]).forEach(([name, value]) => this.#put(part, name, value)));
            }
        } catch {
            this.#trouble = t("state.notSent");
        }
        this.#show();
    }

    /** The settings of a file, or what is wrong with it. */
    async #readHere(file: File): Promise<AllSettings | string> {
        const found = readText(await file.text(), this.#all);
        return "trouble" in found ? `${file.name}: ${t(found.trouble, { which: found.which })}; ${t("file.none")}` : found;
    }
}

/** Likewise, as the service reads it. */
async function readByService(file: File): Promise<AllSettings | string> {
    const answer = await fetch(`/api/settings?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
    const found = (await answer.json()) as AllSettings & { error?: Trouble };
    return answer.ok ? found : found.error ? (await servedWords())(troubleText(found.error)) : t("state.notSent");
}

const partName = (part: Part): string => (part === "unit" ? t("settings.unit") : t("axis.name", { axis: PARTS.indexOf(part) }));

const choices = (name: string): HTMLOptionElement[] => (CHOICES[name] ?? []).map(([value, text]) => make("option", { value: String(value) }, text));

function limits({ unit, form, least, most }: Row): Record<string, string> {
    const lowest = form === "ZERO_OR" ? 0 : least;
    return unit === FEED_UNIT
        ? { min: String(Math.floor((lowest / FEED_PER_MM_MIN) * 1e6) / 1e6), max: "65535.999985", step: "any" }
        : { min: String(lowest), max: String(most), step: "1" };
}

function rangeText({ unit, form, least, most }: Row): string {
    const text = (value: number): string => (unit === FEED_UNIT ? numberText(value / FEED_PER_MM_MIN, 5) : numberText(value));
    return `${form === "ZERO_OR" ? "0, " : ""}${text(least)} … ${text(most)}`;
}
