// Panel "Convergence": objectives, feasible share, diversity and front indicators over evaluations or generations. The
// stages follow each other on one axis; multistart runs of solvers are marked at their first and final evaluation.

/**
 * Position of each stage on the horizontal axis: its `offset` and `end`, the positions `x` of its generations, and a
 * function `position(evaluation)` for its evaluations.
 */
function stageAxis(stages, byGeneration) {
  let begin = 0;
  return stages.map((stage) => {
    const { evaluations, numbers, total } = stage.generations;
    const offset = begin;
    begin += byGeneration ? total : stage.evaluations;
    const position = (evaluation) => {
      if (!byGeneration) return offset + evaluation;
      const g = evaluations.findIndex((end) => evaluation <= end);
      if (g < 0) return offset + total - 1;
      const before = g ? evaluations[g - 1] : 0,
        from = g ? numbers[g - 1] : numbers[g] - 1;
      return offset + from + ((numbers[g] - from) * (evaluation - before)) / (evaluations[g] - before);
    };
    return {
      stage,
      offset,
      end: begin,
      position,
      x: byGeneration ? numbers.map((g) => offset + g) : evaluations.map((e) => offset + e),
    };
  });
}

/** Vertical lines between the stages, and their names above the plot. */
function stageSeparators(axes) {
  const shapes = [],
    annotations = [];
  for (const { stage, offset } of axes) {
    if (axes.length < 2) break;
    if (offset > 0)
      shapes.push({
        type: "line",
        x0: offset,
        x1: offset,
        yref: "paper",
        y0: 0,
        y1: 1,
        line: { color: colour("muted"), width: 1, dash: "dot" },
      });
    annotations.push({
      x: offset,
      xanchor: "left",
      yref: "paper",
      y: 1,
      yanchor: "bottom",
      showarrow: false,
      xshift: 2,
      text: stage.stage + ". " + label(stage.optimiser),
      font: { size: 12, color: colour("muted") },
    });
  }
  return { shapes, annotations, margin: { l: 12, r: 12, t: 28, b: 12 } };
}

function objectiveTraces(axes, k, objective) {
  const unit = unitText(objective.unit) ? " " + label(unitText(objective.unit)) : "";
  const [bestInk, medianInk] = [seriesColours[0], seriesColours[4]];
  const traces = [];
  axes.forEach(({ stage, x, position }, i) => {
    const { best, median, lower, upper } = stage.generations.objectives[k];
    const numbers = stage.generations.numbers;
    const common = {
      x,
      legendgroup: "",
      showlegend: i === 0,
      mode: numbers.length > 1 ? "lines" : "markers",
      type: "scatter",
      customdata: numbers,
    };
    const hover = (title) => `${title} %{y:.4g}${unit}<br>generation %{customdata}<extra></extra>`;
    const hasSpread = median.some((value) => value !== null);
    if (hasSpread && !stage.starts)
      traces.push(
        { ...common, y: lower, line: { width: 0 }, showlegend: false, hoverinfo: "skip", legendgroup: "spread" },
        {
          ...common,
          y: upper,
          line: { width: 0 },
          fill: "tonexty",
          fillcolor: faded(medianInk, 0.25),
          name: "interquartile range of the population",
          legendgroup: "spread",
          hoverinfo: "skip",
        },
        {
          ...common,
          y: median,
          name: "median",
          legendgroup: "median",
          line: { color: medianInk, width: 1.5 },
          hovertemplate: hover("median"),
        },
      );
    if (stage.trace) {
      for (const feasible of [true, false]) {
        const points = stage.trace.points.filter((point) => point.feasible === feasible);
        if (points.length)
          traces.push({
            type: "scatter",
            mode: "markers",
            x: points.map((p) => position(p.evaluation)),
            y: points.map((p) => p.objectives[k]),
            customdata: points.map((p) => p.evaluation),
            name: feasible ? "solver, feasible" : "solver, infeasible",
            legendgroup: "solver" + feasible,
            showlegend: !traces.some((t) => t.legendgroup === "solver" + feasible),
            marker: {
              size: 5,
              color: feasible ? seriesColours[5] : colour("muted"),
              symbol: feasible ? "circle" : "circle-open",
            },
            hovertemplate: `%{y:.4g}${unit}<br>evaluation %{customdata} of the stage<extra>${feasible ? "feasible" : "infeasible"}</extra>`,
          });
      }
      for (const [end, symbol, name] of [
        ["begin", "triangle-right-open", "start of a run"],
        ["end", "diamond", "result of a run"],
      ])
        traces.push({
          type: "scatter",
          mode: "markers",
          name,
          legendgroup: end,
          showlegend: !traces.some((t) => t.legendgroup === end),
          x: stage.starts.map((s) => position(end === "end" ? s.last_evaluation : s.begin.evaluation)),
          y: stage.starts.map((s) => s[end].objectives[k]),
          customdata: stage.starts.map((s) => [
            label(s.origin),
            label(s.stop),
            s[end].feasible ? "feasible" : "infeasible",
          ]),
          marker: {
            size: 10,
            symbol,
            color: seriesColours[1],
            line: { width: 1.5, color: end === "begin" ? seriesColours[1] : colour("panel") },
          },
          hovertemplate: `%{y:.4g}${unit}, %{customdata[2]}<br>%{customdata[0]}${end === "end" ? "<br>%{customdata[1]}" : ""}<extra>${name}</extra>`,
        });
    }
    traces.push({
      ...common,
      y: best,
      name: "best so far",
      legendgroup: "best",
      line: { color: bestInk, width: 2.5, shape: "hv" },
      hovertemplate: hover("best"),
    });
  });
  return traces;
}

