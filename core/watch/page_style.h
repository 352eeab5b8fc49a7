// The style of the preview's page, beside what it shares with others: core/compare/page_style.h, page_viewer_style.h.
#pragma once

namespace whit {

inline constexpr const char* kWatchStyle = R"css(
html,body{height:100%}
#app{display:flex;flex-direction:column;height:100%}
#bar{position:relative;background:var(--card);padding:8px 14px;flex-wrap:nowrap}
#lamp{width:9px;height:9px;border-radius:50%;background:var(--good);flex:none;transition:background .2s}
#lamp.busy{background:var(--accent);animation:breathe 1.1s ease-in-out infinite}
#lamp.wrong{background:var(--bad)}
#lamp.gone{background:var(--grey)}
@keyframes breathe{50%{opacity:.35}}
@media (prefers-reduced-motion:reduce){#lamp.busy{animation:none}}
#status{color:var(--soft);font-size:13.5px;white-space:nowrap;overflow:hidden;text-overflow:ellipsis;min-width:0}
#name{flex:none;max-width:45%}
#progress{position:absolute;left:0;right:0;bottom:-1px;height:2px;overflow:hidden}
#progress i{display:block;height:100%;width:100%;background:var(--accent);transform-origin:0 0;transform:scaleX(0);transition:transform .15s,opacity .5s}
.plain.wide{width:auto;font-size:13.5px;padding:0 12px;color:var(--ink);display:inline-flex;align-items:center;justify-content:center;
text-decoration:none;cursor:pointer}
.plain.strong:not(:disabled){background:var(--accent);border-color:var(--accent);color:var(--card);font-weight:600}
.plain:disabled,.plain[aria-disabled=true]{opacity:.4;cursor:default;pointer-events:none}
.plain[aria-pressed=true]{background:var(--accent);border-color:var(--accent);color:var(--card);font-weight:600}
#work{position:relative}
#app.filled #work{grid-template-columns:minmax(0,1fr)}
#app.filled #panel{display:none}
#stage{outline-offset:-3px}
#stage.flying{cursor:grab}#stage.flying:active{cursor:grabbing}
#canvas{transition:filter .25s}
#stage.stale #canvas{filter:saturate(.35) brightness(.5)}
#hud{position:absolute;left:12px;top:12px;display:flex;flex-wrap:wrap;gap:5px 14px;background:rgba(20,20,19,.72);color:#f1eee9;
border-radius:9px;font-size:12.5px;padding:7px 12px;backdrop-filter:blur(6px);pointer-events:none}
#hud[hidden]{display:none}
#hud span{display:inline-flex;gap:4px;align-items:center}
#hud kbd{background:rgba(255,255,255,.12);border-color:rgba(255,255,255,.2);color:inherit}
#trouble{position:absolute;left:50%;top:22px;transform:translateX(-50%);width:min(860px,calc(100% - 32px));
max-height:calc(100% - 44px);overflow:auto;background:var(--card);color:var(--ink);border-radius:12px;
border:1px solid var(--rule);border-left:5px solid var(--bad);box-shadow:0 18px 60px rgba(0,0,0,.45);cursor:auto;user-select:text;
-webkit-user-select:text}
#trouble[hidden]{display:none}
#trouble>h2{font-size:14px;font-weight:600;margin:0;padding:13px 18px 0;color:var(--bad)}
#trouble .close{position:absolute;right:9px;top:9px}
.problem{padding:11px 18px 13px;border-top:1px solid var(--rule)}
#trouble>h2+.problem{border-top:0}
.problem p{margin:0;overflow-wrap:anywhere;line-height:1.4}
.problem .what{font-weight:600;font-size:15px;margin-top:1px}
.problem .remedy{color:var(--soft);font-size:14px;margin-top:5px;white-space:pre-line}
.problem pre{margin:8px 0 0;padding:8px 12px;background:var(--code);border-radius:8px;overflow-x:auto;
font:13px/1.45 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
.problem pre b{color:var(--bad)}
#warnings .problem{padding:8px 0 0;border:0}
#warnings .problem .what{font-size:13px;font-weight:500}
#warnings .problem .remedy{font-size:12.5px}
#warnings h3{color:var(--warn)}
.place{border:0;background:none;padding:0;color:var(--accent);font:12.5px/1.5 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;
text-align:left;overflow-wrap:anywhere;cursor:pointer}
.place:hover{text-decoration:underline}
#toast{position:absolute;left:50%;bottom:58px;transform:translateX(-50%);background:rgba(20,20,19,.86);color:#f1eee9;border-radius:99px;
padding:6px 16px;font-size:13.5px;max-width:calc(100% - 32px);overflow-wrap:anywhere;pointer-events:none}
#toast[hidden]{display:none}
#swatch{margin-left:auto}
#values th:first-child{width:92px;white-space:nowrap}
#values td{text-align:right}
#spot{margin-top:6px;line-height:1.5;min-height:64px;color:var(--soft)}
#spot b{color:var(--ink);font-weight:550}
#spot div{display:grid;grid-template-columns:76px minmax(0,1fr);gap:0 8px}
.controls label.row{display:flex;align-items:center;gap:10px;margin-bottom:9px}
.controls select{flex:1;min-width:0;border:1px solid var(--rule);background:var(--card);border-radius:7px;padding:3px 6px;font-size:13.5px}
#panel h3 small{font-weight:400;color:var(--soft);font-size:12px;margin-left:6px}
.effect{display:grid;grid-template-columns:18px minmax(0,1fr) auto;gap:0 7px;align-items:center;padding:3px 0;position:relative}
.effect input{margin:0}
.effect label{display:contents;cursor:pointer}
.effect .cost{font-size:12.5px;color:var(--soft);white-space:nowrap}
.effect .bar{grid-column:2/4;height:3px;border-radius:2px;background:var(--code);overflow:hidden;margin-top:2px}
.effect .bar i{display:block;height:100%;background:var(--accent);border-radius:2px}
.effect.off{color:var(--soft)}.effect.off .name{text-decoration:line-through;text-decoration-thickness:1px}
.effect.off .bar i{background:var(--grey)}
.quiet{color:var(--soft);margin:0 0 7px;line-height:1.4;overflow-wrap:anywhere}.quiet:empty{display:none}
#look-at{margin:0 0 8px;padding:8px 10px;background:var(--code);border-radius:8px;white-space:pre-wrap;overflow-wrap:anywhere;
font:12.2px/1.5 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
.buttons{display:flex;flex-wrap:wrap;gap:6px}
#facts td{text-align:right}
@media (max-width:900px){
#app{height:auto;min-height:100%}
#bar{position:sticky;top:0;z-index:3;flex-wrap:wrap}
#name{max-width:60%}#which{flex:1 1 100%;order:0}#modes{flex:1 1 auto;order:1}#window{order:2}
#stage{height:min(62vh,100vw);min-height:320px}}
)css";

}  // namespace whit
