// Makes the module `pos-registers` of firmware/positioning/registers/registers.def, the one list of them.
import { readFile } from "node:fs/promises";

const TABLE = "../../firmware/positioning/registers/registers.def";
const REGISTER = /^([UA])\((\w+), (\d+), (\w+), (\w+), (\w+), (-?\d+), (-?\d+), (\d+), "(.*?)", "(.*?)"\)$/gm;
const IMAGE = /^W\((\w+), (\d+), (\d+), ([\d, ]+)\)$/gm;
const INSTRUCTION = /^I\((\w+), (\d+)\)$/gm;
const BIT = /^B\((\w+), \w+, (\d+), ".*"\)$/gm;

const each = (text, pattern) => [...text.matchAll(pattern)].map(([, ...cells]) => cells);

async function table() {
    const text = await readFile(TABLE, "utf8");
    const rows = each(text, REGISTER).map(([scope, name, number, type, use, form, least, most, start, unit, words]) => ({
        scope, name, number: Number(number), type, use, form, least: Number(least), most: Number(most), start: Number(start),
        unit, text: words,
    }));
    if (rows.length !== (text.match(/^[UA]\(/gm) ?? []).length) {
        throw new Error(`${TABLE}: a row has another form than the others`);
    }
    const images = each(text, IMAGE).map(([name, first, count]) => [name, { first: Number(first), words: Number(count) }]);
    const codes = each(text, INSTRUCTION).map(([name, code]) => [name, Number(code)]);
    const bits = each(text, BIT).map(([name, bit]) => [name, 2 ** Number(bit)]);
    const made = { rows, images: Object.fromEntries(images), instructions: Object.fromEntries(codes), bits: Object.fromEntries(bits) };
    return Object.entries(made).map(([name, value]) => `export const ${name} = ${JSON.stringify(value)};`).join("\n");
}

export const registerTable = {
    name: "pos-registers",
    setup(builder) {
        builder.onResolve({ filter: /^pos-registers$/ }, () => ({ path: "pos-registers", namespace: "registers" }));
        builder.onLoad({ filter: /./, namespace: "registers" }, async () => ({ contents: await table() }));
    },
};
