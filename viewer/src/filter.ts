// Which runs a text asks for: "k4 young>=1000" are those whose name holds "k4" and whose Young's modulus is 1000 or more.

/** What a run can be asked for: names of quantities and their values as texts; those that are asked for most come first. */
export type Traits = Map<string, string>;

const comparison = /^([^<>=]+)(<=|>=|=|<|>)(.+)$/;

/** Whether the traits have all words of the text. A word without a comparison is part of a text or a whole number. */
export function matches(traits: Traits, text: string): boolean {
  return wordsOf(text).every((word) => hasWord(traits, word));
}

/** What a text asks for, word by word. */
export function wordsOf(text: string): string[] {
  return text.toLowerCase().split(/\s+/).filter((word) => word !== "");
}

/** A comparison's quantity, sign and value; null for another word. */
export function comparisonIn(word: string): { name: string; sign: string; value: string } | null {
  const parts = comparison.exec(word);
  return parts && { name: parts[1], sign: parts[2], value: parts[3] };
}

/** Whether a quantity may be meant: it has a word that begins so, as "young" in elasticity.young_modulus_Pa. */
export function isNamed(quantity: string, name: string): boolean {
  return `.${quantity.toLowerCase().replaceAll("_", ".")}`.includes(`.${name.replaceAll("_", ".")}`);
}

function hasWord(traits: Traits, word: string): boolean {
  const asked = comparisonIn(word);
  if (!asked) return [...traits.values()].some((value) => isPart(value.toLowerCase(), word));
  const named = [...traits].find(([quantity]) => isNamed(quantity, asked.name));
  return named !== undefined && compares(named[1].toLowerCase(), asked.sign, asked.value);
}

/** Whether a word is part of a text, or is a whole number. */
export function isPart(value: string, word: string): boolean {
  return Number.isNaN(Number(value)) ? value.includes(word) : value === word;
}

/** Whether a value, "" where it is missing, is as the sign says to the wanted one. */
export function compares(own: string, sign: string, wanted: string): boolean {
  const [a, b] = [Number(own), Number(wanted)];
  if (own === "" || Number.isNaN(a) || Number.isNaN(b)) return sign === "=" && own === wanted;
  if (sign === "=") return a === b;
  if (sign.startsWith("<")) return a < b || (sign === "<=" && a === b);
  return a > b || (sign === ">=" && a === b);
}
