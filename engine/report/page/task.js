// Panel "Task": several robots compared in one task: table of all values, workspaces, and loads along the motions.

/** A value of the comparison in its display unit, with the limit that determines it; why there is none on hover. */
function taskCell({ value, unit, required, limited_by: limit, reason }) {
  if (value === null) {
    const missing = element("span", "", "–");
    if (reason) missing.title = reason;
    return missing;
  }
  const shown = measured(value, unit);
  if (required !== null) shown.classList.add(value >= required ? "better" : "worse");
  return element("span", "", shown, limit ? element("small", "limit", limit) : null);
}

/** Table of all values that at least one robot has; one column per robot. */
function taskTable(task) {
  const head = ["", ...task.robots.map((robot) => robot.name)];
  const rows = task.lines
    .map((name, k) => [name, task.robots.map((robot) => robot.values[k])])
    .filter(([, values]) => values.some(({ value }) => value !== null))
    .map(([name, values]) => [name, ...values.map(taskCell)]);
  const verdicts = task.robots.map(({ performs, verdict }) =>
    element("span", performs === null ? "" : performs ? "better" : "worse", verdict),
  );
  const box = element("div", "box", element("h3", "", "All values"), simpleTable(head, [["does the task", ...verdicts], ...rows]));
  const missing = new Map(); // values by robots and reason
  task.lines.forEach((name, k) => {
    const reasons = new Map(); // with the robots
    for (const robot of task.robots) {
      const { reason } = robot.values[k];
      if (reason) reasons.set(reason, [...(reasons.get(reason) ?? []), robot.name]);
    }
    for (const [reason, robots] of reasons) {
      const key = (robots.length > 1 && robots.length === task.robots.length ? "all robots" : robots.join(", ")) + "\n" + reason;
      missing.set(key, [...(missing.get(key) ?? []), name]);
    }
  });
  if (missing.size)
    box.append(
      element(
        "details",
        "wrapped",
        element("summary", "", "Not available, and why"),
        simpleTable(
          ["values", "robots", "reason"],
          [...missing].map(([key, names]) => [names.join("; "), ...key.split("\n")]),
        ),
      ),
    );
  return box;
}

/** The workspace of a robot with its axes by name; null if it has none. */
function taskCells(robot) {
  if (!robot.workspace) return null;
  return (robot.cells ??= new Cells(robot.workspace));
}

/** Range of each axis in the frame of the task: workspaces, regions and motions, with a margin. */
function taskRanges(task) {
  return task.axes.map(({ name }, axis) => {
    const ends = task.boxes.flatMap((box) => box.ranges[axis] ?? []);
    for (const robot of task.robots) {
      const cells = taskCells(robot),
        own = cells ? cells.axes.findIndex((a) => a.name === name) : -1;
      if (own >= 0) ends.push(...feasibleRange([cells], own));
      for (const motion of robot.motions) ends.push(...Array.from(unpack(motion.path[axis])).filter(Number.isFinite));
    }
    const [low, high] = [Math.min(...ends), Math.max(...ends)],
      margin = 0.05 * (high - low);
    return [low - margin, high + margin].map((value) => value * shownScale(task.axes[axis].unit));
  });
}

