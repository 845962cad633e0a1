"use strict";
// Pictures side by side that pan and zoom together, by mouse, touch and keys, and share one marked pixel.
//
// A pane is { title, note, image, under?, column?, row? }: `image` is a canvas or an image element, `under` another one
// that is shown left of the group's `split` instead. `group.panes[i].image` may be replaced at any time; then update().

class PaneGroup {
  // `onProbe(x, y)` hears of the pixel under the pointer, `onSplit(fraction)` of a split that was dragged.
  constructor(area, { onProbe = () => {}, onSplit = () => {} } = {}) {
    Object.assign(this, { area, onProbe, onSplit, panes: [], zoom: 1, x: 0.5, y: 0.5, split: 0.5, probe: null });
    this.pointers = new Map();
    this.update = oncePerFrame(() => this.draw());
    this.resized = new ResizeObserver(this.update);
  }

  setPanes(panes) {
    this.resized.disconnect();
    this.pointers.clear();
    this.panes = panes;
    for (const pane of panes) {
      pane.canvas = element("canvas", { tabIndex: 0 });
      pane.canvas.setAttribute("role", "img");
      pane.canvas.setAttribute(
          "aria-label", `${pane.title}. Plus and minus zoom, arrows move, shift and arrows choose a pixel`);
      this.listen(pane.canvas);
      pane.caption = element("figcaption", {}, pane.title, " ", element("span", { textContent: pane.note ?? "" }));
      pane.figure = element("figure", {}, pane.canvas, pane.caption);
      if (pane.column) pane.figure.style.gridColumn = pane.column;
      if (pane.row) pane.figure.style.gridRow = pane.row;
      this.resized.observe(pane.canvas);
    }
    this.area.replaceChildren(...panes.map((pane) => pane.figure));
    this.update();
  }

  // Buttons for those without wheel, keyboard or two fingers.
  zoomControls() {
    const group =
        element("span", { className: "buttons" }, button("\u2212", () => this.zoomBy(0.5), { ariaLabel: "zoom out" }),
            button("+", () => this.zoomBy(2), { ariaLabel: "zoom in" }),
            button("whole", () => this.reset(), { ariaLabel: "show the whole picture" }));
    group.setAttribute("role", "group");
    return group;
  }

  reset() {
    Object.assign(this, { zoom: 1, x: 0.5, y: 0.5 });
    this.moved();
  }

  // Keeps the place (u, v) of the canvas, fractions of its size, where it is.
  zoomBy(factor, u = 0.5, v = 0.5) {
    const zoom = Math.min(Math.max(this.zoom * factor, 1), 64), change = 1 / this.zoom - 1 / zoom;
    this.x += (u - 0.5) * change;
    this.y += (v - 0.5) * change;
    this.zoom = zoom;
    this.moved();
  }

  panBy(u, v) {
    this.x -= u / this.zoom;
    this.y -= v / this.zoom;
    this.moved();
  }

  moved() {
    const half = 0.5 / this.zoom;
    this.x = Math.min(Math.max(this.x, half), 1 - half);
    this.y = Math.min(Math.max(this.y, half), 1 - half);
    this.area.classList.toggle("zoomed", this.zoom > 1);
    this.update();
  }

  // `follow` moves the view to a pixel that lies outside of it: one that was not pointed at.
  setProbe(x, y, follow = true) {
    const image = this.panes[0]?.image;
    if (!image) return;
    const [width, height] = sizeOf(image);
    this.probe = { x: Math.min(Math.max(x, 0), width - 1), y: Math.min(Math.max(y, 0), height - 1) };
    if (follow) {
      const half = 0.5 / this.zoom, u = (this.probe.x + 0.5) / width, v = (this.probe.y + 0.5) / height;
      this.x = Math.min(Math.max(this.x, u - half), u + half);
      this.y = Math.min(Math.max(this.y, v - half), v + half);
    }
    this.moved();
    this.onProbe(this.probe.x, this.probe.y);
  }

  // Where on its canvas an event is, as fractions.
  placeOf(event) {
    const box = event.currentTarget.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  }

  probeAt(u, v) {
    const image = this.panes[0]?.image;
    if (!image) return;
    const [width, height] = sizeOf(image);
    this.setProbe(Math.floor((this.x + (u - 0.5) / this.zoom) * width),
        Math.floor((this.y + (v - 0.5) / this.zoom) * height), false);
  }

