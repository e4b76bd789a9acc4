// The report of experiments: a table of outcomes above their runs.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { begin, end, folder, open } from "./browser.mjs";

const experiments = `
title = "A <b>small</b> division"
scenario = "division-demo"
[experiment.reference]
question = "How many cells are there at last?"
observed = "Four."
source = "Fig. 4"
role = "fitted"
[experiment.reference.outcome.cells]
quantity = "cells"
hit = [4, 4]
[experiment.short]
question = "How many are there before the division?"
prediction = "hit"
because = "It divides at 1 min."
set = { "time.end_s" = 30 }
[experiment.short.outcome.cells]
quantity = "cells"
hit = [4, 4]
`;

before(async () => {
  writeFileSync(join(folder, "mine.toml"), experiments);
  execFileSync(process.env.PLICA ?? "plica", ["reproduce", join(folder, "mine.toml"), "--out", join(folder, "out"), "--quiet"]);
  await begin();
});
after(end);

test("the outcomes are listed with their verdicts, by which they are chosen", async () => {
  const { page, done } = await open("out/report.html");
  assert.equal(await page.locator("#title").textContent(), "A <b>small</b> division");
  const rows = () => page.locator("#outcomes tbody tr:visible").evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  assert.deepEqual(await rows(), [
    ["miss", "short, cells", "How many are there before the division?", "", "3", "cells, 4 to 4", "0 of 1", "predicted", "hit", "It divides at 1 min."],
    ["hit", "reference, cells", "How many cells are there at last?", "Four. (Fig. 4)", "4", "cells, 4 to 4", "1 of 1", "fitted", "–", ""],
  ]);
  await page.selectOption("#verdict", "hit");
  assert.deepEqual((await rows()).map((row) => row[1]), ["reference, cells"]);
  assert.deepEqual(await page.locator("#runs tbody tr").evaluateAll((all) => all.map((row) => row.dataset.run)), ["reference", "short"]);
  await done();
});