/** Flat 3-D trace of a workspace over two of three axes: its feasible cells, at the middle of the third axis. */
function flatTrace(cells, task, order, style) {
  const [across, up] = order.filter((k) => k >= 0),
    corners = [],
    triangles = [];
  cells.matrix(across, up, (cell) => cells.feasible[cell]).forEach((row, j) =>
    row.forEach((feasible, i) => {
      if (!feasible) return;
      const first = corners.length;
      for (const [di, dj] of [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
        corners.push({ [across]: cells.centre(across, i + di), [up]: cells.centre(up, j + dj) });
      triangles.push([first, first + 1, first + 2], [first, first + 2, first + 3]);
    }),
  );
  const along = (k, axis) =>
    corners.map((corner) => (k < 0 ? task.middle[axis] : corner[k]) * shownScale(task.axes[axis].unit));
  return {
    type: "mesh3d",
    ...Object.fromEntries(order.map((k, axis) => ["xyz"[axis], along(k, axis)])),
    ...Object.fromEntries([0, 1, 2].map((corner) => ["ijk"[corner], triangles.map((triangle) => triangle[corner])])),
    hoverinfo: "name",
    ...style,
  };
}

/** Line trace of points given by their values along each axis in SI. */
function taskLine(task, points, more) {
  const values = task.axes.map(({ unit }, axis) => points.map((point) => (point ? point[axis] * shownScale(unit) : null)));
  return {
    type: task.axes.length === 3 ? "scatter3d" : "scatter",
    mode: "lines",
    ...Object.fromEntries(values.map((list, axis) => ["xyz"[axis], list])),
    hovertemplate: label(more.name) + "<extra></extra>",
    ...more,
  };
}

/** Edges of the boxes of the regions; a box that does not name an axis extends over its whole range. */
function boxTraces(task, ranges) {
  return task.boxes.map((box) => {
    const ends = task.axes.map(({ unit }, axis) => box.ranges[axis] ?? ranges[axis].map((value) => value / shownScale(unit)));
    const ring = [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]];
    const points = task.axes.length === 3
      ? [
          ...[0, 1].flatMap((k) => [...ring.map(([i, j]) => [ends[0][i], ends[1][j], ends[2][k]]), null]),
          ...ring.slice(1).flatMap(([i, j]) => [0, 1].map((k) => [ends[0][i], ends[1][j], ends[2][k]]).concat([null])),
        ]
      : ring.map(([i, j]) => [ends[0][i], ends[1][j]]);
    return taskLine(task, points, { name: label(box.name), line: { color: colour("ink"), width: 3 } });
  });
}

/** The path of each motion, from the first robot that has all coordinates. */
function pathTraces(task) {
  return task.robots[0].motions.flatMap(({ name }, k) => {
    const paths = task.robots.map((robot) => robot.motions[k].path.map((packed) => unpack(packed)));
    const path = paths.find((columns) => columns.every((column) => Number.isFinite(column[0])));
    if (!path) return [];
    const points = Array.from(path[0], (_, i) => path.map((column) => column[i]));
    return [taskLine(task, points, { name: label(name), line: { color: colour("muted"), width: 3 } })];
  });
}

/** All workspaces with the regions and the motions; null if the task has one axis. */
function addTaskWorkspaces(task, grid) {
  const count = task.axes.length;
  if (count < 2) return;
  const missing = task.robots.filter((robot) => !robot.workspace).map((robot) => robot.name);
  addPlot(grid, {
    title: "Workspaces and regions",
    caption:
      "All in the frame of the task, with the regions (boxes) and the motions (lines)." +
      (missing.length ? ` Without feasible poses: ${missing.join(", ")}.` : ""),
    height: count === 3 ? 620 : 480,
    make(distance) {
      const ranges = taskRanges(task);
      const data = task.robots.flatMap((robot, i) => {
        const cells = taskCells(robot);
        if (!cells) return [];
        const order = task.axes.map(({ name }) => cells.axes.findIndex((axis) => axis.name === name)),
          own = order.filter((k) => k >= 0).length;
        const style = { name: label(robot.name), color: seriesColours[i % seriesColours.length], opacity: 0.3, showlegend: true };
        if (count === 2) return own === 2 ? [outlineTrace(cells, order, style.name, style.color)] : [];
        if (own === 3) return [surfaceTrace(cells, order, style)];
        return own === 2 ? [flatTrace(cells, task, order, style)] : [];
      });
      data.push(...boxTraces(task, ranges), ...pathTraces(task));
      if (count === 3)
        return {
          data,
          layout: { scene: sceneOf(task.axes, ranges, 0.75 * distance), uirevision: "camera", margin: { l: 0, r: 0, t: 0, b: 0 } },
        };
      const isToScale = task.axes.every((a) => a.unit === "m");
      return {
        data,
        layout: {
          xaxis: axis(axisTitle(task.axes[0]), { range: ranges[0], constrain: "domain" }),
          yaxis: axis(axisTitle(task.axes[1]), { range: ranges[1], ...(isToScale ? { scaleanchor: "x", constrain: "domain" } : {}) }),
        },
      };
    },
  });
}

/** One plot per motion and load, with a curve for each robot that has this load. */
function addTaskCurves(task, grid) {
  task.robots[0].motions.forEach(({ name: motion }, m) => {
    const names = [...new Set(task.robots.flatMap((robot) => robot.motions[m].curves.map((curve) => curve.name)))];
    const duration = Math.max(...task.robots.map((robot) => robot.motions[m].duration));
    for (const name of names) {
      const curves = task.robots.flatMap((robot, i) => {
        const curve = robot.motions[m].curves.find((each) => each.name === name);
        return curve ? [{ robot, i, curve, motion: robot.motions[m] }] : [];
      });
      const { unit } = curves[0].curve;
      addPlot(grid, {
        title: `${motion}: ${name}`,
        size: "half",
        height: 340,
        make: () => ({
          data: curves.map(({ robot, i, curve, motion: along }) => ({
            type: "scatter",
            mode: "lines",
            x: timesOf(along),
            y: unpack(curve.values),
            name: label(robot.name),
            showlegend: true,
            line: { color: seriesColours[i % seriesColours.length], width: 2 },
            hovertemplate: `%{y:.4g} ${label(unitText(unit))} at %{x:.4g} s<extra>${label(robot.name)}</extra>`,
          })),
          layout: { xaxis: axis("time [s]", { range: [0, duration] }), yaxis: axis(axisName(name.replace(/ of .*/, ""), unit)) },
        }),
      });
    }
  });
}

function showTask(task, panel) {
  const doing = task.robots.filter(({ performs }) => performs).map(({ name }) => name);
  panel.append(
    element(
      "p",
      "lead",
      `“${task.name}”: ${doing.length} of ${count(task.robots.length, "robot")} ` +
        `${task.robots.length === 1 || doing.length === 1 ? "performs" : "perform"} the task` +
        (doing.length && doing.length < task.robots.length ? ` (${doing.join(", ")}).` : "."),
    ),
  );
  const grid = element("div", "grid");
  panel.append(grid);
  grid.append(taskTable(task));
  addTaskWorkspaces(task, grid);
  addTaskCurves(task, grid);
}
