// Top of the panel "Summary": conclusions in words, drawing of the mechanism with dimensions, plot of the workspace.

/** Phrase for the shown design: "the best design", "point 7 of stage 2". */
function shownDesignPhrase({ columns: [{ name }] }) {
  return name.startsWith("point ") ? name : "the " + name + (name === "compromise" ? "" : " design");
}

/** Objective values of the shown design and gains over the baseline. */
function resultSentence({ summary, problem }) {
  const { table } = summary;
  const rows = (table ? table.rows : []).filter((row) => row.kind === "objective" && row.values[0] !== null);
  if (summary.diagnosis) return [summary.diagnosis.finding + ": " + summary.diagnosis.sentence + "."];
  if (!rows.length) return ["No design has been evaluated yet."];
  const baseline = table.columns.findIndex((column) => column.name === "baseline");
  const shown = rows.filter((row, k) => problem.objectives.some((o) => o.name === row.name));
  return [
    ...shown.flatMap((row, k) => [
      k ? "; " : "",
      rowLabel(row, table.rows) + " ",
      element("b", "", result(row.values[0], row.unit)),
      ...(row.gain
        ? [" (", gainText(row.gain), ")"]
        : baseline >= 0 && row.values[baseline] !== null
          ? [" (baseline ", result(row.values[baseline], row.unit), ")"]
          : []),
    ]),
    baseline >= 0 ? " for " + shownDesignPhrase(table) + ", compared with the baseline." : ". There is no baseline.",
  ];
}

const byMultiplier = (optimality) =>
  [...optimality.active].sort((a, b) => Math.abs(b.multiplier) - Math.abs(a.multiplier));

/** Active constraints and bounds, with their multipliers if a gradient solver computed them. */
function activeSentence({ summary, problem, point }) {
  const { optimality, active, stages } = summary;
  if (point) {
    const { variables } = problem;
    const atBounds = variables.flatMap((v, i) =>
      !v.choices && boundAt(point.design[i], v) ? [`${v.name} (${boundAt(point.design[i], v)})`] : [],
    );
    return [
      (atBounds.length ? "Active bounds: " + atBounds.join("; ") : "No bound is active") +
        ". The command below computes the margins of the constraints.",
    ];
  }
  if (optimality?.active.length)
    return byMultiplier(optimality)
      .slice(0, 4)
      .flatMap((a, k) => [
        k ? "; " : "",
        `${a.name} (${a.kind}): ` + (k ? "" : "gain of "),
        rateText(a.multiplier, problem.objectives[0], a.unit),
        k ? "" : ` in ${problem.objectives[0].name} if relaxed`,
      ])
      .concat(optimality.active.length > 4 ? [`; and ${optimality.active.length - 4} more.`] : ["."]);
  if (!active) return ["Unknown until the study has finished."];
  if (!active.length) return ["No bound and no constraint is active."];
  const names = active.map((sentence) => sentence.replace(/ is active,.*/, "").replace(/ (-?[\d.e+-]+ (m|rad))$/, ""));
  const shown = element(
    "span",
    "",
    names.slice(0, 5).join("; ") + (names.length > 5 ? `; and ${names.length - 5} more` : ""),
  );
  shown.title = active.join("\n");
  const solved = stages.some((stage) => stage.starts);
  return [shown, solved || problem.gradients_unsupported ? "." : ". An nlopt or ipopt stage computes multipliers."];
}

const isBound = (name) => / bound/.test(name);

