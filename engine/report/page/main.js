// Builds the page from its data: the comparison of several studies, and the panels of the selected study.

const panels = [
  { id: "summary", title: "Summary", show: showSummary },
  { id: "design", title: "Design", show: showDesign },
  { id: "front", title: "Pareto front", show: showFront },
  { id: "workspace", title: "Workspace", show: showWorkspace },
  { id: "mechanism", title: "Mechanism", show: showMechanism },
  { id: "motions", title: "Motions", show: showMotions },
  { id: "coupling", title: "Coupling", show: showCoupling },
  { id: "convergence", title: "Convergence", show: showConvergence },
  { id: "sweeps", title: "Sweeps", show: showSweeps },
  { id: "populations", title: "Populations", show: showPopulations },
];

/** Adds an empty panel with a heading; returns the element for its content. */
function addPanel(page, id, title) {
  const panel = element("section");
  panel.id = id;
  panel.tabIndex = -1; // so that a link to the panel moves the keyboard focus there
  panel.setAttribute("aria-label", title || id);
  if (title) panel.append(element("h2", "", title));
  page.append(panel);
  return panel;
}

let highlightCurrent = () => {}; // highlights the link of the panel in view
addEventListener("scroll", () => highlightCurrent(), { passive: true });

/** Fills the table of contents. */
function showContents(list) {
  const links = list.map(({ id, title }) => {
    const link = element("a", "", title);
    link.href = "#" + id;
    return link;
  });
  document
    .getElementById("contents")
    .replaceChildren(element("ol", "", ...links.map((link) => element("li", "", link))));
  highlightCurrent = () => {
    const tops = list.map(({ id }) => document.getElementById(id).getBoundingClientRect().top);
    const here = Math.max(
      0,
      tops.findLastIndex((top) => top < innerHeight / 3),
    );
    links.forEach((link, i) => {
      link.classList.toggle("here", i === here);
      if (i === here) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    });
  };
  highlightCurrent();
}

/**
 * Shows the comparisons of the page and the panels of a study, if there is one.
 * @param point  point of the Pareto front, from chosenPoint(), to be shown instead of the best design; null: none
 */
function showStudy(report, original, point = null) {
  const study = point ? withPoint(original, point) : original;
  if (study) study.choose = (other) => keepInView("front", () => showStudy(report, original, other));
  removePlots();
  const page = document.getElementById("page");
  page.replaceChildren();
  if (study) showChosenPoint(study);
  const shown = [];
  if (report.task) {
    shown.push({ id: "task", title: "Task" });
    showTask(report.task, addPanel(page, "task", "Task"));
  }
  if (report.studies.length > 1) {
    shown.push({ id: "comparison", title: "Comparison" });
    showComparison(report.studies, addPanel(page, "comparison", "Comparison"));
  }
  for (const { id, title, show } of panels) {
    if (!study?.[id]) continue;
    shown.push({ id, title });
    show(study, addPanel(page, id, id === "summary" || id === "design" ? "" : title));
  }
  const files = report.studies
    .map((each) => each.file)
    .filter(Boolean)
    .join(", ");
  page.append(element("footer", "", "Created by " + report.program + (files ? " from " + files : "") + "."));
  showContents(shown);
}

/** The keys j and k move to the next and the previous panel. */
function stepPanels(event) {
  if (!/^[jk]$/.test(event.key) || event.ctrlKey || event.metaKey || event.altKey) return;
  if (/^(input|select|textarea)$/i.test(event.target.localName ?? "")) return;
  const links = [...document.querySelectorAll("#contents a")];
  const here = links.findIndex((link) => link.classList.contains("here"));
  const link = links[here + (event.key === "j" ? 1 : -1)];
  if (!link) return;
  const panel = document.querySelector(link.hash);
  panel.scrollIntoView();
  panel.focus({ preventScroll: true });
}

/** Runs change(), which rebuilds a panel, and restores its scroll position and the keyboard focus. */
function keepInView(id, change) {
  const top = () => document.getElementById(id).getBoundingClientRect().top;
  const controls = () => [...document.querySelectorAll(`#${id} select`)];
  const before = top(),
    focused = controls().indexOf(document.activeElement);
  change();
  scrollBy({ top: top() - before, behavior: "instant" });
  controls()[focused]?.focus({ preventScroll: true });
}

function showReport(report) {
  const chooser = document.getElementById("chooser");
  const names = report.studies.length ? report.studies.map((study) => study.name) : [report.task.name];
  document.title = names.join(", ") + " – pkmopt";
  if (report.studies.length > 1)
    choice(
      chooser,
      "study",
      report.studies.map((study) => study.name + " (" + study.file + ")"),
      0,
      (i) => showStudy(report, report.studies[i]),
    );
  else chooser.append(element("span", "title", names[0]));
  themeButton(document.getElementById("theme"));
  showStudy(report, report.studies[0]);
  addEventListener("keydown", stepPanels);
  const loaded = loadPlotly();
  window.report = { ...report, draw: (id) => loaded.then(() => drawPlots(id)) }; // for tests and scripts
}
