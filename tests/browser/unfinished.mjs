// Reports of unfinished studies, also of earlier program versions, and of a study whose text this program cannot read.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { folderOf, Page, pkmopt } from "./page.mjs";

const folder = folderOf("unfinished");

/** Starts a long study and kills its process when the study file exists; returns the file. */
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
  rmSync(file, { force: true });
  const child = spawn(process.env.PKMOPT, ["run", toml, "--output", file, "--quiet"], { stdio: "ignore" });
  const ended = new Promise((resolve) => child.on("exit", resolve));
  const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  while (!existsSync(file)) await pause(5);
  await pause(100);
  child.kill("SIGKILL");
  await ended;
  return file;
}

{
  const file = await killed(),
    html = path.join(folder, "killed.html");
  pkmopt("report", file, "--output", html, "--force");
  const page = await Page.open(html);
  await page.draw("convergence");
  assert.match(await page.text("#summary"), /still running/);
  assert.ok((await page.panels()).includes("mechanism"));
  await page.close();
}

// A study file that an earlier program version wrote when it was interrupted.
{
  const name = "interrupted-schema-3",
    html = path.join(folder, name + ".html");
  pkmopt("report", path.join(process.env.BROWSER_DATA, name + ".h5"), "--output", html, "--force");
  const page = await Page.open(html);
  const panels = ["summary", "front", "workspace", "mechanism", "convergence", "populations"];
  assert.deepEqual(await page.panels(), panels);
  for (const panel of ["convergence", "front", "populations"]) await page.draw(panel);
  assert.match(await page.text("#summary"), /interrupted/);
  await page.close();
}

const html = path.join(folder, "unreadable.html");
pkmopt("report", path.join(process.env.BROWSER_DATA, "schema-3.h5"), "--output", html, "--force");
const page = await Page.open(html);
await page.draw();
assert.match(await page.text("#summary"), /cannot read the study's text/);
assert.deepEqual(await page.panels(), ["summary", "workspace", "convergence", "populations"]);
await page.screenshots(folder, "unreadable", ["summary"]);
await page.close();
console.log("interrupted, running and unreadable studies have reports");
