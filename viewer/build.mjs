// Bundles the viewer into one HTML file without data: node build.mjs OUT.html
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out) {
  console.error("usage: node build.mjs OUT.html");
  process.exit(2);
}

async function bundle(entry) {
  const result = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2020",
    legalComments: "none",
  });
  return result.outputFiles[0].text;
}

// The licences of what is bundled ask to be named in copies.
async function licence(name) {
  const folder = join(here, "node_modules", name);
  const { version } = JSON.parse(await readFile(join(folder, "package.json"), "utf8"));
  return `${name} ${version}\n${await readFile(join(folder, "LICENSE"), "utf8")}`;
}

const [page, script, style, three, uplot] = await Promise.all([
  readFile(join(here, "src", "page.html"), "utf8"),
  bundle("main.ts"),
  bundle("style.css"),
  licence("three"),
  licence("uplot"),
]);
// "</script" inside a string of the program would end the element.
const parts = {
  "<!--plica:style-->": `<style>${style}</style>`,
  "<!--plica:script-->": `<script>${script.replaceAll("</script", "<\\/script")}</script>`,
  "<!--plica:licences-->": `${three}\n${uplot}`.replaceAll("<", "&lt;"),
};
let html = page;
for (const [place, content] of Object.entries(parts)) {
  if (!html.includes(place)) throw new Error(`page.html has no ${place}`);
  html = html.replace(place, () => content);
}
await writeFile(out, html);
console.log(`${out}: ${Math.round(html.length / 1024)} kB`);
