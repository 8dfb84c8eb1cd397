// The report: a study at a time, section by section, and several studies beside each other.

const sections = [
  { id: "summary", title: "Summary", show: showSummary },
  { id: "design", title: "Design", show: showDesign },
  { id: "front", title: "Trade-off", show: showFront },
  { id: "workspace", title: "Workspace", show: showWorkspace },
  { id: "mechanism", title: "Mechanism", show: showMechanism },
  { id: "motions", title: "Motions", show: showMotions },
  { id: "coupling", title: "Coupling", show: showCoupling },
  { id: "convergence", title: "Convergence", show: showConvergence },
  { id: "populations", title: "Populations", show: showPopulations },
];

/** A section's heading, and the element that its content goes into. */
function sectionOf(page, id, title) {
  const section = element("section");
  section.id = id;
  section.tabIndex = -1; // a link to it takes the keyboard there
  section.setAttribute("aria-label", title || id);
  if (title) section.append(element("h2", "", title));
  page.append(section);
  return section;
}

let markContents = () => {}; // the link of the section in view
addEventListener("scroll", () => markContents(), { passive: true });

function showContents(list) {
  const links = list.map(({ id, title }) => {
    const link = element("a", "", title);
    link.href = "#" + id;
    return link;
  });
  document
    .getElementById("contents")
    .replaceChildren(element("ol", "", ...links.map((link) => element("li", "", link))));
  markContents = () => {
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
  markContents();
}

/**
 * @param point  of the trade-off, as chosenPoint() gives it, which the page shows in place of the best design; null: the
 *               best
 */
function showStudy(report, whole, point = null) {
  const study = point ? withPoint(whole, point) : whole;
  study.choose = (other) => keepInView("front", () => showStudy(report, whole, other));
  forgetPlots();
  const page = document.getElementById("page");
  page.replaceChildren();
  tellChosen(study);
  const shown = [];
  if (report.studies.length > 1) {
    shown.push({ id: "comparison", title: "Comparison" });
    showComparison(report.studies, sectionOf(page, "comparison", "Comparison"));
  }
  for (const { id, title, show } of sections) {
    if (!study[id]) continue;
    shown.push({ id, title });
    show(study, sectionOf(page, id, id === "summary" || id === "design" ? "" : title));
  }
  const files = report.studies
    .map((each) => each.file)
    .filter(Boolean)
    .join(", ");
  page.append(element("footer", "", "Made by " + report.program + (files ? " from " + files : "") + "."));
  showContents(shown);
}

/** j and k go to the next and the last section. */
function stepSections(event) {
  if (!/^[jk]$/.test(event.key) || event.ctrlKey || event.metaKey || event.altKey) return;
  if (/^(input|select|textarea)$/i.test(event.target.localName ?? "")) return;
  const links = [...document.querySelectorAll("#contents a")];
  const here = links.findIndex((link) => link.classList.contains("here"));
  const link = links[here + (event.key === "j" ? 1 : -1)];
  if (!link) return;
  const section = document.querySelector(link.hash);
  section.scrollIntoView();
  section.focus({ preventScroll: true });
}

/** Makes a section anew where it is in view; a control that had the keyboard has it again. */
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
  document.title = report.studies.map((study) => study.name).join(", ") + " – pkmopt";
  if (report.studies.length > 1)
    choice(
      chooser,
      "study",
      report.studies.map((study) => study.name + " (" + study.file + ")"),
      0,
      (i) => showStudy(report, report.studies[i]),
    );
  else chooser.append(element("span", "title", report.studies[0].name));
  themeButton(document.getElementById("theme"));
  showStudy(report, report.studies[0]);
  addEventListener("keydown", stepSections);
  const loaded = loadPlotly();
  window.report = { ...report, draw: (section) => loaded.then(() => drawPlots(section)) }; // for readers that are programs
}
