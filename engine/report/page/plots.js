// Plots: drawn when they come into view, in the colours of the theme, and drawn again when it changes.

// Okabe and Ito, told apart by everybody; of eight limbs the last two are beyond them.
const limbColours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c6d31", "#7f7f7f"];
const seriesColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"];
const fieldColours = "Cividis"; // perceptually uniform
const timeColours = "Viridis";

const plots = [];
let plotlyIsThere = false;

/** Plotly takes a second to compile: by then the page can be read. */
function loadPlotly() {
  return new Promise((resolve) =>
    requestAnimationFrame(() =>
      setTimeout(() => {
        document.head.append(element("script", "", document.getElementById("plotly").textContent));
        plotlyIsThere = true;
        for (const plot of plots) toBeSeen.observe(plot.node);
        resolve();
      }),
    ),
  );
}

/** Those that came into view are drawn one by one, and the reader may scroll in between. */
const inTurn = [];
function drawNext() {
  inTurn.shift()?.draw();
  if (inTurn.length) setTimeout(drawNext, 50);
}

const toBeSeen = new IntersectionObserver(
  (entries) => {
    const seen = entries.filter((entry) => entry.isIntersecting);
    const idle = !inTurn.length;
    inTurn.push(...plots.filter((plot) => !plot.drawn && seen.some((entry) => entry.target === plot.node)));
    if (idle && inTurn.length) setTimeout(drawNext, 50);
  },
  { rootMargin: "400px" },
);

function colour(name) {
  return getComputedStyle(document.documentElement)
    .getPropertyValue("--" + name)
    .trim();
}

/** A colour of "#rrggbb" made transparent. */
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

function layoutOf(more) {
  return {
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour("ink") },
    margin: { l: 12, r: 12, t: 12, b: 12 },
    hovermode: "closest",
    hoverlabel: { bgcolor: colour("panel"), bordercolor: colour("line"), font: { color: colour("ink"), size: 13 } },
    legend: { orientation: "h", x: 0, y: 1.02, xanchor: "left", yanchor: "bottom" },
    colorway: seriesColours,
    modebar: { bgcolor: colour("panel"), color: colour("muted"), activecolor: colour("accent") },
    ...more,
  };
}

/**
 * Adds a panel with a plot to `parent`.
 * @param options  title, caption, size (a class: "half"), height [px], make: (away) => ({ data, layout }), where `away`
 *                 is how much farther a camera has to stand for all to be seen in a panel that is higher than wide
 * @returns { panel, node, update(), .. }; update() draws anew what has been drawn
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
  const panel = element(
    "div",
    "panel " + size,
    title ? element("h3", "", title) : null,
    caption ? element("p", "caption", ...[caption].flat()) : null,
    node,
  );
  parent.append(panel);
  const plot = {
    panel,
    node,
    drawn: false,
    draw() {
      if (!plot.drawn) plot.update(true);
    },
    /** Anew once it is in view. */
    drawAgain() {
      if (!plot.drawn) return;
      plot.drawn = false;
      toBeSeen.unobserve(node);
      toBeSeen.observe(node);
    },
    update(first = false) {
      if (!first && !plot.drawn) return;
      plot.drawn = true;
      const { data, layout } = make(Math.max(1, node.clientHeight / (node.clientWidth || node.clientHeight)));
      plot.done = Plotly.react(node, data, layoutOf(layout), {
        responsive: true,
        displaylogo: false,
        modeBarButtonsToRemove: ["select2d", "lasso2d"],
      });
    },
  };
  plots.push(plot);
  if (plotlyIsThere) toBeSeen.observe(node);
  return plot;
}

function forgetPlots() {
  inTurn.length = 0;
  for (const plot of plots.splice(0)) {
    toBeSeen.unobserve(plot.node);
    if (plot.drawn) Plotly.purge(plot.node);
  }
}

/** Draws the plots of a section, or all, whether they are in view or not. */
function drawPlots(section) {
  const meant = plots.filter((plot) => !section || plot.node.closest("section").id === section);
  for (const plot of meant) plot.draw();
  return Promise.all(meant.map((plot) => plot.done));
}

function themeButton(button) {
  const system = matchMedia("(prefers-color-scheme: dark)");
  let chosen = null;
  const show = () => {
    const dark = chosen === null ? system.matches : chosen === "dark";
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    button.textContent = dark ? "☀ Light" : "☾ Dark";
    button.setAttribute("aria-label", dark ? "light theme" : "dark theme");
    for (const plot of plots) plot.drawAgain();
  };
  button.addEventListener("click", () => {
    chosen = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    show();
  });
  system.addEventListener("change", show);
  addEventListener("beforeprint", () => {
    // paper is white
    document.documentElement.dataset.theme = "light";
    for (const plot of plots) if (plotlyIsThere) plot.update(true);
  });
  addEventListener("afterprint", show);
  show();
}
