"use strict";
// Error over time: a point per method, the Pareto front of the methods, curves of sweeps, the path tracer's own curve,
// and lines for what the oracle says is the best possible; below, what the path tracer does in the same time.

// The errors that a chart can show: those that some row has.
function errorsToChoose() {
  const ofMeasure = (name) => (row) => measureOf(row, name);
  const all = [
    ["RMSE", (row) => ({ value: row.rmse, lower: row.rmse_lower, upper: row.rmse_upper })],
    ["mean absolute error", ofMeasure("mae")], ["95th percentile", ofMeasure("p95")],
    ["99th percentile", ofMeasure("p99")], ["FLIP", ofMeasure("flip")],
    [
      "flicker",
      ({ stability: of }) => (of ? { value: of.flicker, lower: of.flicker_lower, upper: of.flicker_upper } : {})
    ]
  ];
  for (const region of distinct(data.rows.flatMap((row) => Object.keys(row.regions)))) {
    all.push([
      `RMSE of ${region}`,
      (row) => {
        const of = row.regions[region];
        return of ? { value: of.rmse, lower: of.lower, upper: of.upper } : {};
      }
    ]);
  }
  return new Map(all.filter(([, of]) => data.rows.some((row) => row.measured && of(row).value > 0)));
}

// Those of the points that no other beats in time and error, by time.
function paretoFront(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y)) {
    if (front.length === 0 || point.y < front.at(-1).y) front.push(point);
  }
  return front;
}

// A logarithmic axis over just the values, labelled at 1, 2 and 5 times powers of ten.
function logarithmicAxis(text, values) {
  const ink = styleOf("--ink");
  const reads = ({ value }) => [1, 2, 5].some(
      (digit) => Math.abs(value / 10 ** Math.floor(Math.log10(value) + 1e-9) - digit) < 1e-6);
  return {
    type: "logarithmic",
    title: { display: true, text, color: ink },
    grid: { color: styleOf("--line") },
    ...(values.length > 0 ? { min: Math.min(...values) / 1.25, max: Math.max(...values) * 1.25 } : {}),
    ticks: { color: ink, callback: (value) => short(value) },
    afterBuildTicks: (axis) => {
      const few = axis.ticks.filter(reads);
      if (few.length > 1) axis.ticks = few;
    }
  };
}

// Whiskers of the intervals, across points of this chart.
const whiskers = {
  id: "whiskers",
  beforeDatasetsDraw(chart) {
    const { ctx: context, scales: { x, y }, chartArea: area } = chart;
    context.save();
    context.beginPath();
    context.rect(area.left, area.top, area.width, area.height);
    context.clip();
    chart.data.datasets.forEach((set, index) => {
      if (!chart.isDatasetVisible(index) || set.bare) return;
      context.strokeStyle = set.borderColor;
      for (const point of set.data) {
        if (point.lower > 0 && point.upper > point.lower)
          stroke(x.getPixelForValue(point.x), y.getPixelForValue(point.lower), x.getPixelForValue(point.x),
              y.getPixelForValue(point.upper));
        const { milliseconds_lower: fast, milliseconds_upper: slow } = point.row;
        if (fast > 0 && slow > fast)
          stroke(x.getPixelForValue(fast), y.getPixelForValue(point.y), x.getPixelForValue(slow),
              y.getPixelForValue(point.y));
      }
    });
    context.restore();
    function stroke(...line) {
      context.beginPath();
      context.moveTo(line[0], line[1]);
      context.lineTo(line[2], line[3]);
      context.stroke();
    }
  },
};

