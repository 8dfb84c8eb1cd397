// Panel "Populations": the designs of each generation or solver run in a scatter plot and in parallel coordinates.

/** Packed columns of a table of designs in displayed units, with their names: variables, objectives, margins, outputs. */
function designColumns({ variables, objectives, margins, outputs }, packed) {
  const named = [
    ...variables.map((v) => ({ ...v, kind: "variable" })),
    ...objectives.map((o) => ({ ...o, kind: "objective" })),
    ...margins.map((m) => ({ ...m, name: m.name + " margin", kind: "margin" })),
    ...outputs.map((o) => ({ ...o, kind: "output" })),
  ];
  return named.map((column, i) => {
    const isResult = column.kind === "objective" || column.kind === "output";
    const { unit, scale } = isResult
      ? resultUnit(column.unit)
      : { unit: shownUnit(column.unit), scale: shownScale(column.unit) };
    const toDisplayed = (bound) => (Number.isFinite(bound) ? bound * scale : bound);
    return {
      ...column,
      unit,
      scale,
      lower: toDisplayed(column.lower),
      upper: toDisplayed(column.upper),
      values: Array.from(unpack(packed[i]), (value) => value * scale),
    };
  });
}

/** The stored steps of all stages; a step is a generation or a multistart run of a solver. */
function populationSteps(study) {
  return study.populations.stages.flatMap((stage) =>
    stage.steps.map((step) => ({
      stage,
      number: step.number,
      size: step.size,
      members: unpack(step.members),
      text:
        (study.populations.stages.length > 1 ? `stage ${stage.stage}, ` : "") +
        (stage.starts ? `run ${step.number + 1}` : `generation ${step.number}`),
    })),
  );
}

/** Sentence on what the page omits. */
function thinningText(study) {
  const parts = study.populations.stages.flatMap((stage) => [
    ...(stage.stride > 1
      ? [
          `only every ${ordinal(stage.stride)} of the ${stage.total} ${stage.starts ? "runs" : "generations"} of stage ${stage.stage} is shown`,
        ]
      : []),
    ...(stage.members_thinned
      ? [
          `at most ${Math.max(...stage.steps.map((g) => unpack(g.members).length))} designs of each ${stage.starts ? "run" : "generation"} of stage ${stage.stage} are shown, at equal intervals`,
        ]
      : []),
  ]);
  return parts.length ? " To keep the page small, " + parts.join("; ") + "; first and last are included." : "";
}

/** Minimum and maximum of the finite values; [0, 1] if there are none. */
function rangeOf(values) {
  let low = Infinity,
    high = -Infinity;
  for (const value of values)
    if (Number.isFinite(value)) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  return low <= high ? [low, high] : [0, 1];
}

/** A range with a margin on both sides. */
function widened([low, high]) {
  const margin = 0.04 * (high - low) || 0.05 * Math.abs(high) || 1;
  return [low - margin, high + margin];
}

