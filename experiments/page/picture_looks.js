"use strict";
// How the viewer colours its pictures: exposure, kind and range of errors, and the legend that tells them.
//
// An item is a picture of the set, { kind: "truth", "method" or "error", plane }; an error's `plane` is its method's.

class PictureLooks {
  constructor(controls, legend, onChange) {
    this.legend = legend;
    const saySigned = (stops) => `${stops >= 0 ? "+" : "\u2212"}${Math.abs(stops).toFixed(2)} stops`;
    const sayFactor = (stops) => `\u00d7${short(2 ** stops)}`;
    this.exposure = slider(controls, "Exposure", { min: -8, max: 8, step: 0.25, value: 0, say: saySigned }, onChange);
    this.errorKind = select(controls, "Error", Object.keys(errorKinds), onChange);
    this.range = slider(controls, "Error range", { min: -5, max: 5, step: 0.5, value: 0, say: sayFactor }, onChange);
  }

  reset() {
    this.exposure.set(0);
    this.range.set(0);
  }

  // Stops, of the set and of the slider together.
  stopsOf(set) { return set.exposure + Number(this.exposure.box.value); }

  // The error that takes the last colour.
  scaleOf(set) {
    return (errorKinds[this.errorKind.value].scale ?? set.error_scale) * 2 ** Number(this.range.box.value);
  }

  // Makes the errors of the kind that is chosen, and forgets how the items looked before.
  prepare(items) {
    const kind = this.errorKind.value;
    for (const item of items) {
      item.canvas = null;
      if (item.kind !== "error" || (item.errorKind === kind && item.errorOf === item.plane)) continue;
      Object.assign(
          item, { error: errorPlane(item.plane, items[0].plane, kind), errorKind: kind, errorOf: item.plane });
    }
  }

  canvasOf(item, set) {
    item.canvas ??= item.kind === "error" ?
        errorCanvas(item.error, this.scaleOf(set), errorKinds[item.errorKind].signed) :
        pictureCanvas(item.plane, set.display, this.stopsOf(set));
    return item.canvas;
  }

  drawLegend(set) {
    const kind = errorKinds[this.errorKind.value], scale = this.scaleOf(set), low = kind.signed ? -scale : 0;
    const shown = `Pictures: exposure ${this.stopsOf(set).toFixed(1)} stops, then the sRGB curve. `;
    this.legend.replaceChildren(...errorLegend(kind.words, kind.signed ? "signed" : "error", low, scale),
        element("div", { textContent: `${set.display === "radiance" ? shown : ""}Magenta is no number.` }));
  }
}