/** The first applicable suggestion of what to try next. */
function nextSentence(study) {
  const { summary, problem } = study;
  const { optimality, stages } = summary;
  const file = shellWord(study.file);
  if (study.point)
    return [
      "Compute all values of this design: ",
      code(`pkmopt evaluate --from ${file} --front ${study.point.p + 1} --stage ${study.point.stage}`),
      ".",
    ];
  if (summary.diagnosis)
    return [
      "Relax the constraints that no design satisfies; the reasons are below. ",
      code("pkmopt check"),
      " finds contradictory constraints.",
    ];
  if (summary.state !== "finished") return ["Finish the study: ", code("pkmopt resume " + file), "."];
  if (summary.touches_box) return ["Enlarge the box of the workspace, because feasible poses touch it."];
  const bounds = optimality
    ? byMultiplier(optimality)
        .filter((a) => isBound(a.kind))
        .map((a) => `${a.name} (${a.kind})`)
    : (summary.active ?? [])
        .filter(isBound)
        .map((sentence) => sentence.replace(/ at its (\w+) bound.*/, " ($1 bound)"));
  if (bounds.length)
    return ["Widen the active bounds as far as the design can be built: " + bounds.slice(0, 3).join(", ") + "."];
  const solvable = !problem.gradients_unsupported && !stages.some((stage) => stage.starts);
  if (study.front && solvable)
    return ["Refine the Pareto front with a stage ", code('optimiser = "nlopt", start = "pareto"'), "."];
  if (!optimality && problem.objectives.length === 1 && solvable)
    return [
      "Add a gradient stage (",
      code('optimiser = "nlopt", start = "best"'),
      "): it converges to a local optimum and computes the multipliers of the active bounds.",
    ];
  const variables = new Set(problem.variables.map((variable) => variable.name));
  const nominal = (name) => Math.abs(problem.parameters.find((p) => p.name === name)?.value ?? 0);
  const fixed = (optimality?.sensitivities ?? [])
    .filter((s) => !variables.has(s.name) && nominal(s.name) * Math.abs(s.as_built) > 0)
    .sort((a, b) => nominal(b.name) * Math.abs(b.as_built) - nominal(a.name) * Math.abs(a.as_built))[0];
  if (fixed)
    return [
      `Vary ${fixed.name}: it has the largest effect of all fixed parameters, `,
      rateText(fixed.as_built, problem.objectives[0], fixed.unit),
      ".",
    ];
  if (study.front) return ["Choose a design on the Pareto front below: click a point to show it on this page."];
  return [
    "Try another seed or mechanism: ",
    code(`pkmopt run ${shellWord(summary.origin.toml_file || "study.toml")} --seed ${BigInt(summary.origin.seed) + 1n}`),
    ".",
  ];
}

const code = (text) => element("code", "", text);

/** Size of the workspace of the shown design, and minimum and mean of the indices of its poses; null if unknown. */
function workspaceSentence({ workspace }) {
  const packed = workspace?.designs[0];
  if (!packed) return null;
  const cells = (packed.cells ??= new Cells(packed));
  const extents = drawingOrder(cells.axes).map((k) => {
    const [low, high] = feasibleRange([cells], k),
      { name, unit, step } = cells.axes[k];
    return `${name} ${shownQuantity(high - low + step, unit, 3)}`;
  });
  const indices = ["conditioning", "lti"].flatMap((name) => {
    const values = Array.from(cells.values.get(name) ?? []).filter(Number.isFinite);
    if (!values.length) return [];
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    return [`; ${name}: minimum ${digits(rangeOf(values)[0], 3)}, mean ${digits(mean, 3)}`];
  });
  const solids = cells.solids ?? [];
  const sizes = (cells.sizes ?? []).filter(({ shape }) => solids.every((solid) => solid.shape !== shape));
  return [
    "Extent along " + extents.join(", "),
    ...[...solids, ...sizes].map((solid) => "; " + solidText(solid)),
    ...indices,
    ".",
  ];
}

/** The shares of the joints' ranges that the workspace and the motions use; null if they are unknown. */
function jointsSentence(study) {
  const uses = jointUses(study);
  if (!uses.length) return null;
  const sentences = [...new Set(uses.map((use) => use.by))].map((by) => {
    const own = uses.filter((use) => use.by === by);
    const shares = [...new Set(own.map((use) => use.share))].map((share) => {
      const joints = own.filter((use) => use.share === share).map(({ joint }) => joint.name);
      return `${share} % of the range of ${joints.join(", ")}`;
    });
    return `${by} uses ${shares.join("; ")}.`;
  });
  return sentences.map((text) => text[0].toUpperCase() + text.slice(1)).join(" ");
}

/** The total mass of the moving bodies, and the masses of groups of equal bodies; null if the study uses no masses. */
function massesSentence({ mechanism }) {
  const masses = mechanism?.designs[0].masses;
  if (!masses) return null;
  const groups = massGroups(masses);
  const kilograms = (mass) => quantity(mass, "kg", 4);
  return (
    `Moving bodies ${kilograms(masses.reduce((sum, { mass }) => sum + mass, 0))}: ` +
    groups.map(({ name, number, mass }) => (number > 1 ? `${number} × ` : "") + `${name} ${kilograms(mass)}`).join(", ") +
    "."
  );
}

