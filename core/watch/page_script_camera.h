// The preview's script: the camera that flies.
#pragma once

namespace whit {

inline constexpr const char* kWatchScriptCamera = R"js(
// ---- Flying. The page knows where the camera is while it flies; the server renders what it is told last.

const add = (a, b, t = 1) => a.map((v, i) => v + t * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.sqrt(dot(a, a)));
// About an axis, by Rodrigues' formula.
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(v.map((x) => x * c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}

const RADIANS_A_PIXEL = 0.0035, STEEPEST = 0.999;
let camera = null;  // {eye, direction, up, mirrored}, while it flies.
let speed = 1, lastTime = 0, sending = false, unsent = false;
const held = new Set();

// What is to the right in the picture.
const rightOf = (c) => unit(cross(c.up, c.direction)).map((v) => c.mirrored ? -v : v);

function takeCamera() {
  const c = state.camera;
  camera = {eye: [...c.eye], direction: unit(c.direction), up: unit(c.up), mirrored: c.mirrored};
}

async function setFlying(on) {
  if (on && (!state || !state.camera.movable)) return;
  S.flying = on;
  held.clear();
  stage.classList.toggle("flying", on);
  $("fly").setAttribute("aria-pressed", String(on));
  $("hud").hidden = !on;
  if (!on) { camera = null; return; }
  takeCamera();
  stage.focus({preventScroll: true});
  showSpeed();
  // A second takes it a quarter of the way to what is in the middle.
  const [w, h] = resolution();
  const answer = await fetch(`at?x=${w / 2}&y=${h / 2}`).then((a) => a.json()).catch(() => null);
  if (answer && answer.hit && answer.distance > 0) speed = answer.distance / 4;
  showSpeed();
}

const showSpeed = () => { $("speed").textContent = short(speed); };

function lookBy(dx, dy) {
  const right = rightOf(camera);
  // Towards the right of the picture, whatever the hand of the frame.
  const side = turned(camera.direction, camera.up, RADIANS_A_PIXEL * dx);
  const towards = dot(side, right) * dx >= 0 ? side : turned(camera.direction, camera.up, -RADIANS_A_PIXEL * dx);
  const level = rightOf({...camera, direction: towards});
  let tilted = turned(towards, level, RADIANS_A_PIXEL * dy);
  if ((dot(tilted, camera.up) - dot(towards, camera.up)) * dy > 0) tilted = turned(towards, level, -RADIANS_A_PIXEL * dy);
  camera.direction = unit(Math.abs(dot(tilted, camera.up)) < STEEPEST ? tilted : towards);
  sendCamera();
}

function step(time) {
  const passed = Math.min(0.1, (time - lastTime) / 1000);
  lastTime = time;
  if (!camera || !held.size) return;
  const by = [0, 0, 0], go = (axis, t) => axis.forEach((v, i) => { by[i] += t * v; });
  if (held.has("w")) go(camera.direction, 1);
  if (held.has("s")) go(camera.direction, -1);
  if (held.has("d")) go(rightOf(camera), 1);
  if (held.has("a")) go(rightOf(camera), -1);
  if (held.has("e")) go(camera.up, 1);
  if (held.has("q")) go(camera.up, -1);
  if (by.some((v) => v)) {
    camera.eye = add(camera.eye, by, passed * speed * (held.has("shift") ? 4 : 1));
    sendCamera();
  }
  requestAnimationFrame(step);
}

function hold(key) {
  const none = !held.size;
  held.add(key);
  if (none) { lastTime = performance.now(); requestAnimationFrame(step); }
}

async function sendCamera() {
  if (sending) { unsent = true; return; }
  sending = true;
  do {
    unsent = false;
    if (camera) await post("camera", {eye: camera.eye, direction: camera.direction, up: camera.up});
  } while (unsent);
  sending = false;
}

async function writeCamera() {
  const place = state.camera.where, {problem} = await post("camera/write", {});
  toast(problem ? "not written: " + problem : "written to " + (place ? placeText(place) : "the file"));
}

async function resetCamera() {
  await post("camera", {reset: true});
  if (S.flying) setFlying(false);
}
)js";

}  // namespace whit
