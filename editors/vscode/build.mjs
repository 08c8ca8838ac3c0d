// Bundles the extension into dist/, with the licences of what is in the bundle.

import { build } from "esbuild";
import { existsSync, readFileSync, writeFileSync } from "node:fs";

const { metafile } = await build({
  entryPoints: ["src/extension.ts"],
  outfile: "dist/extension.js",
  bundle: true,
  minify: true,
  metafile: true,
  platform: "node",
  target: "node20",
  format: "cjs",
  external: ["vscode"], // VS Code itself provides it
});

/** The folder of the package that a bundled file is of; of our own files, none. */
function packageOf(file) {
  return /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(file)?.[0];
}

/** What a package says of its licence. */
function noticeOf(folder) {
  const { name, version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const names = ["LICENSE", "LICENSE.md", "LICENSE.txt", "License.txt", "license.txt"];
  const path = names.map((each) => `${folder}/${each}`).find(existsSync);
  if (path === undefined) {
    throw new Error(`${name} ${version} has no file with its licence`);
  }
  return `${name} ${version} (${license})\n\n${readFileSync(path, "utf8").trim()}\n`;
}

const folders = new Set(Object.keys(metafile.inputs).map(packageOf).filter(Boolean));
const notices = [...folders].sort().map(noticeOf);
writeFileSync("dist/THIRD-PARTY-LICENSES.txt", notices.join(`\n${"-".repeat(80)}\n\n`));
