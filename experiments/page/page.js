"use strict";
// The parts of the page, from the top.

function drawSummary() {
  byId("summary").append(...data.summary.map((sentence) => element("li", { textContent: sentence })));
  if (data.failures.length > 0) {
    const box = byId("failures");
    box.hidden = false;
    box.textContent =
        "Cells that failed:\n" + data.failures.map((failure) => `${failure.cell}: ${failure.message}`).join("\n");
  }
  byId("notes").append(...data.notes.map((note) => element("li", { textContent: note })));
  for (const [name, value] of Object.entries(data.provenance)) {
    byId("provenance").append(element("dt", { textContent: name.replaceAll("_", " ") }), element("dd", {
      textContent: String(value)
    }));
  }
}

function drawParameters() {
  const table = byId("parameters");
  table.tHead.append(element("tr", {},
      ...["parameter", ...data.methods.map((method) => method.name)].map(
          (title) => element("th", { textContent: title, scope: "col" }))));
  for (const name of Object.keys(data.methods[0]?.parameters ?? {})) {
    table.tBodies[0].append(element("tr", {}, element("th", { textContent: name, scope: "row" }),
        ...data.methods.map((method) => element("td", { textContent: String(method.parameters[name]) }))));
  }
}

drawSummary();
drawTable();
drawParameters();
drawErrorChart();
drawWaterfalls();
drawViewer();
drawPaths();
document.documentElement.dataset.ready = "true";
