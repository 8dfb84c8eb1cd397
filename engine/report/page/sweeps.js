// Panel "Sweeps": how results depend on the variables, as contours of a full-factorial sweep over two variables, or as one
// curve for each variable that a sweep varies alone.

/** The value, or null, for which Plotly leaves a gap. */
function finiteOrNull(value) {
  return Number.isFinite(value) ? value : null;
}

/** Contours of a result over two variables; sliders choose the values of the others. */
function showContours(sweep, columns, grid, controls) {
  const levels = sweep.levels.map((packed, v) => Array.from(unpack(packed), (value) => value * columns[v].scale));
  const varied = levels.flatMap((values, v) => (values.length > 1 ? [v] : []));
  const results = columns.filter((column) => column.kind !== "variable" && column.values.some(Number.isFinite));
  const redraw = () => plot.update();
  const names = varied.map((v) => columns[v].name);
  const x = choice(controls, "horizontal", names, 0, changeAxes);
  const y = choice(controls, "vertical", names, 1, changeAxes);
  const z = choice(controls, "colour", results.map((column) => column.name), 0, redraw);
  const sliders = levels.map((values, v) =>
    values.length > 1
      ? slider(controls, columns[v].name, values.length, Math.floor(values.length / 2),
          (i) => quantity(values[i], columns[v].unit), redraw)
      : { value: 0, node: element("span") },
  );
  function changeAxes() {
    const isAxis = (v) => v === varied[x.value] || v === varied[y.value];
    sliders.forEach(({ node }, v) => (node.style.display = isAxis(v) ? "none" : ""));
    redraw();
  }
  const rowOf = (index) => index.reduce((row, k, v) => row * levels[v].length + k, 0);
  const plot = addPlot(grid, {
    title: "Contours",
    height: 520,
    caption: "Crosses: designs that are infeasible, rejected before the workspace analysis, or failed.",
    make() {
      const [cx, cy, cz] = [varied[x.value], varied[y.value], results[z.value]];
      const row = (i, j) => rowOf(sliders.map(({ value }, v) => (v === cx ? i : v === cy ? j : value)));
      const nodes = levels[cy].flatMap((b, j) => levels[cx].map((a, i) => ({ a, b, row: row(i, j) })));
      const [zmin, zmax] = rangeOf(cz.values); // the same colours at all positions of the sliders
      const infeasible = nodes.filter(({ row }) => row < sweep.designs && sweep.status[row] !== 0);
      return {
        data: [
          {
            type: "contour",
            x: levels[cx],
            y: levels[cy],
            z: levels[cy].map((_, j) => levels[cx].map((_, i) => finiteOrNull(cz.values[row(i, j)]))),
            colorscale: timeColours,
            zmin,
            zmax,
            autocontour: true,
            ncontours: 12,
            contours: { coloring: "heatmap", showlabels: true, labelfont: { size: 11, color: "#ffffff" } },
            line: { width: 1, color: "#ffffff" },
            colorbar: colourBar(axisName(cz.name, cz.unit)),
            hovertemplate: `${label(columns[cx].name)} = %{x:.4~g}<br>${label(columns[cy].name)} = %{y:.4~g}<br>${label(cz.name)} = %{z:.6~g}<extra></extra>`,
          },
          {
            type: "scatter",
            mode: "markers",
            x: infeasible.map(({ a }) => a),
            y: infeasible.map(({ b }) => b),
            marker: { symbol: "x-thin", size: 6, line: { width: 1.2, color: colour("ink") } },
            hoverinfo: "skip",
            showlegend: false,
          },
        ],
        layout: {
          xaxis: axis(axisName(columns[cx].name, columns[cx].unit)),
          yaxis: axis(axisName(columns[cy].name, columns[cy].unit)),
        },
      };
    },
  });
  changeAxes();
}

/** One curve for each variable that is varied alone. */
function showCurves(sweep, columns, grid, controls) {
  const results = columns.filter((column) => column.kind !== "variable" && column.values.some(Number.isFinite));
  const first = unpack(sweep.first_rows);
  const z = choice(controls, "result", results.map((column) => column.name), 0, () => plots.forEach((p) => p.update()));
  const variables = columns.filter((column) => column.kind === "variable");
  const plots = variables.slice(0, first.length - 1).map((variable, v) =>
    addPlot(grid, {
      size: "half",
      title: variable.name,
      height: 300,
      caption: "Filled: feasible. Open: infeasible, rejected or failed.",
      make() {
        const rows = [];
        for (let row = first[v + 1]; row < (first[v + 2] ?? sweep.designs); ++row) rows.push(row);
        const result = results[z.value];
        return {
          data: [
            {
              type: "scatter",
              mode: "lines+markers",
              x: rows.map((row) => variable.values[row]),
              y: rows.map((row) => result.values[row]),
              marker: { size: 6, symbol: rows.map((row) => (sweep.status[row] ? "circle-open" : "circle")) },
              hovertemplate: "%{x:.4~g}: %{y:.6~g}<extra></extra>",
            },
          ],
          layout: {
            xaxis: axis(axisName(variable.name, variable.unit)),
            yaxis: axis(axisName(result.name, result.unit)),
          },
        };
      },
    }),
  );
}

function showSweeps(study, panel) {
  for (const stored of study.sweeps) {
    const title = study.sweeps.length > 1 ? `Stage ${stored.stage}: ` : "";
    if (!stored.columns) {
      panel.append(element("p", "lead", `${title}The sweep has ${stored.designs} designs, too many for this page; pkmopt export writes them as a table.`));
      continue;
    }
    const sweep = { ...stored, status: unpack(stored.status) };
    const columns = designColumns(study.problem, stored.columns);
    const contours = stored.full_factorial && stored.levels.filter((packed) => unpack(packed).length > 1).length > 1;
    panel.append(
      element("p", "lead", title + (contours
            ? "A result over two variables. The sliders set the values of the other variables."
            : "A result over each variable; the other variables have the values of the first design.")),
    );
    const controls = element("div", "controls"),
      grid = element("div", "grid");
    panel.append(controls, grid);
    (contours ? showContours : showCurves)(sweep, columns, grid, controls);
  }
}
