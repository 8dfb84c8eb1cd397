// Conclusions and drawing in the summary; a click on a point of the Pareto front, which shows its design; playing and
// recording a motion.
import assert from "node:assert/strict";
import path from "node:path";
import { folderOf, Page, pkmopt, reportOf, studies } from "./page.mjs";

const folder = folderOf("conclusions");
const { file, html } = reportOf(path.join(studies, "quadrupteron.toml"), folder);
const page = await Page.open(html);
const [titles, sentences] = await Promise.all(
  ["dt", "dd"].map((name) => page.page.locator(".conclusions " + name).allInnerTexts()),
);
const [result, active, workspace, next] = ["Result", "Active constraints", "Workspace", "Next step"].map(
  (title) => sentences[titles.indexOf(title)],
);
assert.match(result, /workspace-volume .*%.*conditioning .*for the compromise, compared with the baseline/);
assert.match(active, /active|bound|stage/);
assert.match(workspace, /^Extent along x \d+ mm, y \d+ mm, phi \d+ deg; conditioning: minimum 0\.\d+, mean 0\.\d+\.$/);
assert.match(next, /\w/);

// The drawing labels the dimensions that are variables.
await page.draw("summary");
await page.comparePicture("Quadrupteron at 1280, light: summary", "#summary .overview");
const labels = await page.page.evaluate(() =>
  document.querySelector("#summary .plot").layout.scene.annotations.map((annotation) => annotation.text),
);
const {
  studies: [study],
} = await page.data();
const best = Object.fromEntries(study.summary.table.rows.map((row) => [row.name, row.values[0]]));
for (const name of ["l", "l_31", "l_32"]) {
  const text = `${name} ${Number((1000 * best[name]).toPrecision(4))} mm`;
  assert.ok(labels.includes(text), `“${text}” is not among ${labels}`);
}

// A click on a point of the front shows its values, workspace and links.
await page.draw("front");
await page.draw("workspace");
await page.draw("mechanism");
const before = [await page.drawn("workspace"), await page.drawn("mechanism")];
const clicked = await page.page.evaluate(() => {
  const [{ name }] = window.report.studies[0].front.designs.workspace.designs;
  const plot = document.querySelector("#front .plot");
  plot.scrollIntoView({ behavior: "instant", block: "center" });
  const [, point, stage] = /^point (\d+) of stage (\d+)$/.exec(name);
  const f = window.report.studies[0].front.fronts.findIndex((front) => front.stage === Number(stage));
  const box = plot.getBoundingClientRect(),
    { xaxis, yaxis, _size } = plot._fullLayout,
    trace = plot.data[f];
  return {
    name,
    f,
    at: [box.left + _size.l + xaxis.d2p(trace.x[point - 1]), box.top + _size.t + yaxis.d2p(trace.y[point - 1])],
  };
});
await page.page.mouse.move(clicked.at[0] - 3, clicked.at[1] - 3);
await page.page.mouse.move(...clicked.at, { steps: 3 });
await page.page.mouse.click(...clicked.at);
await page.page.waitForFunction(() => document.querySelector("#chosen").textContent);
assert.ok((await page.text("#chosen")).startsWith(clicked.name), await page.text("#chosen"));
assert.equal(await page.page.locator("#summary th").nth(2).innerText(), clicked.name);
for (const panel of ["summary", "front", "workspace", "mechanism"]) await page.draw(panel);
assert.notDeepEqual(await page.drawn("workspace"), before[0]);
assert.notDeepEqual(await page.drawn("mechanism"), before[1]);
await page.screenshots(folder, "1280-light", ["summary", "front"]);

// The values on the page agree with `pkmopt evaluate`.
const [, point, stage] = /^point (\d+) of stage (\d+)$/.exec(clicked.name);
const evaluated = JSON.parse(pkmopt("evaluate", "--from", file, "--front", point, "--stage", stage, "--json"));
const values = await page.page
  .locator("#summary tbody td [title]")
  .evaluateAll((list) => list.map((cell) => cell.title));
const volume = evaluated.objectives["workspace-volume"];
assert.ok(
  values.some((title) => Math.abs(parseFloat(title) / volume - 1) < 1e-12),
  `${volume} is not in the table`,
);

// For a point without workspace data the page shows a command; the button in the top bar returns to the best design.
await page.page.evaluate(() => {
  const { fronts, designs } = window.report.studies[0].front;
  const included = new Set(designs.workspace.designs.map((design) => design.name));
  const plot = document.querySelector("#front .plot");
  for (const [f, front] of fronts.entries())
    for (let p = 0; p < front.points.length; ++p)
      if (!included.has(`point ${p + 1} of stage ${front.stage}`) && !front.points[p].compromise)
        return plot.emit("plotly_click", { points: [{ data: plot.data[f], pointIndex: p }] });
});
const command = await page.text("#front .warning code");
assert.match(command, /^pkmopt workspace --from \S+ --front \d+ --stage 1 --html /);
pkmopt(
  ...command.split(" ").slice(1, 3),
  file,
  ...command.split(" ").slice(4, -1),
  path.join(folder, "point.html"),
  "--force",
);
await page.page.click("#chosen button");
assert.equal(await page.text("#chosen"), "");
await page.draw("workspace");
assert.deepEqual(await page.drawn("workspace"), before[0]);
await page.close();

// Playing a motion moves the links; pausing stops at the current pose.
const cycle = await Page.open(reportOf(path.join(studies, "3crr-r-cru.toml"), folder).html);
await cycle.draw("mechanism");
const still = await cycle.drawn("mechanism"),
  play = cycle.page.getByRole("button", { name: "play the motion" });
await play.click();
await cycle.page.waitForFunction(
  () => Number([...document.querySelectorAll("#mechanism input[type=range]")].at(-1).value) > 0,
);
// not by mouse: Playwright would wait for a page that is redrawn continuously
await cycle.page.getByRole("button", { name: "pause the motion" }).evaluate((button) => button.click());
assert.notDeepEqual(await cycle.drawn("mechanism"), still);
const time = await cycle.text("#mechanism .controls:nth-of-type(2) output");
await cycle.page.waitForTimeout(200);
assert.equal(await cycle.text("#mechanism .controls:nth-of-type(2) output"), time);
const [video] = await Promise.all([
  cycle.page.waitForEvent("download", { timeout: 60000 }),
  cycle.page.getByRole("button", { name: /record/ }).click(),
]);
assert.equal(video.suggestedFilename(), "cycle.webm");
await cycle.close();
console.log(`${clicked.name} shown by a click, a motion played and recorded`);
