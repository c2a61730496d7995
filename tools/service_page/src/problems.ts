import type { Diagnostic } from "@codemirror/lint";
import type { Text } from "@codemirror/state";
import type { Problem } from "./protocol";
import { told } from "./common/told";

/** Columns count characters, the editor counts UTF-16 units: they differ after characters outside the BMP. */
function unitsBefore(line: string, column: number): number {
    return Array.from(line).slice(0, column - 1).join("").length;
}

/** The place of a problem in a document; at least one character wide where the line has one. */
export function toDiagnostic(doc: Text, problem: Problem): Diagnostic {
    const line = doc.line(Math.min(Math.max(problem.line, 1), doc.lines));
    const from = Math.min(line.from + unitsBefore(line.text, problem.column), line.to);
    const end = line.from + unitsBefore(line.text, problem.end_column);
    const to = Math.min(Math.max(end, from + 1), line.to);
    return {
        from: from === to ? Math.max(line.from, from - 1) : from,
        to,
        severity: problem.severity,
        message: told(problem.message),
    };
}
