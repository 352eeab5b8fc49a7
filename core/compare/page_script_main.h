// The page's script: rows, pointers and keys.
#pragma once

namespace whit {

inline constexpr const char* kPageScriptMain = R"js(
// ---- What people do.

let blinker = 0, opening = 0;

function changed() {
  showControls();
  showValues();
  redraw();
  remember();
}

// After the part of the picture has changed, but not how it is shown.
function moved() {
  $("zoom").textContent = Math.round(S.zoom * 1000) / 10 + " %";
  if (lastPointer) pointAt(...lastPointer);
  redraw();
  remember();
}

function message(text) {
  $("message").textContent = text;
  $("message").hidden = !text;
}

const readable = (said) => said.layers.map((l, i) => i).filter((i) => said.layers[i].data);

async function openRow(index, restore) {
  const token = ++opening, said = ROWS[index], can = readable(said);
  if (S.row !== index) cache = new Map();
  layer = flipMap = null;
  sources = new Map();
  Object.assign(S, {row: index, layer: can[0] ?? 0, cursor: null, region: -1, fitted: true, scaleStops: 0, flipStops: 0, paused: false},
                restore || {});
  showViewer();
  showRow(said, can);
  if (!can.length) {
    message(said.layers.length ? "The numbers of these pictures are not in the page, which would be too large."
                               : said.verdict);
    return redraw();
  }
  message("Reading …");
  try {
    const [nextLayer, nextFlip] = await Promise.all([layerOf(said, S.layer), flipOf(said)]);
    if (token !== opening) return;
    layer = nextLayer;
    flipMap = nextFlip;
  } catch (error) {
    return message("The numbers cannot be read: " + error.message);
  }
  message("");
  if (S.mode === "flip" && !flipMap) S.mode = "difference";
  if (S.fitted) fit();
  setBlinker();
  changed();
}

function showRow(said, can) {
  $("name").textContent = said.name;
  $("pill").className = "pill " + said.status;
  $("pill").textContent = {same: "same", differs: "differs", cannot: "cannot compare"}[said.status];
  $("verdict").textContent = said.verdict;
  $("paths").replaceChildren(...["a", "b"].map((side) => element("div", {}, element("b", {textContent: side.toUpperCase()}),
                                                                  element("code", {textContent: said[side]}))));
  $("size").textContent = said.full[0] ? `${said.full[0]} × ${said.full[1]} pixels` : "";
  const chooser = $("layer");
  chooser.replaceChildren(...can.map((i) => element("option", {value: i, textContent: said.layers[i].name || "colour"})));
  chooser.value = S.layer;
  chooser.hidden = can.length < 2;
  $("work").classList.toggle("empty", !can.length);
  showRegions();
  showMeasures();
  showValues();
  for (const line of document.querySelectorAll("#pictures .row"))
    line.classList.toggle("current", +line.dataset.row === S.row);
}

async function chooseLayer(index) {
  const token = ++opening, next = await layerOf(row(), index);
  if (token !== opening) return;
  layer = next;
  Object.assign(S, {layer: index, scaleStops: 0});
  $("layer").value = index;
  changed();
}

function chooseMode(mode) {
  if (mode === "difference" && S.mode === mode) S.signed = !S.signed;
  if (mode === "flip" && !flipMap) return;
  Object.assign(S, {mode, paused: false, blinkB: false});
  setBlinker();
  changed();
}

function chooseRegion(index) {
  if (!layer) return;
  S.region = index;
  markRegion();
  const region = row().regions[index], at = row().layers.findIndex((l) => l.name === region.layer && l.data);
  (at >= 0 && at !== S.layer ? chooseLayer(at) : Promise.resolve()).then(() => goTo(pictureBox(region)));
}

function nextRegion(by) {
  const n = row().regions.length;
  if (n) chooseRegion(S.region < 0 ? (by > 0 ? 0 : n - 1) : (S.region + by + n) % n);
}

function setBlinker() {
  clearInterval(blinker);
  if (S.mode !== "blink" || S.paused) return;
  blinker = setInterval(() => {
    S.blinkB = !S.blinkB;
    redraw();
  }, 1000 / S.rate);
}

function expose(by) {
  S.exposure = Math.min(12, Math.max(-12, S.exposure + by));
  changed();
}

// Space: holds the blinking and flips by hand; A alone and B alone take turns.
function flipOver() {
  if (S.mode === "a" || S.mode === "b") return chooseMode(S.mode === "a" ? "b" : "a");
  if (S.mode !== "blink") return chooseMode("blink");
  if (S.paused) S.blinkB = !S.blinkB;
  S.paused = true;
  setBlinker();
  changed();
}

// ---- Rows: with one the viewer is a part of the page, else it is in front of it.

const alone = ROWS.length === 1;

function showViewer() {
  const viewer = $("viewer");
  viewer.hidden = false;
  viewer.classList.toggle("over", !alone || viewer.classList.contains("filled"));
  document.body.classList.toggle("covered", viewer.classList.contains("over"));
}

function closeViewer() {
  if (alone) return fill(false);
  $("viewer").hidden = true;
  document.body.classList.remove("covered");
  clearInterval(blinker);
  const line = document.querySelector(`#pictures .row[data-row="${S.row}"] .open`);
  opening++;  // What is still being decoded comes too late.
  layer = flipMap = null;
  S.row = -1;
  remember();
  if (line) line.focus();
}

function fill(on) {
  $("viewer").classList.toggle("filled", on);
  showViewer();
  redraw();
}

function shownRows() {
  return [...document.querySelectorAll("#pictures .row")].filter((line) => !line.hidden).map((line) => +line.dataset.row);
}

function nextRow(by) {
  const rows = shownRows(), at = rows.indexOf(S.row);
  if (rows.length > 1) openRow(rows[(at + by + rows.length) % rows.length]);
}

// ---- The address keeps what is looked at, so that it can be sent to somebody who has the page.

let remembering = 0;
function remember() {
  clearTimeout(remembering);
  remembering = setTimeout(() => {
    const n = (v) => +v.toPrecision(6);
    const text = S.row < 0 ? "" : "#" + new URLSearchParams({row: S.row, layer: S.layer, mode: S.mode, exposure: S.exposure,
        ...(S.fitted ? {} : {x: n(S.x), y: n(S.y), zoom: n(S.zoom)})});
    try {
      history.replaceState(null, "", text || location.pathname + location.search);
    } catch (error) {
      clearTimeout(remembering);  // Some browsers keep the addresses of files; then it is not remembered.
    }
  }, 300);
}

function recall() {
  const said = new URLSearchParams(location.hash.slice(1)), index = Number(said.get("row"));
  if (!said.has("row") || !ROWS[index]) return false;
  const number = (name, otherwise) => Number.isFinite(parseFloat(said.get(name))) ? parseFloat(said.get(name)) : otherwise;
  const modes = [...$("modes").children].map((button) => button.dataset.mode), wish = number("layer", 0);
  const state = {exposure: number("exposure", 0), mode: modes.includes(said.get("mode")) ? said.get("mode") : S.mode};
  if (readable(ROWS[index]).includes(wish)) state.layer = wish;
  if (said.has("zoom"))
    Object.assign(state, {fitted: false, x: number("x", 0), y: number("y", 0),
                          zoom: Math.min(MOST_ZOOM, Math.max(0.01, number("zoom", 1)))});
  openRow(index, state);
  return true;
}

// ---- Pointers: a mouse, a pen, one finger moves, two zoom.

const pointers = new Map();
let sliding = false, lastPointer = null;

const onStage = (event) => {
  const box = stage.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
};

function pointAt(x, y) {
  if (!layer) return;
  const [px, py] = pictureAt(x, y).map(Math.floor);
  const inside = px >= 0 && py >= 0 && px < layer.width && py < layer.height;
  S.cursor = inside ? [px, py] : null;
  showValues();
}

const nearDivider = (x) => S.mode === "swipe" && Math.abs(x - dividerAt(panes()[0])) < 22;

stage.addEventListener("pointerdown", (event) => {
  if (!layer || event.button > 0) return;
  const at = onStage(event);
  stage.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, at);
  sliding = pointers.size === 1 && nearDivider(at[0]);
  lastPointer = at;
  pointAt(...at);
  redraw();
});

