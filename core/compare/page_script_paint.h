// The page's script: from numbers to pictures.
#pragma once

namespace whit {

inline constexpr const char* kPageScriptPaint = R"js(
// ---- Pictures of numbers.

const decoded = (v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;

// From a number times 65535 to the byte for the screen.
function curveOf(display, gain) {
  const curve = new Uint8Array(65536);
  for (let i = 0; i < 65536; i++) {
    const light = display ? decoded(i / 65535) * gain : i / 65535;
    curve[i] = Math.round(255 * Math.min(1, display && gain === 1 ? i / 65535 : encoded(Math.min(1, light))));
  }
  return curve;
}

function canvasOf(width, height, bytes) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  canvas.getContext("2d").putImageData(new ImageData(bytes, width, height), 0, 0);
  return {canvas, bytes, width, height, step: 1};
}

function coloursOf(layer, side, exposure) {
  const n = layer.width * layer.height, bytes = new Uint8ClampedArray(4 * n).fill(255), gain = 2 ** exposure;
  const linear = !layer.display, curve = curveOf(layer.display, gain), times = 65535 * (linear ? gain : 1);
  const planes = [0, 1, 2].map((c) => layer.channels[layer.channels.length < 3 ? 0 : c][side]);
  for (let c = 0; c < 3; c++)
    for (let i = 0, plane = planes[c]; i < n; i++) {
      const v = plane[i] * times;
      bytes[4 * i + c] = v > 0 ? curve[v < 65535 ? v + 0.5 | 0 : 65535] : 0;
    }
  for (const plane of planes)
    for (let i = 0; i < n; i++) if (plane[i] - plane[i] !== 0) mark(bytes, 4 * i, NOT_FINITE);
  return bytes;
}

// Numbers that are no light are grey, or three of them a colour, from the least to the greatest.
function dataOf(layer, side, exposure) {
  const n = layer.width * layer.height, bytes = new Uint8ClampedArray(4 * n).fill(255);
  const [low, high] = rangeOf(layer), times = 255 * 2 ** exposure / (high - low);
  for (let c = 0; c < 3; c++) {
    const plane = layer.channels[layer.channels.length < 3 ? 0 : c][side];
    for (let i = 0; i < n; i++) bytes[4 * i + c] = (plane[i] - low) * times;
  }
  for (const channel of layer.channels)
    for (let i = 0; i < n; i++) if (channel[side][i] !== channel[side][i]) mark(bytes, 4 * i, NOT_FINITE);
  return bytes;
}

// A colour for each id.
function idsOf(layer, side) {
  const n = layer.width * layer.height, bytes = new Uint8ClampedArray(4 * n).fill(255);
  const planes = layer.channels.map((channel) => new Uint32Array(channel[side].buffer));
  for (let i = 0; i < n; i++) {
    let hash = 0;
    for (const plane of planes) hash = Math.imul(hash ^ plane[i], 0x9e3779b1);
    hash = Math.imul(hash ^ hash >>> 15, 0x85ebca6b);
    hash ^= hash >>> 13;
    mark(bytes, 4 * i, planes[0][i] << 1 ? [56 + (hash & 191), 56 + (hash >> 8 & 191), 56 + (hash >> 16 & 191)] : [0, 0, 0]);
  }
  return bytes;
}

// Sixteen stops from black to pale yellow: what is eight stops below white of the exposure is black.
function stopsOf(layer, side, exposure) {
  const n = layer.width * layer.height, bytes = new Uint8ClampedArray(4 * n).fill(255);
  const [r, g, b] = [0, 1, 2].map((c) => layer.channels[layer.channels.length < 3 ? 0 : c][side]);
  for (let i = 0; i < n; i++) {
    const light = 0.2126 * r[i] + 0.7152 * g[i] + 0.0722 * b[i];
    const t = (Math.log2(Math.max(light, 1e-30)) + exposure + 8) / 16;
    const at = 3 * Math.round(255 * Math.min(1, Math.max(0, t)));
    mark(bytes, 4 * i, light - light !== 0 ? NOT_FINITE : MAPS.magma.subarray(at, at + 3));
  }
  return bytes;
}

function pictureOf(layer, side, exposure, stops) {
  const bytes = layer.kind === "id" ? idsOf(layer, side)
              : layer.kind === "data" ? dataOf(layer, side, exposure)
              : stops ? stopsOf(layer, side, exposure) : coloursOf(layer, side, exposure);
  return canvasOf(layer.width, layer.height, bytes);
}

// Seen from afar a block of pixels shows the largest of its values: a single pixel must not vanish.
function pooled(values, width, height, step) {
  if (step === 1) return {values, width, height};
  const w = Math.ceil(width / step), h = Math.ceil(height / step), out = new Float32Array(w * h);
  for (let y = 0; y < height; y++)
    for (let x = 0, row = Math.floor(y / step) * w; x < width; x++) {
      const v = values[y * width + x], at = row + Math.floor(x / step);
      if (v !== v || Math.abs(v) > Math.abs(out[at])) out[at] = v;
    }
  return {values: out, width: w, height: h};
}

// `full` is the end of the map, `signed` whether 0 is in its middle.
function mapped(values, width, height, step, map, full, signed) {
  const few = pooled(values, width, height, step), n = few.values.length;
  const bytes = new Uint8ClampedArray(4 * n).fill(255);
  for (let i = 0; i < n; i++) {
    const v = few.values[i], t = signed ? 0.5 + 0.5 * v / full : v / full;
    const at = 3 * Math.round(255 * Math.min(1, Math.max(0, t)));
    if (v !== v) mark(bytes, 4 * i, NOT_FINITE);
    else mark(bytes, 4 * i, map.subarray(at, at + 3));
  }
  return {...canvasOf(few.width, few.height, bytes), step};
}
)js";

}  // namespace whit
