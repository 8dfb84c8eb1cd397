// The trade-off: designs of which no other one is better everywhere, with knees and compromise. A click on one puts it in
// the place of the best design, as far as the page has its workspace and mechanism.

/** The p-th point of the f-th front; null where it is the design that the page shows anyway. */
function chosenPoint(study, f, p) {
  const front = study.front.fronts[f],
    point = front.points[p];
  const best = study.summary.table?.rows.filter((row) => row.kind === "variable").map((row) => row.values[0]);
  if (!study.point && point.design.every((value, i) => value === best?.[i])) return null;
  return { ...point, f, p, name: `point ${p + 1} of stage ${front.stage}`, stage: front.stage };
}

const isAt = (study, f, p) => study.point?.f === f && study.point?.p === p;

/** The study with a point of its trade-off where its best design was: first of every list of designs. */
function withPoint(study, point) {
  const { table } = study.summary;
  const { variables, objectives } = study.problem;
  const valueOf = ({ kind, name }) =>
    kind === "variable"
      ? point.design[variables.findIndex((v) => v.name === name)]
      : kind === "objective"
        ? (point.objectives[objectives.findIndex((o) => o.name === name)] ?? null)
        : null;
  const baseline = table.columns.findIndex((column) => column.name === "baseline");
  const gain = (row, value) => {
    const from = row.values[baseline];
    if (row.kind !== "objective" || value === null || !from) return undefined;
    const { maximise } = objectives.find((o) => o.name === row.name);
    return { percent: (100 * (value - from)) / Math.abs(from), worse: maximise ? value < from : value > from };
  };
  const rows = table.rows.map((row) => {
    const value = valueOf(row);
    return { ...row, values: [value, ...row.values], gain: gain(row, value) };
  });
  const columns = [{ name: point.name, status: "feasible", reason: "", reference: false }, ...table.columns];
  const shown = {
    ...study,
    point,
    whole: study,
    // What is active and what it costs is known of the best design only.
    summary: { ...study.summary, table: { columns, rows }, active: undefined, optimality: null },
  };
  const has = (part) => study.front.designs?.[part]?.designs.find((design) => design.name === point.name);
  point.missing = study.workspace && !has("workspace");
  if (point.missing) return shown;
  for (const part of ["workspace", "mechanism"])
    if (study[part] && has(part))
      shown[part] = {
        ...study[part],
        designs: [has(part), ...study[part].designs.filter((design) => design.name === "baseline")],
      };
  if (study.motions && study.front.designs.motions)
    shown.motions = {
      ...study.motions,
      motions: study.motions.motions.map((motion, m) => ({
        ...motion,
        designs: [
          ...study.front.designs.motions.motions[m].designs.filter((design) => design.name === point.name),
          ...motion.designs.filter((design) => design.name === "baseline"),
        ],
      })),
    };
  shown.coupling = undefined; // of the best design and the baseline only
  return shown;
}

/** The commands that show a point whose workspace the page does not have. */
function pointCommand({ file }, { stage, p, name }) {
  const point = `--from ${word(file)} --front ${p + 1} --stage ${stage}`;
  return `pkmopt workspace ${point} --html ${name.replaceAll(" ", "-")}.html`;
}

/** What the bar on top says of the design that is shown. */
function tellChosen(study) {
  const back = element("button", "", "× back to the " + (study.whole?.summary.table.columns[0].name ?? ""));
  back.type = "button";
  back.addEventListener("click", () => study.choose(null));
  document.getElementById("chosen").replaceChildren(...(study.point ? [study.point.name + " ", back] : []));
}

const frontSymbols = ["circle", "diamond", "square", "cross"];

