// Reports of several studies: the comparison, and the panels of the selected study. Page of one design without a study.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { folderOf, Page, pkmopt, reportOf, studies } from "./page.mjs";

const folder = folderOf("comparison");
const files = ["2t1r-p-hybrid", "quadrupteron"].map(
  (name) => reportOf(path.join(studies, name + ".toml"), folder).file,
);
const html = path.join(folder, "several.html");
pkmopt("report", ...files, "--output", html, "--force");
const page = await Page.open(html);
assert.equal((await page.panels())[0], "comparison");
await page.draw("comparison");
const { studies: shown } = await page.data();
const table = await page.text("#comparison");
for (const study of shown) assert.ok(table.includes(study.name), study.name);
await page.screenshots(folder, "1280-light", ["comparison"]);
for (const [i, study] of shown.entries()) {
  await page.page.selectOption("#chooser select", String(i));
  assert.equal(await page.text("h1"), study.name);
}
await page.draw("front"); // only the second study has a front
await page.close();

/** Titles, trace types and text of the comparisons of two runs of a study with different seeds, also in a task. */
async function compared(toml, task) {
  const runs = ["1", "2"].map((seed) => {
    const file = path.join(folder, path.basename(toml, ".toml") + "-" + seed + ".h5");
    pkmopt("run", toml, "--output", file, "--seed", seed, "--force", "--quiet");
    return file;
  });
  const name = path.basename(toml, ".toml") + "-compared";
  const html = path.join(folder, name + ".html"),
    taskFile = path.join(folder, name + "-task.toml");
  writeFileSync(taskFile, task);
  pkmopt("report", ...runs, "--task", taskFile, "--output", html, "--force");
  const both = await Page.open(html);
  const found = {};
  for (const panel of ["task", "comparison"]) {
    await both.draw(panel);
    const titles = await both.page.locator(`#${panel} h3`).allInnerTexts();
    const traces = await both.page.locator(`#${panel} .plot`).evaluateAll((plots) =>
      plots.map((plot) => plot.data.map(({ type }) => type).join(" ")),
    );
    found[panel] = { titles, traces, text: await both.text("#" + panel) };
  }
  await both.screenshots(folder, name, ["task", "comparison"]);
  await both.close();
  return found;
}
const solid = await compared(
  path.join(studies, "3crr-r-cru.toml"),
  `[[region]]
name = "bin"
box = { x = [0.08, 0.12], y = [0.14, 0.16], z = [0.16, 0.18] }
[[motion]]
name = "along x"
type = "points"
time = 0.2
points = [{ x = 0.08, y = 0.15, z = 0.17 }, { x = 0.12 }]
`,
);
for (const title of ["Drive forces, cycle", "Power of the drives, cycle"])
  assert.ok(solid.comparison.titles.includes(title), solid.comparison.titles.join());
assert.ok(solid.comparison.traces.includes("mesh3d mesh3d"), "no overlay of workspaces");
assert.match(solid.comparison.text, /3crr-r-cru-1\.h5[^]*3crr-r-cru-2\.h5/); // both studies have the same name
for (const row of [/\bdci\s+objective/, /workspace-volume margin\s+constraint/, /peak power of all drives\s+motion cycle/])
  assert.match(solid.comparison.text, row);
assert.ok(solid.task.traces.includes("mesh3d mesh3d scatter3d scatter3d"), solid.task.traces.join());
for (const title of ["Workspaces and regions", "along x: power of all drives", "along x: largest force"])
  assert.ok(solid.task.titles.includes(title), solid.task.titles.join());
for (const row of [/does the task/, /bin: margin/, /bin: scale/, /workspace: volume/, /along x: energy/, /moving mass/])
  assert.match(solid.task.text, row);

const plane = path.join(folder, "five-bar.toml");
const bar = path.join(studies, "..", "..", "..", "experiments", "mechanisms", "five-bar.toml");
pkmopt("new", "study", bar, "-o", plane, "--force");
const flat = await compared(plane, '[[region]]\nname = "plate"\nbox = { x = [-0.02, 0.02], y = [0.38, 0.42] }\n');
assert.ok(flat.comparison.traces.includes("contour contour"), "no overlay of outlines");
assert.deepEqual(flat.task.traces, ["contour contour scatter"]);

const one = path.join(folder, "one.html");
pkmopt("workspace", "3crr-r-cru", "--set", "l=50mm", "--html", one, "--force");
const design = await Page.open(one, { scheme: "dark" });
assert.deepEqual(await design.panels(), ["design", "workspace", "mechanism", "coupling"]);
await design.draw();
assert.ok((await design.moveSliders("mechanism")) === 4);
assert.ok((await design.moveSliders("coupling")) > 0);
await design.page.click("#design summary");
assert.match(await design.text("#design"), /\bl\s+50 mm/);
await design.screenshots(folder, "one-design-dark");
await design.close();
console.log("two studies compared, one design without a study");
