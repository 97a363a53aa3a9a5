// The page of `lacon report` from its sources: node build.mjs PAGE. One HTML file with styles, script and the licences of what is in it;
// `lacon report` adds the study at the marker.
import {build} from "esbuild";
import {readFileSync, readdirSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const page = process.argv[2];

const bundle = await build({
  entryPoints: [join(here, "src/main.js")],
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  write: false,
  metafile: true,
  logLevel: "warning",
  legalComments: "none", // every licence is there whole
});

/** The packages that the bundle is made of. */
const packages = new Set(Object.keys(bundle.metafile.outputs).flatMap((output) => Object.entries(bundle.metafile.outputs[output].inputs))
  .filter(([, {bytesInOutput}]) => bytesInOutput > 0)
  .map(([path]) => path.match(/.*node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1])
  .filter(Boolean));

function licence(name) {
  const folder = join(here, "node_modules", name);
  const about = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  const file = readdirSync(folder).find((entry) => /^(licen[cs]e|copying)/i.test(entry));
  const text = file ? readFileSync(join(folder, file), "utf8").trim() : `Licence ${about.license}`;
  return `${name} ${about.version} (${about.license})\n\n${text}\n`;
}

const licences = [...packages].sort().map(licence).join(`\n${"-".repeat(80)}\n\n`);
const inline = (text) => text.replaceAll("</script", "<\\/script");
const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
const read = (name) => readFileSync(join(here, "src", name), "utf8");
const parts = {style: read("style.css"), licences: escaped(licences), script: inline(bundle.outputFiles[0].text)};
writeFileSync(page, read("page.html").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]));
