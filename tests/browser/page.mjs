// Shared by the tests of the page: creates reports with pkmopt and opens them in Chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
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

// Pictures are compared as 32 by 24 mean colours. The tolerances are those of fonts and graphics drivers; a missing or
// dark trace, another theme and another camera exceed them.
const kColumns = 32,
  kRows = 24,
  kMeanDifference = 4, // of 255, mean over the picture
  kLargestDifference = 90; // of 255

/** A page in the browser. Records console errors, dialogs and requests to anything but the file as problems. */
export class Page {
  /**
   * @param drawsInView  true: plots are drawn when they come into view, at full resolution, as for users. Otherwise only
   *                     draw() draws them, at half resolution: without a graphics card, drawing takes most of the time
   */
  static async open(html, { width = 1280, scheme = "light", drawsInView = false } = {}) {
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
    if (!drawsInView)
      await page.addInitScript(() => {
        window.IntersectionObserver = class {
          observe() {}
          unobserve() {}
        };
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
    await this.page.waitForFunction(() => window.Plotly);
    await this.page.evaluate(() => Plotly.setPlotConfig({ plotGlPixelRatio: 1 })); // default: 2
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

  /** Switches to "light" or "dark". The page hears of it later, and until then draw() sees plots that are drawn. */
  async setScheme(scheme) {
    await this.page.emulateMedia({ colorScheme: scheme });
    await this.page.waitForFunction((theme) => document.documentElement.dataset.theme === theme, scheme);
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
          box.left + share * box.width,
          box.top + share * box.height * 0.8, // the colour bar is below the scene
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
      const text = await label.textContent({ timeout: 4000 }).catch(() => "");
      if (text) return text;
    }
    return "";
  }

  /** Mean colours [red, green, blue] of the cells of a picture of an element, row by row; and those of its border. */
  async picture(selector) {
    const locator = this.page.locator(selector).first();
    const png = await locator.screenshot();
    return this.page.evaluate(
      async ([data, columns, rows]) => {
        const image = new Image();
        image.src = "data:image/png;base64," + data;
        await image.decode();
        const pixels = (width, height) => {
          const canvas = Object.assign(document.createElement("canvas"), { width, height });
          const context = canvas.getContext("2d", { willReadFrequently: true });
          context.imageSmoothingQuality = "high";
          context.drawImage(image, 0, 0, width, height);
          return context.getImageData(0, 0, width, height).data;
        };
        const { width, height } = image,
          full = pixels(width, height),
          cells = Array.from({ length: columns * rows }, () => [0, 0, 0, 0]);
        for (let y = 0; y < height; ++y)
          for (let x = 0; x < width; ++x) {
            const cell = cells[Math.floor((y * rows) / height) * columns + Math.floor((x * columns) / width)];
            for (let c = 0; c < 3; ++c) cell[c] += full[4 * (y * width + x) + c];
            ++cell[3];
          }
        const isBackground = (x, y) =>
          [0, 1, 2].every((c) => Math.abs(full[4 * (y * width + x) + c] - full[4 * (2 * width) + c]) < 12);
        const border = [];
        for (let y = 2; y < height - 2; ++y) for (const x of [0, 1, width - 2, width - 1]) if (!isBackground(x, y)) border.push([x, y]);
        return { cells: cells.map(([r, g, b, count]) => [r, g, b].map((sum) => Math.round(sum / count))), border };
      },
      [png.toString("base64"), kColumns, kRows],
    );
  }

  /**
   * Compares the picture of an element with that of pictures.json. With BROWSER_PICTURES=write in the environment, writes
   * it there instead.
   */
  async comparePicture(name, selector) {
    const file = path.join(studies, "..", "pictures.json");
    const known = JSON.parse(readFileSync(file, "utf8"));
    const { cells } = await this.picture(selector);
    const text = cells.map((rgb) => rgb.map((value) => value.toString(16).padStart(2, "0")).join("")).join("");
    if (process.env.BROWSER_PICTURES === "write") {
      writeFileSync(file, JSON.stringify({ ...known, [name]: text }, null, 1) + "\n");
      return;
    }
    assert.ok(known[name], `pictures.json has no picture “${name}”`);
    const differences = cells.flat().map((value, i) => Math.abs(value - parseInt(known[name].slice(2 * i, 2 * i + 2), 16)));
    const mean = differences.reduce((sum, value) => sum + value, 0) / differences.length,
      largest = Math.max(...differences);
    assert.ok(
      mean < kMeanDifference && largest < kLargestDifference,
      `${name}: differs from pictures.json by ${mean.toFixed(1)} of 255 on average, by at most ${largest}`,
    );
  }

  /** Checks that labels of the plots in an element are not cut off: nothing is drawn at their left and right border. */
  async expectMargins(panel) {
    const count = await this.page.locator(`#${panel} .plot`).count();
    for (let i = 0; i < count; ++i) {
      const { border } = await this.picture(`#${panel} .plot >> nth=${i}`);
      assert.deepEqual(border.slice(0, 5), [], `plot ${i + 1} of ${panel} is cut off`);
    }
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
