"use strict";
// Waterfalls: each bar begins where the one before it ends, from the truth down to a method.

// The interval of each step, from where its bar begins.
const stepWhiskers = {
  id: "stepWhiskers",
  afterDatasetsDraw(chart) {
    const { ctx: context, scales: { x } } = chart;
    context.save();
    context.strokeStyle = styleOf("--ink");
    chart.options.plugins.stepWhiskers.bars.forEach((bar, index) => {
      if (!isNumber(bar.lower) || !isNumber(bar.upper)) return;
      const middle = chart.getDatasetMeta(0).data[index].y;
      context.beginPath();
      context.moveTo(x.getPixelForValue(bar.from + bar.lower), middle);
      context.lineTo(x.getPixelForValue(bar.from + bar.upper), middle);
      context.stroke();
    });
    context.restore();
  },
};

function drawWaterfalls() {
  const section = byId("waterfall-section");
  if (data.waterfalls.length === 0) {
    section.hidden = true;
    return;
  }
  const choice = select(byId("waterfall-controls"), "Of", data.waterfalls.map((waterfall) => waterfall.title), redraw);
  let chart = null;

  function describe(bar) {
    const change = bar.to - bar.from, sign = change >= 0 ? "+" : "\u2212";
    const lines = [`${sign}${short(Math.abs(change))}${
        isNumber(bar.lower) ? ` [${short(bar.lower)}, ${short(bar.upper)}]` :
                              ""}: from ${short(bar.from)} to ${short(bar.to)}`];
    return bar.note ? [...lines, bar.note] : lines;
  }

  function redraw() {
    const waterfall = data.waterfalls.find((candidate) => candidate.title === choice.value), { bars } = waterfall;
    const ink = styleOf("--ink"), line = styleOf("--line");
    const adds = methodColours[1], takesAway = methodColours[2];
    const colours = bars.map((bar) => (bar.to >= bar.from ? adds : takesAway));
    const options = {
      indexAxis: "y",
      animation: false,
      maintainAspectRatio: false,
      responsive: true,
      scales: {
        x: {
          title: { display: true, text: waterfall.axis, color: ink },
          grid: { color: line },
          ticks: { color: ink, callback: (value) => short(value) }
        },
        y: { grid: { display: false }, ticks: { color: ink, autoSkip: false } }
      },
      plugins: {
        stepWhiskers: { bars },
        legend: { display: false },
        tooltip: { callbacks: { label: ({ dataIndex }) => describe(bars[dataIndex]) } }
      },
    };
    byId("waterfall").parentElement.style.height = `${4 + 2 * bars.length}rem`;
    chart?.destroy();
    chart = new Chart(byId("waterfall"), {
      type: "bar",
      options,
      plugins: [stepWhiskers],
      data: {
        labels: bars.map((bar) => bar.label),
        datasets: [{
          data: bars.map((bar) => [bar.from, bar.to]),
          backgroundColor: colours,
          borderSkipped: false,
          minBarLength: 2
        }]
      }
    });
    const head = element(
        "tr", {}, ...["rung", waterfall.axis, ""].map((title) => element("th", { textContent: title, scope: "col" })));
    byId("waterfall-table").tHead.replaceChildren(head);
    byId("waterfall-table").tBodies[0].replaceChildren(...bars.map((bar) => {
      const [change, note] = describe(bar);
      return element("tr", {}, element("th", { textContent: bar.label, scope: "row" }),
          element("td", { textContent: change }), element("td", { textContent: note ?? "" }));
    }));
  }
  followColourScheme(redraw);
}
