// The report: a study at a time, section by section, and several studies beside each other.

const sections = [
  { id: "summary", title: "Summary", show: showSummary },
  { id: "design", title: "Design", show: showDesign },
  { id: "workspace", title: "Workspace", show: showWorkspace },
  { id: "mechanism", title: "Mechanism", show: showMechanism },
  { id: "coupling", title: "Coupling", show: showCoupling },
  { id: "motions", title: "Motions", show: showMotions },
  { id: "convergence", title: "Convergence", show: showConvergence },
  { id: "front", title: "Trade-off", show: showFront },
  { id: "populations", title: "Populations", show: showPopulations },
];

/** A section's heading, and the element that its content goes into. */
function sectionOf(page, id, title) {
  const section = element("section");
  section.id = id;
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
    links.forEach((link, i) => link.classList.toggle("here", i === here));
  };
  markContents();
}

function showStudy(report, study) {
  forgetPlots();
  const page = document.getElementById("page");
  page.replaceChildren();
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
  const loaded = loadPlotly();
  window.report = { ...report, draw: (section) => loaded.then(() => drawPlots(section)) }; // for readers that are programs
}
