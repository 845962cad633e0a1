"use strict";
// What all parts of the page share: its data, and small helpers for elements, numbers and colours.

// A script error is shown on the page itself, where a reader and the tests find it.
function showScriptError(text) {
  const box = document.getElementById("script-errors");
  box.hidden = false;
  box.textContent += `${text}\n`;
}
window.addEventListener("error", (event) => showScriptError(`${event.message} (line ${event.lineno})`));
window.addEventListener("unhandledrejection", (event) => showScriptError(String(event.reason)));

const data = JSON.parse(document.getElementById("data").textContent);

// Okabe and Ito's colours, which stay apart for colour-blind readers; grey is the path tracer's.
const methodColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const markers = ["circle", "rect", "triangle", "rectRot", "star", "cross"];
const pathTracerColour = "#888888";
const cycled = (list, index) => list[index % list.length];

// A narrow screen, where pictures stand below each other and few of them are enough to begin with.
const isNarrow = () => matchMedia("(max-width: 50rem)").matches;

const byId = (id) => document.getElementById(id);

// element("p", { className: "note", ariaLabel: "..." }, "text", child...)
function element(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

const distinct = (values) => [...new Set(values)];
const styleOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

// Three significant digits, as everywhere on the page.
function short(value) {
  if (value === null || value === undefined) return "";
  if (!Number.isFinite(value) || value === 0) return String(value);
  if (Math.abs(value) >= 1000 && Math.abs(value) < 1e6) return value.toFixed(0);
  return value.toPrecision(3).replace(/e([+-])0*(\d)/, "e$1$2");
}

// A measure of a row by its name, with the ends of its interval.
function measureOf(row, name) {
  const of = (whole) => row.measures[data.measure_names.indexOf(whole)];
  return { value: of(name), lower: of(`${name}_lower`), upper: of(`${name}_upper`) };
}

function interval(value, low, high) {
  return isNumber(low) && isNumber(high) ? `${short(value)} [${short(low)}, ${short(high)}]` : short(value);
}

function fillOptions(box, options) {
  const before = box.value;
  box.replaceChildren(...options.map((option) => element("option", { value: option, textContent: option })));
  if (options.includes(before)) box.value = before;
}

function select(parent, label, options, onChange) {
  const box = element("select");
  fillOptions(box, options);
  box.addEventListener("change", onChange);
  parent.append(element("label", {}, label, box));
  return box;
}

function checkbox(parent, label, checked, onChange) {
  const box = element("input", { type: "checkbox", checked });
  box.addEventListener("change", () => onChange(box.checked));
  parent.append(element("label", {}, box, label));
  return box;
}

// A slider with its value in words beside it; `say` turns the number into these words.
function slider(parent, label, { min, max, step, value, say }, onInput) {
  const box = element("input", { type: "range", min, max, step, value });
  const words = element("output", { textContent: say(Number(value)) });
  const tell = () => {
    words.textContent = say(Number(box.value));
    box.setAttribute("aria-valuetext", words.textContent);
  };
  box.addEventListener("input", () => {
    tell();
    onInput(Number(box.value));
  });
  parent.append(element("label", {}, label, box, words));
  tell();
  return {
    box,
    set(number) {
      box.value = number;
      tell();
    }
  };
}

function button(text, onClick, properties = {}) {
  const node = element("button", { type: "button", textContent: text, ...properties });
  node.addEventListener("click", onClick);
  return node;
}

// What a comparison is about: the plane, and the truth where there are two.
const subjectOf = (entry) => (entry.truth ? `${entry.plane} (truth: ${entry.truth})` : entry.plane);

// Calls `draw` now and whenever the page turns light or dark: canvases do not follow style sheets by themselves.
function followColourScheme(draw) {
  draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
}

// Calls of the result within one frame of the screen become one call of `draw`.
function oncePerFrame(draw) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      draw();
    });
  };
}
