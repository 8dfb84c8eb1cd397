// The mechanism, to scale, at the poses that the file was asked for: front, top and 3-D, with its workspace.

function partColour(part, parts) {
  if (part === "frame") return "#8893a0";
  if (part === "platform") return document.documentElement.dataset.theme === "dark" ? "#e2e6eb" : "#2b3440";
  const isLimb = (name) => name.startsWith("limb ");
  if (isLimb(part)) return limbColours[parts.filter(isLimb).indexOf(part) % 4];
  const others = parts.filter((name) => !isLimb(name) && name !== "frame" && name !== "platform");
  return ["#56b4e9", "#d55e00", "#b8a000"][others.indexOf(part) % 3];
}

/** Cells of the workspace that are feasible at a rotation, as booleans seen along an axis; null where it does not show. */
function workspaceShadow(cells, rotation, h, v) {
  const find = (coordinate) => cells.axes.findIndex((axis) => axis.coordinate === coordinate);
  const [across, up, turning] = [find(h), find(v), find(3)];
  if (across < 0 || up < 0) return null;
  const layer = turning < 0 ? -1 : cells.layer(turning, rotation);
  if (turning >= 0 && layer < 0) return null;
  const third = [0, 1, 2].find((k) => k !== across && k !== up);
  const layers = turning >= 0 ? [layer] : Array.from({ length: cells.axes[third].cells }, (_, k) => k);
  const z = Array.from({ length: cells.axes[up].cells }, (_, j) =>
    Array.from({ length: cells.axes[across].cells }, (_, i) =>
      layers.some((k) => cells.feasible[k * cells.strides[third] + i * cells.strides[across] + j * cells.strides[up]])
        ? 1
        : null,
    ),
  );
  return { x: cells.centres(across), y: cells.centres(up), z };
}

function flatTraces(poses, pose, cells, rotation, [h, v]) {
  const traces = [];
  const shadow = cells && workspaceShadow(cells, rotation, h, v);
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

/** The workspace in the room: its surface, or at the rotation a layer of cells where the platform's plane is. */
function solidWorkspace(cells, rotation, held) {
  const look = {
    type: "mesh3d",
    color: "#56b4e9",
    opacity: 0.22,
    hoverinfo: "skip",
    name: "workspace",
    showlegend: true,
  };
  const turning = cells.axes.findIndex((axis) => axis.coordinate === 3);
  if (turning < 0) {
    const { at, triangles } = cells.surface,
      order = [0, 1, 2].map((c) => cells.axes.findIndex((axis) => axis.coordinate === c));
    const corner = (c) => Array.from({ length: triangles.length / 3 }, (_, t) => triangles[3 * t + c]);
    return { ...look, x: at[order[0]], y: at[order[1]], z: at[order[2]], i: corner(0), j: corner(1), k: corner(2) };
  }
  const layer = cells.layer(turning, rotation),
    mesh = { x: [], y: [], z: [], i: [], j: [], k: [] };
  const [a, b] = [0, 1, 2].filter((k) => k !== turning),
    names = ["x", "y", "z"];
  for (let p = 0; layer >= 0 && p < cells.axes[a].cells; ++p)
    for (let q = 0; q < cells.axes[b].cells; ++q) {
      if (!cells.feasible[layer * cells.strides[turning] + p * cells.strides[a] + q * cells.strides[b]]) continue;
      const first = mesh.x.length;
      for (const [da, db] of [
        [0, 0],
        [1, 0],
        [1, 1],
        [0, 1],
      ]) {
        mesh[names[cells.axes[a].coordinate]].push(cells.axes[a].lower + (p + da) * cells.axes[a].step);
        mesh[names[cells.axes[b].coordinate]].push(cells.axes[b].lower + (q + db) * cells.axes[b].step);
        mesh[names[cells.held.coordinate]].push(held);
      }
      mesh.i.push(first, first);
      mesh.j.push(first + 1, first + 2);
      mesh.k.push(first + 2, first + 3);
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
  const around = cells && solidWorkspace(cells, values[3], values[cells.held.coordinate]);
  return around ? [...traces, around] : traces;
}

function showMechanism(study, section) {
  const { designs, mode } = study.mechanism;
  const all = designs.map((packed) => (packed.poses ??= new Poses(packed)));
  const cellsOf = (name) => {
    const found = study.workspace?.designs.find((design) => design.name === name);
    return found ? (found.cells ??= new Cells(found)) : null;
  };
  section.append(
    element(
      "p",
      "lead",
      `Drawn to scale in working mode ${mode}. The sliders step through stored poses; blue is where the platform can go` +
        " at this rotation.",
    ),
  );
  const controls = element("div", "controls panel"),
    grid = element("div", "grid");
  section.append(grid);
  grid.append(controls);
  let poses,
    places,
    sliders,
    plots = [];
  const verdict = element("p", "verdict"),
    readout = element("div", "readout");
  const now = () => poses.pose(places);
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
            ...poses.joints.map((joint, i) => [joint, quantity(poses.positions[i][number], "m", 5)]),
            ["conditioning", digits(poses.conditioning[number], 4)],
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
          moved();
        },
      ),
    );
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
  const [xs, ys, zs] = span();
  const [width, depth, height] = [xs, ys, zs].map(([low, high]) => high - low);
  const slim = Math.max(depth, height) > 1.6 * width;
  const column = element("div", "half column" + (slim ? " abreast" : ""));
  const flat = (title, h, v, names, ranges) =>
    addPlot(column, {
      title,
      height: slim ? 694 : 312,
      make: () => ({
        data: flatTraces(poses, now(), cellsOf(poses.name), poses.values(places)[3], [h, v]),
        layout: {
          xaxis: axis(axisName(names[0], "m"), { range: ranges[0], zeroline: false, constrain: "domain" }),
          yaxis: axis(axisName(names[1], "m"), {
            range: ranges[1],
            scaleanchor: "x",
            constrain: "domain",
            zeroline: false,
          }),
          showlegend: false,
        },
      }),
    });
  const room = addPlot(grid, {
    title: "In space",
    size: "half",
    height: 694,
    make() {
      const most = Math.max(width, depth, height);
      return {
        data: solidTraces(poses, now(), cellsOf(poses.name), poses.values(places)),
        layout: {
          uirevision: "camera",
          margin: { l: 0, r: 0, t: 0, b: 0 },
          legend: { orientation: "h", x: 0, y: 0, yanchor: "bottom", bgcolor: faded(colour("panel"), 0.6) },
          scene: {
            xaxis: sceneAxis("x [m]", xs),
            yaxis: sceneAxis("y [m]", ys),
            zaxis: sceneAxis("z [m]", zs),
            aspectmode: "manual",
            aspectratio: { x: (1.35 * width) / most, y: (1.35 * depth) / most, z: (1.35 * height) / most },
            camera: { eye: { x: 1.1, y: -1.45, z: 0.75 } },
          },
        },
      };
    },
  });
  grid.append(column);
  plots = [room, flat("From the front", 0, 2, ["x", "z"], [xs, zs]), flat("From above", 0, 1, ["x", "y"], [xs, ys])];
  grid.append(element("div", "panel", element("h3", "", "At this pose"), verdict, readout));
}