/** One curve per stage of a quantity of its generations, except for stages that lack it. */
function generationTraces(axes, key, name, ink, more = {}) {
  const traces = [];
  for (const { stage, x } of axes) {
    const y = stage.generations[key];
    if (!y || !y.some((value) => value !== null) || stage.starts) continue;
    traces.push({
      type: "scatter",
      mode: y.length > 1 ? "lines" : "markers",
      x,
      y,
      customdata: stage.generations.numbers,
      name,
      legendgroup: key,
      showlegend: traces.length === 0,
      line: { color: ink, width: 2 },
      hovertemplate: `${name} %{y:.4g}<br>generation %{customdata}<extra></extra>`,
      ...more,
    });
  }
  return traces;
}

/** Axis range that covers the best values and the quartiles, or the results of solver runs, but not all outliers. */
function objectiveRange(axes, k) {
  const values = axes
    .flatMap(({ stage }) => {
      const { best, lower, upper } = stage.generations.objectives[k];
      return [
        ...best,
        ...(stage.starts
          ? stage.starts.filter((s) => s.end.feasible).map((s) => s.end.objectives[k])
          : [...lower, ...upper]),
      ];
    })
    .filter((value) => value !== null);
  if (!values.length) return {};
  const low = Math.min(...values),
    high = Math.max(...values),
    margin = 0.06 * (high - low) || 0.05 * Math.abs(high) || 1;
  return { range: [low - margin, high + margin] };
}

