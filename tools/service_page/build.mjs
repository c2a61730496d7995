// Bundles the page into the directory $RKM04_SERVICE_OUT: index.html, page.js, page.css, engine.js (the
// worker of a page without a service) of RKM04, gve134.html and positioning.html with a script
// and a style each, file_words.js, which these two load when they need it, and told_*.json, which all do, gve134_unit.js
// and positioning_unit.js (likewise workers), and icon.svg, nothing else.
import Ajv from "ajv/dist/2020.js";
import standaloneCode from "ajv/dist/standalone/index.js";
import { build } from "esbuild";
import { copyFile, mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { helpPages } from "./help_pages.mjs";
import { registerTable } from "./register_table.mjs";

const out = process.env.RKM04_SERVICE_OUT ?? "../../build/service";

/** What a schema says to people. */
const withoutWords = (name, value) => (name === "description" && typeof value === "string" ? undefined : value);

/** Of the schema itself the code asks which properties there are, and nothing else. */
function onlyNames(schema) {
    const names = Object.keys(JSON.parse(schema).properties);
    return JSON.stringify({ properties: Object.fromEntries(names.map((name) => [name, 0])) });
}

/** The schema of machine files as code, without what nobody reads: the page may not make code of a text itself. */
async function machineRules() {
    const ajv = new Ajv({ allErrors: true, messages: false, code: { source: true, esm: true } });
    const schema = JSON.parse(await readFile("src/machine.schema.json", "utf8"), withoutWords);
    const code = standaloneCode(ajv, ajv.compile(schema));
    const contents = code
        .replace(/schemaPath:"[^"]*",|comparison: "[<>]=?", /g, "")
        .replace(/(?<== )\{"\$schema".*?\}(?=;)/, onlyNames);
    return { contents, resolveDir: process.cwd() };
}

const rules = {
    name: "machine-rules",
    setup(builder) {
        builder.onResolve({ filter: /^machine-rules$/ }, () => ({ path: "machine-rules", namespace: "rules" }));
        builder.onLoad({ filter: /./, namespace: "rules" }, machineRules);
    },
};

/** What a module exports. */
async function evaluated(path) {
    const { outputFiles } = await build({ entryPoints: [path], bundle: true, write: false, format: "esm", charset: "utf8" });
    return import(`data:text/javascript,${encodeURIComponent(outputFiles[0].text)}`);
}

/** The Czech words of a page without their keys, which are those of the English ones. */
const czechWords = {
    name: "czech-words",
    setup(builder) {
        builder.onLoad({ filter: /\/src\/(gve134\/|positioning\/)?cs\.ts$/ }, async ({ path }) => {
            const [{ cs }, { en }] = await Promise.all([path, path.replace(/cs\.ts$/, "en.ts")].map(evaluated));
            const words = JSON.stringify(Object.keys(en).map((key) => cs[key]));
            return {
                contents: `import { en } from "./en";
                    const words = ${words};
                    export const cs = Object.fromEntries(Object.keys(en).map((key, at) => [key, words[at]]));`,
                resolveDir: dirname(path),
            };
        });
    },
};

await mkdir(out, { recursive: true });
await build({
    entryPoints: [
        { in: "src/main.ts", out: "page" },
        { in: "style.css", out: "page" },
        { in: "src/gve134/main.ts", out: "gve134" },
        { in: "gve134.css", out: "gve134" },
        { in: "src/positioning/main.ts", out: "positioning" },
        { in: "positioning.css", out: "positioning" },
        { in: "src/file_words.ts", out: "file_words" },
    ],
    outdir: out,
    external: ["/static/*"],
    plugins: [rules, helpPages, czechWords],
    bundle: true,
    minify: true,
    charset: "utf8",
    format: "esm",
    target: ["chrome109", "firefox115", "safari16"],
    legalComments: "eof",
    logLevel: "warning",
});
await build({
    entryPoints: [
        { in: "src/engine_worker.ts", out: "engine" },
        { in: "src/gve134/alone/worker.ts", out: "gve134_unit" },
        { in: "src/positioning/alone/worker.ts", out: "positioning_unit" },
    ],
    outdir: out,
    plugins: [registerTable, rules],
    bundle: true,
    minify: true,
    charset: "utf8",
    format: "iife",
    target: ["chrome109", "firefox115", "safari16"],
    legalComments: "eof",
    logLevel: "warning",
});
/** English and Czech, line by line. */
const columns = (sentences) => [0, 1].map((column) => sentences.map((each) => each[column]).join("\n"));

/** What units say, in Czech, of which a page without a service has its part (told/NAME.ts). */
async function writeTold(name) {
    const { ALONE, SERVICE } = await evaluated(`src/told/${name}.ts`);
    await writeFile(join(out, `told_${name}.json`), JSON.stringify({ alone: columns(ALONE), service: columns(SERVICE) }));
}

await Promise.all(["rkm04", "gve134", "positioning"].map(writeTold));
for (const name of ["index.html", "gve134.html", "positioning.html", "icon.svg"]) {
    await copyFile(name, join(out, name));
}
