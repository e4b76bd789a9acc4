// The parts of a study's page that draw nothing: values of columns, filters, axes, reasons, commands.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const source = join(fileURLToPath(new URL(".", import.meta.url)), "../src/study");
const modules = ["column", "study_data", "selection", "axis", "failures", "run_panel", "filter_bar", "phase"];
const { outputFiles } = await build({
  stdin: { contents: modules.map((name) => `export * from "./${name}";`).join("\n"), resolveDir: source, loader: "ts" },
  bundle: true, write: false, format: "esm", target: "es2022",
});
const parts = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString("base64")}`);
const { Axis, Column, Selection, Study, cellsOf, commandOf, failuresOf, quoted, rangeText, roundValues, tableText } = parts;

const numbers = (name, role, values) => new Column({ name, role }, Float64Array.from(values, (value) => value ?? NaN));
const words = (name, role, list, places) =>
  new Column({ name, role, words: list }, Float64Array.from(places, (place) => place ?? NaN));

function fourRuns(depth_word = "furrow") {
  return new Study({ name: "four", runs: 4, design: "grid", depth_word, scenario_argument: "my fold.toml", set: ["time.end_min=0.2"] }, [
    numbers("point", "point", [1, 2, 3, 4]),
    numbers("contraction.apical.stiffness_nN_per_um", "key", [1, 10, 100, 1000]),
    words("contraction.apical.region", "key", ['"furrow"', '"all"'], [0, 1, 0, 1]),
    numbers("replicate", "replicate", [1, 1, 1, 1]),
    words("status", "status", ["end_time", "failed"], [0, 0, 1, 1]),
    numbers("furrow_depth_um", "measure", [1.5, 2.5, null, null]),
    numbers("cells", "measure", [756, 756, 756, null]),
    numbers("steps", "steps", [20, 21, 3, 0]),
    numbers("wall_s", "wall_s", [0.1, 0.2, 0.3, 0.4]),
    words("reason", "reason", ["at 3.5 s: too short", "at 12 s: too short"], [null, null, 0, 1]),
    words("seeds", "seeds", ["contraction.apical.variation.seed=8"], [0, null, null, null]),
    words("kept", "kept", [], [null, null, null, null]),
  ]);
}

test("columns know their range, their steps and what is missing", () => {
  const depth = fourRuns().columns.find(({ name }) => name === "furrow_depth_um");
  assert.deepEqual([depth.low, depth.high, depth.missing, depth.steps, depth.title], [1.5, 2.5, 2, [1.5, 2.5], "furrow depth, µm"]);
  assert.equal(fourRuns("fold").of("measure")[0].title, "fold depth, µm");
  assert.deepEqual([depth.text(0), depth.text(2), depth.exact(2)], ["1.5", "none", ""]);
  const region = fourRuns().of("key")[1];
  assert.deepEqual([region.text(0), region.exact(0)], ["furrow", '"furrow"']);
  const far = numbers("x", "measure", [...Array(200).keys(), 1e9]);
  assert.ok(far.usualRange.high < 300, "a value far off does not take all the colours");
  const even = numbers("x", "measure", [...Array(200).keys()]);
  assert.deepEqual(even.usualRange, { low: 0, high: 199 });
});

test("keys that end alike are told apart", () => {
  const study = new Study({ runs: 1 }, [
    numbers("contraction.apical.stiffness_nN_per_um", "key", [1]), numbers("contraction.basal.stiffness_nN_per_um", "key", [1]),
    numbers("a.law.apical.x", "key", [1]), numbers("b.law.apical.x", "key", [1]),
  ]);
  assert.deepEqual(study.of("key").map(({ label }) => label), ["apical stiffness", "basal stiffness", "a law apical x", "b law apical x"]);
});

test("text, ranges and ticks leave runs out together", () => {
  const study = fourRuns();
  const selection = new Selection(study, study.the("status"));
  const cases = [
    ["", [0, 1, 2, 3]], ["furrow", [0, 2]], ["stiffness>=10 failed", [2, 3]], ["depth<2", [0]], ["756", [0, 1, 2]],
    ["status=failed", [2, 3]], ["end_time", [0, 1]], ["region=all", [1, 3]], ["depth>=0", [0, 1]], ["nothing=1", []], ["short", [2, 3]],
  ];
  for (const [text, rows] of cases) {
    selection.setText(text);
    assert.deepEqual(selection.shownRows, rows, text);
  }
  selection.setText("");
  selection.setRanges([[study.of("measure")[0], { low: 2, high: 3 }]]);
  assert.deepEqual(selection.shownRows, [1], "no value is in no range");
  selection.setTicks(study.the("status"), new Set([1]));
  assert.deepEqual(selection.shownRows, []);
  selection.clear();
  assert.deepEqual(selection.shownRows, [0, 1, 2, 3]);
});

test("axes go there and back, along logarithms and words, and have a lane for what is missing", () => {
  const { columns } = fourRuns();
  const [, stiffness, region, , , depth] = columns;
  for (const logarithmic of [false, true]) {
    const axis = new Axis(stiffness, 300, 20, logarithmic);
    for (const value of [1, 10, 500, 1000]) assert.ok(Math.abs(axis.valueAt(axis.at(value)) - value) < 1e-6 * value, `${value}`);
    assert.ok(axis.at(1) <= 300 && axis.at(1000) >= 20 && axis.at(1) > axis.at(1000));
    assert.ok(axis.ticks(5).length >= 3);
  }
  assert.deepEqual(new Axis(stiffness, 0, 300, true).ticks(6).map(({ text }) => text).filter((text) => /^10*$/.test(text)), ["1", "10", "100", "1000"]);
  const lane = new Axis(depth, 300, 20);
  assert.ok(lane.hasLane && lane.at(NaN) > lane.at(1.5), "none is below the least");
  assert.deepEqual(new Axis(region, 0, 100).ticks(5).map(({ text }) => text), ["furrow", "all"]);
  assert.equal(new Axis(numbers("same", "measure", [3, 3]), 0, 100).at(3), 50);
  assert.equal(new Axis(numbers("zero", "measure", [-1, 10]), 0, 100, true).isLogarithmic, false);
  assert.deepEqual(roundValues(0.13, 0.97, 4), [0.2, 0.4, 0.6, 0.8]);
});

test("reasons that differ in numbers only are one", () => {
  const [only, ...others] = failuresOf(fourRuns());
  assert.deepEqual([only.reason, only.count, only.statuses, others.length], ["at … s: too short", 2, ["failed"], 0]);
});

test("cells of a phase plot hold their runs", () => {
  const { columns } = fourRuns();
  const cells = [...cellsOf(columns[2], columns[4], [0, 1, 2, 3]).values()];
  assert.deepEqual(cells.map(({ rows, x, y }) => [rows, x, y]), [[[0], 0, 0], [[1], 1, 0], [[2], 0, 1], [[3], 1, 1]]);
});

test("the command of a run can be pasted, and the table saved", () => {
  const study = fourRuns();
  assert.equal(commandOf(study, 0).replaceAll(" \\\n ", ""),
    "plica run 'my fold.toml' --set time.end_min=0.2 --set contraction.apical.variation.seed=8 " +
      `--set contraction.apical.stiffness_nN_per_um=1 --set 'contraction.apical.region="furrow"' --out run-1`);
  assert.equal(quoted("it's"), `'it'\\''s'`);
  const lines = tableText(new Selection(study, study.the("status")), [2, 0]).split("\n");
  assert.equal(lines[0], "point,contraction.apical.stiffness_nN_per_um,contraction.apical.region,replicate,status,furrow_depth_um,cells,steps,wall_s,reason");
  assert.equal(lines[1], "3,100,furrow,1,failed,,756,3,0.3,at 3.5 s: too short");
  assert.equal(rangeText(study.of("key")[1], 0.5, 1.5), "region: all");
  assert.equal(rangeText(study.of("measure")[0], 1, Infinity), "furrow depth ≥ 1 µm");
});
