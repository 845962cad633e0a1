"use strict";
// Camera paths: the frames of truth, methods and error maps in step, to be scrubbed or played, and below them each
// method's flicker over time with a line at the frame that is seen.

// A vertical line at the frame that is seen.
const frameLine = {
  id: "frameLine",
  afterDatasetsDraw(chart) {
    const x = chart.scales.x.getPixelForValue(chart.options.plugins.frameLine.time),
          { ctx: context, chartArea: area } = chart;
    context.save();
    context.strokeStyle = styleOf("--accent");
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x, area.top);
    context.lineTo(x, area.bottom);
    context.stroke();
    context.restore();
  },
};

function drawPaths() {
  const section = byId("paths-section");
  if (data.paths.length === 0) {
    section.hidden = true;
    return;
  }
  const state = { path: null, shown: new Set(), frame: 0, playing: false, request: 0 };
  const choice = byId("path-controls"), player = byId("path-player");
  const nameOf = (path) => `${path.scene} / ${path.path}`;
  const name = select(choice, "Path", distinct(data.paths.map(nameOf)), nameChanged);
  const subject = select(choice, "Plane", [], pathChanged);
  const measure = select(choice, "Plot", ["flicker", "RMSE"], () => followed());
  const play = button("Play", () => (state.playing ? stop() : start()));
  const back = button("\u2039", () => show(state.frame - 1), { ariaLabel: "frame before" });
  const next = button("\u203a", () => show(state.frame + 1), { ariaLabel: "next frame" });
  player.append(element("span", { className: "buttons" }, play, back, next));
  const scrub = slider(player, "Frame", { min: 0, max: 1, step: 1, value: 0, say: sayFrame }, (frame) => {
    stop();
    show(frame);
  });
  const speed = select(player, "Speed", ["1", "1/2", "1/4", "1/8"], () => {});
  const group = new PaneGroup(byId("path-pictures"));
  player.append(group.zoomControls());
  let chart = null;

  const lengthOf = () => state.path?.strips[0].count ?? 1;
  function sayFrame(frame) {
    return state.path ? `${frame + 1} of ${lengthOf()}, ${(frame / state.path.frames_per_second).toFixed(2)} s` : "";
  }
  const titleOf = (strip) => (strip.kind === "error" ? `${strip.label}: error` : strip.label);

  function nameChanged() {
    fillOptions(subject, data.paths.filter((path) => nameOf(path) === name.value).map(subjectOf));
    pathChanged();
  }

  function pathChanged() {
    stop();
    state.path = data.paths.find((path) => nameOf(path) === name.value && subjectOf(path) === subject.value);
    const methods = distinct(state.path.strips.filter((strip) => strip.kind === "method").map((strip) => strip.label))
                        .slice(0, isNarrow() ? 1 : 2);
    state.shown = new Set(state.path.strips.filter((strip) => strip.kind === "truth" || methods.includes(strip.label)));
    scrub.box.max = lengthOf() - 1;
    const exposure = state.path.exposure_note ? `${state.path.exposure_note}; ` : "";
    byId("path-legend").replaceChildren(...errorLegend(errorKinds.absolute.words, "error", 0, state.path.error_scale));
    byId("path-note").textContent =
        `${exposure}frames are JPEG pictures to look at; the figures come from the float frames.`;
    arrange();
    followed();
    show(Math.min(state.frame, lengthOf() - 1));
  }

  // The frames of a strip as image elements; decoded when the strip is first shown.
  function framesOf(strip) {
    const images = byId(`frames-${strip.frames}`).textContent.trim().split("\n").map((line) => {
      const image = new Image();
      image.src = `data:image/jpeg;base64,${line}`;
      return image;
    });
    return Promise.all(images.map((image) => image.decode().then(() => image)));
  }

  async function arrange() {
    const request = ++state.request, { path } = state;
    byId("path-buttons").replaceChildren(...path.strips.map((strip) => button(titleOf(strip), () => {
      if (!state.shown.delete(strip)) state.shown.add(strip);
      arrange();
    }, { ariaPressed: String(state.shown.has(strip)) })));
    const strips = path.strips.filter((strip) => state.shown.has(strip));
    const upper = strips.filter((strip) => strip.kind !== "error");
    byId("path-pictures").style.setProperty("--columns", Math.max(upper.length, 1));
    section.setAttribute("aria-busy", "true");
    await Promise.all(strips.map(async (strip) => {
      strip.images ??= await framesOf(strip);
    }));
    if (request !== state.request) return;  // another choice was made meanwhile
    section.removeAttribute("aria-busy");
    group.setPanes(strips.map((strip) => {
      const column = upper.findIndex((other) => other.label === strip.label) + 1;
      return {
        title: titleOf(strip),
        strip,
        image: null,
        ...(column > 0 ? { column, row: strip.kind === "error" ? 2 : 1 } : {})
      };
    }));
    show(state.frame);
  }

  // All panes turn to the frame within one frame of the screen.
  function show(frame) {
    state.frame = Math.min(Math.max(Math.round(frame), 0), lengthOf() - 1);
    scrub.set(state.frame);
    for (const pane of group.panes) {
      const { strip } = pane, error = strip.rmse?.[state.frame], flicker = strip.flicker?.[state.frame];
      pane.image = strip.images[state.frame];
      pane.caption.querySelector("span").textContent = [
        isNumber(error) ? `RMSE ${short(error)}` : "", isNumber(flicker) ? `flicker ${short(flicker)}` : ""
      ].filter(Boolean).join(", ");
    }
    group.update();
    if (chart) {
      chart.options.plugins.frameLine.time = timeOf(state.frame);
      chart.draw();
    }
  }
  const timeOf = (frame) => frame / state.path.frames_per_second;

  function start() {
    state.playing = true;
    play.textContent = "Pause";
    const [over, under] = speed.value.split("/").map(Number);
    const factor = over / (under ?? 1), length = lengthOf();
    const first = state.frame === length - 1 ? 0 : state.frame;
    let began = null;
    const step = (now) => {
      if (!state.playing) return;
      began ??= now;
      show((first + Math.floor(((now - began) / 1000) * state.path.frames_per_second * factor)) % length);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }
  function stop() {
    state.playing = false;
    play.textContent = "Play";
  }

  function followed() {
    const key = measure.value === "RMSE" ? "rmse" : "flicker", ink = styleOf("--ink"), line = styleOf("--line");
    const methods = state.path.strips.filter((strip) => strip.kind === "method");
    const axis = (text) => ({
      type: "linear",
      title: { display: true, text, color: ink },
      grid: { color: line },
      ticks: { color: ink, callback: (value) => short(value) }
    });
    const options = {
      animation: false,
      maintainAspectRatio: false,
      responsive: true,
      spanGaps: false,
      scales: {
        x: {...axis("seconds"), max: timeOf(lengthOf() - 1), min: 0 },
        y: {...axis(measure.value), beginAtZero: true }
      },
      interaction: { mode: "nearest", axis: "x", intersect: false },
      onClick: (event, active) => {
        if (active.length > 0) {
          stop();
          show(active[0].index);
        }
      },
      plugins: {
        frameLine: { time: timeOf(state.frame) },
        legend: { labels: { color: ink, usePointStyle: true } },
        tooltip: {
          callbacks: {
            title: ([item]) => `frame ${item.dataIndex + 1}`,
            label: ({ dataset, raw }) => `${dataset.label}: ${short(raw.y)}`
          }
        }
      },
    };
    const datasets = methods.map((strip, index) => ({
      label: strip.label,
      data: (strip[key] ?? []).map((y, frame) => ({ x: timeOf(frame), y: y ?? NaN })),
      showLine: true,
      borderColor: cycled(methodColours, index),
      backgroundColor: cycled(methodColours, index),
      pointStyle: cycled(markers, index),
      pointRadius: 2.5,
      borderWidth: 1.5
    }));
    chart?.destroy();
    chart = new Chart(byId("path-chart"), { type: "scatter", data: { datasets }, options, plugins: [frameLine] });
  }
  nameChanged();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", followed);
}
