// Panel "Pareto front": non-dominated designs with knees and the compromise. A click on a point shows its design in the
// other panels.

const frontSymbols = ["circle", "diamond", "square", "cross"];

/** Hover text of a point. */
function frontPointText(study, front, point) {
  const { variables, objectives } = study.problem;
  const lines = [`<b>stage ${front.stage}, point ${front.points.indexOf(point) + 1}</b>`];
  objectives.forEach((o, k) => lines.push(label(o.name) + " = " + label(quantity(point.objectives[k], o.unit))));
  variables.forEach((v, i) => lines.push(label(v.name) + " = " + label(choiceName(point.design[i], v) ?? shownQuantity(point.design[i], v.unit))));
  return lines.join("<br>");
}

/** @param x, y, byColour  indices of the objectives on the axes and, for three or more objectives, in colour */
function frontTraces(study, x, y, byColour) {
  const { fronts, baseline } = study.front;
  const { objectives } = study.problem;
  const third = objectives.length > 2 ? byColour : -1;
  const all = fronts.flatMap((front) => front.points.map((point) => point.objectives[third]));
  const traces = fronts.map((front, f) => ({
    type: "scatter",
    mode: "markers",
    name: `stage ${front.stage}, ${label(front.optimiser)}`,
    x: front.points.map((p) => p.objectives[x]),
    y: front.points.map((p) => p.objectives[y]),
    text: front.points.map((p) => frontPointText(study, front, p)),
    hovertemplate: "%{text}<br><i>click to show this design</i><extra></extra>",
    front: f,
    marker: {
      size: f ? 9 : 7,
      symbol: frontSymbols[f % frontSymbols.length],
      opacity: 0.9,
      line: { width: f ? 1 : 0, color: colour("ink") },
      ...(third >= 0
        ? {
            color: front.points.map((p) => p.objectives[third]),
            colorscale: fieldColours(),
            cmin: Math.min(...all),
            cmax: Math.max(...all),
            showscale: f === 0,
            colorbar: colourBar(axisName(objectives[third].name, objectives[third].unit)),
          }
        : { color: seriesColours[f] }),
    },
  }));
  for (const [key, name, size, ink] of [
    ["knee", "knee", 17, "#d55e00"],
    ["compromise", "compromise", 23, "#cc79a7"],
  ]) {
    const marked = fronts.flatMap((front) => front.points.filter((p) => p[key]).map((p) => [front, p]));
    if (marked.length)
      traces.push({
        type: "scatter",
        mode: "markers",
        name,
        x: marked.map(([, p]) => p.objectives[x]),
        y: marked.map(([, p]) => p.objectives[y]),
        hoverinfo: "skip",
        marker: { size, symbol: "circle-open", color: ink, line: { width: 2.5, color: ink } },
      });
  }
  if (study.point)
    traces.push({
      type: "scatter",
      mode: "markers",
      name: "shown design",
      x: [study.point.objectives[x]],
      y: [study.point.objectives[y]],
      hoverinfo: "skip",
      marker: { size: 20, symbol: "star-open", color: colour("ink"), line: { width: 2 } },
    });
  if (baseline)
    traces.push({
      type: "scatter",
      mode: "markers",
      name: "baseline",
      x: [baseline[x]],
      y: [baseline[y]],
      marker: { size: 12, symbol: "x", color: colour("ink") },
      hovertemplate:
        objectives.map((o, k) => label(o.name + " = " + quantity(baseline[k], o.unit))).join("<br>") +
        "<extra>baseline</extra>",
    });
  return traces;
}

function loadButton(text, pressed) {
  const node = button(element("span"), text, "show the design " + text, pressed);
  node.className = "link";
  return node;
}

/** Table of distinguished designs: best of each objective, knees, compromise. A click on a name shows the design. */
function distinguishedPoints(study, load) {
  const { variables, objectives } = study.problem;
  const rows = [];
  for (const [f, front] of study.front.fronts.entries()) {
    front.points.forEach((point, i) => {
      const roles = objectives.flatMap((o, k) => {
        const values = front.points.map((p) => p.objectives[k]);
        const best = o.maximise ? Math.max(...values) : Math.min(...values);
        return values.indexOf(best) === i ? ["best " + o.name] : [];
      });
      if (point.knee) roles.push("knee");
      if (point.compromise) roles.push("compromise");
      if (roles.length)
        rows.push([
          loadButton(front.stage + " / " + (i + 1), () => load(f, i)),
          roles.join(", "),
          ...point.objectives.map((v, k) => result(v, objectives[k].unit)),
          ...point.design.map((v, i) => choiceName(v, variables[i]) ?? measured(v, variables[i].unit)),
        ]);
    });
  }
  const name = (each) => each.name;
  return simpleTable(["stage / point", "property", ...objectives.map(name), ...variables.map(name)], rows);
}

function showFront(study, panel) {
  const { objectives } = study.problem;
  const sizes = study.front.fronts.map((front) => `${count(front.points.length, "design")} of stage ${front.stage}`);
  panel.append(
    element(
      "p",
      "lead",
      sizes.join(", ") +
        ". At a knee, a small gain in one objective costs much more in another. The compromise has the smallest maximum loss over all objectives, relative to their ranges on the front. Click a point to show its design in the other panels.",
    ),
  );
  const controls = element("div", "controls"),
    grid = element("div", "grid");
  const names = objectives.map((o) => o.name);
  panel.append(controls, grid);
  const redraw = () => plot.update();
  const x = choice(controls, "horizontal", names, 0, redraw),
    y = choice(controls, "vertical", names, 1, redraw);
  const third = names.length > 2 ? choice(controls, "colour", names, 2, redraw) : { value: -1 };
  const load = (f, p) => study.choose(chosenPoint(study.original ?? study, f, p));
  addPointList(controls, study, load);
  if (study.point?.missing)
    panel.insertBefore(
      element(
        "p",
        "warning",
        `The page includes the values of ${study.point.name}, but not its workspace; the panels below show the ${study.original.summary.table.columns[0].name} design. To see the workspace of this point: `,
        code(pointCommand(study, study.point)),
      ),
      grid,
    );
  const plot = addPlot(grid, {
    height: 520,
    make: () => ({
      data: frontTraces(study, x.value, y.value, third.value),
      layout: {
        xaxis: axis(axisName(names[x.value], objectives[x.value].unit)),
        yaxis: axis(axisName(names[y.value], objectives[y.value].unit)),
      },
    }),
  });
  const draw = plot.draw;
  plot.draw = () => {
    const first = !plot.drawn;
    draw();
    if (first)
      plot.node.on("plotly_click", ({ points: [hit] }) => {
        if (hit.data.front !== undefined) load(hit.data.front, hit.pointIndex);
      });
  };
  grid.append(element("div", "box", element("h3", "", "Distinguished designs"), distinguishedPoints(study, load)));
}
