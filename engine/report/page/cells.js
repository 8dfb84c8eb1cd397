// Voxel grid of a workspace: feasible cells, their fields, slices. Lengths are shown in mm, angles in degrees.

function axisTitle(axis) {
  return axisName(axis.name, shownUnit(axis.unit));
}
function shownValue(value, axis, count = 4) {
  const shown = value * shownScale(axis.unit);
  return quantity(Math.abs(shown) < 1e-9 ? 0 : shown, shownUnit(axis.unit), count); // a rounding error instead of 0
}

/** Title of a field: "DCI of limb 1" for "dci_1". */
function fieldTitle(name, joints) {
  const limb = /^dci_(\d)$/.exec(name);
  if (limb) return "DCI of limb " + limb[1] + (joints ? " (" + joints[limb[1] - 1] + ")" : "");
  return (
    {
      dci_worst: "maximum DCI",
      conditioning: "conditioning",
      margin: "minimum margin",
      inertia_condition: "conditioning of the inertia matrix",
    }[name] || name
  );
}

/**
 * The workspace of one design, unpacked. `values` maps the name of a field to its values at the feasible cells; the value
 * of a cell is at feasibleIndex[cell], which is -1 for infeasible cells. Fields are in display units.
 */
class Cells {
  constructor(packed) {
    Object.assign(this, packed);
    this.axes = packed.axes.map((axis) => ({ ...axis, step: (axis.upper - axis.lower) / axis.cells }));
    this.strides = this.axes.map((_, k) => this.axes.slice(k + 1).reduce((product, axis) => product * axis.cells, 1));
    this.feasible = unpack(packed.feasible);
    this.feasibleIndex = new Int32Array(this.strides[0] * this.axes[0].cells).fill(-1);
    let count = 0;
    for (let cell = 0; cell < this.feasibleIndex.length; ++cell)
      if (this.feasible[cell]) this.feasibleIndex[cell] = count++;
    this.fields = packed.fields.map((field) => ({ ...field, unit: shownUnit(field.unit) }));
    const shown = (name, values) => {
      const scale = shownScale(packed.fields.find((field) => field.name === name)?.unit);
      return scale === 1 ? unpack(values) : Array.from(unpack(values), (value) => value * scale);
    };
    this.values = new Map(packed.fields.map((field) => [field.name, shown(field.name, field.values)]));
    const { surface } = packed; // only if three coordinates are swept
    this.surface = surface && { vertices: surface.vertices.map(unpack), triangles: unpack(surface.triangles) };
  }
  centre(axis, k) {
    return this.axes[axis].lower + (k + 0.5) * this.axes[axis].step;
  }
  centres(axis) {
    return Array.from({ length: this.axes[axis].cells }, (_, k) => this.centre(axis, k));
  }
  /** Index along an axis of the cells that contain a coordinate value; -1 if it is outside the grid. */
  layer(axis, value) {
    const k = Math.floor((value - this.axes[axis].lower) / this.axes[axis].step);
    return k >= 0 && k < this.axes[axis].cells ? k : -1;
  }
  /** valueOf(cell) for the cells of a plane: rows along the axis `up` (one row if undefined), columns along `across`. */
  matrix(across, up, valueOf) {
    const steps = up === undefined ? 1 : this.axes[up].cells;
    return Array.from({ length: steps }, (_, j) =>
      Array.from({ length: this.axes[across].cells }, (_, i) =>
        valueOf(i * this.strides[across] + (j && j * this.strides[up])),
      ),
    );
  }
  /** Values of a field on a slice, one layer of the axis `fixed`; null at infeasible cells. Without a field: 1. */
  slice(field, { fixed, across, up }, layer) {
    const values = this.values.get(field);
    return this.matrix(across, up, (cell) => {
      if (layer < 0) return null;
      const index = this.feasibleIndex[cell + (layer && layer * this.strides[fixed])];
      if (index < 0) return null;
      const value = values ? values[index] : 1;
      return Number.isFinite(value) ? value : null;
    });
  }
  /** Total length of the feasible cells along the axis `along`, for each line of cells. */
  lengths(along, across, up) {
    const { cells, step } = this.axes[along];
    return this.matrix(across, up, (cell) => {
      let sum = 0;
      for (let k = 0; k < cells; ++k) sum += this.feasible[cell + k * this.strides[along]];
      return sum ? sum * step : null;
    });
  }
}

