// Filter of runs by text: "k4 young>=1000" selects names containing "k4" with a Young's modulus of at least 1000.

/** Searchable traits of a run: names of quantities with values as texts, most frequent first. */
export type Traits = Map<string, string>;

const comparison = /^([^<>=]+)(<=|>=|=|<|>)(.+)$/;

/** Whether the traits match all words of the text. A word without comparison matches part of a text, or a number. */
export function matches(traits: Traits, text: string): boolean {
  return wordsOf(text).every((word) => hasWord(traits, word));
}

/** Parse a filter text, word by word. */
export function wordsOf(text: string): string[] {
  return text.toLowerCase().split(/\s+/).filter((word) => word !== "");
}

/** Parse a comparison into quantity, sign and value; null for another word. */
export function comparisonIn(word: string): { name: string; sign: string; value: string } | null {
  const parts = comparison.exec(word);
  return parts && { name: parts[1], sign: parts[2], value: parts[3] };
}

/** Whether a word of the quantity starts with the text, as "young" for elasticity.young_modulus_Pa. */
export function isNamed(quantity: string, name: string): boolean {
  return `.${quantity.toLowerCase().replaceAll("_", ".")}`.includes(`.${name.replaceAll("_", ".")}`);
}

function hasWord(traits: Traits, word: string): boolean {
  const asked = comparisonIn(word);
  if (!asked) return [...traits.values()].some((value) => isPart(value.toLowerCase(), word));
  const named = [...traits].find(([quantity]) => isNamed(quantity, asked.name));
  return named !== undefined && compares(named[1].toLowerCase(), asked.sign, asked.value);
}

/** Whether a word is part of a text, or equals a number. */
export function isPart(value: string, word: string): boolean {
  return Number.isNaN(Number(value)) ? value.includes(word) : value === word;
}

/** Whether a value ("" if missing) fulfils the comparison with the wanted one. */
export function compares(own: string, sign: string, wanted: string): boolean {
  const [a, b] = [Number(own), Number(wanted)];
  if (own === "" || Number.isNaN(a) || Number.isNaN(b)) return sign === "=" && own === wanted;
  if (sign === "=") return a === b;
  if (sign.startsWith("<")) return a < b || (sign === "<=" && a === b);
  return a > b || (sign === ">=" && a === b);
}
