// report.mjs REPORT.html OUT.png: the top of a report's page, 1280 pixels wide. Run it in the build folder's
// tests/browser, which has playwright-core; CHROMIUM names the browser.
//   cd build/release/tests/browser && node ../../../../experiments/pictures/report.mjs larger.html report.png
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(path.resolve("package.json"))("playwright-core");
const [html, out] = process.argv.slice(2).map((file) => path.resolve(file));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
const page = await browser.newPage({ viewport: { width: 1280, height: 1030 }, colorScheme: "light" });
await page.goto(pathToFileURL(html).href);
await page.waitForFunction(() => window.report);
await page.evaluate(() => window.report.draw("summary"));
await page.waitForTimeout(3000); // both scenes are drawn by then
await page.screenshot({ path: out });
await browser.close();
