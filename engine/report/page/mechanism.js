// Panel "Mechanism": the links to scale at the stored poses, in front view, top view and 3-D, with the workspace.

const otherColours = ["#56b4e9", "#d55e00", "#b8a000", "#009e73", "#cc79a7", "#0072b2"]; // of parts that are no limbs

function partColour(part, parts) {
  if (part === "frame") return "#8893a0";
  if (part === "motors") return document.documentElement.dataset.theme === "dark" ? "#b3bdc8" : "#4d5966";
  if (part === "platform") return document.documentElement.dataset.theme === "dark" ? "#e2e6eb" : "#2b3440";
  const isLimb = (name) => name.startsWith("limb ");
  if (isLimb(part)) return limbColours[parts.filter(isLimb).indexOf(part) % limbColours.length];
  const others = parts.filter((name) => !isLimb(name) && !/^(frame|motors|platform)$/.test(name));
  return otherColours[others.indexOf(part) % otherColours.length];
}

const cartesian = ["x", "y", "z"]; // roles of the coordinates that are positions in space
const isCartesian = (axis) => cartesian.includes(axis.role);

/** Indices of the workspace axes x, y and z, in this order; -1 if not swept. */
function cartesianAxes(cells) {
  return cartesian.map((role) => cells.axes.findIndex((axis) => axis.role === role));
}

/** Index of the first cell at given values of the non-Cartesian coordinates; null if they are outside the grid. */
function firstCellAt(cells, values) {
  const layers = cells.axes.map((axis, k) => (isCartesian(axis) ? 0 : cells.layer(k, values[axis.coordinate])));
  return layers.some((layer) => layer < 0) ? null : layers.reduce((sum, layer, k) => sum + layer * cells.strides[k], 0);
}

const toMillimetres = (values) => Array.from(values, (value) => value * shownScale("m"));

/**
 * Projection onto the plane of the axes h and v of the cells that are feasible at the rotation of a pose.
 * @returns null if h or v is not swept, or the rotation is outside the grid
 */
function projectWorkspace(cells, values, h, v) {
  const axes = cartesianAxes(cells);
  const [across, up] = [axes[h], axes[v]];
  const first = firstCellAt(cells, values);
  if (across < 0 || up < 0 || first === null) return null;
  const depth = axes[3 - h - v];
  const layers = depth < 0 ? [0] : Array.from({ length: cells.axes[depth].cells }, (_, k) => k * cells.strides[depth]);
  const z = Array.from({ length: cells.axes[up].cells }, (_, j) =>
    Array.from({ length: cells.axes[across].cells }, (_, i) =>
      layers.some((k) => cells.feasible[first + k + i * cells.strides[across] + j * cells.strides[up]]) ? 1 : null,
    ),
  );
  return { x: toMillimetres(cells.centres(across)), y: toMillimetres(cells.centres(up)), z };
}

/** Traces of a pose projected onto the plane of the axes h and v (0: x, 1: y, 2: z). */
function viewTraces(poses, pose, cells, values, [h, v]) {
  const traces = [];
  const projection = cells && projectWorkspace(cells, values, h, v);
  if (projection)
    traces.push({
      type: "heatmap",
      ...projection,
      colorscale: [
        [0, "#56b4e9"],
        [1, "#56b4e9"],
      ],
      showscale: false,
      opacity: 0.28,
      hoverinfo: "skip",
    });
  const seen = new Set();
  for (const link of poses.linksAt(pose)) {
    const ink = partColour(link.part, poses.parts);
    traces.push({
      type: "scatter",
      mode: "lines",
      ...capsuleOutline([link.from[h], link.from[v]], [link.to[h], link.to[v]], link.radius),
      fill: "toself",
      fillcolor: faded(ink, 0.75),
      line: { color: ink, width: 1 },
      name: label(link.part),
      legendgroup: link.part,
      showlegend: !seen.has(link.part),
      hoveron: "fills",
      hoverinfo: "text",
      text: label(link.part + ": " + link.name),
    });
    seen.add(link.part);
  }
  return traces;
}

/**
 * 3-D trace of the workspace. If x, y and z are swept, it is the boundary surface. Otherwise it shows the feasible
 * cells at the pose's values of the other coordinates, as a layer or a line through the platform.
 * @param position  of the platform, [x, y, z] in mm
 * @returns null if nothing is feasible there
 */
