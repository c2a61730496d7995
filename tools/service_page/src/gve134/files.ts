/** What is wrong in vectors, G-code and machine files, in the language of the page. */
import { servedWords, type Told } from "../common/files";
import { told } from "../common/told";
import { isAlone } from "./i18n";

/** What a page without a service says of files it says itself. */
export const fileWords = async (): Promise<Told> => (isAlone ? told : servedWords());
