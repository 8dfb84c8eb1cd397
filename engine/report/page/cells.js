// The cells of a workspace: which are feasible, their fields, cuts through them. Lengths are shown in mm, angles in degrees.

function axisTitle(axis) {
  return axisName(axis.name, shownUnit(axis.unit));
}
function shownValue(value, axis, count = 4) {
  const shown = value * shownScale(axis.unit);
  return quantity(Math.abs(shown) < 1e-9 ? 0 : shown, shownUnit(axis.unit), count); // rounding of a middle is 0
}

/** "dci_1" as people say it. */
function fieldTitle(name, joints) {
  const limb = /^dci_(\d)$/.exec(name);
  if (limb) return "DCI of limb " + limb[1] + (joints ? " (" + joints[limb[1] - 1] + ")" : "");
  return (
    {
      dci_worst: "largest DCI",
      conditioning: "conditioning",
      margin: "least margin",
      inertia_condition: "conditioning of inertia",
    }[name] || name
  );
}

/** The packed workspace of one design, unpacked. */
class Cells {
  constructor(packed) {
    Object.assign(this, packed);
    this.axes = packed.axes.map((axis) => ({ ...axis, step: (axis.upper - axis.lower) / axis.cells }));
    this.strides = this.axes.map((_, k) => this.axes.slice(k + 1).reduce((product, axis) => product * axis.cells, 1));
    this.feasible = unpack(packed.feasible);
    this.number = new Int32Array(this.strides[0] * this.axes[0].cells).fill(-1);
    let count = 0;
    for (let cell = 0; cell < this.number.length; ++cell) if (this.feasible[cell]) this.number[cell] = count++;
    this.values = new Map(packed.fields.map((field) => [field.name, unpack(field.values)]));
    const { surface } = packed; // of three axes only
    this.surface = surface && {
      at: surface.vertices.map(unpack),
      triangles: unpack(surface.triangles),
      values: new Map(Object.entries(surface.values).map(([field, values]) => [field, unpack(values)])),
    };
  }
  centre(axis, k) {
    return this.axes[axis].lower + (k + 0.5) * this.axes[axis].step;
  }
  centres(axis) {
    return Array.from({ length: this.axes[axis].cells }, (_, k) => this.centre(axis, k));
  }
  /** The layer that holds a value; -1 outside. */
  layer(axis, value) {
    const k = Math.floor((value - this.axes[axis].lower) / this.axes[axis].step);
    return k >= 0 && k < this.axes[axis].cells ? k : -1;
  }
  /** What `of` says of cells: rows along `up` (one if it is undefined), columns along `across`. */
  matrix(across, up, of) {
    const steps = up === undefined ? 1 : this.axes[up].cells;
    return Array.from({ length: steps }, (_, j) =>
      Array.from({ length: this.axes[across].cells }, (_, i) =>
        of(i * this.strides[across] + (j && j * this.strides[up])),
      ),
    );
  }
  /** A field on a cut; null where there is none. */
  cut(field, { fixed, across, up }, layer) {
    const values = this.values.get(field);
    return this.matrix(across, up, (cell) => {
      if (layer < 0) return null;
      const number = this.number[cell + (layer && layer * this.strides[fixed])];
      if (number < 0) return null;
      const value = values ? values[number] : 1;
      return Number.isFinite(value) ? value : null;
    });
  }
  /** Length of the feasible cells along an axis. */
  lengths(along, across, up) {
    const { cells, step } = this.axes[along];
    return this.matrix(across, up, (cell) => {
      let sum = 0;
      for (let k = 0; k < cells; ++k) sum += this.feasible[cell + k * this.strides[along]];
      return sum ? sum * step : null;
    });
  }
}

/** The axes as they are drawn: x, y, rotations, z, so that z or else a rotation points up. */
function drawingOrder(axes) {
  const place = (axis) => ["x", "y", "other", "turn", "z"].indexOf(axis.role);
  return [...axes.keys()].sort((a, b) => place(axes[a]) - place(axes[b]));
}

/** What both designs' pictures span, in shown units: the feasible cells and a little room. */
function sharedRange(designs, axis) {
  const [low, high] = feasibleRange(designs, axis),
    { unit, step } = designs[0].axes[axis];
  const room = 1.2 * step + 0.02 * (high - low);
  return [(low - room) * shownScale(unit), (high + room) * shownScale(unit)];
}

/** Range of a field over all designs. */
function fieldRange(designs, field) {
  const [low, high] = rangeOf(designs.flatMap((d) => rangeOf(d.values.get(field) || [])));
  return high - low > 1e-9 * Math.abs(high) ? [low, high] : widened([low, high]); // of a constant
}

/**
 * What a matrix of Cells says, on the axes that all designs share: cells of a plane in colour, or along one coordinate a
 * curve.
 */
function cellsPicture(designs, design, matrix, across, up, look) {
  if (up !== undefined)
    return { data: planeTraces(design, matrix, across, up, look), layout: planeAxes(designs, across, up) };
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
        hovertemplate: `${label(h.name)} %{x:.4g} ${label(unitText(shownUnit(h.unit)))}<br>${label(look.title)} %{y:.4g} ${label(unitText(look.unit))}<extra></extra>`,
      },
    ],
    layout: {
      xaxis: axis(axisTitle(h), { range: sharedRange(designs, across), zeroline: false }),
      yaxis: axis(axisName(look.title, look.unit), { range: widened(look.range) }),
    },
  };
}

/** Axes of a plane, to scale where both are lengths. */
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

/** A field on a plane: cells in colour, and contour lines where there is room for them. */
function planeTraces(
  design,
  matrix,
  across,
  up,
  { range, title, unit, lines = true, bar = true, colours = fieldColours },
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

/** Between which values of an axis the designs have feasible cells. */
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
 * Controls for a cut: which coordinate is held, and where. A workspace of fewer than three is shown whole.
 * @returns { fixed, across, up, layer(design) }, always as they are set; undefined where there is no such axis
 */
function cutControls(parent, designs, changed) {
  const first = designs[0],
    order = drawingOrder(first.axes);
  if (order.length < 3) return { across: order[0], up: order[1], layer: () => 0 };
  const names = order.map((k) => first.axes[k].name);
  const rotation = order.findIndex((k) => first.axes[k].role === "turn");
  const steps = 41;
  let place = (steps - 1) / 2;
  const cut = {
    fixed: order[rotation >= 0 ? rotation : 2],
    get across() {
      return order.filter((k) => k !== cut.fixed)[0];
    },
    get up() {
      return order.filter((k) => k !== cut.fixed)[1];
    },
    get value() {
      const [low, high] = feasibleRange(designs, cut.fixed);
      return low + ((high - low) * place) / (steps - 1);
    },
    layer: (design) => design.layer(cut.fixed, cut.value),
  };
  choice(parent, "cut at", names, order.indexOf(cut.fixed), (k) => {
    cut.fixed = order[k];
    where.set((place = (steps - 1) / 2));
    changed();
  });
  const where = slider(
    parent,
    "",
    steps,
    place,
    () => shownValue(cut.value, first.axes[cut.fixed]),
    (k) => {
      place = k;
      changed();
    },
  );
  where.node.querySelector("input").setAttribute("aria-label", "where to cut");
  return cut;
}
