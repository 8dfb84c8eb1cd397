// Plotly plots: drawn when they come into view, in the colours of the theme, and redrawn when the theme changes.

// The colour-blind safe palette of Okabe and Ito (2008), with two more colours for the seventh and eighth limb.
const limbColours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c6d31", "#7f7f7f"];
const seriesColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"];
// Cividis, which is perceptually uniform; in the dark theme without its dark end, which would not be visible there.
const fieldColours = () =>
  document.documentElement.dataset.theme === "dark"
    ? [[0, "#4a556c"], [0.33, "#7d7c78"], [0.67, "#bcae6f"], [1, "#fee838"]]
    : "Cividis";
const timeColours = "Viridis";

const plots = [];
let plotlyLoaded = false;

/** Compiles Plotly, which takes about a second, after the text of the page has been rendered. */
function loadPlotly() {
  return new Promise((resolve) =>
    requestAnimationFrame(() =>
      setTimeout(() => {
        document.head.append(element("script", "", document.getElementById("plotly").textContent));
        plotlyLoaded = true;
        for (const plot of plots) visibility.observe(plot.node);
        resolve();
      }),
    ),
  );
}

/** Plots in view that are not drawn yet. They are drawn one at a time, so that the page remains responsive. */
const queue = [];
function drawNext() {
  queue.shift()?.draw();
  if (queue.length) setTimeout(drawNext, 50);
}

const visibility = new IntersectionObserver(
  (entries) => {
    const seen = entries.filter((entry) => entry.isIntersecting);
    const idle = !queue.length;
    queue.push(...plots.filter((plot) => !plot.drawn && seen.some((entry) => entry.target === plot.node)));
    if (idle && queue.length) setTimeout(drawNext, 50);
  },
  { rootMargin: "400px" },
);

/** A colour of the theme, see page.css. */
function colour(name) {
  return getComputedStyle(document.documentElement)
    .getPropertyValue("--" + name)
    .trim();
}

/** A colour "#rrggbb" with transparency. */
function faded(hex, alpha) {
  const part = (i) => parseInt(hex.slice(i, i + 2), 16);
  return `rgba(${part(1)},${part(3)},${part(5)},${alpha})`;
}

function axis(title, more = {}) {
  return {
    title: { text: title, standoff: 8 },
    automargin: true,
    gridcolor: colour("grid"),
    linecolor: colour("line"),
    zerolinecolor: colour("line"),
    ticks: "outside",
    tickcolor: colour("line"),
    tickmode: "auto",
    ...more,
  };
}

function colourBar(title) {
  return { title: { text: title, side: "right" }, thickness: 12, outlinewidth: 0, len: 0.92, tickfont: { size: 12 } };
}

/** A colour bar below the plot, for 3-D scenes, which need the width. */
function lowColourBar(title) {
  return {
    ...colourBar(title),
    title: { text: title, side: "top" },
    orientation: "h",
    y: 0,
    yanchor: "bottom",
    len: 0.8,
  };
}

function layoutOf(more) {
  return {
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour("ink") },
    margin: { l: 12, r: 12, t: 12, b: 12 },
    hovermode: "closest",
    hoverlabel: { bgcolor: colour("box"), bordercolor: colour("line"), font: { color: colour("ink"), size: 13 } },
    legend: { orientation: "h", x: 0, y: 1.02, xanchor: "left", yanchor: "bottom" },
    colorway: seriesColours,
    modebar: { bgcolor: colour("box"), color: colour("muted"), activecolor: colour("accent") },
    ...more,
  };
}

/**
 * Adds a box with a plot to `parent`.
 * @param options  title; caption; size (CSS class "half" or none); height [px]; make(distance) gives { data, layout },
 *                 where `distance` >= 1 is the factor by which a 3-D camera must move back if the box is narrow
 * @returns { box, node, update(), .. }; update() redraws a plot that has been drawn
 */
function addPlot(parent, { title, caption, size = "", height = 380, make }) {
  const node = element("div", "plot");
  node.setAttribute("role", "img");
  node.setAttribute(
    "aria-label",
    [title, caption]
      .flat()
      .filter((part) => typeof part === "string")
      .join(". ") || "plot",
  );
  node.style.height = height + "px";
  const box = element(
    "div",
    "box " + size,
    title ? element("h3", "", title) : null,
    caption ? element("p", "caption", ...[caption].flat()) : null,
    node,
  );
  parent.append(box);
  const plot = {
    box,
    node,
    drawn: false,
    draw() {
      if (!plot.drawn) plot.update(true);
    },
    /** Redraws the plot when it is in view. */
    redrawWhenVisible() {
      if (!plot.drawn) return;
      plot.drawn = false;
      visibility.unobserve(node);
      visibility.observe(node);
    },
    update(first = false) {
      if (!first && !plot.drawn) return;
      plot.drawn = true;
      const { data, layout } = make(Math.max(1, (1.1 * node.clientHeight) / (node.clientWidth || node.clientHeight)));
      plot.done = Plotly.react(node, data, layoutOf(layout), {
        responsive: true,
        displaylogo: false,
        modeBarButtonsToRemove: ["select2d", "lasso2d"],
      });
    },
  };
  plots.push(plot);
  if (plotlyLoaded) visibility.observe(node);
  return plot;
}

/** Removes all plots. */
function removePlots() {
  queue.length = 0;
  for (const plot of plots.splice(0)) {
    visibility.unobserve(plot.node);
    if (plot.drawn) Plotly.purge(plot.node);
  }
}

/** Draws the plots of the panel with this id, or all plots if it is undefined, whether or not they are in view. */
function drawPlots(panelId) {
  const selected = plots.filter((plot) => !panelId || plot.node.closest("section").id === panelId);
  for (const plot of selected) plot.draw();
  return Promise.all(selected.map((plot) => plot.done));
}

/** Makes a button switch between the light and the dark theme; the default is that of the system. */
function themeButton(button) {
  const system = matchMedia("(prefers-color-scheme: dark)");
  let chosen = null;
  const show = () => {
    const dark = chosen === null ? system.matches : chosen === "dark";
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    button.textContent = dark ? "☀ Light" : "☾ Dark";
    button.setAttribute("aria-label", dark ? "light theme" : "dark theme");
    for (const plot of plots) plot.redrawWhenVisible();
  };
  button.addEventListener("click", () => {
    chosen = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    show();
  });
  system.addEventListener("change", show);
  addEventListener("beforeprint", () => {
    // printed pages have the light theme
    document.documentElement.dataset.theme = "light";
    for (const plot of plots) if (plotlyLoaded) plot.update(true);
  });
  addEventListener("afterprint", show);
  show();
}