function showPopulations(study, panel) {
  const columns = designColumns(study.problem, study.populations.columns),
    steps = populationSteps(study);
  const status = unpack(study.populations.status),
    evaluation = unpack(study.populations.evaluation);
  const finite = columns.filter((column) => column.values.some(Number.isFinite));
  const names = finite.map((column) => column.name);
  const find = (kind, k, otherwise) => {
    const found = finite.indexOf(finite.filter((column) => column.kind === kind)[k]);
    return found < 0 ? otherwise : found;
  };
  panel.append(
    element(
      "p",
      "lead",
      "The designs of one generation, or all designs that one run of a solver evaluated. Move the slider to follow the convergence of the search." +
        thinningText(study),
    ),
  );
  const controls = element("div", "controls");
  const grid = element("div", "grid");
  panel.append(controls, grid);
  let plots;
  const redraw = () => plots.forEach((plot) => plot.update());
  const lastGeneration = steps.findLastIndex((step) => !step.stage.starts);
  const stepSlider = slider(
    controls,
    "generation or run",
    steps.length,
    lastGeneration < 0 ? steps.length - 1 : lastGeneration,
    (i) => `${steps[i].text} (${count(steps[i].size, "design")})`,
    redraw,
  );
  stepSlider.node.style.maxWidth = "900px";
  const x = choice(controls, "horizontal", names, 0, redraw);
  const y = choice(controls, "vertical", names, Math.min(1, names.length - 1), redraw);
  const z = choice(controls, "colour", names, find("objective", 0, 0), redraw);
  // The colour range is that of the second half of the steps: early designs are outliers that would compress it.
  const late = new Set(steps.slice(Math.floor(steps.length / 2)).flatMap((step) => [...step.members]));
  const colourRange = (column) =>
    rangeOf([...late].filter((row) => status[row] === 0).map((row) => column.values[row]));
  const shownRows = () => [...steps[stepSlider.value].members];
  const background = Array.from(
    { length: Math.min(1500, evaluation.length) },
    (_, i, n = Math.min(1500, evaluation.length)) => Math.floor((i * evaluation.length) / n),
  );

  const scatter = addPlot(grid, {
    size: "half",
    title: "Scatter plot",
    height: 460,
    caption:
      "Filled: feasible. Open: infeasible, rejected before the workspace analysis, or failed. Grey: designs of all generations and runs.",
    make() {
      const rows = shownRows(),
        [cx, cy, cz] = [x, y, z].map((control) => finite[control.value]);
      const [cmin, cmax] = colourRange(cz);
      const text = (row) =>
        `evaluation ${evaluation[row]}<br>` +
        finite.map((c) => `${label(c.name)} = ${label(quantity(c.values[row], c.unit))}`).join("<br>");
      return {
        data: [
          {
            type: "scatter",
            mode: "markers",
            x: background.map((r) => cx.values[r]),
            y: background.map((r) => cy.values[r]),
            hoverinfo: "skip",
            showlegend: false,
            marker: { size: 3, color: colour("muted"), opacity: 0.35 },
          },
          {
            showlegend: false,
            type: "scatter",
            mode: "markers",
            x: rows.map((r) => cx.values[r]),
            y: rows.map((r) => cy.values[r]),
            text: rows.map(text),
            hovertemplate: "%{text}<extra></extra>",
            marker: {
              size: 9,
              symbol: rows.map((r) => (status[r] ? "circle-open" : "circle")),
              color: rows.map((r) => cz.values[r]),
              colorscale: timeColours,
              cmin,
              cmax,
              line: { width: 1 },
              colorbar: colourBar(axisName(cz.name, cz.unit)),
            },
          },
        ],
        layout: {
          xaxis: axis(axisName(cx.name, cx.unit), { range: widened(rangeOf(cx.values)) }),
          yaxis: axis(axisName(cy.name, cy.unit), { range: widened(rangeOf(cy.values)) }),
        },
      };
    },
  });
  const parallel = addPlot(grid, {
    size: "half",
    title: "Parallel coordinates",
    height: 460,
    caption: "One line per design. Drag along an axis to highlight the designs in a range.",
    make() {
      const rows = shownRows(),
        cz = finite[z.value],
        [cmin, cmax] = colourRange(cz);
      const axes = finite.filter((c) => c.kind !== "margin" || finite.length <= 9);
      return {
        data: [
          {
            type: "parcoords",
            line: { color: rows.map((r) => cz.values[r]), colorscale: timeColours, cmin, cmax },
            dimensions: axes.map((c) => ({
              label: axisName(c.name, c.unit),
              range:
                c.lower !== undefined &&
                Number.isFinite(c.lower) &&
                Number.isFinite(c.upper) &&
                c.lower !== null &&
                c.upper !== null
                  ? [c.lower, c.upper]
                  : rangeOf(c.values),
              values: rows.map((r) => c.values[r]),
              tickformat: ".4~g",
            })),
            labelangle: -22,
            labelfont: { size: 12 },
            tickfont: { size: 11 },
            rangefont: { size: 1, color: "rgba(0,0,0,0)" },
            unselected: { line: { color: colour("line"), opacity: 0.3 } },
          },
        ],
        layout: { margin: { l: 48, r: 96, t: 104, b: 24 } },
      };
    },
  });
  plots = [scatter, parallel];
}
