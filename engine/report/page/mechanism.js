// The mechanism, to scale, at the poses that the file was asked for: front, top and 3-D, with its workspace.

function partColour(part, parts) {
  if (part === "frame") return "#8893a0";
  if (part === "platform") return document.documentElement.dataset.theme === "dark" ? "#e2e6eb" : "#2b3440";
  const isLimb = (name) => name.startsWith("limb ");
  if (isLimb(part)) return limbColours[parts.filter(isLimb).indexOf(part) % limbColours.length];
  const others = parts.filter((name) => !isLimb(name) && name !== "frame" && name !== "platform");
  return ["#56b4e9", "#d55e00", "#b8a000"][others.indexOf(part) % 3];
}

const room = ["x", "y", "z"]; // roles of the coordinates that are places in it

/** The axes of the workspace that are x, y and z, in this order; -1: not swept. */
function axesInRoom(cells) {
  return room.map((role) => cells.axes.findIndex((axis) => axis.role === role));
}

/** Where the cells lie that share a pose's values of all that is no place in the room; null: none does. */
function layerAt(cells, values) {
  const layers = cells.axes.map((axis, k) => (room.includes(axis.role) ? 0 : cells.layer(k, values[axis.coordinate])));
  return layers.some((layer) => layer < 0) ? null : layers.reduce((sum, layer, k) => sum + layer * cells.strides[k], 0);
}

const toRoom = (values) => Array.from(values, (value) => value * shownScale("m")); // drawn in mm

/** Cells of the workspace that are feasible at a pose's rotation, seen along an axis; null where it does not show. */
function workspaceShadow(cells, values, h, v) {
  const places = axesInRoom(cells);
  const [across, up] = [places[h], places[v]];
  const first = layerAt(cells, values);
  if (across < 0 || up < 0 || first === null) return null;
  const depth = places[3 - h - v];
  const layers = depth < 0 ? [0] : Array.from({ length: cells.axes[depth].cells }, (_, k) => k * cells.strides[depth]);
  const z = Array.from({ length: cells.axes[up].cells }, (_, j) =>
    Array.from({ length: cells.axes[across].cells }, (_, i) =>
      layers.some((k) => cells.feasible[first + k + i * cells.strides[across] + j * cells.strides[up]]) ? 1 : null,
    ),
  );
  return { x: toRoom(cells.centres(across)), y: toRoom(cells.centres(up)), z };
}

