// A point of the trade-off in the place of the best design, as far as the page has its workspace, links and motions.

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