function workspaceTrace(cells, values, position) {
  const style = {
    type: "mesh3d",
    color: "#56b4e9",
    opacity: 0.22,
    hoverinfo: "skip",
    name: "workspace",
    showlegend: true,
  };
  const order = cartesianAxes(cells);
  if (order.every((k) => k >= 0)) {
    const { vertices, triangles } = cells.surface;
    const corner = (c) => Array.from({ length: triangles.length / 3 }, (_, t) => triangles[3 * t + c]);
    const [x, y, z] = order.map((axis) => toMillimetres(vertices[axis]));
    return { ...style, x, y, z, i: corner(0), j: corner(1), k: corner(2) };
  }
  const first = firstCellAt(cells, values),
    mesh = { x: [], y: [], z: [], i: [], j: [], k: [] };
  const [a, b] = cells.axes.flatMap((axis, k) => (isCartesian(axis) ? [k] : []));
  if (first === null || a === undefined) return null;
  if (b === undefined) {
    const line = toMillimetres(cells.centres(a)).map((value, k) =>
      cells.feasible[first + k * cells.strides[a]] ? value : null,
    );
    const points = cartesian.map((role, c) => line.map((value) => (cells.axes[a].role === role ? value : position[c])));
    const { color, hoverinfo, name, showlegend } = style;
    return {
      type: "scatter3d",
      mode: "lines",
      ...{ x: points[0], y: points[1], z: points[2] },
      line: { color, width: 8 },
      ...{ hoverinfo, name, showlegend },
    };
  }
  for (let p = 0; p < cells.axes[a].cells; ++p)
    for (let q = 0; q < cells.axes[b].cells; ++q) {
      if (!cells.feasible[first + p * cells.strides[a] + q * cells.strides[b]]) continue;
      const corner = mesh.x.length;
      for (const [da, db] of [
        [0, 0],
        [1, 0],
        [1, 1],
        [0, 1],
      ]) {
        const node = { [a]: p + da, [b]: q + db };
        cartesian.forEach((role, c) => {
          const axis = cells.axes[order[c]];
          mesh[role].push(axis ? shownScale("m") * (axis.lower + node[order[c]] * axis.step) : position[c]);
        });
      }
      mesh.i.push(corner, corner);
      mesh.j.push(corner + 1, corner + 2);
      mesh.k.push(corner + 2, corner + 3);
    }
  return mesh.x.length ? { ...style, ...mesh, lighting: { ambient: 1, diffuse: 0 } } : null;
}

/** 3-D traces of the links of a pose and, with cells, of the workspace. */
function spaceTraces(poses, pose, cells, values) {
  const meshes = new Map();
  for (const link of poses.linksAt(pose)) {
    if (!meshes.has(link.part)) meshes.set(link.part, { x: [], y: [], z: [], i: [], j: [], k: [], text: [] });
    addCapsule(meshes.get(link.part), link.from, link.to, link.radius, label(link.part + ": " + link.name));
  }
  const traces = [...meshes].map(([part, mesh]) => ({
    type: "mesh3d",
    ...mesh,
    color: partColour(part, poses.parts),
    name: label(part),
    showlegend: true,
    hovertemplate: "%{text}<extra></extra>",
    lighting: { ambient: 0.6, diffuse: 0.6, specular: 0.15, roughness: 0.7 },
    lightposition: { x: 1e4, y: -2e4, z: 3e4 },
  }));
  const workspace = cells && workspaceTrace(cells, values, poses.position(values));
  return workspace ? [...traces, workspace] : traces;
}

/**
 * A 3-D scene to scale.
 * @param ranges    [low, high] of x, y and z
 * @param distance  relative distance of the camera
 */
function spaceScene(ranges, distance) {
  const extents = ranges.map(([low, high]) => high - low),
    largest = Math.max(...extents);
  const [x, y, z] = extents.map((extent) => (1.35 * extent) / largest);
  return {
    xaxis: sceneAxis("x [mm]", ranges[0], extents[0] / largest),
    yaxis: sceneAxis("y [mm]", ranges[1], extents[1] / largest),
    zaxis: sceneAxis("z [mm]", ranges[2], extents[2] / largest),
    bgcolor: colour("box"), // not transparent, for recordings
    aspectmode: "manual",
    aspectratio: { x, y, z },
    camera: { eye: { x: 1.1 * distance, y: -1.45 * distance, z: 0.75 * distance }, center: { x: 0, y: 0, z: -0.1 } },
  };
}

const posesOf = (packed) => (packed.poses ??= new Poses(packed));

/** The workspace cells of the design with this name; null if the page has none. */
function cellsOf(study, name) {
  const found = study.workspace?.designs.find((design) => design.name === name);
  return found ? (found.cells ??= new Cells(found)) : null;
}

/** True if the mechanism moves in the x-y plane: its coordinates are x, y and at most one rotation. */
function isPlanar({ coordinates }) {
  const roles = coordinates.map((coordinate) => coordinate.role);
  return (
    ["x", "y"].every((role) => roles.includes(role)) &&
    roles.every((role, c) => /x|y/.test(role) || (role === "rotation" && roles.indexOf(role) === c))
  );
}

