// The preview's script: events, pointers and keys.
#pragma once

namespace whit {

inline constexpr const char* kWatchScriptMain = R"js(
// ---- What comes from the server.

const events = new EventSource("events");
events.onmessage = (event) => {
  state = JSON.parse(event.data);
  showState();
  update();
  // What is under the cursor is of the scene as it is now.
  const key = `${state.reading} ${state.build_seconds} ${state.camera.eye} ${state.camera.direction}`;
  if (key !== askedOf && S.cursor) ask();
  askedOf = key;
};
events.onerror = () => {
  $("lamp").className = "gone";
  $("status").textContent = "whit watch has ended, or does not answer";
};
let askedOf = "";

// ---- What people do.

function changed() {
  $("exposure").value = S.exposure;
  $("exposure-text").textContent = sign(S.exposure) + " stops";
  $("view").value = S.view;
  if (state) { showReference(); showScale(); }
  update();
  redraw();
  showValues();
}

function show(what) {
  if (what === "reference" && !reference) return;
  S.show = what;
  S.blink = false;
  changed();
}

function setExposure(stops) {
  S.exposure = Math.min(10, Math.max(-10, stops));
  changed();
}

function zoomBy(factor, px, py) {
  const [x, y] = toPicture(px, py);
  S.zoom = Math.min(128, Math.max(0.02, S.zoom * factor));
  S.fitted = false;
  S.x = x - (px - stage.clientWidth / 2) / S.zoom, S.y = y - (py - stage.clientHeight / 2) / S.zoom;
  redraw();
}

function natural() {
  S.zoom = 1 / devicePixelRatio;
  S.fitted = false;
  redraw();
}

const inStage = (event) => { const box = stage.getBoundingClientRect(); return [event.clientX - box.x, event.clientY - box.y]; };
const overControls = (event) => event.target.closest("#trouble,#zoomer,#hud");

function pointAt(px, py) {
  const at = shown ? toPicture(px, py).map(Math.floor) : null, [w, h] = resolution();
  S.cursor = at && at[0] >= 0 && at[1] >= 0 && at[0] < w && at[1] < h ? at : null;
  showValues();
  ask();
}

let drag = null;
stage.addEventListener("pointerdown", (event) => {
  if (overControls(event) || event.button !== 0) return;
  stage.focus({preventScroll: true});
  stage.setPointerCapture(event.pointerId);
  drag = {at: inStage(event), moved: 0, shift: event.shiftKey};
});
stage.addEventListener("pointermove", (event) => {
  const [px, py] = inStage(event);
  if (!drag) return overControls(event) ? undefined : pointAt(px, py);
  const dx = px - drag.at[0], dy = py - drag.at[1];
  drag.moved += Math.abs(dx) + Math.abs(dy);
  drag.at = [px, py];
  if (drag.moved < 4) return;
  if (S.flying) return lookBy(dx, dy);
  S.x -= dx / S.zoom, S.y -= dy / S.zoom, S.fitted = false;
  redraw();
});
stage.addEventListener("pointerup", async (event) => {
  const done = drag;
  drag = null;
  if (!done || done.moved >= 4 || S.flying) return;
  pointAt(...inStage(event));
  while (asking) await new Promise((later) => setTimeout(later, 5));
  if (spot && spot.hit && spot.shape_at) goTo(spot.shape_at, done.shift);
});
stage.addEventListener("pointercancel", () => { drag = null; });
stage.addEventListener("pointerleave", () => { if (!drag) { S.cursor = null; showValues(); } });
stage.addEventListener("wheel", (event) => {
  if (overControls(event) && !event.target.closest("#hud")) return;
  event.preventDefault();
  const factor = Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015));
  if (S.flying) { speed *= factor; showSpeed(); }
  else zoomBy(factor, ...inStage(event));
}, {passive: false});
stage.addEventListener("dblclick", (event) => { if (!overControls(event) && !S.flying) { S.fitted = true; redraw(); } });

for (const button of $("modes").children) button.onclick = () => show(button.dataset.show);
$("exposure").oninput = () => setExposure(Number($("exposure").value));
$("exposure").ondblclick = () => setExposure(0);
$("view").onchange = () => { S.view = $("view").value; changed(); };
$("fit").onclick = () => { S.fitted = true; redraw(); };
$("natural").onclick = natural;
$("fly").onclick = () => setFlying(!S.flying);
$("fill").onclick = () => { $("app").classList.toggle("filled"); redraw(); };
$("help-button").onclick = () => $("help").showModal();
$("copy-camera").onclick = () => copy(state.camera.text);
$("write-camera").onclick = writeCamera;
$("reset-camera").onclick = resetCamera;
$("file").onchange = async () => {
  const [file] = $("file").files;
  if (!file) return;
  const answer = await fetch("reference?" + new URLSearchParams({name: file.name}),
                             {method: "POST", headers: {"Content-Type": "application/octet-stream"}, body: file})
                         .then((a) => a.ok ? a.json() : {problem: "it is too large"}).catch(() => ({problem: "whit watch does not answer"}));
  toast(answer.problem ? "not shown: " + answer.problem : "the reference is " + file.name);
  $("file").value = "";
};
new ResizeObserver(redraw).observe(stage);
addEventListener("blur", () => held.clear());

const typing = (event) => event.target.closest("input:not([type=range]):not([type=checkbox]),select,textarea,dialog");
const MOVES = new Set(["w", "a", "s", "d", "q", "e", "shift"]);

addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || typing(event)) return;
  const key = event.key.toLowerCase();
  if (S.flying && MOVES.has(key)) { event.preventDefault(); hold(key); return; }
  const actions = {f: () => setFlying(!S.flying), escape: () => setFlying(false), p: () => show("picture"),
                   c: () => show(S.show === "stops" ? "picture" : "stops"), r: () => show(S.show === "reference" ? "picture" : "reference"),
                   b: () => { if (reference) { S.blink = !S.blink; changed(); } }, "+": () => setExposure(S.exposure + 0.5),
                   "=": () => setExposure(S.exposure + 0.5), "-": () => setExposure(S.exposure - 0.5),
                   "0": () => { S.fitted = true; redraw(); }, "1": natural, x: () => $("fill").onclick(),
                   "?": () => $("help").showModal()};
  if (!actions[key]) return;
  event.preventDefault();
  actions[key]();
});
addEventListener("keyup", (event) => held.delete(event.key.toLowerCase()));
changed();
)js";

}  // namespace whit
