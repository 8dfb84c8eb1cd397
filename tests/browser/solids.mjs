// Panel "Workspace": the largest solids of a study are drawn in the workspace and in its slices, with their dimensions.
import assert from "node:assert/strict";
import path from "node:path";
import { folderOf, Page, pkmopt, reportOf, studies } from "./page.mjs";

const folder = folderOf("solids");
const { file, html } = reportOf(path.join(studies, "largest-cylinder.toml"), folder);
const options = ["workspace", "--from", file, "--json", "--largest-cylinder", "--ratio", "2:1", "--largest-sphere"];
const { cylinder, sphere } = JSON.parse(pkmopt(...options)).largest;

const page = await Page.open(html, { width: 800, scheme: "dark" });
const conclusions = await page.page.locator(".conclusions").innerText();
for (const text of [/largest cylinder: diameter \d/, /largest box: x \d/, /The workspace uses \d+ % of the range of rail1/])
  assert.match(conclusions, text);
await page.draw("summary");
await page.comparePicture("linear Delta at 800, dark: summary", "#summary .overview");
await page.expectMargins("summary");
await page.draw("workspace");
const plots = await page.page.locator("#workspace .plot").evaluateAll((nodes) =>
  nodes.map((node) => node.data.map(({ type, name, x, y, z, i }) => ({ type, name, x, y, z, triangles: i?.length }))),
);
const extent = (values) => Math.max(...values) - Math.min(...values);
const near = (a, b) => assert.ok(Math.abs(a - 1000 * b) <= 1e-3 * Math.abs(a), `${a} mm is not ${b} m`);
const [slice, otherSlice, surface, drawnCylinder, drawnSphere] = plots[0];
assert.deepEqual(
  [slice, otherSlice, surface, drawnCylinder, drawnSphere].map((trace) => trace.name ?? trace.type),
  ["surface", "surface", "best", "largest-cylinder", "largest-sphere"],
);
near(extent(drawnCylinder.x), cylinder.dimensions.diameter);
near(extent(drawnCylinder.y), cylinder.dimensions.diameter);
near(extent(drawnCylinder.z), cylinder.dimensions.height);
for (const axis of ["x", "y", "z"]) near(extent(drawnSphere[axis]), sphere.dimensions.diameter);
assert.ok(drawnCylinder.triangles > 100 && drawnSphere.triangles > 1000);
assert.equal(plots[1].length, 5, "the baseline has solids, too");
// The slice at the middle of the workspace: circles of the cylinder and the sphere.
const lines = plots[2].filter((trace) => trace.type === "scatter");
near(extent(lines[0].x), cylinder.dimensions.diameter);
assert.ok(extent(lines[1].y) <= 1000.1 * sphere.dimensions.diameter);
const millimetres = (value) => Number((1000 * value).toPrecision(4));
assert.ok(
  (await page.text("#workspace")).includes(
    `largest cylinder: diameter ${millimetres(cylinder.dimensions.diameter)} mm, height ${millimetres(cylinder.dimensions.height)} mm`,
  ),
);
await page.screenshots(folder, "800-dark", ["summary", "workspace"]);
await page.close();
