"use strict";
// What the path tracer does in a method's time, and how long it takes to a method's error: read off its own curve.

// y at x on the curve through `points` ([x, y] by x), straight between logarithms; null beyond its ends.
function onCurve(points, x) {
  for (let i = 1; i < points.length; ++i) {
    const [[x0, y0], [x1, y1]] = [points[i - 1], points[i]];
    if (x < x0 || x > x1 || x0 === x1) continue;
    return Math.exp(Math.log(y0) + (Math.log(y1 / y0) * Math.log(x / x0)) / Math.log(x1 / x0));
  }
  return null;
}

// The rows of the table for the chart's points; several views apart have no common curve.
function drawEqualCost(points, error) {
  const table = byId("equal-cost"), places = distinct(points.map(({ row }) => `${row.scene} / ${row.place}`));
  const curve =
      points.filter(({ row }) => row.kind === "path tracer").map(({ x, y }) => [x, y]).sort((a, b) => a[0] - b[0]);
  byId("equal-cost-section").hidden = places.length !== 1 || curve.length < 2;
  if (byId("equal-cost-section").hidden) return;
  const byError = curve.map(([x, y]) => [y, x]).sort((a, b) => a[0] - b[0]);
  const ends = { time: curve.map(([x]) => x), error: curve.map(([, y]) => y) };
  const outside = (value, range, below, above) => (value < Math.min(...range) ? below : above);
  const cell = (text) => element("td", { className: "number", textContent: text });
  table.tHead.replaceChildren(element("tr", {},
      ...["method", error, "ms", `path tracer in the same ms: ${error}`, `path tracer at the same ${error}: ms`].map(
          (title, index) => element("th", { textContent: title, scope: "col", className: index ? "number" : "" }))));
  table.tBodies[0].replaceChildren(
      ...points.filter(({ row }) => row.kind === "method").sort((a, b) => a.x - b.x).map(({ x, y, row }) => {
        const sameTime = onCurve(curve, x), sameError = onCurve(byError, y);
        return element("tr", {}, element("th", { textContent: row.method, scope: "row" }), cell(short(y)),
            cell(short(x)),
            cell(sameTime === null ? outside(x, ends.time, `above ${short(Math.max(...ends.error))}`,
                                         `below ${short(Math.min(...ends.error))}`) :
                                     short(sameTime)),
            cell(sameError === null ? outside(y, ends.error, `above ${short(Math.max(...ends.time))}`,
                                          `below ${short(Math.min(...ends.time))}`) :
                                      short(sameError)));
      }));
}
