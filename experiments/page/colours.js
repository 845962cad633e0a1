"use strict";
// Float planes as colours on the screen: exposure and the sRGB curve, or a colour map.

// The curve of IEC 61966-2-1 as a table over 0..1; its steps are far below the 256 of the screen.
const srgbTable = Uint8ClampedArray.from({ length: 65536 }, (_, i) => {
  const value = i / 65535;
  return Math.round(255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055));
});

const rgbOf = (hexadecimal) => [1, 3, 5].map((from) => parseInt(hexadecimal.slice(from, from + 2), 16));

// 1024 colours, interpolated between the map's stops ("#rrggbb", equally spaced).
function colourTable(stops) {
  const size = 1024, table = new Uint8ClampedArray(3 * size), colours = stops.map(rgbOf);
  for (let i = 0; i < size; ++i) {
    const position = (i / (size - 1)) * (colours.length - 1),
          index = Math.min(Math.floor(position), colours.length - 2);
    for (let c = 0; c < 3; ++c) {
      table[3 * i + c] =
          Math.round(colours[index][c] + (colours[index + 1][c] - colours[index][c]) * (position - index));
    }
  }
  return table;
}
const colourTables = {
  error: colourTable(data.colour_maps.error),
  signed: colourTable(data.colour_maps.signed)
};
const gradientOf = (map) => `linear-gradient(to right, ${data.colour_maps[map].join(", ")})`;

// Nodes that tell what an error map's colours mean: the words, the ramp, and its ends.
function errorLegend(words, map, low, high) {
  const ramp = element("div", { className: "ramp" });
  ramp.style.background = gradientOf(map);
  const ends = [short(low), short((low + high) / 2), `${short(high)} and more`];
  return [
    element("div", { textContent: `Error: ${words}` }), ramp,
    element("div", { className: "ends" }, ...ends.map((text) => element("span", { textContent: text })))
  ];
}

const notANumber = [255, 0, 255];  // magenta, which no map contains

// What 8 bits a value of the plane becomes; each kind of plane has its own way, as the PNG files have.
function toneOf(plane, display, exposure) {
  const factor = 2 ** exposure;
  const within = (value) => Math.min(Math.max(value, 0), 1);
  if (display === "radiance") return (value) => srgbTable[Math.round(65535 * within(value * factor))];
  if (display === "scalar") return (value) => 255 * within(value * factor);
  if (display === "vectors") return (value) => 255 * within(0.5 * value + 0.5);
  if (display === "depth") {
    let nearest = Infinity, farthest = 0;
    for (const value of plane.values) {
      if (!(Number.isFinite(value) && value > 0)) continue;
      nearest = Math.min(nearest, value);
      farthest = Math.max(farthest, value);
    }
    const range = Math.max(farthest - nearest, 1e-6 * farthest);
    return (value) => (Number.isFinite(value) && value > 0 ? 255 * within(1 - 0.85 * (value - nearest) / range) : 0);
  }
  if (display === "scaled vectors") {
    const largest =
        plane.values.reduce((most, value) => (Number.isFinite(value) ? Math.max(most, Math.abs(value)) : most), 0);
    return (value) => 255 * within(0.5 * value / (largest || 1) + 0.5);
  }
  throw new Error(`no way to show a plane as '${display}'`);
}

// A canvas of the plane's size, its pixels coloured by `colour(pixel number, colours, place)`.
function canvasOf(plane, colour) {
  const canvas = element("canvas", { width: plane.width, height: plane.height });
  const context = canvas.getContext("2d"), image = context.createImageData(plane.width, plane.height);
  for (let i = 0; i < plane.pixels; ++i) {
    colour(i, image.data, 4 * i);
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

function pictureCanvas(plane, display, exposure) {
  const tone = toneOf(plane, display, exposure), missing = display.includes("vectors") ? 127.5 : 0;
  return canvasOf(plane, (i, colours, place) => {
    for (let c = 0; c < 3; ++c) {
      if (c >= plane.channels && plane.channels > 1) {
        colours[place + c] = missing;
        continue;
      }
      const value = plane.values[(plane.channels === 1 ? 0 : c) * plane.pixels + i];
      if (Number.isNaN(value)) {
        notANumber.forEach((level, channel) => {
          colours[place + channel] = level;
        });
        return;
      }
      colours[place + c] = tone(value);
    }
  });
}

// Values from 0 to `scale`, or from -scale to scale where `signed`, on the map's colours.
function errorCanvas(plane, scale, signed) {
  const table = signed ? colourTables.signed : colourTables.error;
  return canvasOf(plane, (i, colours, place) => {
    const value = plane.values[i];
    const t = signed ? 0.5 + 0.5 * value / scale : value / scale;
    const index = 3 * Math.round(1023 * Math.min(Math.max(t, 0), 1));
    for (let c = 0; c < 3; ++c) colours[place + c] = Number.isNaN(value) ? notANumber[c] : table[index + c];
  });
}
