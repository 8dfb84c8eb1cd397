// The first screen: what was found in words, the mechanism with its dimensions, and where it can go.

/** "the best design", "point 7 of stage 2" */
function nameOfShown({ columns: [{ name }] }) {
  return name.startsWith("point ") ? name : "the " + name + (name === "compromise" ? "" : " design");
}

/** What was gained over the baseline. */
function gainedSentence({ summary, problem }) {
  const { table } = summary;
  const rows = (table ? table.rows : []).filter((row) => row.kind === "objective" && row.values[0] !== null);
  if (summary.verdict) return [summary.verdict.finding + ": " + summary.verdict.sentence + "."];
  if (!rows.length) return ["Nothing yet: no design has been evaluated."];
  const baseline = table.columns.findIndex((column) => column.name === "baseline");
  const told = rows.filter((row, k) => problem.objectives.some((o) => o.name === row.name));
  return [
    ...told.flatMap((row, k) => [
      k ? "; " : "",
      rowLabel(row, table.rows) + " ",
      element("b", "", result(row.values[0], row.unit)),
      ...(row.gain
        ? [" (", gainText(row.gain), ")"]
        : baseline >= 0 && row.values[baseline] !== null
          ? [" beside ", result(row.values[baseline], row.unit)]
          : []),
    ]),
    baseline >= 0 ? ", of " + nameOfShown(table) + " against the baseline." : "; there is no baseline.",
  ];
}

const byMultiplier = (optimality) =>
  [...optimality.active].sort((a, b) => Math.abs(b.multiplier) - Math.abs(a.multiplier));

/** Active margins and bounds, with what one would gain by moving them where a gradient solver has told. */
function holdingSentence({ summary, problem, point }) {
  const { optimality, active, stages } = summary;
  if (point) {
    const { variables } = problem;
    const at = variables.flatMap((v, i) =>
      boundAt(point.design[i], v) ? [`${v.name} (${boundAt(point.design[i], v)})`] : [],
    );
    return [
      (at.length ? "bounds: " + at.join("; ") + ". " : "no bound. ") + "Margins are known after the command below.",
    ];
  }
  if (optimality?.active.length)
    return byMultiplier(optimality)
      .slice(0, 4)
      .flatMap((a, k) => [
        k ? "; " : "",
        `${a.name} (${a.kind}): ` + (k ? "" : "moved out of the way, it gives "),
        rateText(a.multiplier, problem.objectives[0], a.unit),
        k ? "" : " to " + problem.objectives[0].name,
      ])
      .concat(optimality.active.length > 4 ? [`; and ${optimality.active.length - 4} more.`] : ["."]);
  if (!active) return ["Not known before the study has ended."];
  if (!active.length) return ["No bound and no constraint is active."];
  const names = active.map((sentence) => sentence.replace(/ is active,.*/, "").replace(/ (-?[\d.e+-]+ (m|rad))$/, ""));
  const shown = element(
    "span",
    "",
    names.slice(0, 5).join("; ") + (names.length > 5 ? `; and ${names.length - 5} more` : ""),
  );
  shown.title = active.join("\n");
  const solved = stages.some((stage) => stage.starts);
  return [shown, solved || problem.gradients_refused ? "." : ". Multipliers are known after a gradient stage."];
}

const isBound = (name) => / bound/.test(name);

