// Shared by the tests of the page: creates reports with pkmopt and opens them in Chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const { PKMOPT, CHROMIUM, BROWSER_OUTPUT } = process.env;
export const studies = process.env.BROWSER_STUDIES;

/** Creates a folder for the output of a test in the build folder. */
export function folderOf(name) {
  const folder = path.join(BROWSER_OUTPUT, name);
  mkdirSync(folder, { recursive: true });
  return folder;
}

/** Runs pkmopt; returns its output. */
export function pkmopt(...parameters) {
  return execFileSync(PKMOPT, parameters, { encoding: "utf8", maxBuffer: 1e9 });
}

/** Runs a study and writes its report; returns both files. */
export function reportOf(toml, folder) {
  const name = path.basename(toml, ".toml");
  const file = path.join(folder, name + ".h5"),
    html = path.join(folder, name + ".html");
  pkmopt("run", toml, "--output", file, "--force", "--quiet");
  pkmopt("report", file, "--output", html, "--force");
  return { file, html };
}

/** A page in the browser. Records console errors, dialogs and requests to anything but the file as problems. */
export class Page {
  static async open(html, { width = 1280, scheme = "light" } = {}) {
    const browser = await chromium.launch({
      executablePath: CHROMIUM,
      args: ["--no-sandbox", "--enable-unsafe-swiftshader"], // WebGL without a graphics card
    });
    const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme: scheme });
    const self = Object.assign(new Page(), { browser, page, problems: [] });
    page.on("console", (message) => {
      if (message.type() === "error") self.problems.push("console: " + message.text());
    });
    page.on("pageerror", (error) => self.problems.push("error: " + error.stack));
    page.on("dialog", (dialog) => {
      self.problems.push("dialog: " + dialog.message());
      dialog.dismiss();
    });
    page.on("request", (request) => {
      if (!/^(data|blob):/.test(request.url()) && request.url() !== pathToFileURL(html).href)
        self.problems.push("request: " + request.url());
    });
    const begin = performance.now();
    await page.goto(pathToFileURL(html).href);
    await page
      .waitForFunction(() => window.report, null, { timeout: 60000 })
      .catch(() => self.problems.push("no report"));
    self.seconds = (performance.now() - begin) / 1000;
    self.expectNoProblems();
    return self;
  }

  expectNoProblems() {
    assert.deepEqual(this.problems, []);
  }
  async close() {
    this.expectNoProblems();
    await this.browser.close();
  }
  /** Data of the page without the large panels. */
  data() {
    return this.page.evaluate(() => ({
      program: window.report.program,
      studies: window.report.studies.map(({ workspace, mechanism, populations, ...small }) => small),
    }));
  }
  /** Ids of the panels. */
  panels() {
    return this.page.locator("main > section").evaluateAll((list) => list.map((panel) => panel.id));
  }
  text(selector = "main") {
    return this.page.locator(selector).innerText();
  }

  /** Draws all plots, or those of one panel, and checks that none is empty. */
  async draw(panel) {
    await this.page.evaluate((id) => window.report.draw(id), panel);
    const empty = await this.page.locator((panel ? "#" + panel : "main") + " .plot").evaluateAll((plots) =>
      plots.flatMap((plot) => {
        const numbers = (values) =>
          values
            ? Array.from(values)
                .flat()
                .filter((value) => Number.isFinite(value) || typeof value === "string").length
            : 0;
        const shown = (plot.data || []).some(
          (trace) =>
            numbers(trace.x) +
              numbers(trace.z) +
              (trace.dimensions || []).reduce((sum, d) => sum + numbers(d.values), 0) >
            0,
        );
        return shown && plot.querySelector("svg.main-svg")
          ? []
          : [plot.closest("section").id + ": " + plot.parentElement.innerText.slice(0, 60)];
      }),
    );
    assert.deepEqual(empty, [], "empty plots");
    this.expectNoProblems();
  }

  /** Hashes of the data of the plots of a panel. */
  drawn(panel) {
    return this.page.evaluate(
      (id) =>
        [...document.querySelectorAll(`#${id} .plot`)].map((plot) => {
          let hash = 0;
          for (const trace of plot.data || [])
            for (const values of [
              trace.x,
              trace.y,
              trace.z,
              trace.intensity,
              ...(trace.dimensions || []).map((d) => d.values),
            ])
              for (const value of Array.from(values || []).flat())
                hash = (hash * 31 + Math.round(1e6 * (Number(value) || 0))) % 2147483647;
          return hash;
        }),
      panel,
    );
  }

  /** Moves every slider of a panel and checks that each changes a plot. Returns the number of sliders. */
  async moveSliders(panel) {
    const sliders = this.page.locator(`#${panel} input[type=range]`);
    let moved = 0;
    for (let i = 0; i < (await sliders.count()); ++i) {
      const slider = sliders.nth(i);
      const { value, max } = await slider.evaluate((input) => ({ value: Number(input.value), max: Number(input.max) }));
      if (max === 0) continue;
      const before = await this.drawn(panel);
      await slider.evaluate(
        (input, to) => {
          input.value = to;
          input.dispatchEvent(new Event("input", { bubbles: true }));
        },
        value > max / 2 ? Math.floor(max / 3) : Math.ceil((2 * max) / 3),
      );
      assert.notDeepEqual(await this.drawn(panel), before, `slider ${i + 1} of ${panel} changes nothing`);
      ++moved;
    }
    this.expectNoProblems();
    return moved;
  }

  /** Moves the pointer over points of the first plot of a panel until a hover text appears; returns the text. */
  async hover(panel, trace = (traces) => traces.findLastIndex((t) => t.hoverinfo !== "skip" && t.x?.length)) {
    const plot = this.page.locator(`#${panel} .plot`).first();
    await plot.scrollIntoViewIfNeeded();
    const places = await plot.evaluate((node, source) => {
      const box = node.getBoundingClientRect(),
        layout = node._fullLayout;
      const scene = layout.scene;
      if (scene)
        return [0.5, 0.45, 0.55, 0.4, 0.6].map((share) => [
          box.left + share * box.width * 0.9,
          box.top + share * box.height,
        ]);
      const chosen = node.data[eval(source)(node.data)],
        size = layout._size;
      return Array.from(chosen.x, (x, i) => [x, chosen.y[i]])
        .filter(([, y]) => y !== null && !Number.isNaN(y))
        .reverse()
        .map(([x, y]) => [box.left + size.l + layout.xaxis.d2p(x), box.top + size.t + layout.yaxis.d2p(y)]);
    }, trace.toString());
    for (const [x, y] of places.slice(0, 12)) {
      await this.page.mouse.move(x - 3, y - 3);
      await this.page.mouse.move(x, y, { steps: 3 });
      const label = this.page.locator(`#${panel} .plot`).first().locator(".hovertext").first();
      const text = await label.textContent({ timeout: 1000 }).catch(() => "");
      if (text) return text;
    }
    return "";
  }

  /** Saves a screenshot of each panel without the top bar, if BROWSER_PICTURES is set. */
  async screenshots(folder, name, panels) {
    if (!process.env.BROWSER_PICTURES) return;
    const style = await this.page.addStyleTag({ content: "#bar { position: static !important; }" });
    for (const panel of panels ?? (await this.panels()))
      await this.page.locator("#" + panel).screenshot({ path: path.join(folder, `${name}-${panel}.png`) });
    await style.evaluate((node) => node.remove());
  }
}
