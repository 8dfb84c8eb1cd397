// Panel "Summary": state of the study, table of designs, active constraints, computing time, reproduction.

function gainText(gain) {
  if (!gain) return "";
  const text = (gain.percent >= 0 ? "+" : "−") + Math.abs(gain.percent).toFixed(2) + " %";
  return element("span", gain.worse ? "worse" : "better", gain.worse ? text + ", worse" : text);
}

function card(name, value, unit, ...notes) {
  return element(
    "div",
    "card",
    element("div", "name", name),
    element("div", "value", value, unitText(unit) ? element("small", "", unitText(unit)) : null),
    element("div", "note", ...notes),
  );
}

function headline(study) {
  const { summary, problem } = study;
  const state = element("span", "state " + summary.state, summary.state);
  return element(
    "div",
    "",
    element("h1", "", study.name),
    element("p", "facts", problem.mechanism + (problem.title ? " – " + problem.title : "")),
    element(
      "p",
      "facts",
      state,
      "  " +
        [
          count(summary.evaluations, "evaluation"),
          duration(summary.seconds),
          "seed " + summary.origin.seed,
          summary.origin.machine,
        ]
          .filter(Boolean)
          .join(" · "),
    ),
  );
}

/** Cards with the objective values and the number of evaluations; "" if there are none. */
function cards(study) {
  const { table, stages } = study.summary;
  const list = element("div", "cards");
  for (const row of table ? table.rows : []) {
    if (row.kind !== "objective") continue;
    const baseline = table.columns.findIndex((column) => column.name === "baseline");
    const versus =
      baseline >= 0 && row.values[baseline] !== null
        ? ["; baseline: ", result(row.values[baseline], row.unit)]
        : [];
    if (row.values[0] === null) continue;
    const { unit, scale } = resultUnit(row.unit);
    const value = rounded(digits(row.values[0] * scale), row.values[0], row.unit);
    list.append(card(rowLabel(row, table.rows), value, unit, ...(row.gain ? [gainText(row.gain), ...versus] : [row.meaning])));
  }
  if (stages.length)
    list.append(
      card(
        "evaluations",
        study.summary.evaluations.toLocaleString("en-GB"),
        "1",
        "in " + count(stages.length, "stage") + ": " + stages.map((stage) => stage.optimiser).join(", then "),
      ),
    );
  return list.children.length ? list : "";
}

/** Name of a table row. A value by voxels is marked "by cells" if the table also has the exact value. */
const rowLabel = (row, rows) =>
  rows.some((other) => other.kind === row.kind && other.name === row.name + ", exact") ? row.name + ", by cells" : row.name;

const isResult = (row) => row.kind === "objective" || row.kind === "output" || row.kind === "certified";
const unitOf = (row) => (isResult(row) ? resultUnit(row.unit).unit : shownUnit(row.unit));

/** A constraint is active if its margin is below the threshold of the study, and not negative beyond rounding. */
const isActive = (margin) => margin <= 1e-4 && margin > -1e-6;

function tableCell(row, value) {
  if (value === null) return element("td");
  const scale = isResult(row) ? resultUnit(row.unit).scale : shownScale(row.unit); // the unit is in a column of its own
  const margin = row.kind === "constraint";
  const node = element(
    "td",
    margin && value < 0 && !isActive(value) ? "worse" : "",
    rounded(margin && isActive(value) ? "active" : digits(value * scale), value, row.unit),
  );
  const bound = row.bounds && boundAt(value, row.bounds);
  if (bound) node.append(element("small", "bound", " " + bound));
  return node;
}

/** Whether a variable is at a bound, or beyond it (a baseline may be). */
function boundAt(value, { lower, upper }) {
  const near = 1e-6 * (upper - lower);
  if (value < lower - near) return "below min";
  if (value > upper + near) return "above max";
  return value <= lower + near ? "min" : value >= upper - near ? "max" : "";
}

/** The table of designs. @param variables  variables of the problem, to mark values at their bounds */
function designTable({ columns, rows }, variables) {
  const table = element("table");
  const gains = rows.some((row) => row.gain);
  const head = element("tr", "", element("th"), element("th"));
  for (const column of columns) head.append(element("th", "", column.name));
  if (gains) head.append(element("th", "", "gain"));
  table.append(element("thead", "", head));
  const titles = {
    variable: "variables",
    objective: "objectives",
    output: "outputs",
    constraint: "margins of constraints (≥ 0: satisfied; active: at its bound)",
    certified: "workspace volume with certified bounds",
  };
  let kind = "";
  const body = element("tbody");
  for (const row of rows) {
    if (row.kind !== kind) {
      const cell = element("td", "text", titles[row.kind]);
      cell.colSpan = 2 + columns.length + (gains ? 1 : 0);
      body.append(element("tr", "group", cell));
      kind = row.kind;
    }
    const name = element("th", "text", rowLabel(row, rows));
    name.scope = "row";
    name.title = row.meaning;
    const line = element("tr", "", name, element("td", "unit", unitText(unitOf(row))));
    const bounds = row.kind === "variable" ? variables.find((variable) => variable.name === row.name) : null;
    for (const value of row.values)
      line.append(bounds?.choices ? element("td", "", choiceName(value, bounds)) : tableCell({ ...row, bounds }, value));
    if (gains) line.append(element("td", "", gainText(row.gain)));
    body.append(line);
  }
  table.append(body);
  return element("div", "scroll", table);
}

