// Bundles the viewer into HTML files without data: node build.mjs RUNS.html STUDY.html STUDIO.html
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [ofRuns, ofStudy, ofStudio] = process.argv.slice(2);
if (!ofStudio) {
  console.error("usage: node build.mjs RUNS.html STUDY.html STUDIO.html");
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

// A page and its program and style, from a folder of src, into `file`.
async function make(file, folder, licences) {
  const [page, script, style] = await Promise.all([
    readFile(join(here, "src", folder, "page.html"), "utf8"),
    bundle(join(folder, "main.ts")),
    bundle(join(folder, "style.css")),
  ]);
  // "</script" inside a string of the program would end the element.
  const parts = {
    "<!--plica:style-->": `<style>${style}</style>`,
    "<!--plica:script-->": `<script>${script.replaceAll("</script", "<\\/script")}</script>`,
    "<!--plica:licences-->": licences.join("\n").replaceAll("<", "&lt;"),
  };
  let html = page;
  for (const [place, content] of Object.entries(parts)) {
    if (!html.includes(place)) throw new Error(`page.html has no ${place}`);
    html = html.replace(place, () => content);
  }
  await writeFile(file, html);
  console.log(`${file}: ${Math.round(html.length / 1024)} kB`);
}

const [three, uplot, ...ofMovies] = await Promise.all(["three", "uplot", "modern-gif", "modern-palette"].map(licence));
await make(ofRuns, "", [three, uplot]);
await make(ofStudy, "study", [uplot]);
await make(ofStudio, "studio", [three, uplot, ...ofMovies]);
