// Accessibility of the page: contrast of all texts, accessible names of all controls, use with the keyboard. Also the
// number of printed pages.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { folderOf, Page, reportOf, studies } from "./page.mjs";

const folder = folderOf("accessibility");
const { html } = reportOf(path.join(studies, "quadrupteron.toml"), folder);

/** Texts whose contrast is below the minimum of WCAG 2.1 AA: 4.5, or 3 for large texts. */
function lowContrastTexts() {
  const channels = (text) => {
    const [r, g, b, a = 1] = text.match(/[\d.]+/g).map(Number);
    return [r, g, b, a];
  };
  const over = ([r, g, b, a], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a), 1];
  const luminance = (rgb) =>
    rgb
      .slice(0, 3)
      .map((c) => (c / 255 <= 0.03928 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4))
      .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const background = (node) => {
    const own = node ? channels(getComputedStyle(node).backgroundColor) : [255, 255, 255, 1];
    return own[3] < 1 ? over(own, background(node.parentElement)) : own;
  };
  const low = [];
  let checked = 0;
  for (const node of document.querySelectorAll("body *:not(script, style, noscript, option, .plot *)")) {
    const text = [...node.childNodes].filter((child) => child.nodeType === 3 && child.data.trim()).map((t) => t.data);
    if (!text.length || !node.getClientRects().length || /^[■\s]+$/.test(text.join(""))) continue;
    const style = getComputedStyle(node),
      size = parseFloat(style.fontSize);
    const behind = background(node),
      [light, dark] = [luminance(over(channels(style.color), behind)), luminance(behind)].sort((a, b) => b - a);
    const ratio = (light + 0.05) / (dark + 0.05);
    ++checked;
    if (ratio < (size >= 24 || (size >= 18.7 && style.fontWeight >= 700) ? 3 : 4.5))
      low.push(`${ratio.toFixed(2)}: “${text.join("").slice(0, 40)}” in ${node.localName}.${node.className}`);
  }
  return { low: [...new Set(low)], checked };
}

/** Controls, plots and panels without an accessible name. */
function unnamedElements() {
  const nameOf = (node) =>
    node.getAttribute("aria-label") ||
    (node.labels &&
      [...node.labels]
        .map((label) => label.textContent.replace(node.textContent, ""))
        .join("")
        .trim()) ||
    (/^(button|a|summary)$/.test(node.localName) && node.textContent.trim());
  const elements = [
    ...document.querySelectorAll("a, button, input, select, summary, [role=img], [role=group], nav, main > section"),
  ].filter((node) => !node.closest(".plot") || node.matches(".plot"));
  return {
    unnamed: elements.filter((node) => !nameOf(node)).map((node) => node.outerHTML.slice(0, 120)),
    total: elements.length,
  };
}

let checked = 0;
const page = await Page.open(html);
for (const scheme of ["dark", "light"]) {
  await page.setScheme(scheme);
  const contrast = await page.page.evaluate(lowContrastTexts);
  assert.deepEqual(contrast.low, [], `low contrast in the ${scheme} theme`);
  const names = await page.page.evaluate(unnamedElements);
  assert.deepEqual(names.unnamed, []);
  assert.ok(contrast.checked > 100 && names.total > 20, `${contrast.checked} texts, ${names.total} names`);
  checked += contrast.checked;
  if (scheme === "light") {
    // The first Tab stop skips the top bar, every focused element has an outline, the key j moves to the next panel.
    await page.page.keyboard.press("Tab");
    assert.equal(await page.page.evaluate(() => document.activeElement.textContent), "Skip to the report");
    for (let i = 0; i < 12; ++i) {
      await page.page.keyboard.press("Tab");
      const outline = await page.page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
      assert.notEqual(outline, "none", await page.page.evaluate(() => document.activeElement.outerHTML.slice(0, 80)));
    }
    await page.page.evaluate(() => {
      document.activeElement.blur();
      scrollTo({ top: 0, behavior: "instant" });
    });
    await page.page.waitForFunction(() => document.querySelector("#contents a.here")?.hash === "#summary");
    await page.page.keyboard.press("j");
    assert.equal(await page.page.evaluate(() => document.activeElement.id), "front");
    // Arrow keys move a slider, and its accessible value changes.
    const slider = page.page.locator("#mechanism input[type=range]").first();
    const before = await slider.getAttribute("aria-valuetext");
    await slider.focus();
    await page.page.keyboard.press("ArrowRight");
    assert.notEqual(await slider.getAttribute("aria-valuetext"), before);

    // Printing, which draws all plots, gives at most four pages.
    await page.page.waitForFunction(() => window.Plotly);
    const pdf = await page.page.pdf({ preferCSSPageSize: true, printBackground: true });
    writeFileSync(path.join(folder, "report.pdf"), pdf);
    const pages = pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length;
    assert.ok(pages >= 3 && pages <= 4, `${pages} printed pages`);
  }
}
await page.close();
console.log(`${checked} texts with sufficient contrast, all controls named, at most four printed pages`);
