// Several studies beside each other: results, convergence, best designs.

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
  return element("div", "panel", element("div", "scroll", table));
}

/** Best so far against evaluations, over all stages. */
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

/** The best designs' workspaces over each other, of studies that sweep the same three coordinates. */
function addOverlays(studies, grid) {
  const groups = new Map();
  studies.forEach((study, i) => {
    const packed = study.workspace?.designs[0];
    if (!packed?.surface) return;
    const swept = packed.axes.map((axis) => `${axis.name} [${axis.unit}]`).join(", ");
    if (!groups.has(swept)) groups.set(swept, []);
    groups.get(swept).push({ study, i, cells: (packed.cells ??= new Cells(packed)) });
  });
  for (const those of groups.values()) {
    if (those.length < 2) continue;
    const all = those.map(({ cells }) => cells),
      order = drawingOrder(all[0].axes);
    addPlot(grid, {
      title: "Workspaces over each other",
      caption: [
        "Of the best designs: ",
        ...those.flatMap(({ study, cells }, k) => [
          (k ? ", " : "") + study.name + " ",
          result(cells.volume, cells.volume_unit),
        ]),
        ".",
      ],
      size: "half",
      height: 460,
      make: () => ({
        data: those.map(({ study, i, cells }) =>
          surfaceTrace(cells, null, null, order, {
            name: label(study.name),
            color: studyColour(i),
            opacity: 0.4,
            showlegend: true,
          }),
        ),
        layout: { scene: workspaceScene(all, order), uirevision: "camera", margin: { l: 0, r: 0, t: 0, b: 0 } },
      }),
    });
  }
}

function showComparison(studies, section) {
  section.append(
    element(
      "p",
      "lead",
      count(studies.length, "study", "studies") +
        ". The sections below show one of them; choose it at the top of the page.",
    ),
  );
  const grid = element("div", "grid");
  section.append(grid);
  grid.append(comparisonTable(studies));
  const names = [
    ...new Map(studies.flatMap((s) => s.problem.objectives.map((o) => [o.name + "|" + o.unit, o]))).values(),
  ];
  for (const objective of names) {
    const those = studies
      .map((study, i) => ({
        study,
        i,
        k: study.problem.objectives.findIndex((o) => o.name === objective.name && o.unit === objective.unit),
      }))
      .filter(({ study, k }) => k >= 0 && study.convergence);
    if (those.length)
      addPlot(grid, {
        title: "Best " + objective.name,
        caption: "Of the feasible designs so far.",
        size: "half",
        height: 360,
        make: () => ({
          data: those.map(({ study, i, k }) => ({
            type: "scatter",
            mode: "lines",
            ...bestCurve(study, k),
            name: label(study.name),
            line: { color: studyColour(i), width: 2.5, shape: "hv" },
            hovertemplate: `%{y:.4g} ${label(unitText(objective.unit))}<br>after %{x} evaluations<extra>${label(study.name)}</extra>`,
          })),
          layout: {
            xaxis: axis("evaluations", { type: "log", tickangle: 0, nticks: 5 }),
            yaxis: axis(axisName(objective.name, objective.unit)),
            legend: { orientation: "h", x: 0, y: -0.2, yanchor: "top" },
          },
        }),
      });
  }
  addOverlays(studies, grid);
  const variables = [
    ...new Map(studies.flatMap((s) => s.problem.variables.map((v) => [v.name + "|" + v.unit, v]))).values(),
  ];
  addPlot(grid, {
    title: "Best designs",
    caption: "Each variable from 0, its least bound among the studies, to 1, its greatest.",
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
        yaxis: axis("share of the bounds [1]", { range: [-0.05, 1.05] }),
        legend: { orientation: "h", x: 0, y: -0.2, yanchor: "top" },
      },
    }),
  });
}
