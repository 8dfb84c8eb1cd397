// What the study's motions ask of the drives: positions, speeds, forces and power against time.

// Of joints by their unit: title, name, unit and what is shown of it in SI. Power has one unit for all.
const motionColumns = {
  positions: {
    m: ["Positions of the joints", "position", "mm", 1000],
    rad: ["Angles of the joints", "angle", "deg", 180 / Math.PI],
  },
  speeds: { m: ["Speeds", "speed", "m/s", 1], rad: ["Angular speeds", "angular speed", "rad/s", 1] },
  forces: { m: ["Drive forces", "force", "N", 1], rad: ["Drive torques", "torque", "N m", 1] },
  power: { "": ["Power of the drives", "power", "W", 1] },
};

// Of the auxiliary chain; the last is the unit per radian.
const chainColumns = [
  ["angles", "Angles of the auxiliary chain", "angle", "deg", 180 / Math.PI],
  ["speeds", "Its angular speeds", "angular speed", "rad/s", 1],
  ["accelerations", "Its angular accelerations", "angular acceleration", "rad/s^2", 1],
];

/** How an array of sums that cancel is told: what is rounding beside the rest is 0. */
function beside(value, size) {
  return Math.abs(value) < 1e-9 * Math.abs(size) ? 0 : value;
}

const turns = (coordinate) => coordinate.unit === "rad";

function timesOf(motion) {
  return Array.from({ length: motion.samples }, (_, k) => (motion.duration * k) / (motion.samples - 1));
}

/**
 * One line for each of `names`, of every design.
 * @param names     null: this curve is not meant
 * @param curvesOf  packed; what is shown is `scale` times it
 */
function motionTraces(motion, names, unit, scale, curvesOf) {
  const time = timesOf(motion);
  const meant = [...names.keys()].filter((i) => names[i] !== null);
  return motion.designs.flatMap((design, d) =>
    (curvesOf(design) ? meant.map((i) => [curvesOf(design)[i], i]) : []).map(([packed, i]) => ({
      type: "scatter",
      mode: "lines",
      x: time,
      y: Array.from(unpack(packed), (value) => value * scale),
      name: label(names[i]),
      legendgroup: names[i],
      showlegend: d === 0,
      line: { color: limbColours[i], width: d ? 1.5 : 2.5, dash: d ? "dash" : "solid" },
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
    yaxis: turns(coordinates[c]) ? "y2" : "y",
    line: { color: seriesColours[c], width: 2, dash: turns(coordinates[c]) ? "dot" : "solid" },
    hovertemplate: `%{y:.4g} ${shownUnit(coordinates[c].unit)} at %{x:.4g} s<extra>${label(coordinates[c].name)}</extra>`,
  }));
}

/** Lengths on the left, angles on the right, or on the left where there is nothing else. */
function poseAxes(coordinates) {
  const angles = coordinates.filter(turns),
    lengths = angles.length < coordinates.length;
  const right = axis(axisName(angles.length === 1 ? angles[0].name : "angle", "deg"), {
    ...(lengths ? { overlaying: "y", side: "right", showgrid: false } : {}),
  });
  return {
    xaxis: axis("time [s]"),
    ...(lengths ? { yaxis: axis("position [mm]") } : {}),
    ...(angles.length ? { yaxis2: right } : {}),
    showlegend: true, // also of one coordinate
  };
}

function motionSummary(motion, joints) {
  const rows = [],
    head = ["design", "", ...joints.map((joint) => joint.name), "all"];
  const unitsOf = (column) => joints.map((joint) => motionColumns[column][joint.unit][2]);
  for (const { name, summary } of motion.designs) {
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
    add("root mean square of force", summary.rms_force, unitsOf("forces"));
    add(
      "peak power",
      summary.peak_power,
      joints.map(() => "W"),
      summary.peak_total_power,
    );
    if (summary.energy !== undefined) {
      rows.push([
        name,
        "energy, braking giving back",
        ...joints.map(() => ""),
        quantity(beside(summary.energy, summary.energy_drawn), "J", 4),
      ]);
      rows.push([name, "energy drawn", ...joints.map(() => ""), quantity(summary.energy_drawn, "J", 4)]);
    }
  }
  return simpleTable(head, rows);
}

/** Sentences on the samples that are not feasible. */
function obstacles(motion) {
  return motion.designs.flatMap(({ name, reasons }) => {
    const broken = reasons.map((reason, k) => [reason, k]).filter(([reason]) => reason);
    if (!broken.length) return [];
    const at = (k) => digits((motion.duration * k) / (motion.samples - 1), 3) + " s";
    return [
      `The design “${name}” cannot follow: ${count(broken.length, "sample")} of ${motion.samples} not feasible, first at ${at(broken[0][1])}: ${broken[0][0]}.`,
    ];
  });
}

function showMotions(study, section) {
  const { motions, joints, chain, coordinates } = study.motions;
  section.append(
    element(
      "p",
      "lead",
      "Exact speeds and accelerations of the joints" +
        (motions[0].designs.some((d) => d.forces) ? ", and the forces and power that they take" : "") +
        ". The best design in solid lines, the baseline dashed.",
    ),
  );
  if (study.motions.left_out)
    section.append(
      element(
        "p",
        "lead",
        `The page has the first ${motions.length} of the study's ${motions.length + study.motions.left_out} motions. ` +
          "“pkmopt trajectory --from " +
          (study.file || "FILE.h5") +
          " --motion NAME --csv NAME.csv” computes each of the others.",
      ),
    );
  const controls = element("div", "controls"),
    grid = element("div", "grid"),
    notes = element("div");
  section.append(controls, notes, grid);
  const table = element("div", "panel");
  const plots = [];
  const motion = () => motions[which.value];
  const tell = () => {
    notes.replaceChildren(...obstacles(motion()).map((text) => element("p", "warning", text)));
    table.replaceChildren(element("h3", "", "In numbers"), motionSummary(motion(), joints));
  };
  const which =
    motions.length > 1
      ? choice(
          controls,
          "motion",
          motions.map((m) => m.name),
          0,
          () => {
            tell();
            plots.forEach((plot) => plot.update());
          },
        )
      : { value: 0 };
  tell();
  plots.push(
    addPlot(grid, {
      title: "The motion" + (motions.length > 1 ? "" : ", " + motions[0].name),
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
  for (const [key, title, name, unit, scale] of chainColumns)
    addCurves(title, name, unit, scale, chain, (design) => design.chain?.[key]);
  plots.push(
    addPlot(grid, {
      title: "Conditioning",
      size: "half",
      height: 360,
      make: () => ({
        data: conditioningAlong(motion()),
        layout: { xaxis: axis("time [s]"), yaxis: axis("inverse condition number [1]", { rangemode: "tozero" }) },
      }),
    }),
  );
  grid.append(table);
}
