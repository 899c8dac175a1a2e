// SPDX-License-Identifier: Apache-2.0
// Bundles the page's script and style, and writes their hashes for the content-security policy.
// usage: node build.mjs FOLDER
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const folder = process.argv[2] ?? "dist";
mkdirSync(folder, { recursive: true });
await build({
  absWorkingDir: fileURLToPath(new URL(".", import.meta.url)),
  entryPoints: { page: "src/main.ts", style: "src/style.css" },
  outdir: folder,
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome100", "firefox113", "safari16.4"],
  charset: "ascii",
  legalComments: "none", // the licences stand whole at the foot of the page
  plugins: [{
    name: "licence",
    setup(bundler) {
      bundler.onLoad({ filter: /[\\/]LICENSE$/ }, ({ path }) => ({ contents: readFileSync(path, "utf8"), loader: "text" }));
    },
  }],
});
for (const name of ["page.js", "style.css"]) {
  // An end tag within a script or style would end it; the hash is of what stands between the tags.
  const text = readFileSync(join(folder, name), "utf8").trimEnd();
  if (/<\/(script|style)|<!--/i.test(text)) throw new Error(`${name} holds an end tag`);
  writeFileSync(join(folder, name), text);
  writeFileSync(join(folder, `${name}.hash`), `sha256-${createHash("sha256").update(text).digest("base64")}`);
}
