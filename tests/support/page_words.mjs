// The words of a page in its languages.
//
//   node page_words.mjs ESBUILD FOLDER       FOLDER: where en.ts and cs.ts are
//
// Prints {"en": {key: text}, "cs": {...}}.
import { createRequire } from "node:module";

const [esbuild, folder] = process.argv.slice(2);
const { build } = createRequire(import.meta.url)(esbuild);
const entry = { contents: `export { en } from "./en"; export { cs } from "./cs";`, resolveDir: folder };
const made = await build({ stdin: entry, bundle: true, format: "esm", write: false });
const code = Buffer.from(made.outputFiles[0].contents).toString("base64");
const { en, cs } = await import(`data:text/javascript;base64,${code}`);
console.log(JSON.stringify({ en, cs }));
