// Panel "Workspace": boundary surface, slices and column lengths of the designs, with common axes and colours.

/**
 * 3-D trace of the boundary surface.
 * @param order  indices of the axes that are drawn as x, y and z
 */
function surfaceTrace(design, order, more = {}) {
  const { vertices, triangles } = design.surface;
  const axes = order.map((k) => design.axes[k]);
  const shown = order.map((k) => Array.from(vertices[k], (value) => value * shownScale(design.axes[k].unit)));
  const corner = (c) => Array.from({ length: triangles.length / 3 }, (_, t) => triangles[3 * t + c]);
  return {
    type: "mesh3d",
    x: shown[0],
    y: shown[1],
    z: shown[2],
    i: corner(0),
    j: corner(1),
    k: corner(2),
    name: design.name,
    color: "#56b4e9",
    hovertemplate: spaceTemplate(axes) + "<extra></extra>",
    lighting: { ambient: 0.72, diffuse: 0.5, specular: 0.08, roughness: 0.9, fresnel: 0.05 },
    lightposition: { x: 1e4, y: -2e4, z: 3e4 },
    flatshading: false,
    ...more,
  };
}

/** Hover template with the three coordinates of a point in space. */
function spaceTemplate(axes) {
  return axes
    .map((a, i) => `${label(a.name)} %{${"xyz"[i]}:.4g} ${label(unitText(shownUnit(a.unit)))}`)
    .join("<br>");
}

/**
 * 3-D traces of slices, coloured by a field.
 * @param order   indices of the axes that are drawn as x, y and z
 * @param slices  for each slice, the fixed axis and its value
 * @param field   information on the field: name, unit
 */
function sliceTraces(design, order, slices, field, range) {
  const title = fieldTitle(field.name);
  return slices.flatMap(({ fixed, value }, s) => {
    const layer = design.layer(fixed, value);
    if (layer < 0) return [];
    const [across, up] = order.filter((k) => k !== fixed);
    const matrix = design.slice(field.name, { fixed, across, up }, layer);
    const centres = (k) => design.centres(k).map((centre) => centre * shownScale(design.axes[k].unit));
    const [xs, ys] = [centres(across), centres(up)];
    const coordinate = (k) =>
      matrix.map((row, j) =>
        row.map((cell, i) =>
          cell === null ? null : k === fixed ? value * shownScale(design.axes[k].unit) : k === across ? xs[i] : ys[j],
        ),
      );
    return {
      type: "surface",
      x: coordinate(order[0]),
      y: coordinate(order[1]),
      z: coordinate(order[2]),
      surfacecolor: matrix,
      cmin: range[0],
      cmax: range[1],
      colorscale: fieldColours(),
      showscale: s === 0,
      colorbar: lowColourBar(axisName(title, field.unit === "mixed" ? "1" : field.unit)),
      connectgaps: false,
      contours: Object.fromEntries(["x", "y", "z"].map((name) => [name, { highlight: false }])),
      lighting: { ambient: 1, diffuse: 0, specular: 0 },
      hovertemplate:
        spaceTemplate(order.map((k) => design.axes[k])) +
        `<br>${label(title)} %{surfacecolor:.4g} ${label(unitText(field.unit === "mixed" ? "1" : field.unit))}<extra></extra>`,
    };
  });
}

/** 3-D traces of a workspace: slices within the translucent boundary surface; without fields, the surface alone. */
function workspaceTraces(design, order, slices, field, range) {
  if (!field) return [surfaceTrace(design, order, design.solids ? { opacity: 0.3 } : {})];
  return [...sliceTraces(design, order, slices, field, range), surfaceTrace(design, order, { opacity: 0.16 })];
}

/** The slices at the middle of the workspace normal to the two axes that are drawn horizontally. */
function middleSlices(design, order) {
  return order.slice(0, 2).map((fixed) => {
    const [low, high] = feasibleRange([design], fixed);
    return { fixed, value: (low + high) / 2 };
  });
}

/** Layout of a 3-D plot of workspaces, with room for the colour bar below it. @param distance  from addPlot() */
function workspaceLayout(designs, order, distance) {
  return {
    scene: { ...workspaceScene(designs, order, distance), domain: { y: [0.13, 1] } },
    uirevision: "camera",
    margin: { l: 0, r: 0, t: 0, b: 0 },
  };
}

