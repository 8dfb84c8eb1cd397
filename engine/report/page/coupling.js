// Panel "Coupling": dynamic coupling indices (DCI) of the limbs, from 0 (the drives are decoupled) to 1.

const limbNames = (joints) => joints.map((joint, i) => `limb ${i + 1} (${joint})`);

function rotationTraces(design, names) {
  const x = design.rotations.map((value) => (value * 180) / Math.PI);
  return names.flatMap((name, i) =>
    [
      ["mean", "solid", 2.5],
      ["max", "dot", 1.5],
    ].map(([statistic, dash, width]) => ({
      type: "scatter",
      mode: x.length > 30 ? "lines" : "lines+markers",
      x,
      y: design.indices[i][statistic],
      name: label(name) + (statistic === "mean" ? "" : ", maximum"),
      line: { color: limbColours[i], dash, width },
      marker: { size: 5, color: limbColours[i] },
      hovertemplate: `%{y:.4f} at %{x:.4g} deg<extra>${label(name)}, ${statistic}</extra>`,
      legendgroup: name,
      showlegend: statistic === "mean",
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
      hovertemplate: `%{y:.2f} % of the poses have a DCI near %{x:.2f}<extra>${label(name)}</extra>`,
    };
  });
}

function showCoupling(study, panel) {
  const { coupling } = study,
    names = limbNames(coupling.joints),
    n = names.length;
  const designs = coupling.designs.map((design) => {
    const packed = study.workspace.designs.find((each) => each.name === design.name);
    return { ...design, cells: (packed.cells ??= new Cells(packed)) };
  });
  const all = designs.map((design) => design.cells);
  panel.append(
    element(
      "p",
      "lead",
      `Dynamic coupling indices of the drives over the feasible poses: 0 if the acceleration of a drive needs no force of the other drives; the maximum is 1. Mass model: “${coupling.masses}”.`,
    ),
  );
  const grid = element("div", "grid");
  panel.append(grid);
  const size = designs.length > 1 ? "half" : "";
  const withRotation = designs.filter((design) => design.rotations);
  const top = Math.min(
    1,
    1.05 * Math.max(...withRotation.flatMap((d) => d.indices.slice(0, n).flatMap((i) => rangeOf(i.max)[1]))),
  );
  for (const design of withRotation)
    addPlot(grid, {
      title: `DCI over ${coupling.rotation}, ${design.name}`,
      caption: "Mean over the feasible poses (solid) and maximum (dotted).",
      size,
      height: 380,
      make: () => ({
        data: rotationTraces(design, names),
        layout: { xaxis: axis(axisName(coupling.rotation, "deg")), yaxis: axis("DCI [1]", { range: [0, top] }) },
      }),
    });
  // The histogram of an almost decoupled limb is one high bar. The axis is cut off so that the others remain visible.
  const heights = designs.flatMap((design) =>
    histogramTraces(design.cells, names).map((trace) => Math.max(...trace.y)),
  );
  const highest = Math.min(
    Math.max(...heights),
    Math.max(
      30,
      1.3 *
        Math.max(...designs.map((_, d) => heights.slice(n * d, n * d + n).sort((a, b) => b - a)[Math.min(1, n - 1)])),
    ),
  );
  for (const design of designs)
    addPlot(grid, {
      title: `Distribution of the DCI, ${design.name}`,
      caption: "Histogram over the cells of the workspace, 50 bins.",
      size,
      height: 340,
      make: () => ({
        data: histogramTraces(design.cells, names),
        layout: {
          xaxis: axis("DCI [1]", { range: [0, 1] }),
          yaxis: axis("share of the poses [%]", { range: [0, highest] }),
        },
      }),
    });
  const bar = element("div", "controls box");
  let maps = [];
  const redraw = () => maps.forEach((plot) => plot.update());
  const selected =
    designs.length > 1
      ? buttons(
          bar,
          "design",
          designs.map((d) => d.name),
          0,
          redraw,
        )
      : { value: 0 };
  const slice = sliceControls(bar, all, redraw);
  if (bar.children.length) grid.append(bar);
  const range = rangeOf(names.flatMap((_, i) => fieldRange(all, "dci_" + (i + 1))));
  maps = names.map((name, i) =>
    addPlot(grid, {
      title: name[0].toUpperCase() + name.slice(1),
      size: "half",
      height: 380,
      make() {
        const { cells } = designs[selected.value];
        const matrix = cells.slice("dci_" + (i + 1), slice, slice.layer(cells));
        return cellsPlot(all, cells, matrix, slice.across, slice.up, { range, title: "DCI", unit: "1" });
      },
    }),
  );
}