/** Verdict on the drives along a motion; "" if the study gives no ratings. */
function drivesText(drives) {
  if (!drives) return "";
  const what = drives.motor ? `motor ${drives.motor}` : "drives";
  return (
    `${what} ${drives.reserve >= 1 ? "sufficient" : "not sufficient"}, reserve ${digits(drives.reserve, 3)} ` +
    `(${drives.rating} of ${drives.joint})`
  );
}

/** For each motion, whether the shown design can follow it, and its loads; null without motions. */
function motionsSentence({ motions }) {
  if (!motions) return null;
  const most = (values) => Math.max(...values);
  return motions.motions.map(({ name, samples, designs: [{ summary, drives }] }, k) => {
    const loads = [
      summary.peak_total_power === undefined ? "" : `peak power ${quantity(summary.peak_total_power, "W", 3)}`,
      summary.energy_drawn === undefined ? "" : `energy ${quantity(summary.energy_drawn, "J", 3)}`,
      summary.peak_motor_torque
        ? `motors up to ${quantity(most(summary.peak_motor_torque), "N m", 3)} ` +
          `(RMS ${quantity(most(summary.rms_motor_torque), "N m", 3)}) and ${quantity(most(summary.peak_motor_speed), "rad/s", 3)}`
        : "",
    ].filter(Boolean);
    const verdict = summary.infeasible ? `infeasible at ${summary.infeasible} of ${samples} samples` : "feasible";
    return `${k ? "; " : ""}${name}: ${[verdict, drivesText(drives), ...loads].filter(Boolean).join(", ")}` + (k + 1 === motions.motions.length ? "." : "");
  });
}

/** Conclusions: result, active constraints, workspace, joints, motions, masses, next step. */
function conclusions(study) {
  const list = element("dl", "conclusions");
  for (const [title, sentence] of [
    ["Result", resultSentence(study)],
    ["Active constraints", activeSentence(study)],
    ["Workspace", workspaceSentence(study)],
    ["Joints", jointsSentence(study)],
    ["Motions", motionsSentence(study)],
    ["Masses", massesSentence(study)],
    ["Next step", nextSentence(study)],
  ])
    if (sentence) list.append(element("dt", "", title), element("dd", "", ...sentence));
  return list;
}

const dimensionText = ({ name, value, unit }) => `${name} ${shownQuantity(value, unit)}`;

/** Dimensions to draw: those of the variables, or all if no variable has a dimension. */
function shownDimensions(study, poses) {
  const vary = new Set((study.problem?.variables ?? []).map((variable) => variable.name));
  const varying = poses.dimensions.filter((d) => vary.has(d.name));
  return varying.length ? varying : poses.dimensions;
}

/** Trace with one line per dimension, between the two link ends. @param axes  [0, 1] or [0, 1, 2] */
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

/** Approximate screen coordinates [right, up] of a point for the initial camera. */
function onScreen(point) {
  if (point.length === 2) return point;
  const [x, y, z] = point; // the camera is at (1.1, -1.45, 0.75), see spaceScene()
  return [0.8 * x + 0.6 * y, 0.92 * z - 0.23 * x + 0.3 * y];
}

/** Annotations with names and values of the dimensions, stacked left and right of the drawing to avoid overlaps. */
function dimensionLabels(dimensions, poses, pose, axes) {
  const namesOnly = dimensions.length > 5; // the values are then in the caption
  const labels = dimensions.map((d) => {
    const [from, to] = [poses.end(pose, d.from), poses.end(pose, d.to)];
    const midpoint = axes.map((c) => (from[c] + to[c]) / 2);
    const [across, up] = onScreen(midpoint);
    return { midpoint, across, up, text: label(namesOnly ? d.name : dimensionText(d)) };
  });
  const centre = labels.reduce((sum, each) => sum + each.across, 0) / labels.length;
  const sides = [labels.filter((n) => n.across < centre), labels.filter((n) => n.across >= centre)];
  return sides.flatMap((side, s) =>
    side
      .sort((a, b) => b.up - a.up)
      .map(({ midpoint, text }, k) => ({
        ...Object.fromEntries(midpoint.map((value, i) => ["xyz"[i], value])),
        text,
        ax: s ? 60 : -60,
        ay: 26 * (k - (side.length - 1) / 2),
        arrowcolor: colour("accent"),
        arrowwidth: 1,
        arrowhead: 0,
        font: { size: namesOnly ? 12 : 13, color: colour("ink") },
        bgcolor: faded(colour("box"), 0.85),
      })),
  );
}

