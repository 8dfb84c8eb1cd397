// Panel "Sweeps": contours of a full-factorial sweep have the values of the study, curves of a sweep of single variables
// too.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { folderOf, Page, pkmopt, studies } from "./page.mjs";

const folder = folderOf("sweeps");
const file = path.join(folder, "full-factorial.h5"),
  curves = path.join(folder, "curves.h5"),
  toml = path.join(folder, "curves.toml"),
  html = path.join(folder, "sweeps.html");
writeFileSync(
  toml,
  readFileSync(path.join(studies, "full-factorial.toml"), "utf8").replace("full-factorial", "one-at-a-time"),
);
pkmopt("run", path.join(studies, "full-factorial.toml"), "--output", file, "--force", "--quiet");
pkmopt("run", toml, "--output", curves, "--force", "--quiet");
pkmopt("report", file, curves, "--output", html, "--force"); // one page for both: opening a page takes long
const tables = path.join(folder, "tables");
pkmopt("export", file, "--csv", tables, "--force");
const [head, ...lines] = readFileSync(path.join(tables, "evaluations.csv"), "utf8").trim().split("\n");
const titles = head.split(",").map((title) => title.replace(/ \[.*/, ""));
const column = (name) => titles.indexOf(name);
const volume = (design) =>
  Number(
    lines
      .map((line) => line.split(","))
      .find((words) => Object.entries(design).every(([name, x]) => Math.abs(Number(words[column(name)]) - x) < 1e-6))[
      column("objective workspace-volume")
    ],
  );

const page = await Page.open(html);
assert.ok((await page.panels()).includes("sweeps"));
await page.draw("sweeps");
const contours = () =>
  page.page.evaluate(() => document.querySelector("#sweeps .plot").data.map(({ type, x, y, z }) => ({ type, x, y, z })));
const near = (a, b) => assert.ok(Math.abs(a - b) <= 1e-6 * Math.abs(b), `${a} is not ${b}`);
let [{ type, x, y, z }, crosses] = await contours();
assert.equal(type, "contour");
assert.deepEqual([x.length, y.length, z.length, z[0].length], [5, 5, 5, 5]);
near(z[3][1], volume({ a: x[1] / 1000, b: y[3] / 1000, l_d: 0.75 }));
assert.ok(crosses.x.length > 0 && crosses.x.length < 25); // a + b is at most 1.7 m
assert.ok(crosses.x.every((a, i) => a + crosses.y[i] > 1700));
assert.deepEqual(
  await page.page.locator("#sweeps .slider").evaluateAll((list) => list.map((node) => node.style.display)),
  ["none", "none", ""],
);
await page.page.locator("#sweeps select").nth(1).selectOption({ label: "l_d" });
[{ x, y, z }] = await contours();
near(z[4][0], volume({ a: x[0] / 1000, b: 0.95, l_d: y[4] / 1000 }));
await page.screenshots(folder, "1280-light", ["sweeps"]);

await page.page.click("#theme");
await page.page.selectOption("#chooser select", "1");
await page.draw("sweeps");
const sizes = await page.page
  .locator("#sweeps .plot")
  .evaluateAll((plots) => plots.map((plot) => [plot.data[0].x.length, Math.max(...plot.data[0].x)]));
assert.deepEqual(
  sizes.map(([count, last]) => [count, Math.round(last)]),
  [
    [5, 400],
    [5, 1500],
    [5, 1200],
  ],
);
await page.screenshots(folder, "1280-dark", ["sweeps"]);
await page.close();
console.log("contours and curves of sweeps");
