// Panel "Comparison" of several studies: results, convergence, best designs, workspaces and loads along motions.

function studyColour(i) {
  return seriesColours[i % seriesColours.length];
}

function comparisonTable(studies) {
  const table = element("table");
  table.append(
    element(
      "thead",
      "",
      element(
        "tr",
        "",
        ...[
          "study",
          "mechanism",
          "objective",
          "best",
          "gain over baseline",
          "evaluations",
          "time",
          "seed",
          "state",
        ].map((text, i) => element("th", i < 3 ? "text" : "", text)),
      ),
    ),
  );
  const body = element("tbody");
  studies.forEach((study, s) => {
    const { summary, problem } = study;
    const rows = (summary.table ? summary.table.rows : []).filter((row) => row.kind === "objective");
    (rows.length ? rows : [null]).forEach((row, k) => {
      const key = element("span", "", "■ ");
      key.style.color = studyColour(s);
      const first = k === 0;
      body.append(
        element(
          "tr",
          "",
          element("td", "text", ...(first ? [key, study.name] : [])),
          element("td", "text", first ? problem.mechanism : ""),
          element("td", "text", row ? row.name : "–"),
          element("td", "", row ? result(row.values[0], row.unit) : "–"),
          element("td", "", row ? gainText(row.gain) : ""),
          ...[
            summary.evaluations.toLocaleString("en-GB"),
            duration(summary.seconds),
            summary.origin.seed,
            summary.state,
          ].map((text) => element("td", "", first ? text : "")),
        ),
      );
    });
  });
  table.append(body);
  return element("div", "box", element("div", "scroll", table));
}

/** Best objective value so far over the evaluations of all stages. */
function bestCurve(study, k) {
  const x = [],
    y = [];
  for (const { stage, offset } of stageAxis(study.convergence, false)) {
    const best = stage.generations.objectives[k].best;
    best.forEach((value, g) => {
      const last = y.length ? y[y.length - 1] : null,
        maximise = study.problem.objectives[k].maximise;
      x.push(offset + stage.generations.evaluations[g]);
      y.push(last === null ? value : value === null ? last : maximise ? Math.max(last, value) : Math.min(last, value));
    });
  }
  return { x, y };
}

/** Rows of the results table with peak values and energies along the motions, which all robots have in common units. */
function motionRows(studies) {
  const names = [...new Set(studies.flatMap(({ motions }) => (motions?.motions ?? []).map((motion) => motion.name)))];
  return names.flatMap((name) => {
    const summaries = studies.map(({ motions }) => motions?.motions.find((m) => m.name === name)?.designs[0]?.summary);
    const row = (title, key, unit) => {
      const values = summaries.map((summary) => summary?.[key]);
      if (values.every((value) => value === undefined)) return [];
      return [[title, "motion " + name, ...values.map((value) => (value === undefined ? "–" : result(value, unit)))]];
    };
    return [
      ...row("peak power of all drives", "peak_total_power", "W"),
      ...row("energy without regeneration", "energy_drawn", "J"),
      ...row("energy with regeneration", "energy", "J"),
    ];
  });
}

/** Table of the best designs, one column per study: objectives, outputs, margins of constraints, loads of motions. */
function resultsTable(studies) {
  const kinds = ["objective", "output", "constraint"],
    found = new Map(); // rows by kind, name and unit
  for (const kind of kinds)
    studies.forEach((study, i) => {
      for (const row of study.summary.table?.rows ?? []) {
        if (row.kind !== kind) continue;
        const key = [kind, row.name, row.unit].join("|");
        if (!found.has(key)) found.set(key, { row, values: studies.map(() => "–") });
        found.get(key).values[i] = (isResult(row) ? result : measured)(row.values[0], row.unit);
      }
    });
  const rows = [...found.values()].map(({ row, values }) => [
    row.name + (row.kind === "constraint" ? " margin" : ""),
    row.kind,
    ...values,
  ]);
  rows.push(...motionRows(studies));
  return element(
    "div",
    "box",
    element("h3", "", "Results of the best designs"),
    simpleTable(["quantity", "kind", ...studies.map((study) => study.name)], rows),
  );
}

/** Tick values of a logarithmic axis: 1, 2, 5, 10, .. */
const logarithmicTicks = Array.from({ length: 30 }, (_, k) => [1, 2, 5][k % 3] * 10 ** Math.floor(k / 3));

