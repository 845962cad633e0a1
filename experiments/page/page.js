"use strict";

// A script error is shown on the page itself, where a reader and the tests find it.
window.addEventListener("error", (event) => {
  const box = document.getElementById("script-errors");
  box.hidden = false;
  box.textContent += `${event.message} (line ${event.lineno})\n`;
});

const data = JSON.parse(document.getElementById("data").textContent);

// Okabe and Ito's colours, which stay apart for colour-blind readers; grey is the path tracer's.
const methodColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const pathTracerColour = "#888888";

function element(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

const distinct = (values) => [...new Set(values)];
const styleOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function short(value) {
  if (value === null || value === undefined) return "";
  if (Math.abs(value) >= 1000) return Number(value).toFixed(0);
  return Number(value).toPrecision(3).replace(/e([+-])0*(\d)/, "e$1$2");
}

function select(parent, label, options, onChange) {
  const box = element("select");
  for (const option of options) box.append(element("option", { value: option, textContent: option }));
  box.addEventListener("change", onChange);
  parent.append(element("label", {}, label, box));
  return box;
}

// What a comparison is about: the plane, and the truth where there are two.
const subjectOf = (row) => (row.truth ? `${row.plane} (truth: ${row.truth})` : row.plane);

function drawSummary() {
  const list = document.getElementById("summary");
  for (const sentence of data.summary) list.append(element("li", { textContent: sentence }));
  if (data.failures.length > 0) {
    const box = document.getElementById("failures");
    box.hidden = false;
    box.textContent = "Cells that failed:\n" + data.failures.map((failure) => `${failure.cell}: ${failure.message}`).join("\n");
  }
  const notes = document.getElementById("notes");
  for (const note of data.notes) notes.append(element("li", { textContent: note }));
  const facts = document.getElementById("provenance");
  for (const [name, value] of Object.entries(data.provenance)) {
    facts.append(element("dt", { textContent: name.replaceAll("_", " ") }), element("dd", { textContent: String(value) }));
  }
}

function drawChart() {
  const measured = data.rows.filter((row) => row.rmse !== null && row.milliseconds > 0);
  if (measured.length === 0) {
    document.querySelector(".chart").hidden = true;
    return;
  }
  const controls = document.getElementById("chart-controls");
  const mean = "mean of all views", all = "all views apart";
  const placeOf = (row) => `${row.scene} / ${row.view}`;
  const places = [mean, all, ...distinct(measured.map(placeOf))];
  const subject = select(controls, "Plane", distinct(measured.map(subjectOf)), redraw);
  const place = select(controls, "View", places, redraw);
  const methods = distinct(data.rows.filter((row) => !row.path_tracer_samples).map((row) => row.method));
  let chart = null;

  // One row per method: geometric means over the views in which each of them was measured.
  function meanRows(rows) {
    const names = distinct(rows.map((row) => row.method));
    const complete = distinct(rows.map(placeOf)).filter((where) =>
      names.every((name) => rows.some((row) => row.method === name && placeOf(row) === where && row.rmse > 0)));
    const geometric = (values) => Math.exp(values.reduce((sum, value) => sum + Math.log(value), 0) / values.length);
    return complete.length === 0 ? [] : names.map((name) => {
      const of = rows.filter((row) => row.method === name && complete.includes(placeOf(row)));
      return { ...of[0], scene: "geometric mean", view: `${complete.length} views`, rmse: geometric(of.map((row) => row.rmse)),
        milliseconds: geometric(of.map((row) => row.milliseconds)), rmse_lower: null, rmse_upper: null };
    });
  }

  function datasets() {
    let rows = measured.filter((row) => subjectOf(row) === subject.value &&
      (place.value === all || place.value === mean || placeOf(row) === place.value));
    if (place.value === mean) rows = meanRows(rows);
    const point = (row) => ({ x: row.milliseconds, y: row.rmse, row });
    const sets = methods.map((method, index) => ({
      label: method, data: rows.filter((row) => row.method === method && !row.path_tracer_samples).map(point),
      backgroundColor: methodColours[index % methodColours.length], borderColor: methodColours[index % methodColours.length],
      pointStyle: ["circle", "rect", "triangle", "rectRot", "star", "cross"][index % 6], pointRadius: 6, pointHoverRadius: 8,
    }));
    for (const where of distinct(rows.map(placeOf))) {
      const curve = rows.filter((row) => row.path_tracer_samples && placeOf(row) === where);
      if (curve.length === 0) continue;
      curve.sort((a, b) => a.path_tracer_samples - b.path_tracer_samples);
      sets.push({
        label: "path tracer", data: curve.map(point), showLine: true, borderColor: pathTracerColour,
        backgroundColor: pathTracerColour, borderWidth: 1.5, pointRadius: 3,
      });
    }
    return sets;
  }

  function redraw() {
    const ink = styleOf("--ink"), line = styleOf("--line");
    const axis = (text) => ({
      type: "logarithmic", title: { display: true, text, color: ink }, grid: { color: line },
      ticks: { color: ink, maxTicksLimit: 12, callback: (value) => short(value) },
    });
    const options = {
      animation: false, maintainAspectRatio: false, responsive: true,
      scales: { x: axis("milliseconds per frame"), y: axis("RMSE") },
      plugins: {
        legend: { labels: { color: ink, usePointStyle: true,
          filter: (item, all_data) => all_data.datasets.findIndex((set) => set.label === item.text) === item.datasetIndex },
          onClick: (event, item, legend) => {  // all curves of one name together
            const label = legend.chart.data.datasets[item.datasetIndex].label;
            const visible = legend.chart.isDatasetVisible(item.datasetIndex);
            legend.chart.data.datasets.forEach((set, index) => {
              if (set.label === label) legend.chart.setDatasetVisibility(index, !visible);
            });
            legend.chart.update();
          } },
        tooltip: { callbacks: { label: ({ raw }) => [
          `${raw.row.method}: ${raw.row.scene} / ${raw.row.view}`,
          `RMSE ${short(raw.row.rmse)}${raw.row.rmse_lower === null ? "" : ` [${short(raw.row.rmse_lower)}, ${short(raw.row.rmse_upper)}]`}, ${short(raw.row.milliseconds)} ms`,
        ] } },
      },
    };
    if (chart) chart.destroy();
    chart = new Chart(document.getElementById("chart"), { type: "scatter", data: { datasets: datasets() }, options });
  }
  redraw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

function drawPictures() {
  if (data.pictures.length === 0) return;
  const controls = document.getElementById("picture-controls");
  const scene = select(controls, "Scene", distinct(data.pictures.map((set) => set.scene)), sceneChanged);
  const view = select(controls, "View", [], redraw);
  const subject = select(controls, "Plane", distinct(data.pictures.map(subjectOf)), redraw);

  function sceneChanged() {
    const views = distinct(data.pictures.filter((set) => set.scene === scene.value).map((set) => set.view));
    view.replaceChildren(...views.map((name) => element("option", { value: name, textContent: name })));
    redraw();
  }

  function redraw() {
    const set = data.pictures.find((candidate) => candidate.scene === scene.value && candidate.view === view.value &&
      subjectOf(candidate) === subject.value);
    const area = document.getElementById("pictures");
    area.replaceChildren();
    if (!set) {
      area.append(element("p", { className: "note", textContent: "No pictures of this combination." }));
      return;
    }
    // Upper row: truth and methods; lower row: the legend below the truth, each error below its method.
    const upper = set.images.filter((picture) => picture.kind !== "error");
    const lower = set.images.filter((picture) => picture.kind === "error");
    area.style.setProperty("--columns", upper.length);
    const figure = (picture) => {
      const title = picture.kind === "error" ? `${picture.label}: error` : picture.label;
      const caption = element("figcaption", {}, title + " ", element("span", { textContent: picture.note || "" }));
      const alt = `${title}, ${set.scene}, ${set.view}, ${subjectOf(set)}`;
      return element("figure", {}, element("img", { src: data.files[picture.file], alt }), caption);
    };
    const ramp = element("div", { className: "ramp" });
    ramp.style.background = `linear-gradient(to right, ${data.colour_map.join(", ")})`;
    const legend = element("div", { className: "legend" }, element("div", {}, "Error, |difference| averaged over channels"), ramp,
      element("div", { className: "ends" }, element("span", { textContent: "0" }), element("span", { textContent: `${short(set.error_scale)} and more` })),
      element("div", { textContent: set.exposure_note || "" }));
    area.append(...upper.map(figure), legend, ...lower.map(figure));
  }
  sceneChanged();
}

function interval(value, low, high) {
  const cell = element("td", { className: "number" }, short(value));
  if (low !== null && low !== undefined) cell.append(" ", element("span", { className: "interval", textContent: `[${short(low)}, ${short(high)}]` }));
  return cell;
}

function drawTable() {
  const columns = [
    ["scene", "scene"], ["view", "view"], ["plane", "plane"], ["truth", "truth"], ["method", "method"], ["RMSE", "rmse"],
    ["PSNR", "psnr"], ["SSIM", "ssim"], ["noise of truth", "noise"], ["ms", "milliseconds"],
  ];
  const numbers = new Set(["rmse", "psnr", "ssim", "noise", "milliseconds"]);
  const table = document.getElementById("table"), controls = document.getElementById("table-controls");
  const everything = "all";
  const filters = ["scene", "plane", "method"].map((key) => [key,
    select(controls, key[0].toUpperCase() + key.slice(1), [everything, ...distinct(data.rows.map((row) => row[key]))], redraw)]);
  let sortKey = null, ascending = true;

  const heads = columns.map(([title, key]) => {
    const button = element("button", { type: "button", textContent: title });
    button.addEventListener("click", () => {
      ascending = sortKey === key ? !ascending : true;
      sortKey = key;
      redraw();
    });
    return element("th", { className: numbers.has(key) ? "number" : "", scope: "col" }, button);
  });
  table.tHead.append(element("tr", {}, ...heads));

  function redraw() {
    let rows = data.rows.filter((row) => filters.every(([key, box]) => box.value === everything || row[key] === box.value));
    if (sortKey) {
      const order = (a, b) => {
        if (a[sortKey] === b[sortKey]) return 0;
        if (a[sortKey] === null) return 1;  // unmeasured cells come last either way
        if (b[sortKey] === null) return -1;
        return (a[sortKey] < b[sortKey] ? -1 : 1) * (ascending ? 1 : -1);
      };
      rows = [...rows].sort(order);
    }
    heads.forEach((head, index) => {
      if (columns[index][1] === sortKey) head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
    });
    table.tBodies[0].replaceChildren(...rows.map((row) => {
      const line = element("tr", {}, ...["scene", "view", "plane", "truth", "method"].map((key) => element("td", { textContent: row[key] })));
      if (row.rmse === null) {
        line.append(element("td", { className: "unmeasured", colSpan: 4, textContent: row.refusal }));
      } else {
        line.append(interval(row.rmse, row.rmse_lower, row.rmse_upper), element("td", { className: "number", textContent: short(row.psnr) }),
          element("td", { className: "number", textContent: short(row.ssim) }), element("td", { className: "number", textContent: short(row.noise) }));
      }
      line.append(interval(row.milliseconds, row.milliseconds_lower, row.milliseconds_upper));
      return line;
    }));
  }
  redraw();
}

function drawParameters() {
  const table = document.getElementById("parameters");
  table.tHead.append(element("tr", {}, ...["parameter", ...data.methods.map((method) => method.name)].map((title) => element("th", { textContent: title, scope: "col" }))));
  for (const name of Object.keys(data.methods[0]?.parameters ?? {})) {
    table.tBodies[0].append(element("tr", {}, element("td", { textContent: name }),
      ...data.methods.map((method) => element("td", { textContent: String(method.parameters[name]) }))));
  }
}

drawSummary();
drawPictures();
drawTable();
drawParameters();
drawChart();
document.documentElement.dataset.ready = "true";
