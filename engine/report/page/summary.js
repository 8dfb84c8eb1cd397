// What was found: the best design beside the others, what holds it back, where the time went, how to repeat it.

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

/** Nothing where no objective has a value yet. */
function cards(study) {
  const { table, stages } = study.summary;
  const list = element("div", "cards");
  for (const row of table ? table.rows : []) {
    if (row.kind !== "objective") continue;
    const baseline = table.columns.findIndex((column) => column.name === "baseline");
    const against =
      baseline >= 0 && row.values[baseline] !== null
        ? [" beside the baseline's ", result(row.values[baseline], row.unit)]
        : [];
    if (row.values[0] === null) continue;
    const { unit, scale } = resultUnit(row.unit);
    const value = rounded(digits(row.values[0] * scale), row.values[0], row.unit);
    list.append(card(row.name, value, unit, ...(row.gain ? [gainText(row.gain), ...against] : [row.meaning])));
  }
  if (stages.length)
    list.append(
      card(
        "volume of work",
        study.summary.evaluations.toLocaleString("en-GB"),
        "evaluations",
        "in " + count(stages.length, "stage") + ": " + stages.map((stage) => stage.optimiser).join(", then "),
      ),
    );
  return list.children.length ? list : "";
}

const isResult = (row) => row.kind === "objective" || row.kind === "report" || row.kind === "certain";
const unitOf = (row) => (isResult(row) ? resultUnit(row.unit).unit : shownUnit(row.unit));

/** A margin that has nothing left to give: below the study's own threshold, and not broken beyond rounding. */
const isActive = (margin) => margin <= 1e-4 && margin > -1e-6;

function tableCell(row, value) {
  if (value === null) return element("td");
  const scale = isResult(row) ? resultUnit(row.unit).scale : shownScale(row.unit); // the unit has a column
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

/** "min" or "max" where a variable is at its bound. */
function boundAt(value, { lower, upper }) {
  const near = 1e-6 * (upper - lower);
  return value - lower <= near ? "min" : upper - value <= near ? "max" : "";
}

/** @param variables  of the problem: a value at a bound is marked */
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
    report: "reports",
    constraint: "margins of constraints (≥ 0 holds; active: at its bound)",
    certain: "the workspace’s volume and certain bounds of it",
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
    const name = element("th", "text", row.name);
    name.scope = "row";
    name.title = row.meaning;
    const line = element("tr", "", name, element("td", "unit", unitText(unitOf(row))));
    const bounds = row.kind === "variable" ? variables.find((variable) => variable.name === row.name) : null;
    for (const value of row.values) line.append(tableCell({ ...row, bounds }, value));
    if (gains) line.append(element("td", "", gainText(row.gain)));
    body.append(line);
  }
  table.append(body);
  return element("div", "scroll", table);
}