const solidColour = "#d55e00";

/** "largest cylinder: diameter 600 mm, height 200 mm" */
function solidText(solid) {
  const dimensions = solid.dimensions.map(({ name, value }) => `${name} ${shownValue(value, { unit: "m" })}`);
  return `largest ${solid.shape}: ${dimensions.join(", ")}`;
}

/** Points of the boundary of the unit square or of the unit disc, counterclockwise. */
function unitOutline(isRound) {
  if (!isRound) return [[1, 1], [-1, 1], [-1, -1], [1, -1]];
  return Array.from({ length: 48 }, (_, k) => [Math.cos((k * Math.PI) / 24), Math.sin((k * Math.PI) / 24)]);
}

/**
 * 3-D trace of a box, cylinder or sphere: rings about one of its axes, joined by triangles.
 * @param order  indices of the axes that are drawn as x, y and z
 */
function solidTrace(solid, axes, order) {
  const isSphere = solid.balls.length === 1,
    isCylinder = solid.balls.length === 2;
  const along = solid.balls.find((ball) => ball.length === 1)?.[0] ?? 2;
  const [across, up] = [0, 1, 2].filter((axis) => axis !== along);
  const rings = isSphere // [radius, height] of the unit solid
    ? Array.from({ length: 25 }, (_, k) => [Math.sin((k * Math.PI) / 24), -Math.cos((k * Math.PI) / 24)])
    : [[0, -1], [1, -1], [1, 1], [0, 1]];
  const outline = unitOutline(isSphere || isCylinder),
    n = outline.length;
  const points = rings.flatMap(([radius, height]) =>
    outline.map(([u, v]) => {
      const unit = [];
      [unit[across], unit[up], unit[along]] = [radius * u, radius * v, height];
      return unit.map((value, axis) => solid.centre[axis] + (value * solid.extents[axis]) / 2);
    }),
  );
  const triangles = rings.slice(1).flatMap((_, ring) =>
    outline.flatMap((_, k) => {
      const [a, b] = [ring * n + k, ring * n + ((k + 1) % n)];
      return [[a, b, a + n], [b, b + n, a + n]];
    }),
  );
  const drawn = order.map((axis) => points.map((point) => point[axis] * shownScale(axes[axis].unit)));
  return {
    type: "mesh3d",
    ...Object.fromEntries(drawn.map((values, k) => ["xyz"[k], values])),
    ...Object.fromEntries([0, 1, 2].map((corner) => ["ijk"[corner], triangles.map((triangle) => triangle[corner])])),
    name: label(solid.name),
    color: solidColour,
    hovertemplate: label(solidText(solid)) + "<extra></extra>",
    lighting: { ambient: 0.7, diffuse: 0.5, specular: 0.1 },
    flatshading: true,
  };
}

/** Line trace of the outline of a solid on the plane of a slice; no trace if the slice misses the solid. */
function solidOutlines(design, { fixed, across, up, value }) {
  return (design.solids ?? []).flatMap((solid) => {
    const ballOf = (axis) => solid.balls.findIndex((ball) => ball.includes(axis));
    const offset = fixed === undefined ? 0 : (2 * (value - solid.centre[fixed])) / solid.extents[fixed];
    if (Math.abs(offset) > 1) return [];
    const outline = unitOutline(ballOf(across) === ballOf(up));
    const line = [across, up].map((axis, k) => {
      const share = ballOf(axis) === ballOf(fixed) ? Math.sqrt(1 - offset * offset) : 1;
      return [...outline, outline[0]].map(
        (point) => (solid.centre[axis] + (share * point[k] * solid.extents[axis]) / 2) * shownScale(design.axes[axis].unit),
      );
    });
    return {
      type: "scatter",
      mode: "lines",
      x: line[0],
      y: line[1],
      name: label(solid.name),
      line: { color: solidColour, width: 3 },
      hovertemplate: label(solidText(solid)) + "<extra></extra>",
      showlegend: false,
    };
  });
}