/** Order in which axes are drawn: x, y, others, rotations, z, so that z, or otherwise a rotation, points up. */
function drawingOrder(axes) {
  const rank = (axis) => ["x", "y", "other", "rotation", "z"].indexOf(axis.role);
  return [...axes.keys()].sort((a, b) => rank(axes[a]) - rank(axes[b]));
}

/** Common axis range of the plots of all designs, in displayed units: the feasible cells and a margin. */
function sharedRange(designs, axis) {
  const [low, high] = feasibleRange(designs, axis),
    { unit, step } = designs[0].axes[axis];
  const margin = 1.2 * step + 0.02 * (high - low);
  return [(low - margin) * shownScale(unit), (high + margin) * shownScale(unit)];
}

/** Value below which this share of the values lies. */
function percentile(sorted, share) {
  return sorted[Math.round(share * (sorted.length - 1))];
}

/**
 * Range of the colours of a field: the 2nd to the 98th percentile over the feasible cells of all designs. A few extreme
 * values would otherwise give most cells the same colour.
 */
function fieldRange(designs, field) {
  const key = "range of " + field; // sorting takes long
  const ranges = designs.map((design) => {
    if (!design[key]) {
      const sorted = Float64Array.from(design.values.get(field) ?? []).filter(Number.isFinite).sort();
      design[key] = sorted.length ? [percentile(sorted, 0.02), percentile(sorted, 0.98)] : [];
    }
    return design[key];
  });
  const [low, high] = rangeOf(ranges.flat());
  return high - low > 1e-9 * Math.abs(high) ? [low, high] : widened([low, high]); // the field is constant
}

/**
 * Plot of a matrix from Cells, with axes common to all designs: a heat map of a plane, or a curve over one coordinate.
 * @param style  see planeTraces()
 */
function cellsPlot(designs, design, matrix, across, up, style) {
  if (up !== undefined)
    return { data: planeTraces(design, matrix, across, up, style), layout: planeAxes(designs, across, up) };
  const h = design.axes[across];
  return {
    data: [
      {
        type: "scatter",
        mode: "lines+markers",
        x: design.centres(across).map((value) => value * shownScale(h.unit)),
        y: matrix[0],
        line: { color: seriesColours[0], width: 2 },
        marker: { size: 4, color: seriesColours[0] },
        hovertemplate: `${label(h.name)} %{x:.4g} ${label(unitText(shownUnit(h.unit)))}<br>${label(style.title)} %{y:.4g} ${label(unitText(style.unit))}<extra></extra>`,
      },
    ],
    layout: {
      xaxis: axis(axisTitle(h), { range: sharedRange(designs, across), zeroline: false }),
      yaxis: axis(axisName(style.title, style.unit), { range: widened(style.range) }),
    },
  };
}

/** Axes of a plane, with equal scales if both are lengths. */
function planeAxes(designs, across, up) {
  const [h, v] = [designs[0].axes[across], designs[0].axes[up]];
  const toScale = h.unit === v.unit && h.unit === "m";
  return {
    xaxis: axis(axisTitle(h), { range: sharedRange(designs, across), zeroline: false, constrain: "domain" }),
    yaxis: axis(axisTitle(v), {
      range: sharedRange(designs, up),
      zeroline: false,
      ...(toScale ? { scaleanchor: "x", constrain: "domain" } : {}),
    }),
  };
}

/**
 * Traces of a matrix on a plane: a heat map and contour lines.
 * @param style  { range, title, unit } of the values; whether to draw contour `lines` and a colour `bar`; `colours`
 */
