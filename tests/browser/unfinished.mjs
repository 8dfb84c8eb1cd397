// Reports of unfinished studies, also of earlier program versions, and of a study whose text this program cannot read.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { folderOf, Page, pkmopt } from "./page.mjs";

const folder = folderOf("unfinished");

/** Starts a long study and kills its process when it has stored some generations; returns the file. */
async function killed() {
  const toml = path.join(folder, "killed.toml"),
    file = path.join(folder, "killed.h5");
  writeFileSync(
    toml,
    `[mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
b = { min = 0.7, max = 1.5 }
[baseline]
a = 0.2
[checkpoint]
every = 0
[[objective]]
type = "workspace-ratio"
[[stage]]
optimiser = "ga"
population = 50
generations = 100000
`,
  );
  const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  for (let wait = 100, stored = 0; stored < 2; wait *= 4) {
    rmSync(file, { force: true });
    const child = spawn(process.env.PKMOPT, ["run", toml, "--output", file, "--quiet"], { stdio: "ignore" });
    const ended = new Promise((resolve) => child.on("exit", resolve));
    while (!existsSync(file)) await pause(5);
    await pause(wait);
    child.kill("SIGKILL");
    await ended;
    stored = JSON.parse(pkmopt("show", file, "--json")).stages[0]?.generations ?? 0;
  }
  return file;
}

// One page for all three, because opening a page takes long: a study whose process was killed, one that an earlier
// program version wrote when it was interrupted, and one whose text this version cannot read.
const files = [await killed(), ...["interrupted-schema-3", "schema-3"].map((name) => path.join(process.env.BROWSER_DATA, name + ".h5"))];
const html = path.join(folder, "unfinished.html");
pkmopt("report", ...files, "--output", html, "--force");
const page = await Page.open(html);
const choose = async (i) => {
  await page.page.selectOption("#chooser select", String(i));
  return (await page.panels()).filter((panel) => panel !== "comparison");
};

assert.ok((await choose(0)).includes("mechanism"));
await page.draw("convergence");
assert.match(await page.text("#summary"), /still running/);

assert.deepEqual(await choose(1), ["summary", "front", "workspace", "mechanism", "convergence", "populations"]);
for (const panel of ["convergence", "front", "populations"]) await page.draw(panel);
assert.match(await page.text("#summary"), /interrupted/);

assert.deepEqual(await choose(2), ["summary", "workspace", "convergence", "populations"]);
await page.draw();
assert.match(await page.text("#summary"), /cannot read the study's text/);
await page.screenshots(folder, "unreadable", ["summary"]);
await page.close();
console.log("interrupted, running and unreadable studies have reports");