/** List of warnings and notes on the study. */
function remarks(study) {
  const { summary } = study;
  const list = [];
  if (summary.diagnosis)
    list.push([
      "warning",
      summary.diagnosis.finding + ": " + summary.diagnosis.sentence + ".",
      ...summary.diagnosis.reasons.map((reason) => reason.sentence),
    ]);
  const columns = summary.table ? summary.table.columns : [];
  for (const column of columns)
    if (!column.reference && (column.status !== "feasible" || column.reason))
      list.push([
        "warning",
        "The design “" + column.name + "” is " + column.status + (column.reason ? ": " + column.reason : "") + ".",
      ]);
  if (summary.state !== "finished")
    list.push([
      "warning",
      "The study is " +
        (summary.state === "running" ? "still running, or its process was killed" : "interrupted") +
        ". The report shows the content of the study file when the report was written.",
    ]);
  if (summary.evaluations === 0) list.push(["warning", "No design has been evaluated yet."]);
  if (summary.touches_box)
    list.push(["warning", "Feasible cells of the best design touch the box; enlarge the box."]);
  if (!summary.reproducible)
    list.push(["warning", "A solver run reached its time limit, so the study may not be reproducible."]);
  if (summary.unreadable)
    list.push([
      "warning",
      "This program cannot read the study's text, so what needs new evaluations is omitted: " + summary.unreadable,
    ]);
  if (summary.failures) list.push(["", summary.failures + "."]);
  for (const note of summary.notes) list.push(["", note]);
  return list.map(([kind, text, ...reasons]) =>
    element(
      "li",
      kind,
      text,
      reasons.length ? element("ul", "", ...reasons.map((reason) => element("li", "", reason))) : null,
    ),
  );
}

/** A derivative of the objective by a quantity with the given unit. */
function rateText(value, objective, unit) {
  if (value === null) return "";
  const { unit: objectiveUnit, scale } = resultUnit(objective.unit),
    name = shownUnit(unit);
  const text = quantity((value / shownScale(unit)) * scale, objectiveUnit) + (name && name !== "1" ? " per " + name : "");
  return rounded(text, value, `${objective.unit} per ${unit}`);
}

/** A table of cells, which are text or elements; columns of numbers are right-aligned. */
function simpleTable(head, rows) {
  const isText = head.map((_, i) => rows.some((row) => row[i] && !/^[−+\d∞–]/.test(row[i].textContent ?? row[i])));
  const table = element(
    "table",
    "",
    element("thead", "", element("tr", "", ...head.map((text, i) => element("th", isText[i] ? "text" : "", text)))),
  );
  table.append(
    element(
      "tbody",
      "",
      ...rows.map((row) => element("tr", "", ...row.map((cell, i) => element("td", isText[i] ? "text" : "", cell)))),
    ),
  );
  return element("div", "scroll", table);
}

/** Box with the KKT residual, multipliers and sensitivities of the best design; null if they are unknown. */
function optimalityBox(study) {
  const { optimality } = study.summary;
  if (!optimality) return null; // the conclusions and the table show what is active
  const box = element("div", "box half stretch", element("h3", "", "Active constraints and sensitivities"));
  const objective = study.problem.objectives[0];
  box.append(
    element(
      "p",
      "caption",
      "First-order optimality (KKT residual): " +
        digits(optimality.optimality, 2) +
        ", the relative improvement still possible per full range of a variable, to first order.",
    ),
  );
  if (optimality.active.length)
    box.append(
      simpleTable(
        ["active constraint", "kind", "gain if relaxed"],
        byMultiplier(optimality).map((a) => [a.name, a.kind, rateText(a.multiplier, objective, a.unit)]),
      ),
    );
  // One table per unit, largest sensitivity first. Sensitivities that vanish at an optimum, up to rounding, are 0.
  const rates = optimality.sensitivities.filter((s) => s.as_built !== 0 || s.reoptimised);
  for (const unit of new Set(rates.map((s) => s.unit))) {
    const group = rates.filter((s) => s.unit === unit);
    const size = Math.max(...group.map((s) => Math.abs(s.as_built)));
    const rate = (value) => rateText(Math.abs(value) < 1e-6 * size ? 0 : value, objective, unit);
    box.append(
      simpleTable(
        ["parameter", "others fixed", "reoptimised"],
        group
          .sort((a, b) => Math.abs(b.as_built) - Math.abs(a.as_built))
          .map((s) => [s.name, rate(s.as_built), s.reoptimised === null ? "varies" : rate(s.reoptimised)]),
      ),
    );
  }
  return box;
}