  listen(canvas) {
    canvas.addEventListener("pointerdown", (event) => {
      const [u, v] = this.placeOf(event);
      const onSplit = this.panes[0].under !== undefined && Math.abs(u - this.split) * canvas.clientWidth < 14;
      this.pointers.set(event.pointerId, { u, v, onSplit });
      canvas.setPointerCapture(event.pointerId);
      this.probeAt(u, v);
    });
    canvas.addEventListener("pointermove", (event) => this.pointerMoved(event));
    for (const kind of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(kind, (event) => this.pointers.delete(event.pointerId));
    }
    // Two fingers zoom the picture, not the page; one finger scrolls the page unless the picture is zoomed.
    canvas.addEventListener("touchmove", (event) => {
      if (event.touches.length > 1 || this.zoom > 1 || [...this.pointers.values()].some((pointer) => pointer.onSplit))
        event.preventDefault();
    }, { passive: false });
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;  // the page scrolls
      event.preventDefault();
      this.zoomBy(2 ** (-event.deltaY / 240), ...this.placeOf(event));
    }, { passive: false });
    canvas.addEventListener("dblclick", (event) => this.zoomBy(2, ...this.placeOf(event)));
    canvas.addEventListener("keydown", (event) => this.keyPressed(event));
  }

  pointerMoved(event) {
    const [u, v] = this.placeOf(event), pointer = this.pointers.get(event.pointerId);
    if (!pointer) {
      if (event.pointerType === "mouse") this.probeAt(u, v);
      return;
    }
    if (this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(pointer.u - other.u, pointer.v - other.v), now = Math.hypot(u - other.u, v - other.v);
      this.panBy((u - pointer.u) / 2, (v - pointer.v) / 2);
      if (before > 0) this.zoomBy(now / before, (u + other.u) / 2, (v + other.v) / 2);
    } else if (pointer.onSplit) {
      this.setSplit(u);
      this.onSplit(this.split);
    } else if (this.zoom > 1) {
      this.panBy(u - pointer.u, v - pointer.v);
    } else {
      this.probeAt(u, v);
    }
    Object.assign(pointer, { u, v });
  }

  setSplit(fraction) {
    this.split = Math.min(Math.max(fraction, 0), 1);
    this.update();
  }

  keyPressed(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (step && event.shiftKey) {
      const [width, height] = sizeOf(this.panes[0].image), from = this.probe ?? { x: width >> 1, y: height >> 1 };
      this.setProbe(from.x + step[0], from.y + step[1]);
    } else if (step)
      this.panBy(-step[0] / 8, -step[1] / 8);
    else if (event.key === "+" || event.key === "=")
      this.zoomBy(2);
    else if (event.key === "-")
      this.zoomBy(0.5);
    else if (event.key === "0")
      this.reset();
    else
      return;
    event.preventDefault();
  }

  draw() {
    for (const pane of this.panes) {
      if (pane.image) this.drawPane(pane);
    }
  }

  drawPane({ canvas, image, under }) {
    const [width, height] = sizeOf(image), ratio = window.devicePixelRatio || 1;
    canvas.style.aspectRatio = `${width} / ${height}`;
    const seen = {
      width: Math.max(1, Math.round(canvas.clientWidth * ratio)),
      height: Math.max(1, Math.round(canvas.clientHeight * ratio))
    };
    if (canvas.width !== seen.width || canvas.height !== seen.height) Object.assign(canvas, seen);
    const context = canvas.getContext("2d"), scale = (seen.width * this.zoom) / width;
    const left = seen.width / 2 - this.x * width * scale, top = seen.height / 2 - this.y * height * scale;
    context.imageSmoothingEnabled = scale < 1;  // magnified pixels are to be seen as pixels
    context.clearRect(0, 0, seen.width, seen.height);
    context.drawImage(image, left, top, width * scale, height * scale);
    if (under) {
      const edge = Math.round(this.split * seen.width);
      context.save();
      context.beginPath();
      context.rect(0, 0, edge, seen.height);
      context.clip();
      context.drawImage(under, left, top, width * scale, height * scale);
      context.restore();
      for (const [colour, half] of [["#000000", 2 * ratio], ["#ffffff", ratio]]) {
        context.fillStyle = colour;
        context.fillRect(edge - half, 0, 2 * half, seen.height);
      }
    }
    if (this.probe) markPixel(context, left + this.probe.x * scale, top + this.probe.y * scale, scale, ratio);
  }
}

const sizeOf = (image) => [image.naturalWidth ?? image.width, image.naturalHeight ?? image.height];

// A frame around the pixel, white within black: visible on any picture.
function markPixel(context, x, y, size, ratio) {
  const margin = Math.max(0, (7 * ratio - size) / 2);
  for (const [colour, out] of [["#000000", 1.5 * ratio], ["#ffffff", 0.5 * ratio]]) {
    context.strokeStyle = colour;
    context.lineWidth = ratio;
    context.strokeRect(x - margin - out, y - margin - out, size + 2 * (margin + out), size + 2 * (margin + out));
  }
}
