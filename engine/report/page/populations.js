// The designs themselves: every column against every other, generation by generation.

/** Columns of the populations: what they are called, and their numbers. */
function populationColumns(study) {
  const { variables, objectives, margins, reports } = study.problem;
  const named = [
    ...variables.map((v) => ({ ...v, kind: "variable" })),
    ...objectives.map((o) => ({ ...o, kind: "objective" })),
    ...margins.map((m) => ({ ...m, name: m.name + " margin", kind: "margin" })),
    ...reports.map((r) => ({ ...r, kind: "report" })),
  ];
  return named.map((column, i) => {
    const isResult = column.kind === "objective" || column.kind === "report";
    const { unit, scale } = isResult
      ? resultUnit(column.unit)
      : { unit: shownUnit(column.unit), scale: shownScale(column.unit) };
    const inUnit = (bound) => (Number.isFinite(bound) ? bound * scale : bound);
    return {
      ...column,
      unit,
      lower: inUnit(column.lower),
      upper: inUnit(column.upper),
      values: Array.from(unpack(study.populations.columns[i]), (value) => value * scale),
    };
  });
}

/** All generations shown, stage after stage. */
function populationSteps(study) {
  return study.populations.stages.flatMap((stage) =>
    stage.steps.map((step) => ({
      stage,
      number: step.number,
      size: step.size,
      members: unpack(step.members),
      text:
        (study.populations.stages.length > 1 ? `stage ${stage.stage}, ` : "") +
        (stage.starts ? `start ${step.number + 1}` : `generation ${step.number}`),
    })),
  );
}

function thinningText(study) {
  const parts = study.populations.stages.flatMap((stage) => [
    ...(stage.every > 1
      ? [
          `every ${ordinal(stage.every)} ${stage.starts ? "start" : "generation"} of ${stage.all} of stage ${stage.stage} is shown`,
        ]
      : []),
    ...(stage.members_thinned
      ? [
          `at most ${Math.max(...stage.steps.map((g) => unpack(g.members).length))} designs of each ${stage.starts ? "start" : "generation"} of stage ${stage.stage}, evenly chosen`,
        ]
      : []),
  ]);
  return parts.length ? " To keep the page small, " + parts.join("; ") + "; first and last are always there." : "";
}

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

function widened([low, high]) {
  const room = 0.04 * (high - low) || 0.05 * Math.abs(high) || 1;
  return [low - room, high + room];
}

function showPopulations(study, section) {
  const columns = populationColumns(study),
    steps = populationSteps(study);
  const status = unpack(study.populations.status),
    evaluation = unpack(study.populations.evaluation);
  const drawable = columns.filter((column) => column.values.some(Number.isFinite));
  const names = drawable.map((column) => column.name);
  const find = (kind, k, otherwise) => {
    const found = drawable.indexOf(drawable.filter((column) => column.kind === kind)[k]);
    return found < 0 ? otherwise : found;
  };
  section.append(
    element(
      "p",
      "lead",
      "The designs of a generation, or those that a solver saw on its way from a start: move the slider to see the search close in." +
        thinningText(study),
    ),
  );
  const controls = element("div", "controls");
  const grid = element("div", "grid");
  section.append(controls, grid);
  let plots;
  const redraw = () => plots.forEach((plot) => plot.update());
  const evolved = steps.findLastIndex((step) => !step.stage.starts);
  const at = slider(
    controls,
    "generation",
    steps.length,
    evolved < 0 ? steps.length - 1 : evolved,
    (i) => `${steps[i].text} (${count(steps[i].size, "design")})`,
    redraw,
  );
  at.node.style.maxWidth = "900px";
  const x = choice(controls, "across", names, 0, redraw);
  const y = choice(controls, "up", names, Math.min(1, names.length - 1), redraw);
  const z = choice(controls, "colour", names, find("objective", 0, 0), redraw);
  // Colours span what the last generations have: what the first ones have is far away, and would leave one colour.
  const late = new Set(steps.slice(Math.floor(steps.length / 2)).flatMap((step) => [...step.members]));
  const colourRange = (column) =>
    rangeOf([...late].filter((row) => status[row] === 0).map((row) => column.values[row]));
  const shown = () => [...steps[at.value].members];
  const others = Array.from(
    { length: Math.min(1500, evaluation.length) },
    (_, i, n = Math.min(1500, evaluation.length)) => Math.floor((i * evaluation.length) / n),
  );

  const scatter = addPlot(grid, {
    size: "half",
    title: "Two against each other",
    height: 460,
    caption:
      "Filled: feasible. Open: infeasible, rejected before the survey, or failed. Grey: designs of all other generations.",
    make() {
      const rows = shown(),
        [cx, cy, cz] = [x, y, z].map((control) => drawable[control.value]);
      const [cmin, cmax] = colourRange(cz);
      const text = (row) =>
        `evaluation ${evaluation[row]}<br>` +
        drawable.map((c) => `${label(c.name)} = ${label(quantity(c.values[row], c.unit))}`).join("<br>");
      return {
        data: [
          {
            type: "scatter",
            mode: "markers",
            x: others.map((r) => cx.values[r]),
            y: others.map((r) => cy.values[r]),
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
    title: "All at once",
    height: 460,
    caption: "One line per design; drag along an axis to keep a part of it.",
    make() {
      const rows = shown(),
        cz = drawable[z.value],
        [cmin, cmax] = colourRange(cz);
      const axes = drawable.filter((c) => c.kind !== "margin" || drawable.length <= 9);
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
