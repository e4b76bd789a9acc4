// Order of values in a sorted table.

const collator = new Intl.Collator("en", { numeric: true }); // run-2 before run-10

/** Comparison for Array.sort; missing values last. */
export function compareValues(a: string | number | null, b: string | number | null, down: boolean): number {
  if (a === null || b === null) return Number(a === null) - Number(b === null);
  const difference = typeof a === "number" && typeof b === "number" ? a - b : collator.compare(String(a), String(b));
  return down ? -difference : difference;
}
