// Panel "Design" of a page for one design without a study: mechanism, name and parameters.

function showDesign(study, panel) {
  const { mechanism, title, name, parameters } = study.design;
  panel.append(element("h1", "", mechanism), element("p", "facts", title), element("p", "facts", name));
  addOverview(study, panel);
  const rows = parameters.map((p) => [p.name, measured(p.value, p.unit), p.meaning]);
  panel.append(
    element(
      "div",
      "box",
      element(
        "details",
        "",
        element("summary", "", count(rows.length, "parameter")),
        simpleTable(["parameter", "value", "meaning"], rows),
      ),
    ),
  );
}
