// One design without a study: what it is.

function showDesign(study, section) {
  const { mechanism, title, name, parameters } = study.design;
  section.append(element("h1", "", mechanism), element("p", "facts", title), element("p", "facts", name));
  addOverview(study, section);
  const rows = parameters.map((p) => [p.name, measured(p.value, p.unit), p.meaning]);
  section.append(
    element(
      "div",
      "panel",
      element(
        "details",
        "",
        element("summary", "", count(rows.length, "parameter")),
        simpleTable(["parameter", "value", "meaning"], rows),
      ),
    ),
  );
}