const outcomeColours = { feasible: "#0072b2", infeasible: "#e69f00", rejected: "#9aa7b5", failed: "#d55e00" };

/** Box with the wall time and the outcomes of the evaluations of each stage. */
function timeBox({ stages, seconds }) {
  const bars = element("div", "bars");
  const longest = Math.max(...stages.map((stage) => stage.seconds), 1e-12);
  for (const [i, stage] of stages.entries()) {
    const bar = element("div", "bar");
    for (const [outcome, number] of Object.entries(stage.outcomes)) {
      if (!number) continue;
      const segment = element("i");
      segment.style.width = 100 * (stage.seconds / longest) * (number / stage.evaluations) + "%";
      segment.style.background = outcomeColours[outcome];
      segment.title = count(number, outcome + " evaluation");
      bar.append(segment);
    }
    bars.append(element("span", "", i + 1 + ". " + stage.optimiser), bar, element("span", "", duration(stage.seconds)));
  }
  const outcomes = Object.keys(outcomeColours).filter((outcome) => stages.some((stage) => stage.outcomes[outcome]));
  const rows = stages.map((stage, i) => [
    i + 1 + ". " + stage.optimiser,
    stage.evaluations.toLocaleString("en-GB"),
    ...outcomes.map((outcome) => stage.outcomes[outcome].toLocaleString("en-GB")),
    duration(stage.evaluating),
  ]);
  const stops = stages.map((stage, i) =>
    element(
      "li",
      "",
      `stage ${i + 1}, ${stage.optimiser}: ` +
        (stage.starts ? count(stage.starts, "run") : count(stage.generations, "generation")) +
        (stage.stop ? ", ended: " + stage.stop : ""),
    ),
  );
  const legend = element("p", "caption", "Bars: wall time, divided in proportion to the outcomes of the evaluations: ");
  for (const outcome of outcomes) {
    const key = element("span", "", "■ ");
    key.style.color = outcomeColours[outcome];
    legend.append(key, outcome + "  ");
  }
  return element(
    "div",
    "box half stretch time",
    element("h3", "", "Computing time"),
    element("p", "caption", "Total wall time: " + duration(seconds) + "."),
    bars,
    legend,
    simpleTable(["stage", "evaluations", ...outcomes, "total time of all threads"], rows),
    element("ul", "plain stops", ...stops),
  );
}

/** Quotes a file name for a shell command. */
function shellWord(text) {
  const file = text.startsWith("-") ? "./" + text : text; // must not look like an option
  return /^[\w./+-]+$/.test(file) ? file : "'" + file.replaceAll("'", "'\\''") + "'";
}

/** Text that can be expanded. */
function details(title, text) {
  return element("details", "", element("summary", "", title), element("pre", "", text));
}

/** Box with the commands, version and input that reproduce the study. */
function reproductionBox(study) {
  const { origin } = study.summary;
  const toml = origin.toml_file || "study.toml";
  const commands = ["pkmopt run " + shellWord(toml) + " --seed " + origin.seed + " --output " + shellWord(study.file)];
  for (const extension of origin.extensions)
    commands.push("pkmopt resume " + shellWord(study.file) + " --" + extension.limit + " " + extension.value);
  const box = element(
    "div",
    "box repeat",
    element("h3", "", "Reproduction"),
    element(
      "p",
      "caption",
      [
        origin.version && "pkmopt " + origin.version,
        origin.revision && "revision " + origin.revision,
        origin.created && "started " + origin.created,
        origin.updated && "last written " + origin.updated,
      ]
        .filter(Boolean)
        .join(", ") + ". The same seed gives bit-identical results on any number of threads.",
    ),
    element("pre", "", commands.join("\n")),
    details("Study file in TOML: " + toml, origin.toml),
  );
  if (origin.mechanism_toml)
    box.append(details("Mechanism file: " + origin.mechanism_file, origin.mechanism_toml));
  if (origin.resolved) box.append(details("Problem with all default values", origin.resolved));
  for (const [i, stage] of study.summary.stages.entries())
    if (stage.options.length)
      box.append(details("Options of stage " + (i + 1) + ", " + stage.optimiser, stage.options.join("\n")));
  return box;
}

function showSummary(study, panel) {
  const { table, stages } = study.summary;
  panel.append(headline(study), conclusions(study));
  addOverview(study, panel);
  panel.append(cards(study));
  const notes = remarks(study);
  if (notes.length) panel.append(element("div", "box", element("ul", "plain", ...notes)));
  const grid = element("div", "grid");
  if (notes.length) grid.style.marginTop = "16px";
  if (table)
    grid.append(element("div", "box", element("h3", "", "Designs"), designTable(table, study.problem.variables)));
  const pair = [optimalityBox(study), stages.length ? timeBox(study.summary) : null].filter(Boolean);
  if (pair.length === 1) pair[0].classList.remove("half");
  grid.append(...pair, reproductionBox(study));
  panel.append(grid);
}
