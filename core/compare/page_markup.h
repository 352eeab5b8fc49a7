// The page's viewer before its script has filled it.
#pragma once

namespace whit {

inline constexpr const char* kPageMarkup = R"html(
<noscript><p class="under">The viewer needs a browser that runs the page's own script.</p></noscript>
<section id="viewer" aria-label="Viewer" hidden>
<div id="bar">
<div id="which"><button id="previous" class="plain" title="Previous picture (←)" aria-label="Previous picture">‹</button>
<button id="next" class="plain" title="Next picture (→)" aria-label="Next picture">›</button>
<span id="pill" class="pill"></span><b id="name"></b><select id="layer" title="Layer (L)" aria-label="Layer"></select></div>
<div id="modes" role="group" aria-label="How to compare">
<button data-mode="side" title="Side by side (S)">Side by side</button><button data-mode="swipe" title="Swipe (W)">Swipe</button>
<button data-mode="blink" title="Blink (B)">Blink</button><button data-mode="difference"
title="Difference; again: signed or absolute (D)">Difference</button><button data-mode="flip" title="FLIP (F)">FLIP</button>
<button data-mode="a" title="A alone (A)">A</button><button data-mode="b" title="B, the reference, alone (R)">B</button></div>
<div id="window"><button id="help-button" class="plain" title="Keys (?)" aria-label="Keys">?</button>
<button id="fill" class="plain" title="Fill the window (X)" aria-label="Fill the window">⤢</button>
<button id="close" class="plain" title="Close (Esc)" aria-label="Close">×</button></div>
</div>
<div id="work">
<div id="stage"><canvas id="canvas"></canvas>
<div id="scale" hidden><div id="ramp"></div><div id="ticks"><span id="scale-low"></span><span id="scale-middle"></span><span
id="scale-high"></span></div></div>
<div id="zoomer"><button id="fit" title="Fit (0)">fit</button><button id="natural" title="100 % (1)">1 : 1</button><span
id="zoom"></span></div>
<p id="message" hidden></p></div>
<aside id="panel">
<p id="verdict"></p>
<section class="values"><h3><span id="where"></span><span id="where-step"></span><i id="swatch-a" title="A"></i><i
id="swatch-b" title="B"></i></h3><table id="values"></table></section>
<section class="controls">
<label>Exposure <output id="exposure-text"></output><input id="exposure" type="range" min="-12" max="12" step="0.25"></label>
<label id="scale-row" hidden>Scale <output id="scale-text"></output><input id="scale-slider" type="range" min="-8" max="12"
step="0.25"></label>
<label id="rate-row" hidden>Flips <output id="rate-text"></output><input id="rate" type="range" min="0.5" max="16"
step="0.5"></label>
<div class="checks"><label><input id="signed" type="checkbox"> signed</label><label title="Luminance in stops, in false colours"><input
id="stops" type="checkbox"> false colour</label><label><input id="boxes" type="checkbox"> outlines</label></div>
</section>
<section><h3 id="regions-title">Places</h3><ul id="regions"></ul></section>
<section><h3>Measures</h3><table id="measures"></table><ul id="notes"></ul></section>
<section class="files"><h3>Files <span id="size"></span></h3><div id="paths"></div></section>
</aside>
</div>
<dialog id="help"><form method="dialog"><button class="plain" aria-label="Close">×</button></form><h2>Keys</h2>
<dl>
<div><dt><kbd>S</kbd></dt><dd>side by side</dd></div><div><dt><kbd>W</kbd></dt><dd>swipe: drag the divider</dd></div>
<div><dt><kbd>B</kbd></dt><dd>blink; <kbd>Space</kbd> holds and flips, <kbd>,</kbd> <kbd>.</kbd> slower, faster</dd></div>
<div><dt><kbd>D</kbd></dt><dd>difference; again: signed or absolute</dd></div><div><dt><kbd>F</kbd></dt><dd>FLIP</dd></div>
<div><dt><kbd>A</kbd> <kbd>R</kbd></dt><dd>A alone, the reference alone</dd></div>
<div><dt>wheel</dt><dd>zooms about the cursor, down to the numbers of a pixel; two fingers do too</dd></div>
<div><dt>drag</dt><dd>moves the picture; a double click goes to its pixels and back</dd></div>
<div><dt><kbd>0</kbd> <kbd>1</kbd></dt><dd>fit, one to one</dd></div>
<div><dt><kbd>+</kbd> <kbd>−</kbd> <kbd>E</kbd></dt><dd>exposure up, down, back to 0</dd></div>
<div><dt><kbd>C</kbd></dt><dd>false colour: a step of the map for each stop</dd></div>
<div><dt><kbd>N</kbd> <kbd>P</kbd></dt><dd>next and previous place</dd></div>
<div><dt><kbd>O</kbd></dt><dd>outlines of places</dd></div><div><dt><kbd>L</kbd></dt><dd>next layer</dd></div>
<div><dt><kbd>←</kbd> <kbd>→</kbd></dt><dd>previous and next picture</dd></div>
<div><dt><kbd>X</kbd> <kbd>Esc</kbd></dt><dd>fill the window, close</dd></div>
</dl></dialog>
</section>
)html";

}  // namespace whit
