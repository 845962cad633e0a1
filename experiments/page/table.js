"use strict";
// Every cell of the run as a table that sorts by any column, and whose groups of columns come and go.

// A column is { title, value(row): what sorts, text(row)?: what is seen, error?: whether a refusal covers it }.
function tableColumns() {
  const words = (title, key) => ({ title, value: (row) => row[key] });
  const number = (title, value, more = {}) => ({ title, number: true, value, ...more });
  const error = (title, of) => number(title, (row) => of(row).value,
      { error: true, text: (row) => interval(of(row).value, of(row).lower, of(row).upper) });
  const has = (of) => data.rows.some((row) => isNumber(of(row)));
  const groups = [[
    "",
    [
      words("scene", "scene"),
      words(data.rows.some((row) => row.is_path) ? "view or path" : "view", "place"),
      words("plane", "plane"),
      words("truth", "truth"),
      words("method", "method"),
      error("RMSE", (row) => ({ value: row.rmse, lower: row.rmse_lower, upper: row.rmse_upper })),
      number("PSNR", (row) => row.psnr, { error: true }),
      number("SSIM", (row) => row.ssim, { error: true }),
      number("ms", (row) => row.milliseconds,
          { text: (row) => interval(row.milliseconds, row.milliseconds_lower, row.milliseconds_upper) }),
    ]
  ]];

  const regions = distinct(data.rows.flatMap((row) => Object.keys(row.regions)));
  if (regions.length > 0) {
    groups.push([
      "regions",
      regions.map((name) => error(`RMSE of ${name}`,
                      (row) => {
                        const region = row.regions[name];
                        return region ? { value: region.rmse, lower: region.lower, upper: region.upper } : {};
                      }))
    ]);
  }
  if (data.rows.some((row) => row.stability)) {
    const of = (key) => (row) => row.stability?.[key];
    groups.push([
      "stability",
      [
        error("flicker",
            ({ stability }) => (stability ?
                    { value: stability.flicker, lower: stability.flicker_lower, upper: stability.flicker_upper } :
                    {})),
        number("warping error", of("method_warping"), { error: true }),
        number("that of the truth", of("truth_warping"), { error: true }),
        number("temporal variance", of("temporal_variance"), { error: true }),
      ]
    ]);
  }
  const seen = new Set(["rmse", "mse", "psnr", "ssim", "data_range", "trustworthy"]);
  const isEnd = (name) => name.endsWith("_lower") || name.endsWith("_upper");
  const others = data.measure_names.filter(
      (name) => !seen.has(name) && !isEnd(name) && has((row) => measureOf(row, name).value));
  if (others.length > 0) {
    groups.push(
        ["all measures", others.map((name) => error(name.replaceAll("_", " "), (row) => measureOf(row, name)))]);
  }
  groups.push([
    "noise and memory",
    [number("noise of truth", (row) => row.noise, { error: true }), number("G-buffer B/px", (row) => row.bytes || null)]
  ]);
  return new Map(groups);
}

function drawTable() {
  const groups = tableColumns(), table = byId("table"), controls = byId("table-controls"), everything = "all";
  const filters =
      ["scene", "plane", "method"].map((key) => [key,
                                           select(controls, key[0].toUpperCase() + key.slice(1),
                                               [everything, ...distinct(data.rows.map((row) => row[key]))], redraw)]);
  const shown = new Set([""]);
  for (const group of [...groups.keys()].slice(1)) {
    checkbox(controls, group, false, (on) => {
      shown[on ? "add" : "delete"](group);
      redraw();
    });
  }
  let sorted = null, ascending = true;

  const isMissing = (value) => value === null || value === undefined || Number.isNaN(value);
  function order(a, b) {
    const left = sorted.value(a), right = sorted.value(b);
    if (isMissing(left) || isMissing(right)) return isMissing(left) - isMissing(right);  // last either way
    return (left < right ? -1 : left > right ? 1 : 0) * (ascending ? 1 : -1);
  }

  function headOf(column) {
    const title = button(column.title, () => {
      ascending = sorted === column ? !ascending : true;
      sorted = column;
      redraw();
      [...table.tHead.querySelectorAll("button")].find((other) => other.textContent === column.title)?.focus();
    });
    const head = element("th", { scope: "col", className: column.number ? "number" : "" }, title);
    if (column === sorted) head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    return head;
  }

  function lineOf(row, columns) {
    const line = element("tr");
    let refused = null;
    for (const column of columns) {
      if (!row.measured && column.error) {
        if (refused)
          ++refused.colSpan;
        else
          line.append(refused = element("td", { className: "unmeasured", colSpan: 1, textContent: row.refusal }));
        continue;
      }
      refused = null;
      const text = column.text ? column.text(row) : column.number ? short(column.value(row)) : column.value(row);
      const [value, bounds] = text.split(" [");
      const cell = element("td", { className: column.number ? "number" : "" }, bounds && column.number ? value : text);
      if (bounds && column.number)
        cell.append(" ", element("span", { className: "interval", textContent: `[${bounds}` }));
      line.append(cell);
    }
    return line;
  }

  function redraw() {
    const columns = [...groups].filter(([group]) => shown.has(group)).flatMap(([, of]) => of);
    if (sorted && !columns.includes(sorted)) sorted = null;
    let rows =
        data.rows.filter((row) => filters.every(([key, box]) => box.value === everything || row[key] === box.value));
    if (sorted) rows = [...rows].sort(order);
    table.tHead.replaceChildren(element("tr", {}, ...columns.map(headOf)));
    table.tBodies[0].replaceChildren(...rows.map((row) => lineOf(row, columns)));
    byId("table-count").textContent = `${rows.length} of ${data.rows.length} cells`;
  }
  redraw();
}
