// What the scripts of all pages that show pictures begin with.
#pragma once

namespace whit {

inline constexpr const char* kPageScriptBase = R"js(
// ---- Elements, numbers and colours. "maps" is the element of the colour maps, as hexadecimal digits.

const $ = (id) => document.getElementById(id);

function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

let halfTable = null;
function halfs() {
  if (halfTable) return halfTable;
  halfTable = new Float32Array(65536);
  for (let bits = 0; bits < 65536; bits++) {
    const sign = bits >> 15 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
    halfTable[bits] = exponent === 31 ? (fraction ? NaN : sign * Infinity)
                    : exponent === 0 ? sign * fraction * 2 ** -24 : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
  }
  return halfTable;
}

const MAPS = Object.fromEntries(Object.entries(JSON.parse($("maps").textContent)).map(
    ([name, hex]) => [name, Uint8Array.from(hex.match(/../g), (two) => parseInt(two, 16))]));
const NOT_FINITE = [0, 255, 64];  // A green that neither map has.

const encoded = (v) => v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;

const mark = (bytes, at, colour) => {
  bytes[at] = colour[0];
  bytes[at + 1] = colour[1];
  bytes[at + 2] = colour[2];
};

function rampOf(map) {
  const stops = [];
  for (let i = 0; i < 32; i++) {
    const at = 3 * Math.round(i * 255 / 31);
    stops.push(`rgb(${map[at]},${map[at + 1]},${map[at + 2]})`);
  }
  return `linear-gradient(90deg,${stops.join(",")})`;
}

const strange = (v) => v !== v ? "NaN" : v > 0 ? "+inf" : "-inf";

function short(v) {
  if (v - v !== 0) return strange(v);
  const size = Math.abs(v);
  if (size === 0) return "0";
  return size >= 1e5 || size < 1e-4 ? v.toExponential(1) : String(+v.toPrecision(3));
}

function full(v) {
  if (v - v !== 0) return strange(v);
  const size = Math.abs(v);
  if (size === 0) return Object.is(v, -0) ? "-0" : "0";
  return size >= 1e7 || size < 1e-5 ? v.toExponential(5) : String(+v.toPrecision(6));
}
)js";

}  // namespace whit