function showConvergence(study, panel) {
  const stages = study.convergence;
  const thinned = stages
    .filter((stage) => stage.generations.stride > 1)
    .map(
      (stage) =>
        `only every ${ordinal(stage.generations.stride)} of the ${stage.generations.total} generations of stage ${stage.stage} is shown`,
    );
  panel.append(
    element(
      "p",
      "lead",
      "Best objective value so far, and the median and interquartile range of the feasible designs of the population." +
        (thinned.length ? " To keep the page small, " + thinned.join("; ") + "." : ""),
    ),
  );
  const controls = element("div", "controls");
  const grid = element("div", "grid");
  panel.append(controls, grid);
  const plots = [];
  const currentAxis = () => stageAxis(stages, against.value === 1);
  const xaxis = (more = {}) =>
    axis(against.value === 1 ? "generation" : "evaluations", { rangemode: "tozero", ...more });
  const against = buttons(controls, "against", ["evaluations", "generations"], 0, () =>
    plots.forEach((plot) => plot.update()),
  );
  study.problem.objectives.forEach((objective, k) => {
    plots.push(
      addPlot(grid, {
        title: objective.name,
        caption: objective.meaning,
        size: study.problem.objectives.length > 1 ? "half" : "",
        height: 430,
        make() {
          const axes = currentAxis();
          return {
            data: objectiveTraces(axes, k, objective),
            layout: {
              xaxis: xaxis(),
              yaxis: axis(axisName(objective.name, objective.unit), objectiveRange(axes, k)),
              ...stageSeparators(axes),
              legend: { orientation: "h", x: 0, y: -0.2, yanchor: "top" },
            },
          };
        },
      }),
    );
  });
  if (stages.some((stage) => !stage.starts))
    plots.push(
      addPlot(grid, {
        title: "Feasible share and diversity",
        caption:
          "Share of feasible designs in the population, and diversity of its designs (1: that of a uniform sample).",
        size: "half",
        height: 320,
        make() {
          const axes = currentAxis();
          return {
            data: [
              ...generationTraces(axes, "feasible_share", "feasible share", seriesColours[0]),
              ...generationTraces(axes, "diversity", "diversity", seriesColours[1]),
            ],
            layout: {
              xaxis: xaxis(),
              yaxis: axis("share, diversity [1]", { rangemode: "tozero" }),
              legend: { orientation: "h", x: 0, y: -0.22, yanchor: "top" },
              ...stageSeparators(axes),
            },
          };
        },
      }),
    );
  if (stages.some((stage) => stage.generations.hypervolume))
    plots.push(
      addPlot(grid, {
        title: "Hypervolume of the front",
        caption:
          "Hypervolume between Pareto front and reference point; spread of the population along the front (0: uniform).",
        size: "half",
        height: 320,
        make() {
          const axes = currentAxis();
          return {
            data: [
              ...generationTraces(axes, "hypervolume", "hypervolume", seriesColours[0]),
              ...generationTraces(axes, "spread", "spread", seriesColours[1], { yaxis: "y2" }),
              ...generationTraces(axes, "igd_plus", "IGD+", seriesColours[2], { yaxis: "y2" }),
            ],
            layout: {
              xaxis: xaxis(),
              yaxis: axis("hypervolume"),
              yaxis2: axis("spread, IGD+ [1]", {
                overlaying: "y",
                side: "right",
                rangemode: "tozero",
                showgrid: false,
              }),
              legend: { orientation: "h", x: 0, y: -0.22, yanchor: "top" },
              ...stageSeparators(axes),
            },
          };
        },
      }),
    );
  plots.push(
    addPlot(grid, {
      title: "Computing time",
      caption: "Wall time of the study at the end of each generation.",
      size: "half",
      height: 320,
      make() {
        const axes = currentAxis();
        const data = axes.map(({ stage, x }, i) => ({
          type: "scatter",
          mode: x.length > 1 ? "lines" : "markers",
          x,
          y: stage.generations.seconds,
          name: stage.stage + ". " + label(stage.optimiser),
          line: { color: seriesColours[i % seriesColours.length], width: 2 },
          customdata: stage.generations.numbers,
          hovertemplate: "%{y:.4g} s<br>generation %{customdata}<extra></extra>",
        }));
        return {
          data,
          layout: {
            xaxis: xaxis(),
            yaxis: axis("wall time [s]", { rangemode: "tozero" }),
            legend: { orientation: "h", x: 0, y: -0.22, yanchor: "top" },
            ...stageSeparators(axes),
          },
        };
      },
    }),
  );
}
