"use strict";
// Float planes out of the bytes that the page contains: the decoder of experiments/packed_plane.h.

function bytesOfBase64(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  if (typeof DecompressionStream === "undefined") {
    throw new Error("this browser cannot decompress the pictures; Chrome 80, Firefox 113, Safari 16.4 or later can");
  }
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The value of each code: a half float without its last bit.
const codeValues = (() => {
  const values = new Float32Array(1 << 15);
  for (let code = 0; code < values.length; ++code) {
    const exponent = (code >> 9) & 31, fraction = code & 511, sign = code >> 14 ? -1 : 1;
    if (exponent === 31)
      values[code] = fraction ? NaN : sign * Infinity;
    else if (exponent === 0)
      values[code] = sign * fraction * 2 ** -23;
    else
      values[code] = sign * (1 + fraction / 512) * 2 ** (exponent - 15);
  }
  return values;
})();

// A float image: `values` holds one channel after another, rows from the top.
class Plane {
  constructor(width, height, channels) {
    Object.assign(this, { width, height, channels, pixels: width * height });
    this.values = new Float32Array(this.pixels * channels);
  }
  at(x, y) {
    return Array.from(
        { length: this.channels }, (_, channel) => this.values[channel * this.pixels + y * this.width + x]);
  }
}

async function unpackPlane(bytes) {
  const end = bytes.indexOf(10);
  const [name, ...numbers] = new TextDecoder().decode(bytes.subarray(0, end)).split(" ");
  const [width, height, channels, exponent] = numbers.map(Number);
  if (name !== "plumbline-plane" || !(width > 0 && height > 0 && channels > 0)) throw new Error("not a packed plane");
  const plane = new Plane(width, height, channels);
  const folded = await inflated(bytes.subarray(end + 1));
  const all = plane.values.length, factor = 2 ** exponent;
  const codes = new Uint16Array(plane.pixels), missed = new Uint16Array(plane.pixels);
  for (let channel = 0; channel < channels; ++channel) {
    for (let y = 0, i = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x, ++i) {
        const place = channel * plane.pixels + i;
        const bits = (folded[place] << 8) | folded[all + place];
        missed[i] += (bits >> 1) ^ -(bits & 1);
        let predicted = 0;
        if (x === 0)
          predicted = y === 0 ? 0 : codes[i - width];
        else if (y === 0)
          predicted = codes[i - 1];
        else {
          const left = codes[i - 1], above = codes[i - width], corner = codes[i - width - 1];
          if (corner >= Math.max(left, above))
            predicted = Math.min(left, above);
          else if (corner <= Math.min(left, above))
            predicted = Math.max(left, above);
          else
            predicted = left + above - corner;
        }
        codes[i] = predicted + missed[i];
        plane.values[place] = codeValues[codes[i] & 32767] * factor;
      }
    }
  }
  return plane;
}

// The plane with this number on the page, decoded when it is first asked for. The latest are kept.
const loadPlane = (() => {
  const kept = new Map(), most = 48;
  return (number) => {
    const plane = kept.get(number) ?? unpackPlane(bytesOfBase64(byId(`values-${number}`).textContent));
    kept.delete(number);
    kept.set(number, plane);
    if (kept.size > most) kept.delete(kept.keys().next().value);
    return plane;
  };
})();

// How the difference of one pixel's channel becomes an error; `signed` ones have their zero in the middle of the scale.
const errorKinds = {
  "absolute": { of: (value, truth) => Math.abs(value - truth), words: "|difference|, averaged over channels" },
  "signed": { of: (value, truth) => value - truth, signed: true, words: "method minus truth, averaged over channels" },
  "relative": {
    of: (value, truth) => Math.abs(value - truth) / (Math.abs(truth) + 0.01),
    scale: 1,
    words: "|difference| / (|truth| + 0.01), averaged over channels",
  },
};

// One channel; NaN where either image is not finite, as in experiments' own error maps.
function errorPlane(image, truth, kind) {
  const error = new Plane(image.width, image.height, 1), of = errorKinds[kind].of;
  for (let i = 0; i < error.pixels; ++i) {
    let sum = 0;
    for (let place = i; place < image.values.length; place += image.pixels) {
      const value = image.values[place], right = truth.values[place];
      sum += Number.isFinite(value) && Number.isFinite(right) ? of(value, right) : NaN;
    }
    error.values[i] = sum / image.channels;
  }
  return error;
}
