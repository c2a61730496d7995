import type { FromService, Node, UnitState } from "./protocol";

const keyOf = ({ port, node }: Node): string => `${node} ${port}`;

/** Each node once, in the order in which they are named first. */
export const merged = (...nodes: Node[]): Node[] => [...new Map(nodes.map((node) => [keyOf(node), node])).values()];

const without = (all: Node[], these: Node[]): Node[] => {
    const keys = these.map(keyOf);
    return all.filter((each) => !keys.includes(keyOf(each)));
};

/** What the page is told of the connection, and of the units that have answered; every change is told at once. */
export class DeskState {
    readonly #tell: (told: FromService) => void;
    readonly #heard = new Map<string, { node: Node; at_ms: number }>();
    /** Units that may have moved when their port was lost, and were not seen since. */
    #lost: Node[] = [];
    #now: UnitState;

    constructor(port: string, tell: (told: FromService) => void) {
        this.#tell = tell;
        this.#now = {
            connected: true, port, virtual: true, node: 1, busy: null, error: null, unit: null, away: false, nodes: [],
            stop: null, seen_ago_s: null,
        };
    }

    get now(): UnitState {
        return this.#now;
    }

    /** The unit that is shown. */
    get here(): Node {
        return { port: this.#now.port ?? "", node: this.#now.node };
    }

    /** All units of which a stop has to be confirmed. */
    get known(): Node[] {
        return merged(...this.#now.nodes, ...(this.#now.stop ?? []), ...this.#lost);
    }

    change(part: Partial<UnitState>): void {
        this.#now = { ...this.#now, ...part };
        this.tell();
    }

    tell(): void {
        const { stop } = this.#now;
        const heard = this.#heard.get(keyOf(this.here));
        const seen_ago_s = heard === undefined ? null : (performance.now() - heard.at_ms) / 1000;
        const lost = this.#lost.length > 0;
        const open = lost ? merged(...(stop ?? []), ...this.#lost) : stop;
        this.#tell({ type: "state", ...this.#now, stop: open, lost, seen_ago_s });
    }

    /** A node has answered. */
    hear(node: Node): void {
        this.#heard.set(keyOf(node), { node, at_ms: performance.now() });
        if (!this.#now.nodes.some((each) => keyOf(each) === keyOf(node))) {
            this.change({ nodes: this.nodesOf(node.port) });
        }
    }

    /** Those that have answered on a port, the last first. */
    nodesOf(port: string): Node[] {
        const found = [...this.#heard.values()].filter(({ node }) => node.port === port);
        return found.sort((one, other) => other.at_ms - one.at_ms).map(({ node }) => node);
    }

    /** What the units of the port do is not known; the next change tells it. */
    lose(): void {
        this.#lost = merged(...this.#lost, ...this.#now.nodes);
    }

    /** What a node does is known again. */
    see(node: Node): void {
        const left = without(this.#lost, [node]);
        if (left.length < this.#lost.length) {
            this.#lost = left;
            this.tell();
        }
    }

    /** The user has dealt with these: no stop waits for them. */
    forget(nodes: Node[]): void {
        this.#lost = without(this.#lost, nodes);
        this.change({ stop: this.#now.stop && without(this.#now.stop, nodes) });
    }
}
