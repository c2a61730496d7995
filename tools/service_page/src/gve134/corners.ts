/** Of longer paths some corners are left out: a page that draws for long does not hear HALT. */
const CORNERS_MAX = 20_000;
const COLUMNS = 5;

/** A place of the plan, pulses; `seconds` since the corner before: NaN where no way leads to it. */
export interface Corner {
    at: readonly number[];
    /** Of each axis whether the place counts from where the axes stand at the beginning. */
    isRelative: readonly boolean[];
    seconds: number;
}

/** The plan to be drawn; `every`: so many vectors are one way in it. */
export interface Corners {
    corners: Corner[];
    every: number;
}

/** From the rows of a course (api.ts); `absoluteFrom`: of each axis the vector from which on its places are absolute. */
export function cornersOf(rows: Float32Array, absoluteFrom: readonly (number | null)[]): Corners {
    const every = Math.max(1, Math.ceil(rows.length / COLUMNS / CORNERS_MAX));
    const corners: Corner[] = [];
    let [vectors, seconds] = [0, 0];
    for (let row = 0; row < rows.length; row += COLUMNS) {
        const took = rows[row + 3] ?? NaN;
        const isBegin = Number.isNaN(took);
        const next = rows[row + COLUMNS + 3];
        const isEnd = next === undefined || Number.isNaN(next);
        const isAbsoluteNext = absoluteFrom.includes(vectors + 1);
        if (isBegin || isEnd || isAbsoluteNext || (vectors + 1) % every === 0) {
            const isRelative = [0, 1, 2].map((axis) => vectors < (absoluteFrom[axis] ?? Infinity));
            const at = [rows[row] ?? 0, rows[row + 1] ?? 0, rows[row + 2] ?? 0];
            corners.push({ at, isRelative, seconds: isBegin ? NaN : seconds + took });
            seconds = 0;
        } else {
            seconds += took;
        }
        vectors += isBegin ? 0 : 1;
    }
    return { corners, every };
}

/** A way that was made, thinned out when it becomes long. */
export function thinned<T>(places: T[]): T[] {
    return places.length > CORNERS_MAX ? places.filter((_, number) => number % 2 === 0) : places;
}