function drawErrorChart() {
  const errors = errorsToChoose();
  const usable = data.rows.filter((row) => row.measured && (row.milliseconds > 0 || row.kind === "oracle"));
  if (errors.size === 0 || !usable.some((row) => row.kind !== "oracle")) {
    byId("chart-section").hidden = true;
    return;
  }
  const mean = "mean of all views", all = "all views apart";
  const controls = byId("chart-controls"), placeOf = (row) => `${row.scene} / ${row.place}`;
  const subject = select(controls, "Plane", distinct(usable.map(subjectOf)), redraw);
  const place = select(controls, "View", [mean, all, ...distinct(usable.map(placeOf))], redraw);
  const measure = select(controls, "Error", [...errors.keys()], redraw);
  const names = distinct(data.rows.filter((row) => row.kind === "method").map((row) => row.curve || row.method));
  let chart = null;

  const pointOf = (row) => ({
    x: row.milliseconds,
    y: errors.get(measure.value)(row).value,
    row,
    lower: errors.get(measure.value)(row).lower,
    upper: errors.get(measure.value)(row).upper
  });

  // One point per method: geometric means over the views in which each of them was measured.
  function meanPoints(all_points) {
    // Frames of a path are no further views; paths alone are taken together (flicker).
    const views = all_points.filter(({ row }) => !row.is_path), points = views.length > 0 ? views : all_points;
    const methods = distinct(points.map(({ row }) => row.method));
    const complete = distinct(points.map(({ row }) => placeOf(row)))
                         .filter((where) => methods.every((method) => points.some(({ row }) => row.method === method &&
                                                                  placeOf(row) === where)));
    const geometric = (values) => Math.exp(values.reduce((sum, value) => sum + Math.log(value), 0) / values.length);
    return complete.length === 0 ? [] : methods.map((method) => {
      const of = points.filter(({ row }) => row.method === method && complete.includes(placeOf(row)));
      const row = {
        ...of[0].row,
        scene: "geometric mean",
        place: `${complete.length} ${views.length > 0 ? "views" : "paths"}`,
        milliseconds_lower: null,
        milliseconds_upper: null
      };
      return {
        x: row.kind === "oracle" ? null : geometric(of.map(({ x }) => x)),
        y: geometric(of.map(({ y }) => y)),
        row
      };
    });
  }

  function pointsShown() {
    const ofView = (row) => place.value === all || place.value === mean || placeOf(row) === place.value;
    const points =
        usable.filter((row) => subjectOf(row) === subject.value && ofView(row)).map(pointOf).filter(({ y }) => y > 0);
    return place.value === mean ? meanPoints(points) : points;
  }

  function datasets(points) {
    const sets = names
                     .map((name, index) => {
                       const data =
                           points.filter(({ row }) => row.kind === "method" && (row.curve || row.method) === name);
                       const isCurve = data.some(({ row }) => row.curve) && place.value !== all;
                       data.sort((a, b) => a.row.curve_value - b.row.curve_value);
                       return {
                         label: name,
                         data,
                         backgroundColor: cycled(methodColours, index),
                         borderColor: cycled(methodColours, index),
                         pointStyle: cycled(markers, index),
                         pointRadius: 6,
                         pointHoverRadius: 8,
                         showLine: isCurve,
                         borderWidth: 1.5
                       };
                     })
                     .filter((set) => set.data.length > 0);
    for (const where of distinct(points.map(({ row }) => placeOf(row)))) {
      const curve = points.filter(({ row }) => row.kind === "path tracer" && placeOf(row) === where);
      curve.sort((a, b) => a.row.samples - b.row.samples);
      if (curve.length > 0) {
        sets.push({
          label: "path tracer",
          data: curve,
          showLine: true,
          borderColor: pathTracerColour,
          backgroundColor: pathTracerColour,
          borderWidth: 1.5,
          pointRadius: 3
        });
      }
    }
    const methods = points.filter(({ row }) => row.kind === "method"),
          times = points.filter(({ x }) => x > 0).map(({ x }) => x);
    if (place.value !== all && methods.length > 1) {
      sets.push({
        label: "Pareto front of the methods",
        data: paretoFront(methods),
        showLine: true,
        stepped: true,
        bare: true,
        pointRadius: 0,
        pointStyle: "line",
        pointHitRadius: 0,
        borderColor: styleOf("--ink"),
        backgroundColor: styleOf("--ink"),
        borderWidth: 1,
        borderDash: [2, 3]
      });
    }
    if (place.value !== all) {
      for (const { y, row } of points.filter((point) => point.row.kind === "oracle")) {
        sets.push({
          label: row.method,
          data: [Math.min(...times), Math.max(...times)].map((x) => ({ x, y, row })),
          showLine: true,
          bare: true,
          pointRadius: 0,
          pointStyle: "line",
          borderColor: styleOf("--faint"),
          backgroundColor: styleOf("--faint"),
          borderWidth: 1.5,
          borderDash: [8, 4]
        });
      }
    }
    return sets;
  }

  function describe({ row, x, y, lower, upper }) {
    const time = x > 0 && row.kind !== "oracle" ? `, ${short(x)} ms` : "";
    return [`${row.method}: ${row.scene} / ${row.place}`, `${measure.value} ${interval(y, lower, upper)}${time}`];
  }

  function redraw() {
    const points = pointsShown(), ink = styleOf("--ink");
    const times = points.flatMap(({ x, row }) => [x, row.milliseconds_lower, row.milliseconds_upper])
                      .filter((value) => value > 0);
    const values = points.flatMap(({ y, lower, upper }) => [y, lower, upper]).filter((value) => value > 0);
    const options = {
      animation: false,
      maintainAspectRatio: false,
      responsive: true,
      scales: { x: logarithmicAxis("milliseconds per frame", times), y: logarithmicAxis(measure.value, values) },
      plugins: {
        legend: {
          labels: {
            color: ink,
            usePointStyle: true,
            filter: (item, { datasets: sets }) => sets.findIndex((set) => set.label === item.text) === item.datasetIndex
          },
          onClick: (event, item, legend) => toggleAll(legend.chart, item)
        },
        tooltip: { callbacks: { label: ({ raw }) => describe(raw) } },
      },
    };
    chart?.destroy();
    chart = new Chart(
        byId("chart"), { type: "scatter", data: { datasets: datasets(points) }, options, plugins: [whiskers] });
    walkByKeys(points.filter(({ x }) => x > 0).sort((a, b) => a.x - b.x));
    drawEqualCost(points, measure.value);
  }

  // Curves of one name come and go together.
  function toggleAll(of, item) {
    const label = of.data.datasets[item.datasetIndex].label, visible = of.isDatasetVisible(item.datasetIndex);
    of.data.datasets.forEach((set, index) => {
      if (set.label === label) of.setDatasetVisibility(index, !visible);
    });
    of.update();
  }

  // Left and right go from point to point; the point's text is also read out.
  function walkByKeys(points) {
    let at = -1;
    byId("chart").onkeydown = (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step || points.length === 0) return;
      event.preventDefault();
      at = (at + step + points.length) % points.length;
      const datasetIndex = chart.data.datasets.findIndex((set) => !set.bare && set.data.includes(points[at]));
      const active = [{ datasetIndex, index: chart.data.datasets[datasetIndex].data.indexOf(points[at]) }];
      chart.setActiveElements(active);
      chart.tooltip.setActiveElements(active, { x: 0, y: 0 });
      chart.update();
      byId("chart-spoken").textContent = describe(points[at]).join(", ");
    };
  }
  followColourScheme(redraw);
}
