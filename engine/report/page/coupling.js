// How much the drives disturb each other: dynamic coupling indices (DCI) of the limbs, 0 for none, up to 1.

const limbNames = (joints) => joints.map((joint, i) => `limb ${i + 1} (${joint})`);

function againstRotation(design, names) {
  const x = design.rotations.map((value) => (value * 180) / Math.PI);
  return names.flatMap((name, i) =>
    [
      ["mean", "solid", 2.5],
      ["max", "dot", 1.5],
    ].map(([what, dash, width]) => ({
      type: "scatter",
      mode: x.length > 30 ? "lines" : "lines+markers",
      x,
      y: design.indices[i][what],
      name: label(name) + (what === "mean" ? "" : ", greatest"),
      line: { color: limbColours[i], dash, width },
      marker: { size: 5, color: limbColours[i] },
      hovertemplate: `%{y:.4f} at %{x:.4g} deg<extra>${label(name)}, ${what}</extra>`,
      legendgroup: name,
      showlegend: what === "mean",
    })),
  );
}

function histogramTraces(cells, names) {
  const bins = 50;
  return names.map((name, i) => {
    const values = cells.values.get("dci_" + (i + 1)),
      share = new Array(bins).fill(0);
    let count = 0;
    for (const value of values)
      if (Number.isFinite(value)) {
        ++share[Math.min(bins - 1, Math.floor(value * bins))];
        ++count;
      }
    return {
      type: "scatter",
      mode: "lines",
      x: share.map((_, k) => (k + 0.5) / bins),
      y: share.map((n) => (100 * n) / count),
      name: label(name),
      line: { color: limbColours[i], width: 2, shape: "hvh" },
      fill: "tozeroy",
      fillcolor: faded(limbColours[i], 0.12),
      hovertemplate: `%{y:.2f} % of the poses have an index near %{x:.2f}<extra>${label(name)}</extra>`,
    };
  });
}

function showCoupling(study, section) {
  const { coupling } = study,
    names = limbNames(coupling.joints),
    n = names.length;
  const designs = coupling.designs.map((design) => {
    const packed = study.workspace.designs.find((each) => each.name === design.name);
    return { ...design, cells: (packed.cells ??= new Cells(packed)) };
  });
  const all = designs.map((design) => design.cells);
  section.append(
    element(
      "p",
      "lead",
      `Dynamic coupling indices of the drives over the feasible poses: 0 where a drive's acceleration needs no force of the others, up to 1. Masses by the model “${coupling.masses}”.`,
    ),
  );
  const grid = element("div", "grid");
  section.append(grid);
  const size = designs.length > 1 ? "half" : "";
  const turning = designs.filter((design) => design.rotations);
  const top = Math.min(
    1,
    1.05 * Math.max(...turning.flatMap((d) => d.indices.slice(0, n).flatMap((i) => rangeOf(i.max)[1]))),
  );
  for (const design of turning)
    addPlot(grid, {
      title: `Against ${coupling.rotation}, ${design.name}`,
      caption: "Mean over the feasible poses, and dotted the greatest.",
      size,
      height: 380,
      make: () => ({
        data: againstRotation(design, names),
        layout: { xaxis: axis(axisName(coupling.rotation, "deg")), yaxis: axis("DCI [1]", { range: [0, top] }) },
      }),
    });
  // A limb that is all but decoupled has all its poses in one bar, which must not flatten the others.
  const heights = designs.flatMap((design) =>
    histogramTraces(design.cells, names).map((trace) => Math.max(...trace.y)),
  );
  const often = Math.min(
    Math.max(...heights),
    Math.max(
      30,
      1.3 *
        Math.max(...designs.map((_, d) => heights.slice(n * d, n * d + n).sort((a, b) => b - a)[Math.min(1, n - 1)])),
    ),
  );
  for (const design of designs)
    addPlot(grid, {
      title: `How often, ${design.name}`,
      caption: "Share of the workspace's cells with an index in each fiftieth.",
      size,
      height: 340,
      make: () => ({
        data: histogramTraces(design.cells, names),
        layout: {
          xaxis: axis("DCI [1]", { range: [0, 1] }),
          yaxis: axis("share of the poses [%]", { range: [0, often] }),
        },
      }),
    });
  const bar = element("div", "controls panel");
  let maps = [];
  const redraw = () => maps.forEach((plot) => plot.update());
  const which =
    designs.length > 1
      ? buttons(
          bar,
          "maps of",
          designs.map((d) => d.name),
          0,
          redraw,
        )
      : { value: 0 };
  const cut = cutControls(bar, all, redraw);
  if (bar.children.length) grid.append(bar);
  const range = rangeOf(names.flatMap((_, i) => fieldRange(all, "dci_" + (i + 1))));
  maps = names.map((name, i) =>
    addPlot(grid, {
      title: name[0].toUpperCase() + name.slice(1),
      size: "half",
      height: 380,
      make() {
        const { cells } = designs[which.value];
        const matrix = cells.cut("dci_" + (i + 1), cut, cut.layer(cells));
        return cellsPicture(all, cells, matrix, cut.across, cut.up, { range, title: "DCI", unit: "1" });
      },
    }),
  );
}
