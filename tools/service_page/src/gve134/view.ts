/** From pulses to the screen: turned, shifted, enlarged. */

export type Place = readonly [x: number, y: number, z: number];
type Flat = readonly [u: number, v: number];

const FROM_ABOVE = { turn: 0, tilt: Math.PI / 2 };
const ASLANT = { turn: -0.6, tilt: 0.55 };
const ROOM = 0.86;
const SPAN_MIN = 1e-9;
const SCALE_MAX = 1e9;

export class View {
    #angle = { ...FROM_ABOVE };
    #middle: Flat = [0, 0];
    /** Pixels a unit. */
    scale = 1;
    isFlat = true;
    width = 1;
    height = 1;

    choose(isFlat: boolean): void {
        this.isFlat = isFlat;
        this.#angle = { ...(isFlat ? FROM_ABOVE : ASLANT) };
    }

    flat([x, y, z]: Place): Flat {
        const { turn, tilt } = this.#angle;
        const [c, s] = [Math.cos(turn), Math.sin(turn)];
        return [x * c - y * s, (x * s + y * c) * Math.sin(tilt) + z * Math.cos(tilt)];
    }

    fit(boxes: Iterable<Flat>): void {
        let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
        for (const [u, v] of boxes) {
            [left, right, low, high] = [Math.min(left, u), Math.max(right, u), Math.min(low, v), Math.max(high, v)];
        }
        if (left > right) {
            [left, right, low, high] = [-1, 1, -1, 1];
        }
        this.#middle = [(left + right) / 2, (low + high) / 2];
        const [wide, tall] = [Math.max(right - left, SPAN_MIN), Math.max(high - low, SPAN_MIN)];
        this.scale = Math.min((ROOM * this.width) / wide, (ROOM * this.height) / tall, SCALE_MAX);
        if (right - left < SPAN_MIN && high - low < SPAN_MIN) {
            this.scale = 1;
        }
    }

    /** A drag: from above it shifts, aslant it turns. */
    drag(dx: number, dy: number): void {
        if (this.isFlat) {
            const [u, v] = this.#middle;
            this.#middle = [u - dx / this.scale, v + dy / this.scale];
        } else {
            this.#angle.turn += dx / 150;
            this.#angle.tilt = Math.min(Math.max(this.#angle.tilt + dy / 150, 0), Math.PI / 2);
        }
    }

    /** Enlarges about a point of the canvas. */
    zoom(factor: number, px = this.width / 2, py = this.height / 2): void {
        const [dx, dy] = [px - this.width / 2, py - this.height / 2];
        const [u, v] = this.#middle;
        const shift = (1 - 1 / factor) / this.scale;
        this.#middle = [u + dx * shift, v - dy * shift];
        this.scale *= factor;
    }

    /** Lets paths in flat units be drawn. */
    apply(context: CanvasRenderingContext2D, ratio: number): void {
        const [k, [u, v]] = [this.scale * ratio, this.#middle];
        context.setTransform(k, 0, 0, -k, (this.width / 2) * ratio - u * k, (this.height / 2) * ratio + v * k);
    }

    pixel([u, v]: Flat): Flat {
        const [mu, mv] = this.#middle;
        return [this.width / 2 + (u - mu) * this.scale, this.height / 2 - (v - mv) * this.scale];
    }

    /** The flat places of two opposite corners of the canvas. */
    get corners(): [Flat, Flat] {
        const [u, v] = this.#middle;
        const [w, h] = [this.width / 2 / this.scale, this.height / 2 / this.scale];
        return [[u - w, v - h], [u + w, v + h]];
    }
}
