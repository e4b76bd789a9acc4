// Which runs a text asks for: "k4 young>=1000" are those whose name holds "k4" and whose Young's modulus is 1000 or more.

/** What a run can be asked for: names of quantities and their values as texts; those that are asked for most come first. */
export type Traits = Map<string, string>;

const comparison = /^([^<>=]+)(<=|>=|=|<|>)(.+)$/;

/** Whether the traits have all words of the text. A word without a comparison is part of a text or a whole number. */
export function matches(traits: Traits, text: string): boolean {
  const words = text.toLowerCase().split(/\s+/).filter((word) => word !== "");
  return words.every((word) => hasWord(traits, word));
}

function hasWord(traits: Traits, word: string): boolean {
  const parts = comparison.exec(word);
  if (!parts) return [...traits.values()].some((value) => isPart(value.toLowerCase(), word));
  // The first that has a word which begins like that: "young" is elasticity.young_modulus_Pa.
  const named = [...traits].find(([name]) => `.${name.toLowerCase().replaceAll("_", ".")}`.includes(`.${parts[1].replaceAll("_", ".")}`));
  return named !== undefined && compares(named[1].toLowerCase(), parts[2], parts[3]);
}

function isPart(value: string, word: string): boolean {
  return Number.isNaN(Number(value)) ? value.includes(word) : value === word;
}

function compares(own: string, sign: string, wanted: string): boolean {
  const [a, b] = [Number(own), Number(wanted)];
  if (own === "" || Number.isNaN(a) || Number.isNaN(b)) return sign === "=" && own === wanted;
  if (sign === "=") return a === b;
  if (sign.startsWith("<")) return a < b || (sign === "<=" && a === b);
  return a > b || (sign === ">=" && a === b);
}
