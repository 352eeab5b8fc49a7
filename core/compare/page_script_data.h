// The page's script: the numbers, as page_data.h has put them there.
#pragma once

namespace whit {

inline constexpr const char* kPageScriptData = R"js(
// ---- Numbers: what is in the page is decoded when it is looked at.

const ROWS = JSON.parse($("rows").textContent);

async function inflated(id) {
  const text = atob($(id).textContent), packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Bit patterns of a plane: zigzag-coded differences from `before`, or from the pixel before.
function wordsAt(bytes, at, n, size, before) {
  const words = size === 2 ? new Uint16Array(n) : new Uint32Array(n);
  let last = 0;
  for (let i = 0; i < n; i++) {
    let coded = bytes[at + i] | bytes[at + n + i] << 8;
    if (size === 4) coded = (coded | bytes[at + 2 * n + i] << 16 | bytes[at + 3 * n + i] << 24) >>> 0;
    words[i] = (before ? before[i] : last) + ((coded >>> 1) ^ -(coded & 1));
    last = words[i];
  }
  return words;
}

function numbersOf(words, kind) {
  if (kind === "float") return new Float32Array(words.buffer);
  if (kind === "whole") return Float32Array.from(words, (w) => w / 65535);
  const table = halfs(), numbers = new Float32Array(words.length);
  for (let i = 0; i < words.length; i++) numbers[i] = table[words[i]];
  return numbers;
}

// The layers of the row that is open: {name, kind, width, height, channels: [{name, a, b}]}, by their numbers.
let cache = new Map();

async function layerOf(row, index) {
  const key = row.layers[index].data;
  if (!cache.has(key)) cache.set(key, decodeLayer(row, row.layers[index]));
  return cache.get(key);
}

async function decodeLayer(row, said) {
  const bytes = await inflated(said.data), n = row.width * row.height, size = said.numbers === "float" ? 4 : 2;
  const channels = said.channels.map((name, c) => {
    const a = wordsAt(bytes, 2 * c * n * size, n, size, null);
    const b = wordsAt(bytes, (2 * c + 1) * n * size, n, size, a);
    return {name, a: numbersOf(a, said.numbers), b: numbersOf(b, said.numbers)};
  });
  return {name: said.name, kind: said.kind, display: row.display, width: row.width, height: row.height, channels};
}

async function flipOf(row) {
  if (!row.flip) return null;
  if (!cache.has(row.flip)) cache.set(row.flip, inflated(row.flip));
  return cache.get(row.flip);
}

// What differs, a number for each pixel: the mean over channels, as heat.h has it. Of ids whether they do.
function differenceOf(layer, signed) {
  const key = signed ? "signedDifference" : "absoluteDifference";
  if (layer[key]) return layer[key];
  const n = layer.width * layer.height, out = new Float32Array(n), data = layer.kind !== "colour";
  for (const {a, b} of layer.channels)
    for (let i = 0; i < n; i++) {
      if (data && a[i] === b[i]) continue;
      const d = a[i] - b[i];
      out[i] += layer.kind === "id" ? 1 : d - d !== 0 ? NaN : signed ? d : Math.abs(d);
    }
  const weight = layer.kind === "id" ? 1 : 1 / layer.channels.length;
  for (let i = 0; i < n; i++) out[i] *= weight;
  return layer[key] = out;
}

// The magnitude that all but one in a thousand are within.
function scaleOf(layer) {
  if (layer.scale) return layer.scale;
  const sizes = differenceOf(layer, false).filter((d) => d - d === 0).sort();
  const most = sizes.length ? sizes[sizes.length - 1 - Math.floor(sizes.length / 1000)] || sizes[sizes.length - 1] : 0;
  return layer.scale = most > 0 ? most : 1;
}

// What is black and what is white of numbers that are no light: [-1, 1], [0, 1], or what nearly all are within.
function rangeOf(layer) {
  if (layer.range) return layer.range;
  let some = [];
  for (const {a, b} of layer.channels)
    for (const plane of [a, b]) {
      const step = Math.max(1, Math.floor(plane.length / 20000));
      for (let i = 0; i < plane.length; i += step) if (plane[i] - plane[i] === 0) some.push(plane[i]);
    }
  some = Float32Array.from(some).sort();
  const at = (share) => some.length ? some[Math.round(share * (some.length - 1))] : 0;
  const low = at(0.005), high = at(0.995);
  if (low >= 0 && high <= 1 && high > 0.2) layer.range = [0, 1];
  else if (low >= -1 && high <= 1 && low < 0 && high - low > 0.2) layer.range = [-1, 1];
  else layer.range = high > low ? [low, high] : [low - 0.5, low + 0.5];
  return layer.range;
}
)js";

}  // namespace whit
