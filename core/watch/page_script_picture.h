// The preview's script: pictures as they come, in the colours of the screen.
#pragma once

namespace whit {

inline constexpr const char* kWatchScriptPicture = R"js(
// ---- Pictures: fetched when there is a newer one, and no faster than they are shown.

const S = {show: "picture", blink: false, exposure: 0, view: "", x: 0, y: 0, zoom: 1, fitted: true, cursor: null, flying: false};
const stage = $("stage"), screen = $("canvas"), pen = screen.getContext("2d");
let state = null;
let shown = null;      // {info, words, canvas}: the newest picture that was fetched.
let reference = null;  // The same of the reference.
let fetching = false, drawing = false;

const readable = async (address) => {
  const answer = await fetch(address);
  return answer.ok ? answer.arrayBuffer() : null;
};

const viewOf = () => S.show === "stops" ? "" : S.view;
const tonedBy = () => `${S.show === "stops"} ${viewOf()} ${S.exposure}`;

// The bytes of a view that the server knows; the exact sRGB curve is done here. False when it does not have the picture.
async function toned(address, made) {
  const key = tonedBy();
  if (made.toned === key) return true;
  let bytes = null;
  if (viewOf()) {
    const query = new URLSearchParams({view: viewOf(), exposure: S.exposure});
    const rgb = await readable(`${address}?${query}`);
    if (!rgb) return false;
    bytes = spread(new Uint8Array(rgb));
  }
  bytes ||= S.show === "stops" ? stopsOf(made.words) : coloursOf(made.words);
  made.bytes = bytes;
  made.canvas ||= document.createElement("canvas");
  made.canvas.width = made.width;
  made.canvas.height = made.height;
  made.canvas.getContext("2d").putImageData(new ImageData(bytes, made.width, made.height), 0, 0);
  made.toned = key;
  return true;
}

function spread(rgb) {
  const n = rgb.length / 3, bytes = new Uint8ClampedArray(4 * n).fill(255);
  for (let i = 0; i < n; i++) for (let c = 0; c < 3; c++) bytes[4 * i + c] = rgb[3 * i + c];
  return bytes;
}

// From a half float's bits to the byte for the screen.
function curveOf(gain) {
  const numbers = halfs(), curve = new Uint8Array(65536);
  for (let i = 0; i < 65536; i++) {
    const v = numbers[i] * gain;
    curve[i] = v > 0 ? 255 * encoded(Math.min(1, v)) + 0.5 | 0 : 0;
  }
  return curve;
}

const isFinite16 = (word) => (word & 0x7c00) !== 0x7c00;

function coloursOf(words) {
  const n = words.length / 3, curve = curveOf(2 ** S.exposure), bytes = new Uint8ClampedArray(4 * n).fill(255);
  for (let i = 0, from = 0, to = 0; i < n; i++, from += 3, to += 4) {
    const r = words[from], g = words[from + 1], b = words[from + 2];
    bytes[to] = curve[r], bytes[to + 1] = curve[g], bytes[to + 2] = curve[b];
    if (!(isFinite16(r) && isFinite16(g) && isFinite16(b))) mark(bytes, to, NOT_FINITE);
  }
  return bytes;
}

// Sixteen stops from black to pale yellow: what is eight stops below white of the exposure is black.
function stopsOf(words) {
  const numbers = halfs(), n = words.length / 3, bytes = new Uint8ClampedArray(4 * n).fill(255);
  for (let i = 0; i < n; i++) {
    const light = 0.2126 * numbers[words[3 * i]] + 0.7152 * numbers[words[3 * i + 1]] + 0.0722 * numbers[words[3 * i + 2]];
    const t = (Math.log2(Math.max(light, 1e-30)) + S.exposure + 8) / 16;
    const at = 3 * Math.round(255 * Math.min(1, Math.max(0, t)));
    mark(bytes, 4 * i, light - light !== 0 ? NOT_FINITE : MAPS.magma.subarray(at, at + 3));
  }
  return bytes;
}

async function update() {
  if (fetching) return;
  fetching = true;
  try {
    for (let again = true; again;) {
      const info = state && state.picture;
      again = false;
      if (info && (!shown || shown.info.number !== info.number)) {
        const numbers = await readable("picture/" + info.number);
        // One that is not kept any more has a successor.
        if (!numbers) { if (state.picture.number === info.number) break; again = true; continue; }
        const next = {info, words: new Uint16Array(numbers), width: info.width, height: info.height};
        if (await toned("picture/" + info.number, next)) shown = next;
      } else if (shown && !(await toned("picture/" + shown.info.number, shown))) {
        break;  // There will be a newer one.
      }
      await updateReference();
      redraw();
      showValues();
      again = !!shown && (shown.toned !== tonedBy() || shown.info.number !== state.picture.number);
    }
  } catch {
    // The server has gone, which the events tell too.
  } finally {
    fetching = false;
  }
}

async function updateReference() {
  const said = state && state.reference;
  if (!said || said.problem) { reference = null; return; }
  if (!reference || reference.number !== said.number) {
    const numbers = await readable("reference");
    if (!numbers) return;
    reference = {number: said.number, words: new Uint16Array(numbers), width: said.width, height: said.height};
  }
  if (reference.toned !== tonedBy()) {
    reference.bytes = S.show === "stops" ? stopsOf(reference.words) : coloursOf(reference.words);
    reference.canvas ||= document.createElement("canvas");
    reference.canvas.width = reference.width;
    reference.canvas.height = reference.height;
    reference.canvas.getContext("2d").putImageData(
        new ImageData(reference.bytes, reference.width, reference.height), 0, 0);
    reference.toned = tonedBy();
  }
}

// ---- On the screen: the whole picture is `resolution`, what was rendered of it a window.

const resolution = () => shown ? shown.info.resolution : [1, 1];
const shownNow = () => (S.show === "reference" || S.blink) && reference ? reference : shown;

function fit() {
  if (!shown) return;
  const [w, h] = resolution();
  S.zoom = Math.min(stage.clientWidth / w, stage.clientHeight / h);
  S.x = w / 2, S.y = h / 2, S.fitted = true;
}

const toScreen = (x, y) => [stage.clientWidth / 2 + (x - S.x) * S.zoom, stage.clientHeight / 2 + (y - S.y) * S.zoom];
const toPicture = (x, y) => [S.x + (x - stage.clientWidth / 2) / S.zoom, S.y + (y - stage.clientHeight / 2) / S.zoom];

function redraw() {
  if (drawing) return;
  drawing = true;
  requestAnimationFrame(() => { drawing = false; draw(); });
}

function draw() {
  const ratio = devicePixelRatio, w = Math.round(stage.clientWidth * ratio), h = Math.round(stage.clientHeight * ratio);
  if (screen.width !== w || screen.height !== h) screen.width = w, screen.height = h;
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.clearRect(0, 0, w, h);
  if (!shown || !shown.canvas) return;
  if (S.fitted) fit();
  const made = shownNow();
  const [x0, y0, x1, y1] = made === reference && made.width === resolution()[0] ? [0, 0, made.width, made.height]
                                                                                : shown.info.window;
  const [left, top] = toScreen(x0, y0), [right, bottom] = toScreen(x1, y1);
  // Coarse pictures are shown as what they are, softly; pixels that are large as squares.
  pen.imageSmoothingEnabled = made.width < x1 - x0 || S.zoom * ratio < 2;
  pen.imageSmoothingQuality = "high";
  const at = [left, top].map((v) => Math.round(v * ratio));
  const size = S.zoom === 1 / ratio || Number.isInteger(S.zoom * ratio)
      ? [(x1 - x0) * S.zoom * ratio, (y1 - y0) * S.zoom * ratio] : [right * ratio - at[0], bottom * ratio - at[1]];
  $("message").hidden = true;
  pen.drawImage(made.canvas, at[0], at[1], size[0], size[1]);
  $("zoom").textContent = Math.round(S.zoom * 1000) / 10 + " %";
}

// The numbers at a place of the whole picture; null outside of what was rendered.
function valueAt(made, x, y) {
  const [x0, y0, x1, y1] = shown.info.window;
  if (x < x0 || y < y0 || x >= x1 || y >= y1) return null;
  const column = Math.floor((x - x0) * made.width / (x1 - x0)), line = Math.floor((y - y0) * made.height / (y1 - y0));
  const i = line * made.width + column, numbers = halfs();
  return {rgb: [0, 1, 2].map((c) => numbers[made.words[3 * i + c]]), bytes: made.bytes.subarray(4 * i, 4 * i + 3)};
}
)js";

}  // namespace whit