/**
 * The intervals of the joints' ranges that the first design uses: at the centres of the feasible cells, and along each
 * motion. None without joint positions or ranges.
 * @returns [{ by: "the workspace", joint, used: [low, high], share in percent }, ..]
 */
function jointUses({ workspace, motions }) {
  const packed = workspace?.designs[0];
  if (!packed?.joints) return [];
  const cells = (packed.cells ??= new Cells(packed));
  const use = (by, joint, values) => {
    if (!joint.range || !values) return [];
    const used = rangeOf(Array.from(values).filter(Number.isFinite));
    const share = Math.round((100 * (used[1] - used[0])) / (joint.range[1] - joint.range[0]));
    return Number.isFinite(share) ? [{ by, joint, used, share }] : [];
  };
  const inSI = (joint) => cells.values.get(joint.name)?.map((value) => value / shownScale(joint.unit)); // of display units
  return [
    ...packed.joints.flatMap((joint) => use("the workspace", joint, inSI(joint))),
    ...(motions?.motions ?? []).flatMap(({ name, designs: [{ positions }] }) =>
      packed.joints.flatMap((joint, i) => use("the motion " + name, joint, positions && unpack(positions[i]))),
    ),
  ];
}

/** Box with the used joint ranges as bars; null if they are unknown. */
function jointBox(study) {
  const uses = jointUses(study);
  if (!uses.length) return null;
  const box = element("div", "box", element("h3", "", "Used joint ranges"));
  for (const by of new Set(uses.map((use) => use.by))) {
    const bars = element("div", "bars");
    for (const { joint, used, share } of uses.filter((use) => use.by === by)) {
      const [low, high] = joint.range;
      const percent = (value) => (100 * (value - low)) / (high - low);
      const filled = element("i");
      filled.style.marginLeft = percent(used[0]) + "%";
      filled.style.width = percent(used[1]) - percent(used[0]) + "%";
      const [from, to] = used.map((value) => shownValue(value, joint, 3));
      const range = `${shownValue(low, joint, 3)} .. ${shownValue(high, joint, 3)}`;
      bars.append(
        element("span", "", joint.name),
        element("div", "bar", filled),
        element("span", "", `${share} %: ${from} .. ${to} of ${range}`),
      );
    }
    box.append(element("p", "caption", by[0].toUpperCase() + by.slice(1)), bars);
  }
  return box;
}

/** Bodies with equal masses whose names differ in numbers only: [{ name, number, mass of each }]. */
function massGroups(masses) {
  const groups = [];
  for (const { name, mass } of masses) {
    const common = name.replace(/\s*\d+/g, "");
    const known = groups.find((group) => group.name === common && Math.abs(group.mass - mass) <= 1e-9 * mass);
    if (known) ++known.number;
    else groups.push({ name: common, number: 1, mass });
  }
  return groups;
}

/** Box with the masses of the bodies of a design; null if the study uses no masses. */
function massBox({ name, masses }) {
  if (!masses) return null;
  const rows = massGroups(masses).map((group) => [
    group.name,
    String(group.number),
    measured(group.mass, "kg"),
    measured(group.number * group.mass, "kg"),
  ]);
  rows.push(["all", String(masses.length), "", measured(masses.reduce((sum, { mass }) => sum + mass, 0), "kg")]);
  return element(
    "div",
    "box",
    element("h3", "", "Masses of the moving bodies, " + name),
    element("p", "caption", "Without motors and other parts of the drive trains."),
    simpleTable(["body", "number", "mass of each", "mass of all"], rows),
  );
}

