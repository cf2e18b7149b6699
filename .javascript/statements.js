/**
 * Statements of the page's JavaScript by folder, as ESLint's parser finds them; blocks, which only hold others, do not
 * count. `node .javascript/statements.js REVISION` compares the working tree with a revision.
 */

import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { dirname } from "node:path";
import { argv } from "node:process";
import { Linter } from "eslint";

const FOLDER = "service/page/static";
const LINTER = new Linter();
const RULE = {
  create: (context) => ({
    ":statement:not(BlockStatement)": (node) => context.report({ node, message: "statement" }),
  }),
};
const CONFIG = { plugins: { count: { rules: { all: RULE } } }, rules: { "count/all": "warn" } };

function git(...words) {
  return execFileSync("git", words, { encoding: "utf8" });
}

function statementsOf(text, path) {
  const found = LINTER.verify(text, CONFIG, { filename: "module.js" });
  const wrong = found.find(({ fatal }) => fatal);
  if (wrong) throw new Error(`${path}:${wrong.line}: ${wrong.message}`);
  return found.length;
}

/** Return the statements of each folder. files: paths; read: gives the text of one. */
function byFolder(files, read) {
  const counts = {};
  for (const path of files.filter((name) => name.endsWith(".js"))) {
    const folder = dirname(path).slice(FOLDER.length + 1) || "itself";
    counts[folder] = (counts[folder] ?? 0) + statementsOf(read(path), path);
  }
  return { ...counts, together: Object.values(counts).reduce((sum, count) => sum + count, 0) };
}

const now = byFolder(
  git("ls-files", "--cached", "--others", "--exclude-standard", "--deduplicate", FOLDER)
    .split("\n")
    .filter(existsSync),
  (path) => readFileSync(path, "utf8"),
);
const [, , revision] = argv;
const before =
  revision &&
  byFolder(git("ls-tree", "-r", "--name-only", revision, FOLDER).split("\n"), (path) =>
    git("show", `${revision}:${path}`),
  );
for (const [folder, count] of Object.entries(now)) {
  const was = before ? String(before[folder] ?? 0).padStart(8) : "";
  const share = before?.[folder]
    ? `${((100 * count) / before[folder]).toFixed(1)} %`.padStart(10)
    : "";
  console.log(`${folder.padEnd(12)}${was}${String(count).padStart(8)}${share}`);
}
