// Text from study files is shown as text everywhere on the page and never interpreted as HTML, script or template.
import assert from "node:assert/strict";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { folderOf, Page, pkmopt, reportOf } from "./page.mjs";

const folder = folderOf("escaping"),
  toml = path.join(folder, "escaping.toml");
const evil = "<script>alert(1)</script>",
  image = "<img src=x onerror=alert(2)>",
  bold = "<b>%{y} &amp; 50%</b>",
  attribute = `"><img src=x onerror=alert(4)> ' onmouseover='alert(5)`,
  ending = "</script></style></textarea><svg onload=alert(6)>",
  formula = "=cmd|' /C calc'!A0",
  controlCharacters = "\u001b[31mred\u001b]0;title\u0007";
const quoted = (text) => JSON.stringify(text); // TOML strings have the same escapes as JSON
writeFileSync(
  toml,
  `# </script><script>alert(3)</script> <!-- <script> \u2028 \u2029
[study]
name = "${evil}"
[mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
b = { min = 0.7, max = 1.5 }
[baseline]
a = 0.2
[[motion]]
name = "${image}"
type = "points"
points = [{ x = 0.4, y = 1.25, z = -1.0, theta = 0 }, { z = -0.95 }]
time = 0.5
[[objective]]
type = "workspace-ratio"
[[constraint]]
type = "rail-length"
[[reference]]
name = "${bold}"
design = { a = 0.2 }
${[attribute, ending, formula, controlCharacters]
  .map((name) => `[[reference]]\nname = ${quoted(name)}\ndesign = { a = 0.2 }\nvalues = { workspace-ratio = 0.1 }`)
  .join("\n")}
[[motion]]
name = ${quoted(attribute + ending + formula + controlCharacters)}
type = "points"
points = [{ x = 0.4, y = 1.25, z = -1.0, theta = 0 }, { z = -0.9 }]
time = 0.5
[[stage]]
optimiser = "ga"
population = 8
generations = 3
`,
);
const { file } = reportOf(toml, folder);
const html = path.join(folder, "both.html"),
  copy = path.join(folder, image + ".h5");
copyFileSync(file, copy);
pkmopt("report", file, copy, "--output", html, "--force");
const page = await Page.open(html);
for (const panel of ["comparison", "motions", "populations"]) await page.draw(panel);
assert.equal(await page.page.title(), `${evil}, ${evil} – pkmopt`);
assert.equal(await page.text("h1"), evil);
assert.equal(await page.page.locator("main script, main img, header script, header img").count(), 0);
const everything = await page.text();
for (const text of [evil, image, bold, attribute, ending, formula, "red"]) assert.ok(everything.includes(text), text);
// Both studies have the same name, so the page shows their file names.
const files = [file, copy].map((each) => path.basename(each)),
  names = (text) => files.some((each) => text.includes(each));
assert.ok((await page.text("#comparison")).includes(image + ".h5"));
const {
  studies: [study],
} = await page.data();
assert.ok(study.summary.origin.toml.includes("</script><script>alert(3)</script> <!-- <script> \u2028 \u2029"));
assert.ok((await page.text("#comparison")).includes("Overlay of the workspaces"), "both sweep the same coordinates");
const legend = await page.page.locator("#comparison .plot .legendtext").first().textContent();
assert.ok(names(legend), `legend: ${legend}`);
const hover = await page.hover("comparison");
assert.ok(names(hover), `hover: ${hover}`);
// No name has created an element or an attribute.
const injected = await page.page.evaluate(() =>
  [...document.querySelectorAll("*")]
    .filter(
      (element) =>
        /^(iframe|object|embed|base)$/i.test(element.localName) ||
        element.getAttribute("src") === "x" ||
        element.getAttributeNames().some((name) => /^on/i.test(name)),
    )
    .map((element) => element.outerHTML),
);
assert.deepEqual(injected, []);
assert.ok(!readFileSync(html, "utf8").includes("\u001b"), "control characters in the file");
await page.screenshots(folder, "1280-light", ["comparison", "summary"]);
await page.close();
console.log("text of a study is not interpreted");
