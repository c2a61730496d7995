/** What is wrong in vectors, G-code and machine files, in the language of the page. */
import { asTold, servedWords, type Told } from "../common/files";
import { translatorOf } from "../common/patterns";
import type { Language } from "../language";
import { isAlone, language } from "./i18n";
import { VECTORS_CS } from "./vector_words";

/** What a page without a service says of files itself. */
const OWN: Partial<Record<Language, Told>> = { cs: translatorOf(VECTORS_CS) };

export const fileWords = async (): Promise<Told> => (isAlone ? (OWN[language.value] ?? asTold) : servedWords());
