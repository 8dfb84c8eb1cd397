// Panel "Motions": positions, speeds, forces and power of the joints over time along the motions of the study.

// Plots of joint quantities by unit of the joint ("": any): title, name of the axis, displayed unit, factor from SI.
const motionColumns = {
  positions: {
    m: ["Positions of the joints", "position", "mm", 1000],
    rad: ["Angles of the joints", "angle", "deg", 180 / Math.PI],
  },
  speeds: { m: ["Speeds", "speed", "m/s", 1], rad: ["Angular speeds", "angular speed", "rad/s", 1] },
  forces: { m: ["Drive forces", "force", "N", 1], rad: ["Drive torques", "torque", "N m", 1] },
  power: { "": ["Power of the drives", "power", "W", 1] },
};

/** Replaces a sum whose terms cancel by 0 if it is a rounding error relative to `size`. */
function withoutRounding(value, size) {
  return Math.abs(value) < 1e-9 * Math.abs(size) ? 0 : value;
}

const isRotation = (coordinate) => coordinate.unit === "rad";

function timesOf(motion) {
  return Array.from({ length: motion.samples }, (_, k) => (motion.duration * k) / (motion.samples - 1));
}

/**
 * One curve per name and design.
 * @param names     names of the curves; null: omit this curve
 * @param scale     factor from SI to `unit`
 * @param curvesOf  curvesOf(design) gives the packed curves, or null
 */
function motionTraces(motion, names, unit, scale, curvesOf) {
  const time = timesOf(motion);
  const included = [...names.keys()].filter((i) => names[i] !== null);
  return motion.designs.flatMap((design, d) =>
    (curvesOf(design) ? included.map((i) => [curvesOf(design)[i], i]) : []).map(([packed, i]) => ({
      type: "scatter",
      mode: "lines",
      x: time,
      y: Array.from(unpack(packed), (value) => value * scale),
      name: label(names[i]),
      legendgroup: names[i],
      showlegend: d === 0,
      line: { color: limbColours[i % limbColours.length], width: d ? 1.5 : 2.5, dash: d ? "dash" : "solid" },
      hovertemplate: `%{y:.4g} ${label(unitText(unit))} at %{x:.4g} s<extra>${label(names[i] + ", " + design.name)}</extra>`,
    })),
  );
}

function conditioningAlong(motion) {
  return motion.designs.map((design, d) => ({
    type: "scatter",
    mode: "lines",
    x: timesOf(motion),
    y: unpack(design.conditioning),
    name: label(design.name),
    line: { color: seriesColours[d], width: d ? 1.5 : 2.5, dash: d ? "dash" : "solid" },
    hovertemplate: `%{y:.4f} at %{x:.4g} s<extra>${label(design.name)}</extra>`,
  }));
}

function posesAlong(motion, coordinates) {
  const time = timesOf(motion);
  return motion.designs[0].poses.map((packed, c) => ({
    type: "scatter",
    mode: "lines",
    x: time,
    y: Array.from(unpack(packed), (value) => value * shownScale(coordinates[c].unit)),
    name: label(coordinates[c].name),
    yaxis: isRotation(coordinates[c]) ? "y2" : "y",
    line: { color: seriesColours[c], width: 2, dash: isRotation(coordinates[c]) ? "dot" : "solid" },
    hovertemplate: `%{y:.4g} ${shownUnit(coordinates[c].unit)} at %{x:.4g} s<extra>${label(coordinates[c].name)}</extra>`,
  }));
}

/** Axes for lengths on the left and angles on the right; angles on the left if there are no lengths. */
function poseAxes(coordinates) {
  const angles = coordinates.filter(isRotation),
    lengths = angles.length < coordinates.length;
  const right = axis(axisName(angles.length === 1 ? angles[0].name : "angle", "deg"), {
    ...(lengths ? { overlaying: "y", side: "right", showgrid: false } : {}),
  });
  return {
    xaxis: axis("time [s]"),
    ...(lengths ? { yaxis: axis("position [mm]") } : {}),
    ...(angles.length ? { yaxis2: right } : {}),
    showlegend: true, // also for a single coordinate
  };
}