stage.addEventListener("pointermove", (event) => {
  if (!layer) return;
  const at = onStage(event), before = pointers.get(event.pointerId);
  stage.style.cursor = sliding || nearDivider(at[0]) ? "ew-resize" : before ? "grabbing" : "crosshair";
  lastPointer = at;
  if (before) drag(event.pointerId, before, at);
  pointAt(...at);
  redraw();
});

function drag(id, before, at) {
  if (sliding) {
    S.divider = Math.min(1, Math.max(0, at[0] / stage.clientWidth));
  } else if (pointers.size === 2) {
    const other = [...pointers].find(([key]) => key !== id)[1];
    const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
    panBy((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
    zoomAt((at[0] + other[0]) / 2, (at[1] + other[1]) / 2, apart(at) / apart(before));
  } else {
    panBy(at[0] - before[0], at[1] - before[1]);
  }
  pointers.set(id, at);
}

for (const name of ["pointerup", "pointercancel"])
  stage.addEventListener(name, (event) => {
    pointers.delete(event.pointerId);
    sliding = false;
  });

stage.addEventListener("pointerleave", (event) => {
  if (event.pointerType !== "mouse") return;  // What a finger has touched stays to be read.
  S.cursor = lastPointer = null;
  showValues();
  redraw();
});

stage.addEventListener("wheel", (event) => {
  if (!layer) return;
  event.preventDefault();
  const pixels = event.deltaY * (event.deltaMode === 1 ? 30 : event.deltaMode === 2 ? 400 : 1);
  zoomAt(...onStage(event), 2 ** (-pixels / (event.ctrlKey ? 60 : 220)));
}, {passive: false});

stage.addEventListener("dblclick", (event) => {
  if (layer && !nearDivider(onStage(event)[0])) zoomAt(...onStage(event), S.zoom < 32 ? 32 / S.zoom : fitZoom() / S.zoom);
});

// ---- Keys.

const middle = () => [panes()[0].x + panes()[0].w / 2, panes()[0].y + panes()[0].h / 2];

const KEYS = {
  s: () => chooseMode("side"), w: () => chooseMode("swipe"), b: () => chooseMode("blink"), " ": flipOver,
  d: () => chooseMode("difference"), f: () => chooseMode("flip"), a: () => chooseMode("a"), r: () => chooseMode("b"),
  0: () => { fit(); moved(); }, 1: () => zoomAt(...middle(), 1 / S.zoom),
  "+": () => expose(0.5), "=": () => expose(0.5), "-": () => expose(-0.5), e: () => expose(-S.exposure),
  n: () => nextRegion(1), p: () => nextRegion(-1),
  o: () => { S.boxes = !S.boxes; changed(); }, c: () => { S.stops = !S.stops; changed(); },
  l: () => {
    const can = readable(row());
    chooseLayer(can[(can.indexOf(S.layer) + 1) % can.length]);
  },
  ",": () => setRate(S.rate / 2), ".": () => setRate(S.rate * 2),
};
const ALWAYS = {
  arrowleft: () => nextRow(-1), arrowright: () => nextRow(1), "?": () => $("help").showModal(),
  x: () => alone && fill(!$("viewer").classList.contains("filled")), escape: closeViewer,
};

function setRate(rate) {
  S.rate = Math.min(16, Math.max(0.5, rate));
  S.paused = false;
  setBlinker();
  changed();
}

document.addEventListener("keydown", (event) => {
  const typing = event.target.matches("select,textarea,input:not([type=range]):not([type=checkbox])");
  if (event.ctrlKey || event.metaKey || event.altKey || typing || $("help").open || S.row < 0) return;
  const key = event.key.toLowerCase(), act = ALWAYS[key] || (layer && KEYS[key]);
  if (!act || (event.target.matches("input[type=range]") && key.startsWith("arrow"))) return;
  event.preventDefault();
  act();
});

// ---- Buttons.

for (const button of $("modes").children) button.onclick = () => chooseMode(button.dataset.mode);
const bind = (id, event, act) => $(id).addEventListener(event, act);
bind("exposure", "input", () => { S.exposure = +$("exposure").value; changed(); });
bind("scale-slider", "input", () => {
  S[S.mode === "flip" ? "flipStops" : "scaleStops"] = +$("scale-slider").value;
  changed();
});
bind("rate", "input", () => setRate(+$("rate").value));
bind("signed", "change", () => { S.signed = $("signed").checked; changed(); });
bind("stops", "change", () => { S.stops = $("stops").checked; changed(); });
bind("boxes", "change", () => { S.boxes = $("boxes").checked; changed(); });
bind("layer", "change", () => { chooseLayer(+$("layer").value); $("layer").blur(); });
bind("previous", "click", () => nextRow(-1));
bind("next", "click", () => nextRow(1));
bind("close", "click", closeViewer);
bind("fill", "click", () => fill(!$("viewer").classList.contains("filled")));
bind("fit", "click", () => layer && KEYS[0]());
bind("natural", "click", () => layer && KEYS[1]());
bind("help-button", "click", () => $("help").showModal());
bind("help", "click", (event) => { if (event.target === $("help")) $("help").close(); });

for (const line of document.querySelectorAll("#pictures .row"))
  line.addEventListener("click", () => openRow(+line.dataset.row));

for (const button of document.querySelectorAll(".count"))
  button.onclick = () => {
    button.setAttribute("aria-pressed", String(button.getAttribute("aria-pressed") !== "true"));
    for (const line of document.querySelectorAll("#pictures .row"))
      line.hidden = document.querySelector(`.count[data-status="${line.dataset.status}"][aria-pressed="false"]`) !== null;
  };

$("viewer").classList.toggle("alone", alone);
new ResizeObserver(redraw).observe(stage);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
if (!recall() && alone) openRow(0);
)js";

}  // namespace whit
