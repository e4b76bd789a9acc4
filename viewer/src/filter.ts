// Which runs a text asks for: "k4 young>=1000" are those whose name holds "k4" and whose Young's modulus is 1000 or more.

/** What a run can be asked for: names of quantities and their values as texts. */
export type Traits = Map<string, string>;

const comparison = /^([^<>=]+)(<=|>=|=|<|>)(.+)$/;

/** Whether the traits have all words of the text. A word without a comparison stands anywhere in a name or a value. */
export function matches(traits: Traits, text: string): boolean {
  const words = text.toLowerCase().split(/\s+/).filter((word) => word !== "");
  return words.every((word) => hasWord(traits, word));
}

function hasWord(traits: Traits, word: string): boolean {
  const parts = comparison.exec(word);
  for (const [name, value] of traits) {
    const [key, own] = [name.toLowerCase(), value.toLowerCase()];
    if (!parts ? own.includes(word) : key.includes(parts[1]) && compares(own, parts[2], parts[3])) return true;
  }
  return false;
}

function compares(own: string, sign: string, wanted: string): boolean {
  const [a, b] = [Number(own), Number(wanted)];
  if (own === "" || Number.isNaN(a) || Number.isNaN(b)) return sign === "=" && own === wanted;
  if (sign === "=") return a === b;
  if (sign.startsWith("<")) return a < b || (sign === "<=" && a === b);
  return a > b || (sign === ">=" && a === b);
}
