// Verdict on an embryo by the rules of plica.verdict (docs/how-to/answers.md).
import { Column, hasEnded } from "./column";

const furrowed_um = 1; // below its lips
const deep_um = 15; // below the reference position, if the lips have moved inward, too

export const verdictRule = `Furrowed: bottom at least ${furrowed_um} µm below the lips, or ${deep_um} µm deep; flattened: less.`;
const verdicts = ["closed", "furrowed", "flattened", "passes through itself"];
export const verdictColours: Record<string, string> = {
  closed: "#009e73", furrowed: "#0072b2", flattened: "#e69f00", "passes through itself": "#d55e00",
};

/** Column of verdicts, if the study has the required output variables; missing for runs without a result. */
export function verdictColumn(columns: Column[]): Column | null {
  const named = (name: string) => columns.find((column) => column.name === name);
  const [closed, belowLips, depth] = ["lips_closed_time_s", "furrow_depth_below_lips_um", "furrow_depth_um"].map(named);
  const [status, crossings] = [columns.find(({ role }) => role === "status"), named("self_intersections")];
  if (!closed || !belowLips || !depth || !status) return null;
  const values = Float64Array.from(status.values, (_, row) => {
    if (!hasEnded(status, row)) return NaN;
    if (crossings && crossings.values[row] > 0) return verdicts.indexOf("passes through itself");
    if (closed.has(row)) return verdicts.indexOf("closed");
    if (!belowLips.has(row) && !depth.has(row)) return NaN;
    const isFurrow = belowLips.values[row] >= furrowed_um || depth.values[row] >= deep_um;
    return verdicts.indexOf(isFurrow ? "furrowed" : "flattened");
  });
  return new Column({ name: "verdict", role: "verdict", words: verdicts }, values);
}

/** Columns with the verdicts, if available, after the status. */
export function withVerdict(columns: Column[]): Column[] {
  const verdict = verdictColumn(columns);
  return verdict ? columns.flatMap((column) => (column.role === "status" ? [column, verdict] : [column])) : columns;
}
