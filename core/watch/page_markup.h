// The preview's page before its script has filled it.
#pragma once

namespace whit {

inline constexpr const char* kWatchMarkup = R"html(
<div id="app">
<header id="bar">
<div id="which"><i id="lamp" class="busy"></i><b id="name">whit watch</b><span id="status" role="status">connecting …</span></div>
<div id="modes" role="group" aria-label="What is shown">
<button data-show="picture" title="The picture (P)">Picture</button><button data-show="stops"
title="Luminance in stops, in false colours (C)">False colour</button><button data-show="reference"
title="The reference; B blinks (R)">Reference</button></div>
<div id="window"><button id="fly" class="plain wide" aria-pressed="false" title="Fly: drag to look, WASD and QE to move (F)">Fly</button>
<button id="help-button" class="plain" title="Keys (?)" aria-label="Keys">?</button>
<button id="fill" class="plain" title="Hide the panel (X)" aria-label="Hide the panel">⤢</button></div>
<div id="progress"><i></i></div>
</header>
<div id="work">
<div id="stage" tabindex="0" aria-label="The picture"><canvas id="canvas"></canvas>
<div id="hud" hidden><span><kbd>drag</kbd> look</span><span><kbd>W</kbd><kbd>A</kbd><kbd>S</kbd><kbd>D</kbd> move</span><span><kbd>Q</kbd><kbd>E</kbd>
down, up</span><span><kbd>wheel</kbd> speed <b id="speed"></b></span><span><kbd>Esc</kbd> stop flying</span></div>
<div id="trouble" role="alert" hidden></div>
<div id="scale" hidden><div id="ramp"></div><div id="ticks"><span id="scale-low"></span><span id="scale-middle"></span><span
id="scale-high"></span></div></div>
<div id="zoomer"><button id="fit" title="Fit (0)">fit</button><button id="natural" title="100 % (1)">1 : 1</button><span
id="zoom"></span></div>
<div id="toast" role="status" hidden></div>
<p id="message">Reading the scene …</p></div>
<aside id="panel">
<section class="values"><h3><span id="where">point at a pixel</span><span id="where-step"></span><i id="swatch"></i></h3>
<table id="values"></table><div id="spot"></div></section>
<section class="controls"><h3>View</h3>
<label>Exposure <output id="exposure-text"></output><input id="exposure" type="range" min="-10" max="10" step="0.25" value="0"></label>
<label class="row">View <select id="view"></select></label>
<div class="checks"><label title="A click copies the place of the shape; with this it opens it in the editor"><input id="click-opens"
type="checkbox"> a click opens the editor</label></div></section>
<section id="warnings" hidden><h3></h3><div></div></section>
<section><h3>Effects <small id="effects-note"></small></h3><div id="effects"></div></section>
<section><h3>Camera</h3><pre id="look-at"></pre><p id="refusal" class="quiet"></p>
<div class="buttons"><button id="copy-camera" class="plain wide">Copy</button><button id="write-camera"
class="plain wide strong">Write into the file</button><button id="reset-camera" class="plain wide">Back to the file's</button></div></section>
<section><h3>Reference</h3><p id="reference-name" class="quiet"></p>
<div class="buttons"><label class="plain wide" id="choose">Choose a picture<input id="file" type="file" hidden
accept=".exr,.png,.pfm,.hdr,.tif,.tiff,.jpg,.tga"></label><a id="report" class="plain wide" href="report" target="_blank"
rel="noopener">Compare</a></div></section>
<section><h3>Scene</h3><table id="facts"></table></section>
</aside>
</div>
</div>
<dialog id="help"><form method="dialog"><button class="plain" aria-label="Close">×</button></form><h2>Keys</h2><dl>
<div><dt><kbd>F</kbd></dt><dd>fly: drag to look; W A S D, Q and E move, with Shift faster; the wheel sets the speed</dd></div>
<div><dt><kbd>Esc</kbd></dt><dd>stop flying</dd></div>
<div><dt><kbd>P</kbd> <kbd>C</kbd> <kbd>R</kbd></dt><dd>picture, false colour, reference</dd></div>
<div><dt><kbd>B</kbd></dt><dd>blink: the reference, and the picture again</dd></div>
<div><dt><kbd>+</kbd> <kbd>−</kbd></dt><dd>exposure by half a stop</dd></div>
<div><dt><kbd>0</kbd> <kbd>1</kbd></dt><dd>fit, 100 %; wheel and drag zoom and move the picture</dd></div>
<div><dt>click</dt><dd>copies file:line of the shape; with Shift opens it in Visual Studio Code</dd></div>
<div><dt><kbd>X</kbd></dt><dd>hide or show the panel</dd></div>
</dl></dialog>
)html";

}  // namespace whit