function flatTraces(poses, pose, cells, values, [h, v]) {
  const traces = [];
  const shadow = cells && workspaceShadow(cells, values, h, v);
  if (shadow)
    traces.push({
      type: "heatmap",
      ...shadow,
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
 * The workspace in the room: its surface, or of those that sweep other coordinates too, the cells at the pose's values
 * of these: a layer where the platform's plane is, or a line.
 * @param place  of the platform, [x, y, z] in mm
 */
function solidWorkspace(cells, values, place) {
  const look = {
    type: "mesh3d",
    color: "#56b4e9",
    opacity: 0.22,
    hoverinfo: "skip",
    name: "workspace",
    showlegend: true,
  };
  const order = axesInRoom(cells);
  if (order.every((k) => k >= 0)) {
    const { at, triangles } = cells.surface;
    const corner = (c) => Array.from({ length: triangles.length / 3 }, (_, t) => triangles[3 * t + c]);
    const [x, y, z] = order.map((axis) => toRoom(at[axis]));
    return { ...look, x, y, z, i: corner(0), j: corner(1), k: corner(2) };
  }
  const first = layerAt(cells, values),
    mesh = { x: [], y: [], z: [], i: [], j: [], k: [] };
  const [a, b] = cells.axes.flatMap((axis, k) => (room.includes(axis.role) ? [k] : []));
  if (first === null || a === undefined) return null;
  if (b === undefined) {
    const line = toRoom(cells.centres(a)).map((value, k) =>
      cells.feasible[first + k * cells.strides[a]] ? value : null,
    );
    const points = room.map((role, c) => line.map((value) => (cells.axes[a].role === role ? value : place[c])));
    const { color, hoverinfo, name, showlegend } = look;
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
        const at = { [a]: p + da, [b]: q + db };
        room.forEach((role, c) => {
          const axis = cells.axes[order[c]];
          mesh[role].push(axis ? shownScale("m") * (axis.lower + at[order[c]] * axis.step) : place[c]);
        });
      }
      mesh.i.push(corner, corner);
      mesh.j.push(corner + 1, corner + 2);
      mesh.k.push(corner + 2, corner + 3);
    }
  return mesh.x.length ? { ...look, ...mesh, lighting: { ambient: 1, diffuse: 0 } } : null;
}

function solidTraces(poses, pose, cells, values) {
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
  const around = cells && solidWorkspace(cells, values, poses.place(values));
  return around ? [...traces, around] : traces;
}

/** A scene of the room, to scale. @param spans  of x, y and z @param away  how far the camera is */
function roomScene(spans, away) {
  const extents = spans.map(([low, high]) => high - low),
    most = Math.max(...extents);
  const [x, y, z] = extents.map((extent) => (1.35 * extent) / most);
  return {
    xaxis: sceneAxis("x [mm]", spans[0], extents[0] / most),
    yaxis: sceneAxis("y [mm]", spans[1], extents[1] / most),
    zaxis: sceneAxis("z [mm]", spans[2], extents[2] / most),
    bgcolor: colour("panel"), // of the film, too
    aspectmode: "manual",
    aspectratio: { x, y, z },
    camera: { eye: { x: 1.1 * away, y: -1.45 * away, z: 0.75 * away }, center: { x: 0, y: 0, z: -0.1 } },
  };
}

const posesOf = (packed) => (packed.poses ??= new Poses(packed));

/** The workspace of the design of this name; null: the page has none. */
function cellsOf(study, name) {
  const found = study.workspace?.designs.find((design) => design.name === name);
  return found ? (found.cells ??= new Cells(found)) : null;
}

/** It moves in the plane of x and y. */
function isPlanar({ coordinates }) {
  const roles = coordinates.map((coordinate) => coordinate.role);
  return (
    ["x", "y"].every((role) => roles.includes(role)) &&
    roles.every((role, c) => /x|y/.test(role) || (role === "turn" && roles.indexOf(role) === c))
  );
}

function showMechanism(study, section) {
  const { designs, mode } = study.mechanism;
  const all = designs.map(posesOf);
  const turning = all[0].coordinates.some((coordinate) => coordinate.role === "turn");
  const planar = isPlanar(all[0]);
  const goes = study.workspace?.designs.some((design) => design.axes.some((axis) => room.includes(axis.role)));
  section.append(
    element(
      "p",
      "lead",
      `Drawn to scale in working mode ${mode}. The sliders step through stored poses` +
        (all.some((design) => design.motions.length)
          ? ", the player along the " + (study.motions?.left_out ? `first ${all[0].motions.length} ` : "") + "motions"
          : "") +
        (goes ? "; blue is where the platform can go" + (turning ? " at this rotation" : "") : "") +
        ".",
    ),
  );
  const controls = element("div", "controls panel"),
    grid = element("div", "grid");
  section.append(grid);
  grid.append(controls);
  const playBar = element("div", "controls panel");
  if (all.some((design) => design.motions.length)) grid.append(playBar);
  let poses,
    places,
    sliders,
    player,
    inSpace,
    plots = [];
  const verdict = element("p", "verdict"),
    readout = element("div", "readout");
  let along = null; // { motion, k }: a pose of a motion instead of the sliders'
  const now = () => (along ? along.motion.first + along.k : poses.pose(places));
  const valuesNow = () => (along ? along.motion.coordinates.map((column) => column[along.k]) : poses.values(places));
  const tell = () => {
    const pose = now(),
      number = poses.number[pose],
      reason = poses.reasons[poses.reason[pose]];
    verdict.className = "verdict " + (reason ? "worse" : "better");
    verdict.textContent =
      (reason ? (number < 0 ? "Does not assemble: " : "Not feasible: ") + reason : "Feasible") + ".";
    readout.replaceChildren(
      ...(number < 0
        ? []
        : [
            ...poses.joints.map((joint, i) => [joint.name, shownValue(poses.positions[i][number], joint)]),
            ["conditioning", digits(poses.conditioning[number])],
          ]
      ).map(([name, value]) => element("div", "", element("span", "", name + " "), element("b", "", value))),
    );
  };
  const moved = () => {
    tell();
    plots.forEach((plot) => plot.update());
  };
  const choose = (i) => {
    poses = all[i];
    places = poses.places(poses.start);
    sliders?.forEach((control) => control.node.remove());
    sliders = poses.coordinates.map((coordinate, c) =>
      slider(
        controls,
        coordinate.name,
        coordinate.values.length,
        places[c],
        (k) => shownValue(coordinate.values[k], coordinate),
        (k) => {
          places[c] = k;
          player?.stop();
          along = null;
          moved();
        },
      ),
    );
    player?.stop();
    playBar.replaceChildren();
    along = null;
    player = poses.motions.length
      ? addPlayer(
          playBar,
          poses.motions,
          (motion, k) => {
            along = { motion, k };
            moved();
          },
          () => inSpace?.node.querySelector("canvas"),
        )
      : null;
    moved();
  };
  if (all.length > 1)
    buttons(
      controls,
      "design",
      all.map((design) => design.name),
      0,
      choose,
    );
  choose(0);
  const span = () =>
    all
      .map((design) => design.span())
      .reduce((a, b) => a.map(([low, high], c) => [Math.min(low, b[c][0]), Math.max(high, b[c][1])]));
  const spans = span(),
    [xs, ys, zs] = spans;
  const [width, depth, height] = [xs, ys, zs].map(([low, high]) => high - low);
  const slim = Math.max(depth, height) > 1.6 * width;
  const column = element("div", "half column" + (slim ? " abreast" : ""));
  const flat = (title, h, v, tall = slim ? 694 : 312) =>
    addPlot(column, {
      title,
      height: tall,
      make: () => ({
        data: flatTraces(poses, now(), cellsOf(study, poses.name), valuesNow(), [h, v]),
        layout: {
          xaxis: axis(axisName(room[h], "mm"), { range: spans[h], zeroline: false, constrain: "domain" }),
          yaxis: axis(axisName(room[v], "mm"), {
            range: spans[v],
            scaleanchor: "x",
            constrain: "domain",
            zeroline: false,
          }),
          showlegend: false,
        },
      }),
    });
  const solid = () =>
    addPlot(grid, {
      title: "In space",
      size: "half",
      height: 694,
      make(away) {
        return {
          data: solidTraces(poses, now(), cellsOf(study, poses.name), valuesNow()),
          layout: {
            uirevision: "camera",
            margin: { l: 0, r: 0, t: 0, b: 0 },
            legend: { orientation: "h", x: 0, y: 0, yanchor: "bottom", bgcolor: faded(colour("panel"), 0.6) },
            scene: roomScene(spans, Math.sqrt(away)), // it may be turned and come nearer
          },
        };
      },
    });
  if (planar) {
    column.className = "half";
    plots = [flat("In its plane", 0, 1, 694)];
  } else plots = [(inSpace = solid()), flat("From the front", 0, 2), flat("From above", 0, 1)];
  grid.append(column);
  grid.append(element("div", "panel", element("h3", "", "At this pose"), verdict, readout));
}
