/** Words of the links between the pages of all units, where no service serves them. */
export const pagesEn = {
    "page.units": "Units",
    "unit.index": "RKM04",
    "unit.gve134": "GVE134",
    "unit.positioning": "Positioning",
};

export const pagesCs = {
    "page.units": "Jednotky",
    "unit.index": "RKM04",
    "unit.gve134": "GVE134",
    "unit.positioning": "Polohování",
};
