// The preview's script: what is said beside the picture and over it.
#pragma once

namespace whit {

inline constexpr const char* kWatchScriptPanel = R"js(
// ---- Words and numbers. Text goes in as text, never as HTML.

const sign = (v) => (v > 0 ? "+" : v < 0 ? "−" : "") + Math.abs(v);
const seconds = (s) => s < 0.0995 ? Math.round(s * 1000) + " ms" : s < 9.95 ? s.toFixed(1) + " s" : Math.round(s) + " s";
const percent = (share) => share < 0.01 ? "< 1 %" : Math.round(100 * share) + " %";
const fileName = (path) => path.split("/").pop();

let toastTimer = 0;
function toast(text) {
  $("toast").textContent = text;
  $("toast").hidden = false;
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => { $("toast").hidden = true; }, 2600);
}

const placeText = (place) => `${place.file}:${place.line}`;
const editorAddress = (place) =>
    "vscode://file" + encodeURI(place.path).replace(/[?#]/g, encodeURIComponent) + `:${place.line}:${place.column}`;

async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = element("textarea", {value: text});
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  toast("copied " + text);
}

let openAddress = (address) => { location.href = address; };

// What a click on a place does: copy it, or open it in the editor; Shift does the other.
function goTo(place, shift) {
  if ($("click-opens").checked === shift || !place.path) return copy(placeText(place));
  openAddress(editorAddress(place));
  toast("opening " + placeText(place));
}

function placeButton(place) {
  return element("button", {className: "place", textContent: placeText(place), title: place.path || place.file,
                            onclick: (event) => { event.stopPropagation(); goTo(place, event.shiftKey); }});
}

// ---- The state.

function statusText() {
  const s = state, picture = s.picture;
  if (s.stale) return picture ? "the picture is of the last text without errors" : "no picture yet";
  if (s.phase === "reading") return "reading …";
  if (s.phase === "building") return "building …";
  if (!picture) return "first pixels …";
  const samples = picture.samples < 1 ? "coarse" : `${short(picture.samples)} of ${short(s.samples_wanted)} samples`;
  const first = s.first_seconds ? ` · first pixels after ${seconds(s.first_seconds)}` : "";
  if (s.phase === "rendering") return `${samples} · ${seconds(s.render_seconds)}`;
  return `${short(picture.samples)} samples · ${seconds(s.render_seconds)}${first}`;
}

function showStatus() {
  const busy = state.phase !== "done";
  $("name").textContent = fileName(state.scene);
  $("name").title = state.scene;
  document.title = (state.stale ? "✕ " : busy ? "◌ " : "") + fileName(state.scene) + " · whit";
  $("status").textContent = statusText();
  $("lamp").className = state.stale ? "wrong" : busy ? "busy" : "";
  const share = state.phase === "rendering" && state.picture ? Math.max(0.02, state.samples / state.samples_wanted) : busy ? 0.02 : 1;
  const bar = $("progress").firstChild;
  bar.style.transform = `scaleX(${share})`;
  bar.style.opacity = state.phase === "done" ? 0 : 1;
  $("message").hidden = !!shown || state.stale;
}

function problemElement(problem) {
  const parts = [];
  if (problem.where) parts.push(placeButton({...problem.where, file: problem.where.file}));
  parts.push(element("p", {className: "what", textContent: problem.message}));
  if (problem.excerpt) {
    const pre = element("pre", {}), given = problem.excerpt.replace(/\n$/, "").split("\n");
    const indent = Math.min(...given.map((line) => line.search(/\S|$/))), lines = given.map((line) => line.slice(indent));
    const caret = lines.length > 1 ? lines.pop() : "";
    pre.append(lines.join("\n"));
    if (caret) pre.append("\n", element("b", {textContent: caret}));
    parts.push(pre);
  }
  if (problem.remedy) parts.push(element("p", {className: "remedy", textContent: problem.remedy}));
  return element("div", {className: "problem"}, ...parts);
}

let problemsKey = "";
function showProblems() {
  const key = JSON.stringify([state.problems, state.stale]);
  if (key === problemsKey) return;
  problemsKey = key;
  const errors = state.problems.filter((p) => p.error), warnings = state.problems.filter((p) => !p.error);
  const count = (n, what) => n === 1 ? `1 ${what}` : `${n} ${what}s`;
  $("trouble").hidden = !errors.length;
  if (errors.length) {
    const left = state.problems_left_out ? `, and ${state.problems_left_out} more` : "";
    const close = element("button", {className: "plain close", textContent: "×", title: "Until something else is wrong",
                                     onclick: () => { $("trouble").hidden = true; }});
    $("trouble").replaceChildren(close, element("h2", {textContent: count(errors.length, "error") + left}),
                                 ...errors.map(problemElement));
  }
  $("stage").classList.toggle("stale", state.stale);
  $("warnings").hidden = !warnings.length;
  $("warnings").children[0].textContent = count(warnings.length, "warning");
  $("warnings").children[1].replaceChildren(...warnings.slice(0, 12).map(problemElement));
}

// ---- Effects.

const offNow = () => state.effects.filter((e) => e.off).map((e) => e.name);

function effectElement(effect) {
  const box = element("input", {type: "checkbox", checked: !effect.off && !effect.why_off, disabled: !!effect.why_off});
  box.dataset.effect = effect.name;
  box.onchange = () => post("effects", {off: box.checked ? offNow().filter((n) => n !== effect.name) : [...offNow(), effect.name]});
  const took = state.phase === "done" && state.picture && state.picture.done ? state.render_seconds : 0;
  const cost = effect.cost === null ? (effect.why_off ? "not simulated" : "")
             : percent(effect.cost) + (took && !effect.off ? ` · ${seconds(Math.max(0, effect.cost * took))}` : "");
  const line = element("div", {className: "effect" + (effect.off || effect.why_off ? " off" : "")},
      element("label", {title: [effect.doc, "Without it: " + effect.without, effect.why_off, "Called for by " + effect.causes]
                                   .filter((t) => t).join("\n")},
              box, element("span", {className: "name", textContent: effect.name}), element("span", {className: "cost", textContent: cost})));
  if (effect.cost !== null) {
    const bar = element("i", {});
    bar.style.width = Math.round(100 * Math.min(1, Math.max(0, effect.cost))) + "%";
    line.append(element("div", {className: "bar"}, bar));
  }
  return line;
}

let effectsKey = "";
function showEffects() {
  const key = JSON.stringify([state.effects, state.phase === "done" && state.render_seconds]);
  if (key === effectsKey) return;
  effectsKey = key;
  const measured = state.effects.some((e) => e.cost !== null);
  $("effects-note").textContent = measured ? "and the time that each takes" : "";
  $("effects").replaceChildren(...(state.effects.length ? state.effects.map(effectElement)
                                                        : [element("p", {className: "quiet", textContent: "none yet"})]));
}

// ---- Camera, reference, scene.

function showCamera() {
  const camera = state.camera;
  $("look-at").textContent = camera.text || "…";
  $("refusal").textContent = !camera.refusal ? "" : camera.refusal[0].toUpperCase() + camera.refusal.slice(1) + ".";
  $("copy-camera").disabled = !camera.text;
  $("write-camera").disabled = !camera.moved || !!camera.refusal || state.stale;
  $("write-camera").title = camera.where ? "Replaces what stands at " + placeText(camera.where) : camera.refusal;
  $("reset-camera").disabled = !camera.moved;
  $("fly").disabled = !camera.movable;
}

function showReference() {
  const said = state.reference, ready = !!said && !said.problem;
  $("reference-name").textContent = said ? said.name + (said.problem ? ": " + said.problem : "")
                                         : "A picture to blink with and to compare with.";
  $("report").setAttribute("aria-disabled", String(!ready));
  for (const button of $("modes").children) {
    if (button.dataset.show === "reference") button.disabled = !ready;
    const what = S.blink ? "reference" : S.show;
    button.setAttribute("aria-pressed", String(button.dataset.show === what));
  }
}

const countText = (n) => n >= 1e6 ? (n / 1e6).toPrecision(3) + " M" : n >= 1e4 ? Math.round(n / 1000) + " k" : String(n);

function showFacts() {
  const s = state, picture = s.picture;
  const rows = [["integrator", s.integrator], ["triangles", countText(s.triangles)], ["lights", countText(s.lights)],
                ["size", picture ? picture.resolution.join(" × ") : ""], ["read", seconds(s.read_seconds)],
                ["built", seconds(s.build_seconds)], ["files watched", countText(s.file_count)]];
  if (s.worlds > 1) rows.push(["worlds", s.worlds + ", the first is shown"]);
  $("facts").replaceChildren(...rows.filter(([, v]) => v).map(([k, v]) =>
      element("tr", {}, element("th", {textContent: k}), element("td", {textContent: v}))));
}

function showViews() {
  const names = state.views, select = $("view");
  if (select.dataset.names === JSON.stringify(names)) return;
  select.dataset.names = JSON.stringify(names);
  select.replaceChildren(...names.map((name) => element("option", {value: name, textContent: name || "sRGB (exact curve)"})));
  select.value = S.view = names[0] ?? "";
}

function showScale() {
  const on = S.show === "stops" && !S.blink;
  $("scale").hidden = !on;
  $("ramp").style.background = rampOf(MAPS.magma);
  $("scale-low").textContent = sign(-8 - S.exposure) + " stops";
  $("scale-middle").textContent = "luminance " + short(2 ** -S.exposure);
  $("scale-high").textContent = sign(8 - S.exposure) + " stops";
}

function showState() {
  showViews();
  showStatus();
  showProblems();
  showEffects();
  showCamera();
  showReference();
  showFacts();
  showScale();
}

// ---- Under the cursor.

let spot = null, asking = false, askAgain = false;

function showValues() {
  const at = S.cursor, made = shownNow(), table = $("values");
  const value = at && made ? valueAt(made, ...at) : null;
  $("where").textContent = value ? `x ${at[0]}, y ${at[1]}` : "point at a pixel";
  $("where-step").textContent = made && made.width < shown.info.window[2] - shown.info.window[0] ? "coarse" : "";
  $("swatch").style.background = value ? `rgb(${value.bytes.join(",")})` : "";
  const cell = (i) => value ? full(value.rgb[i]) : "–";
  table.replaceChildren(...["R", "G", "B"].map((name, i) =>
      element("tr", {}, element("th", {textContent: name}), element("td", {textContent: cell(i)}))));
  const light = value ? 0.2126 * value.rgb[0] + 0.7152 * value.rgb[1] + 0.0722 * value.rgb[2] : NaN;
  table.append(element("tr", {}, element("th", {textContent: "luminance"}), element("td", {textContent: value ? full(light) : "–"})));
  showSpot();
}

function showSpot() {
  const lines = [], line = (name, ...what) => lines.push(element("div", {}, element("span", {textContent: name}), element("span", {}, ...what)));
  if (S.cursor && spot && spot.hit) {
    line("depth", element("b", {textContent: full(spot.depth)}));
    line("shape", element("b", {textContent: spot.shape + (spot.object ? ` in ${spot.object}` : "") + " "}),
         ...(spot.shape_at ? [placeButton(spot.shape_at)] : []));
    line("material", element("b", {textContent: [spot.material, spot.material_kind].filter((t) => t).join(", ") + " "}),
         ...(spot.material_at ? [placeButton(spot.material_at)] : []));
  } else if (S.cursor && spot && spot.known) {
    line("depth", element("b", {textContent: "nothing here"}));
  }
  $("spot").replaceChildren(...lines);
}

async function ask() {
  if (asking) { askAgain = true; return; }
  asking = true;
  try {
    do {
      askAgain = false;
      const at = S.cursor;
      if (!at) { spot = null; break; }
      const answer = await fetch(`at?x=${at[0] + 0.5}&y=${at[1] + 0.5}`);
      const said = answer.ok ? await answer.json() : null;
      // While the scene is being built, what was there stays.
      if (said && said.busy) { setTimeout(ask, 200); break; }
      if (said) spot = {...said, x: at[0], y: at[1]};
    } while (askAgain);
  } catch {
    spot = null;
  } finally {
    asking = false;
  }
  showSpot();
}

async function post(what, body) {
  try {
    const answer = await fetch(what, {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(body)});
    return answer.ok ? await answer.json() : {problem: await answer.text()};
  } catch {
    return {problem: "whit watch does not answer"};
  }
}
)js";

}  // namespace whit