/** What to try, the first of what applies. */
function nextSentence(study) {
  const { summary, problem } = study;
  const { optimality, stages } = summary;
  const file = word(study.file);
  if (study.point)
    return [
      "For all of its values: ",
      code(`pkmopt evaluate --from ${file} --front ${study.point.p + 1} --stage ${study.point.stage}`),
      ".",
    ];
  if (summary.verdict)
    return [
      "Loosen what no design kept; the reasons are below, and ",
      code("pkmopt check"),
      " looks for contradictions.",
    ];
  if (summary.state !== "finished") return ["Let it finish: ", code("pkmopt resume " + file), "."];
  if (summary.touches_box) return ["Enlarge the box of the workspace: feasible poses touch it."];
  const bounds = optimality
    ? byMultiplier(optimality)
        .filter((a) => isBound(a.kind))
        .map((a) => `${a.name} (${a.kind})`)
    : (summary.active ?? [])
        .filter(isBound)
        .map((sentence) => sentence.replace(/ at its (\w+) bound.*/, " ($1 bound)"));
  if (bounds.length)
    return ["Widen the bounds the design lies on, as far as it can be built: " + bounds.slice(0, 3).join(", ") + "."];
  const solvable = !problem.gradients_refused && !stages.some((stage) => stage.starts);
  if (study.front && solvable)
    return ["Refine the trade-off: a stage ", code('optimiser = "nlopt", start = "pareto"'), "."];
  if (!optimality && problem.objectives.length === 1 && solvable)
    return [
      "Add a gradient stage (",
      code('optimiser = "nlopt", start = "best"'),
      "): it ends at an optimum and tells what each bound costs.",
    ];
  const variables = new Set(problem.variables.map((variable) => variable.name));
  const nominal = (name) => Math.abs(problem.parameters.find((p) => p.name === name)?.value ?? 0);
  const fixed = (optimality?.sensitivities ?? [])
    .filter((s) => !variables.has(s.name) && nominal(s.name) * Math.abs(s.as_built) > 0)
    .sort((a, b) => nominal(b.name) * Math.abs(b.as_built) - nominal(a.name) * Math.abs(a.as_built))[0];
  if (fixed)
    return [
      `Vary ${fixed.name}: of what the study holds fixed it matters most, `,
      rateText(fixed.as_built, problem.objectives[0], fixed.unit),
      ".",
    ];
  if (study.front) return ["Choose a design of the trade-off below: a click on a point loads it into this page."];
  return [
    "Another seed or mechanism: ",
    code(`pkmopt run ${word(summary.origin.toml_file || "study.toml")} --seed ${BigInt(summary.origin.seed) + 1n}`),
    ".",
  ];
}

const code = (text) => element("code", "", text);

/** Three lines to decide by. */
function verdictOf(study) {
  const list = element("dl", "decision");
  for (const [title, sentence] of [
    ["Gained", gainedSentence(study)],
    ["Held back by", holdingSentence(study)],
    ["Next", nextSentence(study)],
  ])
    list.append(element("dt", "", title), element("dd", "", ...sentence));
  return list;
}

const dimensionText = ({ name, value, unit }) => `${name} ${shownQuantity(value, unit)}`;

/** Of the drawing: those that vary, of a design without a study all; the others would hide them. */
function shownDimensions(study, poses) {
  const vary = new Set((study.problem?.variables ?? []).map((variable) => variable.name));
  const varying = poses.dimensions.filter((d) => vary.has(d.name));
  return varying.length ? varying : poses.dimensions;
}

/** A line from end to end of each dimension. */
function dimensionTrace(dimensions, poses, pose, axes) {
  const lines = axes.map(() => []);
  for (const { from, to } of dimensions)
    axes.forEach((c, i) => lines[i].push(poses.end(pose, from)[c], poses.end(pose, to)[c], null));
  return {
    type: axes.length === 3 ? "scatter3d" : "scatter",
    mode: "lines+markers",
    ...Object.fromEntries(lines.map((line, i) => ["xyz"[i], line])),
    line: { color: colour("accent"), width: axes.length === 3 ? 5 : 2 },
    marker: { size: 3, color: colour("accent") },
    hoverinfo: "skip",
    showlegend: false,
  };
}

/** Where a place of the drawing is on the screen, as the camera first stands. */
function onScreen(place) {
  if (place.length === 2) return place;
  const [x, y, z] = place; // the camera looks from (1.1, -1.45, 0.75)
  return [0.8 * x + 0.6 * y, 0.92 * z - 0.23 * x + 0.3 * y];
}

/** Their names and values: outside of the drawing's middle, and on each side one below the other. */
function dimensionNotes(dimensions, poses, pose, axes) {
  const crowded = dimensions.length > 5; // then the values are said beside the drawing
  const notes = dimensions.map((d) => {
    const [from, to] = [poses.end(pose, d.from), poses.end(pose, d.to)];
    const middle = axes.map((c) => (from[c] + to[c]) / 2);
    const [across, up] = onScreen(middle);
    return { middle, across, up, text: label(crowded ? d.name : dimensionText(d)) };
  });
  const centre = notes.reduce((sum, note) => sum + note.across, 0) / notes.length;
  const sides = [notes.filter((n) => n.across < centre), notes.filter((n) => n.across >= centre)];
  return sides.flatMap((side, s) =>
    side
      .sort((a, b) => b.up - a.up)
      .map(({ middle, text }, k) => ({
        ...Object.fromEntries(middle.map((value, i) => ["xyz"[i], value])),
        text,
        ax: s ? 60 : -60,
        ay: 26 * (k - (side.length - 1) / 2),
        arrowcolor: colour("accent"),
        arrowwidth: 1,
        arrowhead: 0,
        font: { size: crowded ? 12 : 13, color: colour("ink") },
        bgcolor: faded(colour("panel"), 0.85),
      })),
  );
}

