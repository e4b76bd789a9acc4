// Formatting of numbers and names.

/** Format a number: four or more significant digits, without trailing zeros. */
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e7) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${Number(mantissa)}·10${superscript(Number(exponent))}`.replace("-", "−");
  }
  const text = size >= 10 ** digits ? value.toFixed(0) : String(Number(value.toPrecision(digits)));
  return text.replace("-", "−");
}

function superscript(exponent: number): string {
  return String(exponent).replace(/[-0-9]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
}

export function time(seconds: number): string {
  return seconds < 120 ? `${number(seconds)} s` : `${number(seconds / 60)} min`;
}

// Longer endings come before their parts.
const units: [RegExp, string][] = [
  [/_nN_s_per_um$/, "nN·s/µm"],
  [/_nN_per_um$/, "nN/µm"],
  [/_nN_per_um3$/, "nN/µm³"],
  [/_mN_per_m$/, "mN/m"],
  [/_Pa_s_per_um$/, "Pa·s/µm"],
  [/_Pa_s$/, "Pa·s"],
  [/_kg_per_m3$/, "kg/m³"],
  [/_percent$/, "%"],
  [/_um_per_min$/, "µm/min"],
  [/_um2_per_min$/, "µm²/min"],
  [/_per_min$/, "1/min"],
  [/_per_h$/, "1/h"],
  [/_deg$/, "°"],
  [/_min$/, "min"],
  [/_um_per_s$/, "µm/s"],
  [/_um3$/, "µm³"],
  [/_um2$/, "µm²"],
  [/_nN_um$/, "nN·µm"],
  [/_um$/, "µm"],
  [/_nN$/, "nN"],
  [/_MB$/, "MB"],
  [/_Pa$/, "Pa"],
  [/_s$/, "s"],
];

// Columns whose names do not read as words.
const labels = new Map<string, [string, string]>([
  ["furrow_depth_below_lips_um", ["depth below its borders", "µm"]],
  ["lip_distance_um", ["distance of the contractile borders", "µm"]],
  ["highest_points_distance_um", ["distance of the outermost points", "µm"]],
  ["ends_lead_until_s", ["ends are faster until", "s"]],
  ["depth_20um_time_s", ["time of 20 µm depth", "s"]],
  ["knee_depth_um", ["depth at the onset of fast invagination", "µm"]],
  ["knee_time_s", ["onset of fast invagination", "s"]],
  ["wall_s", ["wall time", "s"]],
  ["wall_solver_s", ["wall time of the solver", "s"]],
  ["max_node_speed_um_per_s", ["largest speed of a node", "µm/s"]],
  ["max_volume_error", ["largest volume error of a cell", ""]],
  ["max_shell_penetration_um", ["largest penetration of the membrane", "µm"]],
  ["max_displacement_um", ["largest displacement", "µm"]],
  ["min_scaled_jacobian", ["smallest scaled Jacobian", ""]],
  ["min_apical_area_ratio", ["smallest apical area / reference area", ""]],
  ["min_corner_jacobian_ratio", ["smallest corner Jacobian / reference value", ""]],
  ["min_contact_distance_um", ["smallest contact distance", "µm"]],
  ["newton_iterations", ["Newton iterations", ""]],
  ["self_intersections", ["self-intersecting pairs of faces", ""]],
  ["self_intersections_time_s", ["first self-intersection", "s"]],
  ["shell_fluid_um3", ["perivitelline volume", "µm³"]],
  ["cubic_three_real_roots", ["cubic equations with three real roots", ""]],
]);

/** Split a column or key into words and unit: "vml_speed_um_per_s" is ["VML speed", "µm/s"]. */
export function words(key: string): [string, string] {
  const label = labels.get(key);
  if (label) return label;
  let name = key;
  let unit = "";
  for (const [ending, words] of units)
    if (ending.test(key)) {
      name = key.replace(ending, "");
      unit = words;
      break;
    }
  name = name.replaceAll("_", " ").replaceAll(".", ": ")
    .replace(/\bvml\b/g, "VML").replace(/\bvce\b/g, "VCE").replace(/\bap\b/g, "position along the axis")
    .replace(/\byoung modulus\b/, "Young's modulus").replace(/\bpoisson ratio\b/, "Poisson's ratio");
  return [name, unit];
}

/** Format a count: "10 000". */
export function count(many: number): string {
  return String(many).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** Last part of a dotted key. */
export function lastOf(key: string): string {
  return key.slice(key.lastIndexOf(".") + 1);
}