/**
 * Groups items of all studies that have the same key; groups of one item are omitted.
 * @param itemsOf  itemsOf(study) gives objects { key, .. }
 */
function groupByKey(studies, itemsOf) {
  const groups = new Map();
  studies.forEach((study, i) => {
    for (const { key, ...item } of itemsOf(study)) {
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push({ study, i, ...item });
    }
  });
  return [...groups.values()].filter((group) => group.length > 1);
}

/** Loads of the best design along each motion: power of all drives; forces and speeds of the joints of each unit. */
function loadsAlong({ motions }) {
  return (motions?.motions ?? []).flatMap((motion) => {
    const columns = ["m", "rad"].flatMap((unit) => [["forces", unit], ["speeds", unit]]);
    return [["power", ""], ...columns].flatMap(([column, unit]) => {
      const curves = motion.designs[0]?.[column]?.filter((_, j) => !unit || motions.joints[j].unit === unit).map(unpack);
      return curves?.length ? [{ key: [motion.name, column, unit].join("|"), motion, column, unit, curves }] : [];
    });
  });
}

/** Plots the loads over time for motions that have the same name in several studies. */
function addLoadPlots(studies, grid) {
  for (const group of groupByKey(studies, loadsAlong)) {
    const { column, unit: kind, motion: first } = group[0];
    const [title, name, unit, scale] = motionColumns[column][kind],
      isSum = column === "power";
    const combined = (values) => (isSum ? values.reduce((sum, value) => sum + value, 0) : Math.max(...values.map(Math.abs)));
    addPlot(grid, {
      title: `${title}, ${first.name}`,
      caption: `${isSum ? "Sum" : "Maximum"} over ${isSum ? "all drives" : "these drives"} of the best designs.`,
      size: "half",
      height: 360,
      make: () => ({
        data: group.map(({ study, i, motion, curves }) => ({
          type: "scatter",
          mode: "lines",
          x: timesOf(motion),
          y: Array.from(curves[0], (_, k) => scale * combined(curves.map((curve) => curve[k]))),
          name: label(study.name),
          line: { color: studyColour(i), width: 2 },
          hovertemplate: `%{y:.4g} ${label(unitText(unit))} at %{x:.4g} s<extra>${label(study.name)}</extra>`,
        })),
        layout: {
          xaxis: axis("time [s]"),
          yaxis: axis(axisName(isSum ? name : "maximum " + name, unit), { rangemode: isSum ? "normal" : "tozero" }),
          legend: { orientation: "h", x: 0, y: -0.2, yanchor: "top" },
        },
      }),
    });
  }
}

/** Outline of the feasible cells of a plane. A border of infeasible cells around the grid makes it closed. */
function outlineTrace(cells, [across, up], name, colour) {
  const shown = (axis) =>
    [-1, ...Array(cells.axes[axis].cells + 1).keys()].map(
      (k) => cells.centre(axis, k) * shownScale(cells.axes[axis].unit),
    );
  const rows = cells.matrix(across, up, (cell) => cells.feasible[cell]).map((row) => [0, ...row, 0]),
    border = rows[0].map(() => 0);
  return {
    type: "contour",
    x: shown(across),
    y: shown(up),
    z: [border, ...rows, border],
    contours: { start: 0.5, end: 0.5, size: 1, coloring: "lines" },
    colorscale: [
      [0, colour],
      [1, colour],
    ],
    line: { width: 2 },
    showscale: false,
    showlegend: true,
    hoverinfo: "skip",
    name,
  };
}

/** Overlays the workspaces of the best designs of studies that sweep the same two or three coordinates. */
function addOverlayPlots(studies, grid) {
  const workspaces = ({ workspace }) => {
    const packed = workspace?.designs[0];
    if (!packed || packed.axes.length < 2) return [];
    const key = packed.axes.map((axis) => `${axis.name} [${axis.unit}]`).join(", ");
    return [{ key, cells: (packed.cells ??= new Cells(packed)) }];
  };
  for (const group of groupByKey(studies, workspaces)) {
    const all = group.map(({ cells }) => cells),
      order = drawingOrder(all[0].axes);
    addPlot(grid, {
      title: "Overlay of the workspaces",
      caption: [
        "Workspaces of the best designs; volumes by voxels: ",
        ...group.flatMap(({ study, cells }, k) => [
          (k ? ", " : "") + study.name + " ",
          result(cells.volume, cells.volume_unit),
        ]),
        ".",
      ],
      size: "half",
      height: 460,
      make: (distance) =>
        order.length === 2
          ? {
              data: group.map(({ study, i, cells }) => outlineTrace(cells, order, label(study.name), studyColour(i))),
              layout: planeAxes(all, ...order),
            }
          : {
              data: group.map(({ study, i, cells }) =>
                surfaceTrace(cells, order, {
                  name: label(study.name),
                  color: studyColour(i),
                  opacity: 0.4,
                  showlegend: true,
                }),
              ),
              layout: {
                scene: workspaceScene(all, order, distance),
                uirevision: "camera",
                margin: { l: 0, r: 0, t: 0, b: 0 },
              },
            },
    });
  }
}