function showMechanism(study, panel) {
  const { designs, mode } = study.mechanism;
  const all = designs.map(posesOf);
  const rotates = all[0].coordinates.some((coordinate) => coordinate.role === "rotation");
  const planar = isPlanar(all[0]);
  const hasWorkspace = study.workspace?.designs.some((design) => design.axes.some(isCartesian));
  panel.append(
    element(
      "p",
      "lead",
      `Drawn to scale in working mode ${mode}. The sliders select one of the stored poses` +
        (all.some((design) => design.motions.length)
          ? "; the player shows the " + (study.motions?.omitted ? `first ${all[0].motions.length} ` : "") + "motions"
          : "") +
        (all.some((design) => design.parts.includes("motors")) ? ". The size of the motors is schematic" : "") +
        (hasWorkspace ? ". The blue region is the workspace" + (rotates ? " at this rotation" : "") : "") +
        ".",
    ),
  );
  const controls = element("div", "controls box"),
    grid = element("div", "grid");
  panel.append(grid);
  grid.append(controls);
  const playBar = element("div", "controls box");
  if (all.some((design) => design.motions.length)) grid.append(playBar);
  let poses,
    positions,
    sliders,
    player,
    spacePlot,
    plots = [];
  const feasibility = element("p", "feasibility"),
    readout = element("div", "readout");
  let sample = null; // { motion, k }: shows the k-th pose of a motion instead of the sliders' pose
  const currentPose = () => (sample ? sample.motion.first + sample.k : poses.pose(positions));
  const currentValues = () => (sample ? sample.motion.coordinates.map((c) => c[sample.k]) : poses.values(positions));
  const showFacts = () => {
    const pose = currentPose(),
      index = poses.assembledIndex[pose],
      reason = poses.reasons[poses.reason_index[pose]];
    feasibility.className = "feasibility " + (reason ? "worse" : "better");
    feasibility.textContent =
      (reason ? (index < 0 ? "Does not assemble: " : "Infeasible: ") + reason : "Feasible") + ".";
    readout.replaceChildren(
      ...(index < 0
        ? []
        : [
            ...poses.joints.map((joint, i) => [joint.name, shownValue(poses.joint_positions[i][index], joint)]),
            ["conditioning", digits(poses.conditioning[index])],
          ]
      ).map(([name, value]) => element("div", "", element("span", "", name + " "), element("b", "", value))),
    );
  };
  const update = () => {
    showFacts();
    plots.forEach((plot) => plot.update());
  };
  const chooseDesign = (i) => {
    poses = all[i];
    positions = poses.sliderPositions(poses.initial_pose);
    sliders?.forEach((control) => control.node.remove());
    sliders = poses.coordinates.map((coordinate, c) =>
      slider(
        controls,
        coordinate.name,
        coordinate.values.length,
        positions[c],
        (k) => shownValue(coordinate.values[k], coordinate),
        (k) => {
          positions[c] = k;
          player?.stop();
          sample = null;
          update();
        },
      ),
    );
    player?.stop();
    playBar.replaceChildren();
    sample = null;
    player = poses.motions.length
      ? addPlayer(
          playBar,
          poses.motions,
          (motion, k) => {
            sample = { motion, k };
            update();
          },
          () => spacePlot?.node.querySelector("canvas"),
        )
      : null;
    update();
  };
  if (all.length > 1)
    buttons(
      controls,
      "design",
      all.map((design) => design.name),
      0,
      chooseDesign,
    );
  chooseDesign(0);
  const ranges = all
    .map((design) => design.ranges())
    .reduce((a, b) => a.map(([low, high], c) => [Math.min(low, b[c][0]), Math.max(high, b[c][1])]));
  const [xs, ys, zs] = ranges;
  const [width, depth, height] = [xs, ys, zs].map(([low, high]) => high - low);
  const slim = Math.max(depth, height) > 1.6 * width;
  const column = element("div", "half column" + (slim ? " side-by-side" : ""));
  const addPlaneView = (title, h, v, height = slim ? 694 : 312) =>
    addPlot(column, {
      title,
      height,
      make: () => ({
        data: viewTraces(poses, currentPose(), cellsOf(study, poses.name), currentValues(), [h, v]),
        layout: {
          xaxis: axis(axisName(cartesian[h], "mm"), { range: ranges[h], zeroline: false, constrain: "domain" }),
          yaxis: axis(axisName(cartesian[v], "mm"), {
            range: ranges[v],
            scaleanchor: "x",
            constrain: "domain",
            zeroline: false,
          }),
          showlegend: false,
        },
      }),
    });
  const addSpaceView = () =>
    addPlot(grid, {
      title: "3-D view",
      size: "half",
      height: 694,
      make(distance) {
        return {
          data: spaceTraces(poses, currentPose(), cellsOf(study, poses.name), currentValues()),
          layout: {
            uirevision: "camera",
            margin: { l: 0, r: 0, t: 0, b: 0 },
            legend: { orientation: "h", x: 0, y: 0, yanchor: "bottom", bgcolor: faded(colour("box"), 0.6) },
            scene: spaceScene(ranges, 1.45 * distance),
          },
        };
      },
    });
  if (planar) {
    column.className = "half";
    plots = [addPlaneView("Plane of motion", 0, 1, 694)];
  } else plots = [(spacePlot = addSpaceView()), addPlaneView("Front view", 0, 2), addPlaneView("Top view", 0, 1)];
  grid.append(column);
  grid.append(
    element("div", "box", element("h3", "", "Values at this pose"), feasibility, readout),
    ...[jointBox(study), massBox(designs[0])].filter(Boolean),
  );
}
