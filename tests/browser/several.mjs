// Several files: a comparison, and each study's sections by choice. One design without a study.
import assert from "node:assert/strict";
import path from "node:path";
import { folderOf, Page, pkmopt, reportOf, studies } from "./page.mjs";

const folder = folderOf("several");
const files = ["2t1r-p-hybrid", "quadrupteron"].map(
  (name) => reportOf(path.join(studies, name + ".toml"), folder).file,
);
const html = path.join(folder, "several.html");
pkmopt("report", ...files, "--output", html, "--force");
const page = await Page.open(html);
assert.equal((await page.sections())[0], "comparison");
await page.draw("comparison");
const { studies: shown } = await page.data();
const table = await page.text("#comparison");
for (const study of shown) assert.ok(table.includes(study.name), study.name);
await page.screenshots(folder, "1280-light", ["comparison"]);
for (const [i, study] of shown.entries()) {
  await page.page.selectOption("#chooser select", String(i));
  assert.equal(await page.text("h1"), study.name);
}
await page.draw("front"); // only the second has one
await page.close();

const one = path.join(folder, "one.html");
pkmopt("workspace", "3crr-r-cru", "--set", "l=50mm", "--html", one, "--force");
const design = await Page.open(one, { scheme: "dark" });
assert.deepEqual(await design.sections(), ["design", "workspace", "mechanism", "coupling"]);
await design.draw();
assert.ok((await design.moveSliders("mechanism")) === 4);
await design.page.click("#design summary");
assert.match(await design.text("#design"), /\bl\s+50 mm/);
await design.screenshots(folder, "one-design-dark");
await design.close();
console.log("two studies compared, one design without a study");