/** @param relativeLength  relative to the longest axis; a shorter axis gets fewer tick labels */
function sceneAxis(title, range, relativeLength = 1) {
  return {
    nticks: Math.max(2, Math.round(8 * relativeLength)),
    title: { text: title, font: { size: 12 } },
    tickfont: { size: 11 },
    gridcolor: colour("line"),
    zeroline: false,
    showbackground: false,
    showspikes: false,
    color: colour("ink"),
    ...(range ? { range } : {}),
  };
}

/**
 * 3-D scene for workspaces, with equal scales if all axes are lengths.
 * @param distance  relative distance of the camera, from addPlot()
 */
function workspaceScene(designs, order, distance) {
  return sceneOf(
    order.map((k) => designs[0].axes[k]),
    order.map((k) => sharedRange(designs, k)),
    distance,
  );
}

/** 3-D scene with these ranges of the axes, in displayed units. */
function sceneOf(axes, ranges, distance) {
  const toScale = axes.every((a) => a.unit === "m");
  const extents = ranges.map(([low, high]) => high - low),
    largest = Math.max(...extents);
  const axisOf = (i) => sceneAxis(axisTitle(axes[i]), ranges[i], toScale ? extents[i] / largest : 1);
  return {
    xaxis: axisOf(0),
    yaxis: axisOf(1),
    zaxis: axisOf(2),
    aspectmode: "manual",
    aspectratio: toScale
      ? Object.fromEntries(extents.map((e, i) => ["xyz"[i], (1.2 * e) / largest]))
      : { x: 1, y: 1, z: 1 },
    camera: { eye: { x: 1.4 * distance, y: -1.8 * distance, z: 0.92 * distance }, center: { x: 0, y: 0, z: -0.08 } },
  };
}

/** Rotating one scene rotates the others. */
function linkCameras(plots) {
  const ready = new Set();
  for (const plot of plots) {
    const draw = plot.draw;
    plot.draw = () => {
      draw();
      if (ready.has(plot)) return;
      ready.add(plot);
      plot.node.on("plotly_relayout", (change) => {
        const camera = change["scene.camera"];
        if (!camera) return;
        for (const other of plots)
          if (
            other !== plot &&
            other.drawn &&
            JSON.stringify(other.node.layout.scene.camera) !== JSON.stringify(camera)
          )
            Plotly.relayout(other.node, { "scene.camera": camera });
      });
    };
  }
}

/** Index of the field that is shown first: the maximum DCI if available, otherwise conditioning. */
function initialField({ fields }) {
  const names = fields.map((field) => field.name);
  return Math.max(0, names.indexOf(names.includes("dci_worst") ? "dci_worst" : "conditioning"));
}

/**
 * Volumes of the designs: those of the table in the summary, if the study computes them; otherwise the numbers of cells.
 * @returns { volumes, by }: children of an element, and how the volumes were found
 */
function workspaceVolumes({ summary }, designs) {
  const row = summary?.table?.rows.find(({ kind, name }) => /^(objective|output)$/.test(kind) && name === "workspace-volume");
  const inTable = ({ name }) => row?.values[summary.table.columns.findIndex((column) => column.name === name)];
  const known = designs.every((design) => Number.isFinite(inTable(design)));
  const volumes = designs.flatMap((d, i) => [
    i ? ", " : "",
    d.name + " ",
    known ? result(inTable(d), row.unit) : result(d.volume, d.volume_unit),
  ]);
  return { volumes, by: known ? "" : " by counting these cells" };
}

