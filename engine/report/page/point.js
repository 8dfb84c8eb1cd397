// Shows a point of the Pareto front instead of the best design, with workspace, links and motions if the page includes
// them.

/** The p-th point of the f-th front; null if it is the best design, which the page shows by default. */
function chosenPoint(study, f, p) {
  const front = study.front.fronts[f],
    point = front.points[p];
  const best = study.summary.table?.rows.filter((row) => row.kind === "variable").map((row) => row.values[0]);
  if (!study.point && point.design.every((value, i) => value === best?.[i])) return null;
  return { ...point, f, p, name: `point ${p + 1} of stage ${front.stage}`, stage: front.stage };
}

const isAt = (study, f, p) => study.point?.f === f && study.point?.p === p;

/** A copy of the study with a point of its front instead of the best design, first in every list of designs. */
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
    original: study,
    // Active constraints and multipliers are known only for the best design.
    summary: { ...study.summary, table: { columns, rows }, active: undefined, optimality: null },
  };
  const find = (panelId) => study.front.designs?.[panelId]?.designs.find((design) => design.name === point.name);
  point.missing = study.workspace && !find("workspace");
  if (point.missing) return shown;
  for (const panelId of ["workspace", "mechanism"])
    if (study[panelId] && find(panelId))
      shown[panelId] = {
        ...study[panelId],
        designs: [find(panelId), ...study[panelId].designs.filter((design) => design.name === "baseline")],
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
  shown.coupling = undefined; // known only for the best design and the baseline
  return shown;
}

/** The command that writes a page for a point whose workspace this page does not include. */
function pointCommand({ file }, { stage, p, name }) {
  const point = `--from ${shellWord(file)} --front ${p + 1} --stage ${stage}`;
  return `pkmopt workspace ${point} --html ${name.replaceAll(" ", "-")}.html`;
}

/** Shows the chosen point in the top bar, with a button to return to the best design. */
function showChosenPoint(study) {
  const back = element("button", "", "× back to the " + (study.original?.summary.table.columns[0].name ?? ""));
  back.type = "button";
  back.addEventListener("click", () => study.choose(null));
  document.getElementById("chosen").replaceChildren(...(study.point ? [study.point.name + " ", back] : []));
}

/** Adds a list of the points whose workspace the page includes; it can be used with the keyboard. */
function addPointList(controls, study, load) {
  const { fronts, designs } = study.front;
  const original = study.original ?? study;
  const included = (designs?.workspace?.designs ?? []).flatMap(({ name }) => {
    const [, p, stage] = /^point (\d+) of stage (\d+)$/.exec(name);
    return [{ name, f: fronts.findIndex((front) => front.stage === Number(stage)), p: Number(p) - 1 }];
  });
  if (!included.length) return;
  const shown = included.findIndex(({ f, p }) => isAt(study, f, p));
  choice(
    controls,
    "shown design",
    [original.summary.table.columns[0].name, ...included.map(({ name }) => name)],
    study.point && shown < 0 ? -1 : shown + 1,
    (i) => (i ? load(included[i - 1].f, included[i - 1].p) : study.choose(null)),
  );
}