function motionSummary(motion, joints) {
  const rows = [],
    head = ["design", "", ...joints.map((joint) => joint.name), "all"];
  const unitsOf = (column) => joints.map((joint) => motionColumns[column][joint.unit][2]);
  for (const { name, summary, drives } of motion.designs) {
    const add = (title, values, units, total) =>
      values &&
      rows.push([
        name,
        title,
        ...values.map((v, i) => quantity(v, units[i], 4)),
        total === undefined || total === null ? "" : quantity(total, units[0], 4),
      ]);
    add("peak speed", summary.peak_speed, unitsOf("speeds"));
    add("peak force", summary.peak_force, unitsOf("forces"));
    add("RMS force", summary.rms_force, unitsOf("forces"));
    add(
      "peak power",
      summary.peak_power,
      joints.map(() => "W"),
      summary.peak_total_power,
    );
    const all = (unit) => joints.map(() => unit);
    add("peak motor torque", summary.peak_motor_torque, all("N m"));
    add("RMS motor torque", summary.rms_motor_torque, all("N m"));
    add("peak motor speed", summary.peak_motor_speed, all("rad/s"));
    if (drives) rows.push([name, "drives", ...joints.map(() => ""), drivesText(drives)]);
    if (summary.energy !== undefined) {
      rows.push([
        name,
        "energy with regeneration",
        ...joints.map(() => ""),
        quantity(withoutRounding(summary.energy, summary.energy_drawn), "J", 4),
      ]);
      rows.push([name, "energy without regeneration", ...joints.map(() => ""), quantity(summary.energy_drawn, "J", 4)]);
    }
  }
  return simpleTable(head, rows);
}

/** One sentence per design that has infeasible samples. */
function infeasibleSamples(motion) {
  return motion.designs.flatMap(({ name, reasons }) => {
    const infeasible = reasons.map((reason, k) => [reason, k]).filter(([reason]) => reason);
    if (!infeasible.length) return [];
    const at = (k) => digits((motion.duration * k) / (motion.samples - 1), 3) + " s";
    return [
      `The design “${name}” cannot follow the motion: ${infeasible.length} of ${count(motion.samples, "sample")} are infeasible, the first at ${at(infeasible[0][1])}: ${infeasible[0][0]}.`,
    ];
  });
}

function showMotions(study, panel) {
  const { motions, joints, quantities, coordinates } = study.motions;
  panel.append(
    element(
      "p",
      "lead",
      "Positions and exact speeds of the joints" +
        (motions[0].designs.some((d) => d.forces) ? ", with the drive forces and power" : "") +
        ". Solid lines: best design; dashed lines: baseline.",
    ),
  );
  if (study.motions.omitted)
    panel.append(
      element(
        "p",
        "lead",
        `The page includes the first ${motions.length} of the study's ${motions.length + study.motions.omitted} motions. ` +
          "“pkmopt trajectory --from " +
          (study.file || "FILE.h5") +
          " --motion NAME --csv NAME.csv” computes each of the others.",
      ),
    );
  const controls = element("div", "controls"),
    grid = element("div", "grid"),
    notes = element("div");
  panel.append(controls, notes, grid);
  const table = element("div", "box");
  const plots = [];
  const motion = () => motions[selected.value];
  const showMotion = () => {
    notes.replaceChildren(...infeasibleSamples(motion()).map((text) => element("p", "warning", text)));
    table.replaceChildren(element("h3", "", "Summary"), motionSummary(motion(), joints));
  };
  const selected =
    motions.length > 1
      ? choice(
          controls,
          "motion",
          motions.map((m) => m.name),
          0,
          () => {
            showMotion();
            plots.forEach((plot) => plot.update());
          },
        )
      : { value: 0 };
  showMotion();
  plots.push(
    addPlot(grid, {
      title: "Motion" + (motions.length > 1 ? "" : ", " + motions[0].name),
      size: "half",
      height: 360,
      make: () => ({
        data: posesAlong(motion(), coordinates),
        layout: poseAxes(coordinates),
      }),
    }),
  );
  const addCurves = (title, name, unit, scale, names, curvesOf) => {
    if (!motions.some((m) => m.designs.some(curvesOf))) return;
    plots.push(
      addPlot(grid, {
        title,
        size: "half",
        height: 360,
        make: () => ({
          data: motionTraces(motion(), names, unit, scale, curvesOf),
          layout: { xaxis: axis("time [s]"), yaxis: axis(axisName(name, unit)) },
        }),
      }),
    );
  };
  for (const [key, kinds] of Object.entries(motionColumns))
    for (const [kind, [title, name, unit, scale]] of Object.entries(kinds)) {
      const names = joints.map((joint) => (kind && joint.unit !== kind ? null : joint.name));
      if (names.some(Boolean)) addCurves(title, name, unit, scale, names, (design) => design[key]);
    }
  for (const unit of new Set(quantities.map((quantity) => quantity.unit))) {
    const names = quantities.map((quantity) => (quantity.unit === unit ? quantity.name : null));
    const [shown, scale] = unit === "rad" ? ["deg", 180 / Math.PI] : [unit, 1];
    addCurves(`Quantities in ${shown}`, "quantity", shown, scale, names, (design) => design.quantities);
  }
  plots.push(
    addPlot(grid, {
      title: "Conditioning",
      size: "half",
      height: 360,
      make: () => ({
        data: conditioningAlong(motion()),
        layout: { xaxis: axis("time [s]"), yaxis: axis("conditioning", { rangemode: "tozero" }) },
      }),
    }),
  );
  grid.append(table);
}
