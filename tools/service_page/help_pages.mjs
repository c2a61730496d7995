// Makes the module `help-pages` of what the page shows of the project's own documents: their text, section by section,
// in English and, of those with a `.cs.md` beside them, in Czech, and the table of commands. There is no second copy.
import { Marked } from "marked";
import { existsSync } from "node:fs";
import { readFile, readdir } from "node:fs/promises";
import { basename, posix } from "node:path";

const ROOT = "../..";
const DOCUMENTS = [
    "firmware/rkm04/docs/language.md",
    "firmware/rkm04/docs/unit.md",
    "firmware/docs/motion.md",
    "firmware/rkm04/docs/messages.md",
    "firmware/rkm04/docs/line.md",
];
const BOARDS = "hal/stm32/boards";
/** The chapter that is shown of a board's page. */
const FLASHING = { en: "Flashing", cs: "Nahrání firmwaru" };
const TABLE = "firmware/rkm04/program/program_opcodes.def";
/** Sections have headings of these depths; the title of a document is a section of its own. */
const DEPTH_MAX = 3;
/** A document's title stands below that of the panel, which is a second one. */
const BELOW = 2;

const escaped = (text) =>
    text.replace(/[&<>"]/g, (sign) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[sign]);

/** The anchor of a heading, as GitHub makes it. */
const slug = (text) =>
    text.toLowerCase().replace(/[^\p{L}\p{N}\s_-]/gu, "").trim().replace(/\s/g, "-");

const anchor = (document, heading) => `help-${basename(document, ".md")}${heading ? `-${heading}` : ""}`;

const inEnglish = (document) => document;

/** What is shown of a document when the page is in Czech. */
function inCzech(document) {
    const czech = document.replace(/\.md$/, ".cs.md");
    return existsSync(`${ROOT}/${czech}`) ? czech : document;
}

async function headingsOf(document) {
    const tokens = new Marked().lexer(await readFile(`${ROOT}/${document}`, "utf8"));
    return tokens.filter(({ type }) => type === "heading").map(({ depth, text }) => (depth === 1 ? "" : slug(text)));
}

/** The anchor in the page of each heading that is shown; a Czech one has the English one's, so that links to it hold. */
async function placesOf(versionOf) {
    const places = DOCUMENTS.map(async (document) => {
        const [english, shown] = await Promise.all([document, versionOf(document)].map(headingsOf));
        return shown.map((heading, at) => [`${versionOf(document)}#${heading}`, anchor(document, english[at])]);
    });
    return new Map((await Promise.all(places)).flat());
}

/** A heading as links write it. */
function wantedBy(document, href) {
    const [path, heading = ""] = href.split("#");
    return `${path === "" ? document : posix.normalize(posix.join(posix.dirname(document), path))}#${heading}`;
}

function rendererOf(document, places) {
    return {
        heading({ tokens, depth, text }) {
            const words = this.parser.parseInline(tokens);
            const id = places.get(`${document}#${depth === 1 ? "" : slug(text)}`);
            return `<h${depth + BELOW}${id === undefined ? "" : ` id="${id}"`}>${words}</h${depth + BELOW}>`;
        },
        link({ href, tokens }) {
            const words = this.parser.parseInline(tokens);
            if (/^https?:/.test(href)) {
                return `<a href="${escaped(href)}" target="_blank" rel="noreferrer">${words}</a>`;
            }
            const place = places.get(wantedBy(document, href));
            return place === undefined ? words : `<a href="#${place}">${words}</a>`;
        },
        image: ({ text }) => escaped(text),
        code({ text, lang }) {
            const code = `<code>${escaped(text)}</code>`;
            return lang === "rks"
                ? `<div class="program"><pre>${code}</pre></div>`
                : `<pre class="drawn" tabindex="0">${code}</pre>`;
        },
        html: ({ text }) => escaped(text),
    };
}

/** The parts of a text; where its lines end says nothing, and takes a kilobyte of the page. */
function tokensOf(marked, text) {
    const tokens = marked.lexer(text);
    marked.walkTokens(tokens, (token) => {
        if (token.type === "text") {
            token.text = token.text.replaceAll("\n", " ");
        }
    });
    return tokens;
}

/** No text has a bare ">", so only tags are joined; what the parser of HTML ends itself takes a kilobyte of the page. */
const htmlOf = (marked, tokens) => marked.parser(tokens).replaceAll(">\n", ">").replace(/<\/(?:li|p|t[dhr])>/g, "");

async function textOf(document, places) {
    const marked = new Marked({ renderer: rendererOf(document, places) });
    const tokens = tokensOf(marked, await readFile(`${ROOT}/${document}`, "utf8"));
    const sections = [];
    for (const token of tokens) {
        if (sections.length === 0 || (token.type === "heading" && token.depth <= DEPTH_MAX)) {
            sections.push([]);
        }
        sections.at(-1).push(token);
    }
    const title = tokens.find(({ type, depth }) => type === "heading" && depth === 1).text;
    return { title, sections: sections.map((part) => htmlOf(marked, part)) };
}

async function pages() {
    const [places, czechPlaces] = await Promise.all([inEnglish, inCzech].map(placesOf));
    return Promise.all(
        DOCUMENTS.map(async (document) => {
            const czech = inCzech(document);
            const cs = czech === document ? undefined : await textOf(czech, czechPlaces);
            return { id: anchor(document, ""), texts: { en: await textOf(document, places), cs } };
        }),
    );
}

/** The chapter of a document that has this heading, without the heading; empty where there is none. */
async function chapterOf(document, title, places) {
    const marked = new Marked({ renderer: rendererOf(document, places) });
    const text = await readFile(`${ROOT}/${document}`, "utf8");
    const tokens = tokensOf(marked, text);
    const begin = tokens.findIndex((token) => token.type === "heading" && token.text === title);
    const after = tokens.slice(begin + 1);
    const end = after.findIndex(({ type, depth }) => type === "heading" && depth <= tokens[begin]?.depth);
    return begin < 0 ? "" : htmlOf(marked, end < 0 ? after : after.slice(0, end));
}

/** The boards, each with where its image begins and what its page says of flashing. */
async function boards() {
    const [places, czechPlaces] = await Promise.all([inEnglish, inCzech].map(placesOf));
    const names = (await readdir(`${ROOT}/${BOARDS}`, { withFileTypes: true })).filter((each) => each.isDirectory());
    return Promise.all(
        names.map(async ({ name }) => {
            const document = `${BOARDS}/${name}/README.md`;
            const header = await readFile(`${ROOT}/${BOARDS}/${name}/board.h`, "utf8");
            const loader_bytes = Number(/^#define BOARD_LOADER_BYTES (\w+)$/m.exec(header)?.[1] ?? 0);
            const slow_crystal = /^#define BOARD_SLOW_CRYSTAL 1$/m.test(header);
            const text = await readFile(`${ROOT}/${document}`, "utf8");
            const czech = inCzech(document);
            const cs = czech === document ? undefined : await chapterOf(czech, FLASHING.cs, czechPlaces);
            const flashing = { en: await chapterOf(document, FLASHING.en, places), cs };
            return { name, title: /^# (.+)$/m.exec(text)[1], loader_bytes, slow_crystal, flashing };
        }),
    );
}

const ROW = /^X\((\w+), '(\\?.)', (\w+), (-?\d+), (-?\d+)\)$/;

async function commands() {
    const rows = (await readFile(`${ROOT}/${TABLE}`, "utf8")).split("\n").filter((line) => line.startsWith("X("));
    return rows.map((row) => {
        const [, name, letter, form, min, max] = ROW.exec(row) ?? [];
        if (name === undefined) {
            throw new Error(`${TABLE}: ${row} is no row of a command`);
        }
        return { name, letter: letter.at(-1), form, min: Number(min), max: Number(max) };
    });
}

/** A plugin of esbuild. */
export const helpPages = {
    name: "help-pages",
    setup(builder) {
        builder.onResolve({ filter: /^help-pages$/ }, () => ({ path: "help-pages", namespace: "help" }));
        builder.onLoad({ filter: /./, namespace: "help" }, async () => {
            const text = { pages: await pages(), commands: await commands(), boards: await boards() };
            return { contents: JSON.stringify(text), loader: "json" };
        });
    },
};