function addDrawing(study, grid, poses) {
  const pose = poses.initial_pose;
  const ranges = poses.rangesAt(pose);
  const planar = isPlanar(poses);
  const dimensions = shownDimensions(study, poses);
  const drawn = new Set(dimensions.map((d) => d.name));
  const table = study.summary?.table;
  const others = (table ? table.rows : [])
    .filter((row) => row.kind === "variable" && !drawn.has(row.name) && row.values[0] !== null)
    .map((row) => `${row.name} ${shownQuantity(row.values[0], row.unit)}`);
  return addPlot(grid, {
    title: "Mechanism, " + poses.name,
    caption:
      "To scale, at a pose in the middle of the workspace." +
      (dimensions.length > 5 ? " " + dimensions.map(dimensionText).join(", ") + "." : "") +
      (others.length ? " Not drawn: " + others.join(", ") + "." : ""),
    size: "half",
    height: 520,
    make: (distance) =>
      planar
        ? {
            data: [...viewTraces(poses, pose, null, null, [0, 1]), dimensionTrace(dimensions, poses, pose, [0, 1])],
            layout: {
              annotations: dimensionLabels(dimensions, poses, pose, [0, 1]),
              xaxis: axis(axisName("x", "mm"), { range: ranges[0], zeroline: false, constrain: "domain" }),
              yaxis: axis(axisName("y", "mm"), {
                range: ranges[1],
                zeroline: false,
                constrain: "domain",
                scaleanchor: "x",
              }),
              showlegend: false,
            },
          }
        : {
            data: [...spaceTraces(poses, pose, null, null), dimensionTrace(dimensions, poses, pose, [0, 1, 2])].map(
              (trace) => ({
                ...trace,
                showlegend: false,
              }),
            ),
            layout: {
              scene: { ...spaceScene(ranges, 1.5 * distance), annotations: dimensionLabels(dimensions, poses, pose, [0, 1, 2]) },
              uirevision: "camera",
              margin: { l: 0, r: 0, t: 0, b: 0 },
            },
          },
  });
}

function addWorkspacePlot(study, grid, cells) {
  const order = drawingOrder(cells.axes),
    isVolume = order.length === 3;
  const field = cells.fields[initialField(cells)];
  const range = field && fieldRange([cells], field.name);
  return addPlot(grid, {
    title: "Workspace",
    caption:
      "Feasible poses" +
      (field ? (isVolume ? ": the boundary, and slices coloured by " : ", coloured by ") + fieldTitle(field.name) : "") +
      ".",
    size: "half",
    height: 520,
    make: (distance) => {
      if (isVolume && cells.surface)
        return {
          data: workspaceTraces(cells, order, middleSlices(cells, order), field, range),
          layout: workspaceLayout([cells], order, distance),
        };
      const matrix = cells.slice(field?.name, { across: order[0], up: order[1] }, 0);
      return cellsPlot([cells], cells, matrix, order[0], order[1], {
        range: range ?? [0, 1],
        title: field ? fieldTitle(field.name) : "feasible",
        unit: field && field.unit !== "mixed" ? field.unit : "1",
        lines: !!field,
        bar: !!field,
      });
    },
  });
}

/** Adds the drawing and the workspace plot side by side, as far as the page has their data. */
function addOverview(study, panel) {
  const drawn = study.mechanism?.designs[0];
  const packed = study.workspace?.designs[0];
  if (!drawn && !packed) return;
  const grid = element("div", "grid overview");
  panel.append(grid);
  const plots = [];
  if (drawn) plots.push(addDrawing(study, grid, posesOf(drawn)));
  if (packed) plots.push(addWorkspacePlot(study, grid, (packed.cells ??= new Cells(packed))));
  if (plots.length === 1) plots[0].box.classList.remove("half");
}
