// The page's script: what is said beside the pictures.
#pragma once

namespace whit {

inline constexpr const char* kPageScriptPanel = R"js(
// ---- Numbers and words beside the pictures. Text goes in as text, never as HTML.

// A difference of such numbers has fewer digits that mean something.
const fewer = (v) => v - v === 0 && Math.abs(v) >= 1e-5 && Math.abs(v) < 1e7 ? String(+v.toPrecision(4)) : full(v);

// Ids are whole numbers, or hashes: the bits of a float.
function idText(v) {
  if (Number.isInteger(v) && Math.abs(v) < 1e7) return String(v);
  return "#" + new Uint32Array(new Float32Array([v]).buffer)[0].toString(16).padStart(8, "0");
}

function showValues() {
  const table = $("values"), at = S.cursor;
  table.replaceChildren();
  if (!layer) return;
  const {corner, step} = row(), i = at ? at[1] * layer.width + at[0] : -1;
  $("where").textContent = at ? `x ${corner[0] + at[0] * step}, y ${corner[1] + at[1] * step}` : "point at a pixel";
  $("where-step").textContent = at && step > 1 ? `mean of ${step} × ${step}` : "";
  table.append(element("tr", {}, ...["", "A", "B", "A − B"].map((text) => element("th", {textContent: text}))));
  for (const {name, a, b} of layer.channels) {
    const id = layer.kind === "id", text = id ? idText : full;
    const cells = at ? [text(a[i]), text(b[i]), a[i] === b[i] ? "0" : id ? "differs" : fewer(a[i] - b[i])] : ["", "", ""];
    const own = name.startsWith(layer.name + ".") ? name.slice(layer.name.length + 1) : name;
    const line = element("tr", {title: name}, element("th", {textContent: own}),
                         ...cells.map((v) => element("td", {textContent: v})));
    if (at && a[i] !== b[i]) line.className = "off";
    table.append(line);
  }
  if (flipMap)
    table.append(element("tr", {}, element("th", {textContent: "FLIP"}),
                         element("td", {colSpan: 3, textContent: at ? (flipMap[i] / 255).toFixed(3) : ""})));
  for (const side of ["a", "b"]) {
    const from = at && source(side), k = 4 * i;
    $("swatch-" + side).style.background = at ? `rgb(${from.bytes[k]},${from.bytes[k + 1]},${from.bytes[k + 2]})` : "";
  }
}

function showScale() {
  const flip = S.mode === "flip", on = flip || S.mode === "difference", signed = S.signed && !flip;
  $("scale").hidden = !on;
  $("scale-row").hidden = !on;
  $("rate-row").hidden = S.mode !== "blink";
  if (!on) return;
  const end = flip ? flipScale() : layer.kind === "id" ? 1 : differenceScale();
  $("ramp").style.background = rampOf(signed ? MAPS.berlin : MAPS.magma);
  $("scale-low").textContent = signed ? "−" + short(end) : "0";
  $("scale-middle").textContent = signed ? "0" : short(end / 2);
  $("scale-high").textContent = (signed ? "+" : "") + short(end);
  $("scale-text").textContent = (signed ? "± " : "to ") + short(end);
}

function showRegions() {
  const list = $("regions"), regions = row().regions;
  list.replaceChildren(...regions.map((region, i) => {
    const [x0, y0, x1, y1] = region.box, one = x0 === x1 && y0 === y1;
    const place = one ? `at ${x0}, ${y0}` : `${x1 - x0 + 1} × ${y1 - y0 + 1} at ${x0}, ${y0}`;
    const button = element("button", {className: "region " + region.kind, onclick: () => chooseRegion(i)},
                           element("i", {}), element("b", {textContent: region.title}),
                           element("span", {textContent: region.text}), element("small", {textContent: place}));
    return element("li", {}, button);
  }));
  $("regions-title").textContent = regions.length ? `Places (${regions.length})` : "Places";
  if (!regions.length) list.append(element("li", {className: "none", textContent: "Nothing here has a place."}));
}

function markRegion() {
  [...$("regions").querySelectorAll("button")].forEach((button, i) => {
    button.classList.toggle("chosen", i === S.region);
    if (i === S.region) button.scrollIntoView({block: "nearest"});
  });
}

const said = (v) => typeof v === "number" ? String(+v.toPrecision(4)) : v;

function showMeasures() {
  const list = $("measures");
  list.replaceChildren(...row().measures.map((m) => {
    const line = element("tr", {className: m.failed ? "bad" : "", title: m.doc});
    const limit = m.limit === null ? "" : (m.falls ? "≥ " : m.measure === "ratio" ? "1 ± " : "≤ ") + said(m.limit);
    line.append(element("th", {textContent: m.measure}, ...(m.layer ? [element("small", {textContent: " " + m.layer})] : [])),
                element("td", {textContent: said(m.value)}), element("td", {className: "limit", textContent: limit}));
    return line;
  }));
  $("notes").replaceChildren(...row().notes.map((note) => element("li", {textContent: note})));
}

function showControls() {
  for (const button of $("modes").children) {
    const mode = button.dataset.mode;
    button.setAttribute("aria-pressed", String(mode === S.mode));
    button.disabled = mode === "flip" && !flipMap;
  }
  const sign = (v) => (v > 0 ? "+" : v < 0 ? "−" : "") + Math.abs(v);
  $("exposure").value = S.exposure;
  $("exposure-text").textContent = sign(S.exposure) + " stops";
  $("scale-slider").value = S.mode === "flip" ? S.flipStops : S.scaleStops;
  $("rate").value = S.rate;
  $("rate-text").textContent = S.paused ? "paused" : S.rate + " a second";
  $("signed").checked = S.signed;
  $("stops").checked = S.stops;
  $("boxes").checked = S.boxes;
  if (layer) $("zoom").textContent = Math.round(S.zoom * 1000) / 10 + " %";
}
)js";

}  // namespace whit