function showWorkspace(study, panel) {
  const designs = study.workspace.designs.map((packed) => (packed.cells ??= new Cells(packed)));
  for (const problem of study.workspace.problems) panel.append(element("p", "warning", problem));
  if (!designs.length) return;
  const first = designs[0],
    order = drawingOrder(first.axes),
    isVolume = order.length === 3;
  const fixedValues = [
    ...new Set(
      designs
        .filter((d) => d.fixed.length)
        .map((d) => d.fixed.map((axis) => `${axis.name} = ${shownValue(axis.value, axis)}, ${axis.note}`).join("; ")),
    ),
  ];
  const { volumes, by } = workspaceVolumes(study, designs);
  panel.append(
    element(
      "p",
      "lead",
      "Feasible poses" +
        (fixedValues.length ? " at " + fixedValues.join("; ") : "") +
        `, on ${order.map((k) => first.axes[k].cells).join(" × ")} cells. ${["Length", "Area", "Volume"][order.length - 1]}${by}: `,
      ...volumes,
      "." +
        (designs.length > 1
          ? " All designs have the same axes and colours" + (isVolume ? " and rotate together." : ".")
          : ""),
    ),
  );
  const size = "half";
  const names = first.fields.map((field) => field.name);
  const controls = element("div", "controls"),
    grid = element("div", "grid");
  panel.append(controls, grid);
  const start = initialField(first);
  const field = names.length
    ? choice(
        controls,
        "colour",
        names.map((name) => fieldTitle(name, study.coupling?.joints)),
        start,
        () => all.forEach((plot) => plot.update()),
      )
    : { value: 0 };
  const meaning = element("span", "control");
  controls.append(meaning);
  const current = () => {
    const info = first.fields[field.value] || { name: "", unit: "1", meaning: "" };
    meaning.textContent = info.meaning;
    return info;
  };
  current();

  const sliceBar = element("div", "controls box");
  if (isVolume) grid.append(sliceBar);
  const slice = sliceControls(sliceBar, designs, () => all.forEach((plot) => plot.update()));
  const surfaces = (isVolume ? designs : []).map((design) =>
    addPlot(grid, {
      title: design.name[0].toUpperCase() + design.name.slice(1),
      size,
      height: 520,
      caption:
        (names.length ? "The boundary, and two slices in colour." : "The boundary.") +
        (design.solids ? ` The ${design.solids.map(solidText).join("; ")}.` : ""),
      make(distance) {
        const info = current();
        const other = middleSlices(design, order).find(({ fixed }) => fixed !== slice.fixed);
        const field = names.length ? info : null;
        return {
          data: [
            ...workspaceTraces(design, order, [slice, other], field, field && fieldRange(designs, info.name)),
            ...(design.solids ?? []).map((solid) => solidTrace(solid, design.axes, order)),
          ],
          layout: workspaceLayout(designs, order, distance),
        };
      },
    }),
  );
  linkCameras(surfaces);

  const slices = designs.map((design) =>
    addPlot(grid, {
      title: isVolume ? "Slice of " + design.name : design.name[0].toUpperCase() + design.name.slice(1),
      size,
      height: 440,
      caption:
        (order.length > 1 ? "Cells in colour, contour lines in white." : "Values at the centres of the cells.") +
        (design.solids && !isVolume ? ` The ${design.solids.map(solidText).join("; ")}.` : ""),
      make() {
        const info = current();
        const plot = cellsPlot(designs, design, design.slice(info.name, slice, slice.layer(design)), slice.across, slice.up, {
          range: fieldRange(designs, info.name),
          title: info.name ? fieldTitle(info.name) : "feasible",
          unit: info.unit === "mixed" ? "1" : info.unit,
          lines: names.length > 0,
          bar: names.length > 0,
        });
        plot.data.push(...solidOutlines(design, slice));
        return plot;
      },
    }),
  );
  const all = [...surfaces, ...slices];
  if (order.length < 2) return; // over one coordinate, the length is already given above
  const along = first.axes.findIndex((a) => a.name === study.workspace.column);
  const [across, up] = order.filter((k) => k !== along);
  const lengths = designs.map((design) => {
    const scale = shownScale(design.axes[along].unit);
    return design.lengths(along, across, up).map((row) => row.map((value) => (value === null ? null : value * scale)));
  });
  const range = [0, Math.max(...lengths.flatMap((matrix) => rangeOf(matrix.flat().filter((v) => v !== null))))];
  designs.forEach((design, d) =>
    addPlot(grid, {
      title: `Column length along ${first.axes[along].name}, ${design.name}`,
      size,
      height: 440,
      caption: `Feasible length along this coordinate for fixed values of the other${isVolume ? "s" : ""}.`,
      make: () =>
        cellsPlot(designs, design, lengths[d], across, up, {
          range,
          title: "length",
          unit: shownUnit(first.axes[along].unit),
        }),
    }),
  );
}