function frontPoint(study, front, point) {
  const { variables, objectives } = study.problem;
  const lines = [`<b>stage ${front.stage}, point ${front.points.indexOf(point) + 1}</b>`];
  objectives.forEach((o, k) => lines.push(label(o.name) + " = " + label(quantity(point.objectives[k], o.unit))));
  variables.forEach((v, i) => lines.push(label(v.name) + " = " + label(shownQuantity(point.design[i], v.unit))));
  return lines.join("<br>");
}

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
    text: front.points.map((p) => frontPoint(study, front, p)),
    hovertemplate: "%{text}<br><i>click: load it</i><extra></extra>",
    front: f,
    marker: {
      size: f ? 9 : 7,
      symbol: frontSymbols[f % frontSymbols.length],
      opacity: 0.9,
      line: { width: f ? 1 : 0, color: colour("ink") },
      ...(third >= 0
        ? {
            color: front.points.map((p) => p.objectives[third]),
            colorscale: fieldColours,
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
      name: "shown",
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

/** The designs worth naming: ends, knees, compromise. */
function namedPoints(study) {
  const { variables, objectives } = study.problem;
  const rows = [];
  for (const front of study.front.fronts) {
    front.points.forEach((point, i) => {
      const marks = objectives.flatMap((o, k) => {
        const values = front.points.map((p) => p.objectives[k]);
        const best = o.maximise ? Math.max(...values) : Math.min(...values);
        return values.indexOf(best) === i ? ["best " + o.name] : [];
      });
      if (point.knee) marks.push("knee");
      if (point.compromise) marks.push("compromise");
      if (marks.length)
        rows.push([
          front.stage + " / " + (i + 1),
          marks.join(", "),
          ...point.objectives.map((v, k) => result(v, objectives[k].unit)),
          ...point.design.map((v, i) => measured(v, variables[i].unit)),
        ]);
    });
  }
  const name = (each) => each.name;
  return simpleTable(["stage / point", "what", ...objectives.map(name), ...variables.map(name)], rows);
}

/** The designs that the page has in full, for a keyboard. */
function pointChoice(controls, study, load) {
  const { fronts, designs } = study.front;
  const whole = study.whole ?? study;
  const named = (designs?.workspace?.designs ?? []).flatMap(({ name }) => {
    const [, p, stage] = /^point (\d+) of stage (\d+)$/.exec(name);
    return [{ name, f: fronts.findIndex((front) => front.stage === Number(stage)), p: Number(p) - 1 }];
  });
  if (!named.length) return;
  const shown = named.findIndex(({ f, p }) => isAt(study, f, p));
  choice(
    controls,
    "shown in the page",
    [whole.summary.table.columns[0].name, ...named.map(({ name }) => name)],
    study.point && shown < 0 ? -1 : shown + 1,
    (i) => (i ? load(named[i - 1].f, named[i - 1].p) : study.choose(null)),
  );
}

function showFront(study, section) {
  const { objectives } = study.problem;
  const sizes = study.front.fronts.map((front) => `${count(front.points.length, "design")} of stage ${front.stage}`);
  section.append(
    element(
      "p",
      "lead",
      sizes.join(", ") +
        ". To leave a knee in any direction costs more than it gains; the compromise is nearest to the best of all objectives. A click on a point loads it into the page.",
    ),
  );
  const controls = element("div", "controls"),
    grid = element("div", "grid");
  const names = objectives.map((o) => o.name);
  section.append(controls, grid);
  const redraw = () => plot.update();
  const x = choice(controls, "across", names, 0, redraw),
    y = choice(controls, "up", names, 1, redraw);
  const third = names.length > 2 ? choice(controls, "colour", names, 2, redraw) : { value: -1 };
  const load = (f, p) => study.choose(chosenPoint(study.whole ?? study, f, p));
  pointChoice(controls, study, load);
  if (study.point?.missing)
    section.insertBefore(
      element(
        "p",
        "warning",
        `The page has the values of ${study.point.name}, but not its workspace: below are those of the ${study.whole.summary.table.columns[0].name}. Its own: `,
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
  grid.append(element("div", "panel", element("h3", "", "Designs worth naming"), namedPoints(study)));
}
