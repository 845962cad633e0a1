"use strict";
// The pictures of one view and plane: truth, methods and error maps side by side, by turns or with a slider between
// two, with exposure, and with the values of the pixel under the pointer. All of it is drawn from the float planes.

function drawViewer() {
  const section = byId("pictures-section");
  byId("left-off").hidden = data.left_off === "";
  byId("left-off").textContent = data.left_off;
  if (data.pictures.length === 0) {
    section.hidden = true;
    return;
  }
  const layouts = ["side by side", "by turns", "slider"];
  const state = {
    set: null,
    items: [],
    layout: isNarrow() ? "slider" : layouts[0],
    shown: new Set(),
    turn: 0,
    left: 0,
    right: 1,
    request: 0
  };

  const choice = byId("picture-controls");
  const scene = select(choice, "Scene", distinct(data.pictures.map((set) => set.scene)), sceneChanged);
  const view = select(choice, "View", [], viewChanged);
  const subject = select(choice, "Plane", [], setChanged);
  const layout = select(choice, "Layout", layouts, () => {
    state.layout = layout.value;
    arrange();
  });
  layout.value = state.layout;
  const looks = new PictureLooks(byId("picture-looks"), byId("picture-legend"), oncePerFrame(recolour));
  const group = new PaneGroup(byId("pictures"), { onProbe: showValues, onSplit: (fraction) => split.set(fraction) });
  byId("picture-looks").append(group.zoomControls());
  const split = slider(byId("picture-split"), "Split",
      { min: 0, max: 1, step: 0.01, value: 0.5, say: (fraction) => `${Math.round(100 * fraction)} %` },
      (fraction) => group.setSplit(fraction));
  const pixelX = numberInput("x"), pixelY = numberInput("y");

  function numberInput(label) {
    const box = element("input", { type: "number", min: 0, step: 1 });
    box.addEventListener("change", () => group.setProbe(Number(pixelX.value), Number(pixelY.value)));
    byId("picture-pixel").append(element("label", {}, `Pixel ${label}`, box));
    return box;
  }

  const setsOf = (wanted) =>
      data.pictures.filter((set) => Object.entries(wanted).every(([key, value]) => set[key] === value));
  function sceneChanged() {
    fillOptions(view, distinct(setsOf({ scene: scene.value }).map((set) => set.view)));
    viewChanged();
  }
  function viewChanged() {
    fillOptions(subject, distinct(setsOf({ scene: scene.value, view: view.value }).map(subjectOf)));
    setChanged();
  }
  function setChanged() {
    const before = state.items.map((item) => item.title).join("\n");
    state.set = setsOf({ scene: scene.value, view: view.value }).find((set) => subjectOf(set) === subject.value);
    const pictures = state.set.images.map((picture) => ({...picture, title: picture.label }));
    const errors =
        pictures.slice(1).map((picture) => ({...picture, kind: "error", title: `${picture.label}: error`, note: "" }));
    state.items = [...pictures, ...errors];
    if (state.items.map((item) => item.title).join("\n") !== before) {
      // The truth, the first two methods and their errors; the others are a key away.
      const methods = pictures.slice(1, 3).map((picture) => picture.label);
      state.shown = new Set(state.items.filter((item) => item.kind === "truth" || methods.includes(item.label)));
      state.turn = 0, state.left = 0, state.right = Math.min(1, state.items.length - 1);
    } else {
      const titles = [...state.shown].map((item) => item.title);
      state.shown = new Set(state.items.filter((item) => titles.includes(item.title)));
    }
    looks.reset();
    loadPlanes();
  }

  async function loadPlanes() {
    const request = ++state.request, items = state.items;
    section.setAttribute("aria-busy", "true");
    const planes = await Promise.all(items.map((item) => loadPlane(item.values)));
    if (request !== state.request) return;  // another set was chosen meanwhile
    items.forEach((item, index) => {
      item.plane = planes[index];
    });
    pixelX.max = planes[0].width - 1, pixelY.max = planes[0].height - 1;
    section.removeAttribute("aria-busy");
    recolour();
    arrange();
    const probe = group.probe ?? { x: planes[0].width >> 1, y: planes[0].height >> 1 };
    group.setProbe(probe.x, probe.y);
  }

  function recolour() {
    if (!state.items.every((item) => item.plane)) return;
    looks.prepare(state.items);
    for (const pane of group.panes) {
      pane.image = looks.canvasOf(pane.item, state.set);
      if (pane.underItem) pane.under = looks.canvasOf(pane.underItem, state.set);
    }
    looks.drawLegend(state.set);
    group.update();
    if (group.probe) showValues(group.probe.x, group.probe.y);
  }

  function arrange() {
    const { items } = state, area = byId("pictures");
    byId("picture-split").hidden = state.layout !== "slider";
    const pane = (item, more = {}) =>
        ({ title: item.title, note: item.note, item, image: looks.canvasOf(item, state.set), ...more });
    let panes = [];
    if (state.layout === "side by side") {
      const upper = items.filter((item) => state.shown.has(item) && item.kind !== "error");
      const columnOf = (item) => upper.findIndex((other) => other.label === item.label) + 1;
      const lower = items.filter((item) => state.shown.has(item) && item.kind === "error");
      const below = lower.every((item) => columnOf(item) > 0);  // each error below its method
      panes = [
        ...upper.map((item, index) => pane(item, { column: index + 1, row: 1 })),
        ...lower.map(
            (item, index) => pane(item, { column: below ? columnOf(item) : index + 1, row: upper.length > 0 ? 2 : 1 }))
      ];
      area.style.setProperty("--columns", Math.max(upper.length, below ? 0 : lower.length, 1));
    } else if (state.layout === "by turns") {
      area.style.setProperty("--columns", 1);
      panes = [pane(items[state.turn])];
    } else {
      area.style.setProperty("--columns", 1);
      const left = items[state.left], right = items[state.right];
      panes = [{
        ...pane(right, { underItem: left, under: looks.canvasOf(left, state.set) }),
        title: `${left.title} | ${right.title}`,
        note: ""
      }];
    }
    area.dataset.layout = state.layout;
    const focused = area.contains(document.activeElement);
    group.setPanes(panes);
    if (focused) panes[0]?.canvas.focus();
    drawButtons();
  }

  // One button per picture, with the key that does the same.
  function drawButtons() {
    const pressed = {
      "side by side": (item) => state.shown.has(item),
      "by turns": (item, index) => index === state.turn,
      "slider": (item, index) => index === state.left || index === state.right,
    }[state.layout];
    byId("picture-buttons").replaceChildren(...state.items.map((item, index) => {
      const node = button(item.title, () => choose(index), { ariaPressed: String(pressed(item, index)) });
      if (index < 9) node.prepend(element("kbd", { textContent: index + 1 }), " ");
      return node;
    }));
    const keys = {
      "side by side": "Keys 1 to 9 show and hide a picture.",
      "by turns": "Keys 1 to 9 flip to a picture, in place.",
      "slider": "Keys 1 to 9 choose the right picture, with shift the left one; drag the line or use the slider.",
    }[state.layout];
    byId("picture-help").textContent = `${keys} Drag to move; with a picture chosen, the wheel or plus and minus ` +
        "zoom, arrows move, shift and arrows choose a pixel. Two fingers zoom.";
  }

  function choose(index, other = false) {
    const item = state.items[index];
    if (!item) return;
    const focused = [...byId("picture-buttons").children].indexOf(document.activeElement);
    if (state.layout === "by turns")
      state.turn = index;
    else if (state.layout === "slider")
      state[other ? "left" : "right"] = index;
    else if (!state.shown.delete(item))
      state.shown.add(item);
    arrange();
    byId("picture-buttons").children[focused]?.focus();
    if (group.probe) showValues(group.probe.x, group.probe.y);
  }

  document.addEventListener("keydown", (event) => {
    const number = /^Digit([1-9])$/.exec(event.code) ?? /^Numpad([1-9])$/.exec(event.code);
    if (!number || event.ctrlKey || event.altKey || event.metaKey || event.target.closest("input, select, textarea"))
      return;
    const box = section.getBoundingClientRect();
    if (box.bottom < 0 || box.top > window.innerHeight) return;  // not in sight
    choose(Number(number[1]) - 1, event.shiftKey);
    event.preventDefault();
  });

  function showValues(x, y) {
    pixelX.value = x, pixelY.value = y;
    const rows = state.items.map((item) => {
      const values = (item.kind === "error" ? item.error : item.plane).at(x, y);
      return element("tr", {}, element("th", { textContent: item.title, scope: "row" }),
          ...values.map((value) => element("td", { className: "number", textContent: short(value) })));
    });
    const channels = state.items[0].plane.channels;
    const heads = state.set.display === "radiance" && channels === 3 ?
        ["red", "green", "blue"] :
        Array.from({ length: channels }, (_, i) => (channels === 1 ? "value" : `channel ${i}`));
    const table = byId("picture-values"), column = { scope: "col", className: "number" };
    table.tHead.replaceChildren(element("tr", {}, element("th", { textContent: "picture", scope: "col" }),
        ...heads.map((head) => element("th", { textContent: head, ...column }))));
    table.tBodies[0].replaceChildren(...rows);
  }

  byId("picture-precision").textContent = "Values are those of the pixel under the pointer, linear, rounded by at " +
      `most ${short(100 * data.precision)} %. Error maps are made of them here, so that errors below that share of a ` +
      "value are lost; the figures of this page come from the whole values.";
  sceneChanged();
}
