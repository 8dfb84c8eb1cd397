// Reports of several studies: the comparison, and the panels of the selected study. Page of one design without a study.
import assert from "node:assert/strict";
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

/** Titles, trace types and text of the comparison of two runs of a study with different seeds. */
async function compared(toml) {
  const runs = ["1", "2"].map((seed) => {
    const file = path.join(folder, path.basename(toml, ".toml") + "-" + seed + ".h5");
    pkmopt("run", toml, "--output", file, "--seed", seed, "--force", "--quiet");
    return file;
  });
  const html = path.join(folder, path.basename(toml, ".toml") + "-compared.html");
  pkmopt("report", ...runs, "--output", html, "--force");
  const both = await Page.open(html);
  await both.draw("comparison");
  const titles = await both.page.locator("#comparison h3").allInnerTexts();
  const traces = await both.page.locator("#comparison .plot").evaluateAll((plots) =>
    plots.map((plot) => plot.data.map(({ type }) => type).join(" ")),
  );
  await both.screenshots(folder, path.basename(toml, ".toml") + "-compared", ["comparison"]);
  const table = await both.text("#comparison");
  await both.close();
  return { titles, traces, table };
}
const forces = await compared(path.join(studies, "3crr-r-cru.toml"));
assert.ok(forces.titles.includes("Drive forces, cycle"), forces.titles.join());
assert.ok(forces.traces.includes("mesh3d mesh3d"), "no overlay of workspaces");
assert.match(forces.table, /3crr-r-cru-1\.h5[^]*3crr-r-cru-2\.h5/); // both studies have the same name
for (const row of [/\bdci\s+objective/, /workspace-volume margin\s+constraint/]) assert.match(forces.table, row);

const plane = path.join(folder, "five-bar.toml");
const bar = path.join(studies, "..", "..", "..", "experiments", "mechanisms", "five-bar.toml");
pkmopt("new", "study", bar, "-o", plane, "--force");
assert.ok((await compared(plane)).traces.includes("contour contour"), "no overlay of outlines");

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
