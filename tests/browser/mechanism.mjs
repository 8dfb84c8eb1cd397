// The report of a study of one mechanism: all plots are drawn, values agree with the study file, sliders and hover
// texts work. Argument: name of the study in studies/.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import path from "node:path";
import { folderOf, Page, pkmopt, reportOf, studies } from "./page.mjs";

const name = process.argv[2],
  folder = folderOf(name);
const expected = {
  "4ppa-2par": ["summary", "workspace", "mechanism", "motions", "convergence", "populations"],
  "2t1r-p-hybrid": ["summary", "workspace", "mechanism", "motions", "convergence", "populations"],
}[name];
const { file, html } = reportOf(path.join(studies, name + ".toml"), folder);
const page = await Page.open(html);
assert.deepEqual(await page.panels(), expected);
await page.draw();
if (name === "4ppa-2par") {
  await page.comparePicture("4PPa-2PaR at 1280, light: summary", "#summary .overview");
  await page.expectMargins("summary");
  await page.expectMargins("mechanism");
}

// The table of designs agrees with `pkmopt show`, and the best value per generation with the study file.
const shown = JSON.parse(pkmopt("show", file, "--json")),
  {
    studies: [study],
  } = await page.data();
const inTable = (kind, key) => study.summary.table.rows.find((row) => row.kind === kind && row.name === key).values[0];
let compared = 0;
for (const [kind, values] of [
  ["variable", shown.best.design],
  ["objective", shown.best.objectives],
  ["constraint", shown.best.constraints],
  ["output", shown.best.outputs],
])
  for (const [key, value] of Object.entries(values)) {
    assert.equal(inTable(kind, key), value, key);
    ++compared;
  }
assert.ok(compared >= 4);
// Values have four digits in mm or deg, and full precision in SI units on hover.
const cells = await page.page
  .locator("#summary tbody td [title]")
  .evaluateAll((list) => list.map((cell) => [cell.title.split(" ")[0], cell.textContent]));
for (const [key, value] of Object.entries(shown.best.design)) {
  const { unit } = study.problem.variables.find((variable) => variable.name === key);
  const scale = { m: 1000, rad: 180 / Math.PI }[unit];
  const text = String(Number((value * scale).toPrecision(4))).replace("-", "−");
  assert.ok(
    cells.some(([title, cell]) => Number(title) === value && cell === text),
    `${key} = ${value} is not in the summary`,
  );
}
const conclusions = await page.page.locator(".conclusions").innerText();
for (const title of ["Result", "Active constraints", "Workspace", "Joints", "Next step"]) assert.ok(conclusions.includes(title), title);
if (study.motions) assert.match(conclusions, /Motions\s+[^\n]+: (feasible|infeasible at)/);
if (name === "2t1r-p-hybrid")
  assert.ok((await page.text("#motions")).includes("Quantities in deg"), "no plot of the quantities of the motion");
const inFile = JSON.parse(
  execFileSync(
    "/usr/bin/python3",
    [
      "-c",
      `
import h5py, json, sys
with h5py.File(sys.argv[1], "r") as f:
    stage = f["stages/1"]
    print(json.dumps(list(stage["evaluations/objective"][:, 0][stage["generations/best_row"][:]])))`,
      file,
    ],
    { encoding: "utf8" },
  ),
);
assert.deepEqual(study.convergence[0].generations.objectives[0].best, inFile);
const lengths = study.convergence[0].generations.numbers.length;
assert.equal(lengths, inFile.length);

await page.screenshots(folder, "1280-light");

// Hover texts have values with units.
const unit = { "4ppa-2par": "rad", "2t1r-p-hybrid": "m³" }[name];
const curve = await page.hover("convergence");
assert.ok(/\d/.test(curve) && curve.includes(unit), `hover over the convergence: “${curve}”`);
const surface = await page.hover("workspace");
assert.ok(/x −?[\d.]+ m/.test(surface.replace("-", "−")), `hover over the workspace: “${surface}”`);

// Rotating one workspace rotates the other.
await page.page.evaluate(() =>
  Plotly.relayout(document.querySelector("#workspace .plot"), { "scene.camera": { eye: { x: 2, y: 1, z: 0.5 } } }),
);
await page.page.waitForFunction(() => document.querySelectorAll("#workspace .plot")[1].layout.scene.camera.eye.y === 1);

let sliders = 0;
for (const panel of ["workspace", "mechanism", "populations"])
  sliders += await page.moveSliders(panel);
assert.ok(sliders >= 6, `${sliders} sliders`);

// Wide and narrow window and dark theme, for one mechanism only, because drawing is slow without a graphics card.
if (name === "4ppa-2par") {
  await page.page.setViewportSize({ width: 1920, height: 1080 });
  await page.setScheme("dark");
  await page.draw("summary");
  await page.comparePicture("4PPa-2PaR at 1920, dark: summary", "#summary .overview");
  await page.screenshots(folder, "1920-dark", ["summary"]);
  await page.page.setViewportSize({ width: 800, height: 900 });
  await page.page.evaluate(() =>
    Promise.all([...document.querySelectorAll("#summary .plot")].map((plot) => plot.data && Plotly.Plots.resize(plot))),
  );
  await page.expectMargins("summary");
}
await page.close();
console.log(`${name}: ${expected.length} panels, ${compared} values agree with the file, ${sliders} sliders`);