function planeTraces(
  design,
  matrix,
  across,
  up,
  { range, title, unit, lines = true, bar = true, colours = fieldColours() },
) {
  const [h, v] = [design.axes[across], design.axes[up]];
  const x = design.centres(across).map((value) => value * shownScale(h.unit)),
    y = design.centres(up).map((value) => value * shownScale(v.unit));
  const text = unitText(unit);
  const traces = [
    {
      type: "heatmap",
      x,
      y,
      z: matrix,
      colorscale: colours,
      zmin: range[0],
      zmax: range[1],
      showscale: bar,
      hoverongaps: false,
      colorbar: colourBar(axisName(title, unit)),
      hovertemplate: `${label(h.name)} %{x:.4g} ${label(unitText(shownUnit(h.unit)))}<br>${label(v.name)} %{y:.4g} ${label(unitText(shownUnit(v.unit)))}<br>${label(title)} %{z:.4g}${text ? " " + label(text) : ""}<extra></extra>`,
    },
  ];
  if (lines && range[1] > range[0])
    traces.push({
      type: "contour",
      x,
      y,
      z: matrix,
      showscale: false,
      hoverinfo: "skip",
      autocontour: true,
      ncontours: 9,
      colorscale: [
        [0, "#ffffff"],
        [1, "#ffffff"],
      ],
      zmin: range[0],
      zmax: range[1],
      contours: { coloring: "lines", showlabels: true, labelfont: { size: 11, color: "#ffffff" } },
      line: { width: 1 },
      connectgaps: false,
    });
  return traces;
}

/** Range of an axis that the feasible cells of all designs cover. */
function feasibleRange(designs, axis) {
  const ranges = designs.map((design) => {
    design.extents ??= design.axes.map((_, k) => {
      const used = design.feasible.reduce(
        (set, feasible, cell) =>
          feasible ? set.add(Math.floor(cell / design.strides[k]) % design.axes[k].cells) : set,
        new Set(),
      );
      return [design.centre(k, Math.min(...used)), design.centre(k, Math.max(...used))];
    });
    return design.extents[axis];
  });
  return [Math.min(...ranges.map((r) => r[0])), Math.max(...ranges.map((r) => r[1]))];
}

/**
 * Adds controls for a slice: the fixed coordinate and its value. Workspaces of one or two coordinates need no slice.
 * @returns { fixed, across, up, layer(design) }: the current axes, undefined if the workspace has no such axis, and the
 * layer of a design on the fixed axis
 */
function sliceControls(parent, designs, changed) {
  const first = designs[0],
    order = drawingOrder(first.axes);
  if (order.length < 3) return { across: order[0], up: order[1], layer: () => 0 };
  const names = order.map((k) => first.axes[k].name);
  const rotation = order.findIndex((k) => first.axes[k].role === "rotation");
  const steps = 41;
  let position = (steps - 1) / 2;
  const slice = {
    fixed: order[rotation >= 0 ? rotation : 2],
    get across() {
      return order.filter((k) => k !== slice.fixed)[0];
    },
    get up() {
      return order.filter((k) => k !== slice.fixed)[1];
    },
    get value() {
      const [low, high] = feasibleRange(designs, slice.fixed);
      return low + ((high - low) * position) / (steps - 1);
    },
    layer: (design) => design.layer(slice.fixed, slice.value),
  };
  choice(parent, "slice at", names, order.indexOf(slice.fixed), (k) => {
    slice.fixed = order[k];
    positionSlider.set((position = (steps - 1) / 2));
    changed();
  });
  const positionSlider = slider(
    parent,
    "",
    steps,
    position,
    () => shownValue(slice.value, first.axes[slice.fixed]),
    (k) => {
      position = k;
      changed();
    },
  );
  positionSlider.node.querySelector("input").setAttribute("aria-label", "position of the slice");
  return slice;
}