/** @param given  studies; if several have the same name, their file names are shown instead */
function showComparison(given, panel) {
  const studies = given.map((study) =>
    given.some((other) => other !== study && other.name === study.name) ? { ...study, name: study.file } : study,
  );
  panel.append(
    element(
      "p",
      "lead",
      count(studies.length, "study", "studies") +
        ". The other panels show one study; select it at the top of the page.",
    ),
  );
  const grid = element("div", "grid");
  panel.append(grid);
  grid.append(comparisonTable(studies), resultsTable(studies));
  const objectives = [
    ...new Map(studies.flatMap((s) => s.problem.objectives.map((o) => [o.name + "|" + o.unit, o]))).values(),
  ];
  for (const objective of objectives) {
    const group = studies
      .map((study, i) => ({
        study,
        i,
        k: study.problem.objectives.findIndex((o) => o.name === objective.name && o.unit === objective.unit),
      }))
      .filter(({ study, k }) => k >= 0 && study.convergence);
    if (group.length)
      addPlot(grid, {
        title: "Best " + objective.name,
        caption: "Best feasible value so far.",
        size: "half",
        height: 360,
        make: () => ({
          data: group.map(({ study, i, k }) => ({
            type: "scatter",
            mode: "lines",
            ...bestCurve(study, k),
            name: label(study.name),
            line: { color: studyColour(i), width: 2.5, shape: "hv" },
            hovertemplate: `%{y:.4g} ${label(unitText(objective.unit))}<br>after %{x} evaluations<extra>${label(study.name)}</extra>`,
          })),
          layout: {
            xaxis: axis("evaluations", { type: "log", tickangle: 0, tickmode: "array", tickvals: logarithmicTicks }),
            yaxis: axis(axisName(objective.name, objective.unit)),
            legend: { orientation: "h", x: 0, y: -0.2, yanchor: "top" },
          },
        }),
      });
  }
  addOverlayPlots(studies, grid);
  addLoadPlots(studies, grid);
  const variables = [
    ...new Map(studies.flatMap((s) => s.problem.variables.map((v) => [v.name + "|" + v.unit, v]))).values(),
  ];
  addPlot(grid, {
    title: "Variables of the best designs",
    caption: "Each variable is scaled from 0, its smallest lower bound in all studies, to 1, its largest upper bound.",
    size: "half",
    height: 360,
    make: () => ({
      data: studies.flatMap((study, i) => {
        if (!study.summary.table) return [];
        const points = variables.flatMap((v) => {
          const row = study.summary.table.rows.find(
            (r) => r.kind === "variable" && r.name === v.name && r.unit === v.unit,
          );
          const bounds = studies.flatMap((s) =>
            s.problem.variables.filter((o) => o.name === v.name && o.unit === v.unit),
          );
          const low = Math.min(...bounds.map((b) => b.lower)),
            high = Math.max(...bounds.map((b) => b.upper));
          return row
            ? [[label(v.name), (row.values[0] - low) / (high - low), label(shownQuantity(row.values[0], v.unit))]]
            : [];
        });
        return [
          {
            type: "scatter",
            mode: "lines+markers",
            name: label(study.name),
            x: points.map((p) => p[0]),
            y: points.map((p) => p[1]),
            text: points.map((p) => p[2]),
            line: { color: studyColour(i), width: 1.5 },
            marker: { size: 9, color: studyColour(i) },
            hovertemplate: `%{x} = %{text}<extra>${label(study.name)}</extra>`,
          },
        ];
      }),
      layout: {
        xaxis: axis("variable", { type: "category" }),
        yaxis: axis("position between the bounds [1]", { range: [-0.05, 1.05] }),
        legend: { orientation: "h", x: 0, y: -0.2, yanchor: "top" },
      },
    }),
  });
}