function drawingPlot(study, grid, poses) {
  const pose = poses.start;
  const spans = poses.spanAt(pose);
  const planar = isPlanar(poses);
  const dimensions = shownDimensions(study, poses);
  const drawn = new Set(dimensions.map((d) => d.name));
  const table = study.summary?.table;
  const others = (table ? table.rows : [])
    .filter((row) => row.kind === "variable" && !drawn.has(row.name) && row.values[0] !== null)
    .map((row) => `${row.name} ${shownQuantity(row.values[0], row.unit)}`);
  return addPlot(grid, {
    title: "The mechanism, " + poses.name,
    caption:
      "To scale, at a pose amid its workspace." +
      (dimensions.length > 5 ? " " + dimensions.map(dimensionText).join(", ") + "." : "") +
      (others.length ? " Not drawn: " + others.join(", ") + "." : ""),
    size: "half",
    height: 520,
    make: (away) =>
      planar
        ? {
            data: [...flatTraces(poses, pose, null, null, [0, 1]), dimensionTrace(dimensions, poses, pose, [0, 1])],
            layout: {
              annotations: dimensionNotes(dimensions, poses, pose, [0, 1]),
              xaxis: axis(axisName("x", "mm"), { range: spans[0], zeroline: false, constrain: "domain" }),
              yaxis: axis(axisName("y", "mm"), {
                range: spans[1],
                zeroline: false,
                constrain: "domain",
                scaleanchor: "x",
              }),
              showlegend: false,
            },
          }
        : {
            data: [...solidTraces(poses, pose, null, null), dimensionTrace(dimensions, poses, pose, [0, 1, 2])].map(
              (trace) => ({
                ...trace,
                showlegend: false,
              }),
            ),
            layout: {
              scene: { ...roomScene(spans, 1.25 * away), annotations: dimensionNotes(dimensions, poses, pose, [0, 1, 2]) },
              uirevision: "camera",
              margin: { l: 0, r: 0, t: 0, b: 0 },
            },
          },
  });
}

function reachPlot(study, grid, cells) {
  const order = drawingOrder(cells.axes),
    solid = order.length === 3;
  const field = cells.fields[firstField(cells)];
  const range = field && fieldRange([cells], field.name);
  return addPlot(grid, {
    title: "Where it can go",
    caption: "Feasible poses" + (field ? ", coloured by " + fieldTitle(field.name) : "") + ".",
    size: "half",
    height: 520,
    make: (away) => {
      if (solid && cells.surface)
        return {
          data: [surfaceTrace(cells, field?.name, range, order)],
          layout: { scene: workspaceScene([cells], order, away), uirevision: "camera", margin: { l: 0, r: 0, t: 0, b: 0 } },
        };
      const matrix = cells.cut(field?.name, { across: order[0], up: order[1] }, 0);
      return cellsPicture([cells], cells, matrix, order[0], order[1], {
        range: range ?? [0, 1],
        title: field ? fieldTitle(field.name) : "feasible",
        unit: field && field.unit !== "mixed" ? field.unit : "1",
        lines: !!field,
        bar: !!field,
      });
    },
  });
}

/** Mechanism and workspace side by side, as far as the page has them. */
function addOverview(study, section) {
  const drawn = study.mechanism?.designs[0];
  const packed = study.workspace?.designs[0];
  if (!drawn && !packed) return;
  const grid = element("div", "grid overview");
  section.append(grid);
  const plots = [];
  if (drawn) plots.push(drawingPlot(study, grid, posesOf(drawn)));
  if (packed) plots.push(reachPlot(study, grid, (packed.cells ??= new Cells(packed))));
  if (plots.length === 1) plots[0].panel.classList.remove("half");
}
