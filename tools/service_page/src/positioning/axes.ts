import type { Danger } from "../danger";
import { byId } from "../dom";
import { Card } from "./card";
import { language, t } from "./i18n";
import { AXES } from "./protocol";
import type { Unit } from "./unit";

/** The cards of all axes. */
export class Axes {
    constructor(unit: Unit, danger: Danger) {
        const cards = AXES.map((axis) => new Card(unit, danger, axis));
        const show = (): void => {
            byId("live", HTMLElement).dataset.fresh = String(unit.now !== null);
            cards.forEach((card) => card.show());
        };
        byId("axes", HTMLElement).append(...cards.map(({ root }) => root));
        unit.watch(show);
        unit.settings.onChange(show);
        danger.isConfirmed.onChange(show);
        language.watch(() => byId("live", HTMLElement).setAttribute("aria-label", t("axes.title")));
        language.onChange(() => {
            cards.forEach((card) => card.name());
            show();
        });
    }
}