function remarks(study) {
  const { summary } = study;
  const list = [];
  if (summary.verdict)
    list.push([
      "warning",
      summary.verdict.finding + ": " + summary.verdict.sentence + ".",
      ...summary.verdict.reasons.map((reason) => reason.sentence),
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
        (summary.state === "running" ? "still running, or was killed" : "interrupted") +
        ": this is what its file held when the report was made.",
    ]);
  if (summary.evaluations === 0) list.push(["warning", "Nothing has been evaluated yet."]);
  if (summary.touches_box)
    list.push(["warning", "Feasible cells of the best design touch the box; a larger box may hold more workspace."]);
  if (!summary.reproducible)
    list.push(["warning", "The clock ended a start, so another run with this seed may end elsewhere."]);
  if (summary.unreadable)
    list.push([
      "warning",
      "This program cannot read the study's text, so what would have to be evaluated again is left out: " +
        summary.unreadable,
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

function rateText(value, objective, unit) {
  if (value === null) return "";
  const { unit: of, scale } = resultUnit(objective.unit),
    name = shownUnit(unit);
  const text = quantity((value / shownScale(unit)) * scale, of) + (name && name !== "1" ? " per " + name : "");
  return rounded(text, value, `${objective.unit} per ${unit}`);
}

/** A table of text; columns that hold numbers are set to the right. */
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

function holdingBack(study) {
  const { optimality } = study.summary;
  if (!optimality) return null; // what is active is said above, and in the table
  const panel = element("div", "panel half stretch", element("h3", "", "What holds the best design back"));
  const objective = study.problem.objectives[0];
  panel.append(
    element(
      "p",
      "caption",
      "First-order optimality " +
        digits(optimality.optimality, 2) +
        ": the gradient that is left once the active ones are allowed for.",
    ),
  );
  if (optimality.active.length)
    panel.append(
      simpleTable(
        ["active", "", "gain if moved"],
        byMultiplier(optimality).map((a) => [a.name, a.kind, rateText(a.multiplier, objective, a.unit)]),
      ),
    );
  // Of a unit the greatest first; what an optimum leaves of the others is 0.
  const rates = optimality.sensitivities.filter((s) => s.as_built !== 0 || s.reoptimised);
  for (const unit of new Set(rates.map((s) => s.unit))) {
    const alike = rates.filter((s) => s.unit === unit);
    const size = Math.max(...alike.map((s) => Math.abs(s.as_built)));
    const rate = (value) => rateText(Math.abs(value) < 1e-6 * size ? 0 : value, objective, unit);
    panel.append(
      simpleTable(
        ["sensitivity", "as built", "reoptimised"],
        alike
          .sort((a, b) => Math.abs(b.as_built) - Math.abs(a.as_built))
          .map((s) => [s.name, rate(s.as_built), s.reoptimised === null ? "varies" : rate(s.reoptimised)]),
      ),
    );
  }
  return panel;
}

const outcomeColours = { feasible: "#0072b2", infeasible: "#e69f00", rejected: "#9aa7b5", failed: "#d55e00" };

function timeSpent({ stages, seconds }) {
  const bars = element("div", "bars");
  const longest = Math.max(...stages.map((stage) => stage.seconds), 1e-12);
  for (const [i, stage] of stages.entries()) {
    const bar = element("div", "bar");
    for (const [outcome, number] of Object.entries(stage.outcomes)) {
      if (!number) continue;
      const part = element("i");
      part.style.width = 100 * (stage.seconds / longest) * (number / stage.evaluations) + "%";
      part.style.background = outcomeColours[outcome];
      part.title = count(number, outcome + " evaluation");
      bar.append(part);
    }
    bars.append(element("span", "", i + 1 + ". " + stage.optimiser), bar, element("span", "", duration(stage.seconds)));
  }
  const kinds = Object.keys(outcomeColours).filter((outcome) => stages.some((stage) => stage.outcomes[outcome]));
  const rows = stages.map((stage, i) => [
    i + 1 + ". " + stage.optimiser,
    stage.evaluations.toLocaleString("en-GB"),
    ...kinds.map((outcome) => stage.outcomes[outcome].toLocaleString("en-GB")),
    duration(stage.evaluating),
  ]);
  const ends = stages.map((stage, i) =>
    element(
      "li",
      "",
      `stage ${i + 1}, ${stage.optimiser}: ` +
        (stage.starts ? count(stage.starts, "start") : count(stage.generations, "generation")) +
        (stage.stop ? ", ended: " + stage.stop : ""),
    ),
  );
  const legend = element("p", "caption", "Bars: wall time, shared by how the evaluations ended: ");
  for (const outcome of kinds) {
    const key = element("span", "", "■ ");
    key.style.color = outcomeColours[outcome];
    legend.append(key, outcome + "  ");
  }
  return element(
    "div",
    "panel half stretch time",
    element("h3", "", "Where the time went"),
    element("p", "caption", duration(seconds) + " of wall time in all."),
    bars,
    legend,
    simpleTable(["", "evaluations", ...kinds, "time of all threads"], rows),
    element("ul", "plain ends", ...ends),
  );
}

function word(text) {
  // of a shell
  return /^[\w./+-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";
}

function details(title, text) {
  return element("details", "", element("summary", "", title), element("pre", "", text));
}

function howToRepeat(study) {
  const { origin } = study.summary;
  const toml = origin.toml_file || "study.toml";
  const commands = ["pkmopt run " + word(toml) + " --seed " + origin.seed + " --output " + word(study.file)];
  for (const extension of origin.extensions)
    commands.push("pkmopt resume " + word(study.file) + " --" + extension.limit + " " + extension.value);
  const panel = element(
    "div",
    "panel repeat",
    element("h3", "", "How to repeat it"),
    element(
      "p",
      "caption",
      [
        origin.version && "pkmopt " + origin.version,
        origin.revision && "revision " + origin.revision,
        origin.created && "begun " + origin.created,
        origin.updated && "last written " + origin.updated,
      ]
        .filter(Boolean)
        .join(", ") + ". The same seed gives the same bits, on any number of threads.",
    ),
    element("pre", "", commands.join("\n")),
    details("The study's text, " + toml, origin.toml),
  );
  if (origin.mechanism_toml)
    panel.append(details("The mechanism's text, " + origin.mechanism_file, origin.mechanism_toml));
  if (origin.resolved) panel.append(details("The problem with every default spelled out", origin.resolved));
  for (const [i, stage] of study.summary.stages.entries())
    if (stage.options.length)
      panel.append(details("Options of stage " + (i + 1) + ", " + stage.optimiser, stage.options.join("\n")));
  return panel;
}

function showSummary(study, section) {
  const { table, stages } = study.summary;
  section.append(headline(study), verdictOf(study));
  addOverview(study, section);
  section.append(cards(study));
  const notes = remarks(study);
  if (notes.length) section.append(element("div", "panel", element("ul", "plain", ...notes)));
  const grid = element("div", "grid");
  if (notes.length) grid.style.marginTop = "16px";
  if (table)
    grid.append(element("div", "panel", element("h3", "", "Designs"), designTable(table, study.problem.variables)));
  const pair = [holdingBack(study), stages.length ? timeSpent(study.summary) : null].filter(Boolean);
  if (pair.length === 1) pair[0].classList.remove("half");
  grid.append(...pair, howToRepeat(study));
  section.append(grid);
}
