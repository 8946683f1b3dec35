// Vendored libraries of the studio: the files of their packages, with bare names of modules made relative, since a page without
// a bundler and without an inline import map cannot look them up.
//   node tests/studio/vendor.mjs           writes them
//   node tests/studio/vendor.mjs --check   fails if a file is not that of its package
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const ROOT = fileURLToPath(new URL("../../", import.meta.url));
const FOLDER = `${ROOT}python/linkwright/studio/static/vendor/`;
const FILES = {
  "preact.mjs": ["preact", "dist/preact.mjs"],
  "hooks.mjs": ["preact", "hooks/dist/hooks.mjs"],
  "signals-core.mjs": ["@preact/signals-core", "dist/signals-core.mjs"],
  "signals.mjs": ["@preact/signals", "dist/signals.mjs"],
  "htm.mjs": ["htm", "dist/htm.mjs"],
  "uPlot.iife.min.js": ["uplot", "dist/uPlot.iife.min.js"],
  "uPlot.min.css": ["uplot", "dist/uPlot.min.css"],
};
const NAMES = { preact: "preact", "preact/hooks": "hooks", "@preact/signals-core": "signals-core", htm: "htm" };

function source([name, path]) {
  const text = readFileSync(`${ROOT}node_modules/${name}/${path}`, "utf8").replace(/\n?\/\/# sourceMappingURL=.*\n?/, "\n");
  return text.replace(/from"([^"./][^"]*)"/g, (_, module) => `from"./${NAMES[module]}.mjs"`);
}

function licences() {
  const names = [...new Set(Object.values(FILES).map(([name]) => name))];
  return names.map((name) => {
    const { version, license } = JSON.parse(readFileSync(`${ROOT}node_modules/${name}/package.json`, "utf8"));
    return `${name} ${version} (${license})\n\n${readFileSync(`${ROOT}node_modules/${name}/LICENSE`, "utf8").trim()}\n`;
  }).join(`\n${"-".repeat(80)}\n\n`);
}

const wanted = { ...Object.fromEntries(Object.entries(FILES).map(([to, from]) => [to, source(from)])), LICENSES: licences() };
const different = Object.entries(wanted).filter(([name, text]) => {
  if (!process.argv.includes("--check")) writeFileSync(FOLDER + name, text);
  return readFileSync(FOLDER + name, "utf8") !== text;
});
if (different.length) {
  console.error(`not the files of their packages: ${different.map(([name]) => name).join(", ")}; run node tests/studio/vendor.mjs`);
  process.exit(1);
}
