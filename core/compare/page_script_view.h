// The page's script: what is on the screen, zoomed and moved.
#pragma once

namespace whit {

inline constexpr const char* kPageScriptView = R"js(
// ---- The stage: one or two panes that show the same part of the picture.

const MOST_ZOOM = 256, NUMBERS_FROM = 46, GRID_FROM = 14;
const S = {row: -1, layer: 0, mode: "swipe", exposure: 0, scaleStops: 0, flipStops: 0, signed: true, rate: 2, stops: false, boxes: true,
           divider: 0.5, blinkB: false, paused: false, x: 0, y: 0, zoom: 1, fitted: true, cursor: null, region: -1};
let layer = null, flipMap = null, sources = new Map(), wanted = false;
const stage = $("stage"), screen = $("canvas"), pen = screen.getContext("2d");

const row = () => ROWS[S.row];
const stageSize = () => [stage.clientWidth, stage.clientHeight];

function panes() {
  const [w, h] = stageSize(), gap = 2;
  if (S.mode !== "side") return [{x: 0, y: 0, w, h, what: shownAlone()}];
  const beside = Math.min((w - gap) / 2 / layer.width, h / layer.height);
  const above = Math.min(w / layer.width, (h - gap) / 2 / layer.height);
  if (beside >= above) {
    const half = Math.floor((w - gap) / 2);
    return [{x: 0, y: 0, w: half, h, what: "a"}, {x: w - half, y: 0, w: half, h, what: "b"}];
  }
  const half = Math.floor((h - gap) / 2);
  return [{x: 0, y: 0, w, h: half, what: "a"}, {x: 0, y: h - half, w, h: half, what: "b"}];
}

function shownAlone() {
  if (S.mode === "blink") return S.blinkB ? "b" : "a";
  return {swipe: "a", a: "a", b: "b", difference: "difference", flip: "flip"}[S.mode];
}

// Pictures are made once for each way of looking at them; few are kept.
function source(what) {
  const step = S.zoom * devicePixelRatio < 1 ? 2 ** Math.ceil(-Math.log2(S.zoom * devicePixelRatio) - 1e-6) : 1;
  const key = what === "difference" ? `difference ${S.layer} ${S.signed} ${S.scaleStops} ${step}`
            : what === "flip" ? `flip ${S.flipStops} ${step}` : `${what} ${S.layer} ${S.exposure} ${S.stops}`;
  if (!sources.has(key)) {
    if (sources.size >= 8) sources.delete(sources.keys().next().value);
    sources.set(key, make(what, step));
  }
  const made = sources.get(key);
  sources.delete(key);
  sources.set(key, made);
  return made;
}

const differenceScale = () => scaleOf(layer) * 2 ** -S.scaleStops;
const flipScale = () => 2 ** -S.flipStops;

function make(what, step) {
  const {width, height} = layer;
  if (what === "difference")
    return mapped(differenceOf(layer, S.signed), width, height, step, S.signed ? MAPS.berlin : MAPS.magma,
                  differenceScale(), S.signed);
  if (what === "flip") return mapped(flipMap, width, height, step, MAPS.magma, 255 * flipScale(), false);
  return pictureOf(layer, what, S.exposure, S.stops);
}

// Where the picture's upper left corner is in a pane, on whole pixels of the screen where the picture's are.
function origin(pane) {
  const snap = (v) => S.zoom >= 1 ? Math.round(v * devicePixelRatio) / devicePixelRatio : v;
  return [snap(pane.x + pane.w / 2 - S.x * S.zoom), snap(pane.y + pane.h / 2 - S.y * S.zoom)];
}

function drawPicture(pane, what, clip) {
  const from = source(what), [ox, oy] = origin(pane), unit = S.zoom * from.step;
  pen.save();
  pen.beginPath();
  pen.rect(clip.x, clip.y, clip.w, clip.h);
  pen.clip();
  pen.imageSmoothingEnabled = unit * devicePixelRatio < 1;
  pen.imageSmoothingQuality = "high";
  const x0 = Math.max(0, Math.floor((clip.x - ox) / unit)), y0 = Math.max(0, Math.floor((clip.y - oy) / unit));
  const x1 = Math.min(from.width, Math.ceil((clip.x + clip.w - ox) / unit));
  const y1 = Math.min(from.height, Math.ceil((clip.y + clip.h - oy) / unit));
  if (x1 > x0 && y1 > y0)
    pen.drawImage(from.canvas, x0, y0, x1 - x0, y1 - y0, ox + x0 * unit, oy + y0 * unit, (x1 - x0) * unit, (y1 - y0) * unit);
  if (S.zoom >= GRID_FROM) drawGrid(ox, oy, x0, y0, x1, y1);
  if (S.zoom >= NUMBERS_FROM) drawNumbers(what, from, ox, oy, x0, y0, x1, y1);
  pen.restore();
}

function drawGrid(ox, oy, x0, y0, x1, y1) {
  pen.strokeStyle = `rgba(128,128,128,${Math.min(0.5, S.zoom / 80)})`;
  pen.lineWidth = 1 / devicePixelRatio;
  pen.beginPath();
  for (let x = x0; x <= x1; x++) {
    pen.moveTo(ox + x * S.zoom, oy + y0 * S.zoom);
    pen.lineTo(ox + x * S.zoom, oy + y1 * S.zoom);
  }
  for (let y = y0; y <= y1; y++) {
    pen.moveTo(ox + x0 * S.zoom, oy + y * S.zoom);
    pen.lineTo(ox + x1 * S.zoom, oy + y * S.zoom);
  }
  pen.stroke();
}

// The numbers of a pixel as it is shown: one for each channel, of maps the one that has the colour.
function numbersIn(what, i) {
  if (what === "flip") return [short(flipMap[i] / 255)];
  if (what === "difference") return [short(differenceOf(layer, S.signed)[i])];
  return layer.channels.slice(0, 4).map((channel) => layer.kind === "id" ? idText(channel[what][i]) : short(channel[what][i]));
}

function drawNumbers(what, from, ox, oy, x0, y0, x1, y1) {
  const size = Math.min(15, S.zoom / 4.6);
  pen.font = `${size}px ui-monospace,SFMono-Regular,Menlo,Consolas,monospace`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  for (let y = y0; y < y1; y++)
    for (let x = x0; x < x1; x++) {
      const at = 4 * (y * from.width + x), lines = numbersIn(what, y * layer.width + x);
      const bright = 0.3 * from.bytes[at] + 0.6 * from.bytes[at + 1] + 0.1 * from.bytes[at + 2];
      pen.fillStyle = bright > 120 ? "rgba(0,0,0,.85)" : "rgba(255,255,255,.9)";
      lines.forEach((text, k) => pen.fillText(text, ox + (x + 0.5) * S.zoom,
                                              oy + (y + 0.5) * S.zoom + (k - (lines.length - 1) / 2) * size * 1.15));
    }
}

// A region's box, at least large enough to be seen, in the colour of its kind.
function drawBox(pane, region, chosen) {
  const [x0, y0, x1, y1] = pictureBox(region), [ox, oy] = origin(pane), least = chosen ? 16 : 9;
  let w = (x1 - x0) * S.zoom, h = (y1 - y0) * S.zoom, x = ox + x0 * S.zoom, y = oy + y0 * S.zoom;
  if (w < least) [x, w] = [x + (w - least) / 2, least];
  if (h < least) [y, h] = [y + (h - least) / 2, least];
  for (const [width, colour] of [[chosen ? 4 : 3, "rgba(0,0,0,.55)"], [chosen ? 2 : 1, COLOURS[region.kind]]]) {
    pen.lineWidth = width;
    pen.strokeStyle = colour;
    pen.strokeRect(x, y, w, h);
  }
}

const COLOURS = {noise: "#ffb454", failure: "#ff6b5e", nonfinite: "#00ff40", place: "#4de1ff"};

// Outlines are those of the layer that is shown, as far as they can be told apart.
const isHere = (region, i) => i < 60 && (region.layer === layer.name || region.kind === "nonfinite");

// From pixels of the display window to those of the page's picture.
function pictureBox(region) {
  const {corner, step} = row(), [x0, y0, x1, y1] = region.box;
  return [(x0 - corner[0]) / step, (y0 - corner[1]) / step, (x1 + 1 - corner[0]) / step, (y1 + 1 - corner[1]) / step];
}

function drawLabel(text, x, y, right) {
  pen.font = "600 12.5px system-ui,-apple-system,'Segoe UI',Roboto,sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  const w = pen.measureText(text).width + 18, left = right ? x - w : x;
  pen.fillStyle = "rgba(20,20,19,.72)";
  pen.beginPath();
  pen.roundRect(left, y, w, 24, 12);
  pen.fill();
  pen.fillStyle = "#fff";
  pen.fillText(text, left + 9, y + 12.5);
}

const dividerAt = (pane) => pane.x + S.divider * pane.w;

function drawSwipe(pane) {
  const at = Math.round(dividerAt(pane));
  drawPicture(pane, "a", {...pane, w: at - pane.x});
  drawPicture(pane, "b", {...pane, x: at, w: pane.x + pane.w - at});
  pen.fillStyle = "rgba(255,255,255,.9)";
  pen.fillRect(at - 1, pane.y, 2, pane.h);
  pen.shadowColor = "rgba(0,0,0,.5)";
  pen.shadowBlur = 8;
  pen.beginPath();
  pen.roundRect(at - 17, pane.y + pane.h / 2 - 15, 34, 30, 15);
  pen.fill();
  pen.shadowBlur = 0;
  pen.strokeStyle = "#33312e";
  pen.lineWidth = 1.8;
  pen.beginPath();
  for (const side of [-1, 1]) {
    pen.moveTo(at + side * 4, pane.y + pane.h / 2 - 5);
    pen.lineTo(at + side * 9, pane.y + pane.h / 2);
    pen.lineTo(at + side * 4, pane.y + pane.h / 2 + 5);
  }
  pen.stroke();
}

function drawLabels(pane) {
  const names = {a: "A", b: "B, the reference", flip: "FLIP",
                 difference: layer.kind === "id" ? "ids that differ" : S.signed ? "A − B" : "|A − B|"};
  if (S.mode !== "swipe") return drawLabel(names[pane.what], pane.x + 12, pane.y + 12, false);
  const at = dividerAt(pane);
  if (at > pane.x + 60) drawLabel("A", pane.x + 12, pane.y + 12, false);
  if (at < pane.x + pane.w - 150) drawLabel(names.b, pane.x + pane.w - 12, pane.y + 12, true);
}

// The pixel under the cursor, in both panes.
function drawCursor(pane) {
  if (!S.cursor || S.zoom < 4 && S.mode !== "side") return;
  const [ox, oy] = origin(pane), size = Math.max(S.zoom, 9), off = (S.zoom - size) / 2;
  for (const [width, colour] of [[3, "rgba(0,0,0,.5)"], [1.2, "#fff"]]) {
    pen.lineWidth = width;
    pen.strokeStyle = colour;
    pen.strokeRect(ox + S.cursor[0] * S.zoom + off, oy + S.cursor[1] * S.zoom + off, size, size);
  }
}

function draw() {
  wanted = false;
  const [w, h] = stageSize(), dpr = devicePixelRatio;
  if (!w || !h) return;
  if (screen.width !== Math.round(w * dpr) || screen.height !== Math.round(h * dpr)) {
    screen.width = Math.round(w * dpr);
    screen.height = Math.round(h * dpr);
  }
  pen.setTransform(dpr, 0, 0, dpr, 0, 0);
  pen.clearRect(0, 0, w, h);
  if (!layer) return;
  if (S.fitted) fit();
  for (const pane of panes()) {
    if (S.mode === "swipe") drawSwipe(pane);
    else drawPicture(pane, pane.what, pane);
    pen.save();
    pen.beginPath();
    pen.rect(pane.x, pane.y, pane.w, pane.h);
    pen.clip();
    if (S.boxes)
      row().regions.forEach((region, i) => { if (i !== S.region && isHere(region, i)) drawBox(pane, region, false); });
    if (S.region >= 0) drawBox(pane, row().regions[S.region], true);
    drawCursor(pane);
    pen.restore();
    drawLabels(pane);
  }
  showScale();
}

function redraw() {
  if (wanted) return;
  wanted = true;
  requestAnimationFrame(draw);
}

// ---- Moving about.

const fitZoom = () => {
  const pane = panes()[0];
  return Math.min(pane.w / layer.width, pane.h / layer.height);
};

// Small pictures are enlarged by whole numbers, so that all pixels are alike.
function fit() {
  const zoom = fitZoom();
  S.zoom = zoom > 2 ? Math.min(Math.floor(zoom), 32) : zoom;
  S.x = layer.width / 2;
  S.y = layer.height / 2;
  S.fitted = true;
}

function paneAt(x, y) {
  return panes().find((p) => x >= p.x && y >= p.y && x < p.x + p.w && y < p.y + p.h) || panes()[0];
}

function pictureAt(x, y) {
  const [ox, oy] = origin(paneAt(x, y));
  return [(x - ox) / S.zoom, (y - oy) / S.zoom];
}

function keepInside() {
  S.x = Math.min(layer.width, Math.max(0, S.x));
  S.y = Math.min(layer.height, Math.max(0, S.y));
}

// What is at a place of the stage stays there.
function zoomAt(x, y, factor) {
  const pane = paneAt(x, y), px = S.x + (x - pane.x - pane.w / 2) / S.zoom, py = S.y + (y - pane.y - pane.h / 2) / S.zoom;
  S.zoom = Math.min(MOST_ZOOM, Math.max(Math.min(fitZoom(), 1) / 4, S.zoom * factor));
  S.x = px - (x - pane.x - pane.w / 2) / S.zoom;
  S.y = py - (y - pane.y - pane.h / 2) / S.zoom;
  S.fitted = false;
  keepInside();
  moved();
}

function panBy(dx, dy) {
  S.x -= dx / S.zoom;
  S.y -= dy / S.zoom;
  S.fitted = false;
  keepInside();
  moved();
}

// So that a box fills a good part of a pane, within a quarter of a second.
function goTo(box) {
  const pane = panes()[0], w = box[2] - box[0], h = box[3] - box[1];
  const end = {x: (box[0] + box[2]) / 2, y: (box[1] + box[3]) / 2,
               zoom: Math.min(56, Math.max(fitZoom(), 0.4 * Math.min(pane.w / w, pane.h / h)))};
  const start = {x: S.x, y: S.y, zoom: S.zoom}, began = performance.now();
  const shown = layer, quick = matchMedia("(prefers-reduced-motion: reduce)").matches;
  S.fitted = false;
  const frame = (now) => {
    if (layer !== shown) return;  // Another picture has been opened meanwhile.
    const t = quick ? 1 : Math.min(1, Math.max(0, (now - began) / 240)), s = t * t * (3 - 2 * t);
    S.zoom = start.zoom * (end.zoom / start.zoom) ** s;
    // The place moves with the zoom, so that it comes in evenly.
    const u = end.zoom === start.zoom ? s : (1 / start.zoom - 1 / S.zoom) / (1 / start.zoom - 1 / end.zoom);
    S.x = start.x + (end.x - start.x) * u;
    S.y = start.y + (end.y - start.y) * u;
    if (t === 1) Object.assign(S, end);
    else requestAnimationFrame(frame);
    moved();
  };
  requestAnimationFrame(frame);
}
)js";

}  // namespace whit
