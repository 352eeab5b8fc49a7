// The style of the table of pictures and of the viewer.
#pragma once

namespace whit {

inline constexpr const char* kPageViewerStyle = R"css(
[hidden]{display:none!important}
:root{--stage:#2b2a28;--raised:#fff;--over:0 18px 60px rgba(0,0,0,.28);--tint:rgba(11,110,153,.09)}
@media (prefers-color-scheme:dark){:root{--stage:#0d0d0c;--raised:#4a463f;--over:0 18px 60px rgba(0,0,0,.6);--tint:rgba(91,184,224,.12)}}
body.covered{overflow:hidden}
main{max-width:1480px;padding-top:28px}
.kind{font-size:13px;letter-spacing:.06em;text-transform:uppercase;margin:0!important}
h1{overflow-wrap:anywhere}
h3{font-size:13px;font-weight:600;margin:0 0 6px}
button,select,input{font:inherit;color:inherit;accent-color:var(--accent)}
button{cursor:pointer}
:focus-visible{outline:2px solid var(--accent);outline-offset:1px}
.outcome{margin:4px 0 0!important;line-height:1.4;max-width:110ch!important;overflow-wrap:anywhere}
.outcome.differs{color:var(--bad)}.outcome.same{color:var(--good)}
.counts{display:flex;flex-wrap:wrap;gap:8px;margin:14px 0 20px}
.count{border:1px solid var(--rule);background:var(--card);border-radius:99px;padding:4px 14px;font-size:14px}
.count b{font-size:16px}
.count.differs b{color:var(--bad)}.count.cannot b{color:var(--warn)}.count.same b{color:var(--good)}
.count[aria-pressed=false]{opacity:.45;text-decoration:line-through;text-decoration-thickness:1px}
.pill{display:inline-block;border-radius:99px;padding:1px 10px;font-size:12.5px;font-weight:600;white-space:nowrap}
.pill.differs{color:var(--bad);background:var(--bad-paper)}
.pill.cannot{color:var(--warn);background:var(--warn-paper)}
.pill.same{color:var(--good);background:color-mix(in srgb,var(--good) 12%,transparent)}
#pictures td{vertical-align:middle;padding:10px 9px}
#pictures th{padding:6px 9px 9px}
#pictures th.p{text-align:left}
#pictures .row{cursor:pointer}
#pictures .row:hover td,#pictures .row.current td{background:var(--tint)}
#pictures td.s{width:1%}
#pictures td.n{white-space:normal;min-width:210px}
.open{border:0;background:none;padding:0;font-weight:600;font-size:15px;text-align:left;overflow-wrap:anywhere}
.row:hover .open{color:var(--accent)}
td.n p{margin:2px 0 0;color:var(--soft);font-size:13px;line-height:1.4;max-width:60ch;overflow-wrap:anywhere}
.row.differs td.n p{color:var(--bad)}.row.cannot td.n p{color:var(--warn)}
td.p{text-align:left!important;width:1%}
td.p img{display:block;width:112px;max-height:112px;object-fit:contain;border-radius:5px;background:var(--stage);
image-rendering:pixelated}
td.m b{font-weight:500;display:block}
td.m small{display:block;line-height:1.25}
@media (max-width:1240px){td.s .pill{white-space:normal;text-align:center;border-radius:10px;line-height:1.25;padding:2px 8px}
td.m small{white-space:normal}td.p img{width:88px}#pictures td,#pictures th{padding-left:6px!important;padding-right:6px!important}
#pictures td.n{min-width:170px}}
td.m.bad b{color:var(--bad);font-weight:700}
td.m.bad small{color:var(--bad)}
th code{font-size:12px}

#viewer{margin-top:18px;background:var(--card);border:1px solid var(--rule);border-radius:12px;overflow:hidden;display:flex;
flex-direction:column;height:max(560px,calc(100vh - 170px))}
#viewer.alone:not(.filled) #verdict{display:none}
#viewer.alone:not(.filled) #panel>section:nth-child(2){border-top:0}
#viewer.over{position:fixed;inset:0;z-index:2;margin:0;border:0;border-radius:0;height:auto}
#viewer.alone:not(.filled) #close,#viewer:not(.alone) #fill,#viewer.alone #previous,#viewer.alone #next{display:none}
#bar{display:flex;align-items:center;gap:10px 16px;padding:9px 12px;border-bottom:1px solid var(--rule);flex-wrap:wrap}
#which{display:flex;align-items:center;gap:8px;flex:1 1 240px;min-width:0}
#name{white-space:nowrap;overflow:hidden;text-overflow:ellipsis;min-width:0}
#layer{border:1px solid var(--rule);background:var(--card);border-radius:7px;padding:3px 6px;font-size:13.5px;max-width:150px}
#window{display:flex;gap:4px}
.plain{border:1px solid var(--rule);background:var(--card);border-radius:8px;min-width:32px;height:32px;padding:0 8px;
font-size:16px;line-height:1;color:var(--soft)}
.plain:hover{color:var(--ink);border-color:var(--grey)}
#modes{display:flex;background:var(--code);border-radius:9px;padding:3px;gap:1px;overflow-x:auto;scrollbar-width:none;
max-width:100%}
#modes button{border:0;background:none;border-radius:7px;padding:4px 12px;font-size:13.5px;white-space:nowrap;color:var(--soft)}
#modes button:hover{color:var(--ink)}
#modes button[aria-pressed=true]{background:var(--raised);color:var(--ink);font-weight:600;box-shadow:0 1px 3px rgba(0,0,0,.16)}
#modes button:disabled{opacity:.35;cursor:default}
#work{display:grid;grid-template-columns:minmax(0,1fr) 322px;flex:1;min-height:0}
#stage{position:relative;background:var(--stage);overflow:hidden;touch-action:none;user-select:none;-webkit-user-select:none;
min-height:0;cursor:crosshair}
#canvas{position:absolute;inset:0;width:100%;height:100%;display:block}
#message{position:absolute;inset:0;display:grid;place-content:center;text-align:center;color:#d6d2ca;padding:30px;margin:0;
pointer-events:none}
#scale,#zoomer{position:absolute;bottom:12px;background:rgba(20,20,19,.72);color:#f1eee9;border-radius:9px;font-size:12px;
backdrop-filter:blur(6px)}
#scale{left:12px;padding:8px 11px 5px;width:min(300px,calc(100% - 200px));pointer-events:none}
#ramp{height:10px;border-radius:3px}
#ticks{display:flex;justify-content:space-between;margin-top:3px}
#zoomer{right:12px;display:flex;align-items:center;padding:3px}
#zoomer button{border:0;background:none;color:inherit;border-radius:7px;padding:3px 9px}
#zoomer button:hover{background:rgba(255,255,255,.14)}
#zoom{min-width:62px;text-align:right;padding:0 9px 0 4px}
#panel{border-left:1px solid var(--rule);overflow-y:auto;min-height:0;font-size:13.5px}
#panel>section{padding:13px 15px;border-top:1px solid var(--rule)}
#verdict{margin:0;padding:12px 15px;line-height:1.4;overflow-wrap:anywhere}
.values h3{display:flex;gap:8px;align-items:center;min-height:20px}
#where-step{flex:1;color:var(--soft);font-weight:400}
.values h3 i{width:20px;height:20px;border-radius:5px;border:1px solid var(--rule);background:var(--code)}
#panel table{font-size:13px}
#panel th,#panel td{padding:3px 0 3px 8px;border:0;min-width:0;overflow-wrap:anywhere;white-space:normal}
#panel th:first-child{text-align:left;padding-left:0;color:var(--ink);font-weight:550;vertical-align:baseline}
#values{table-layout:fixed}
#values th:first-child{width:58px}
#values td{white-space:nowrap!important;font:12.2px/1.5 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;height:25px}
#values .off td:last-child{color:var(--warn)}
.controls label{display:block;color:var(--soft)}
.controls output{float:right;color:var(--ink)}
.controls input[type=range]{display:block;width:100%;margin:3px 0 9px}
.checks{display:flex;flex-wrap:wrap;gap:4px 14px}
.checks label{display:inline-flex;align-items:center;gap:5px;white-space:nowrap;color:var(--ink)}
.checks input{margin:0}
#regions{list-style:none;margin:0 -7px;padding:0;max-height:290px;overflow-y:auto}
.region{display:grid;grid-template-columns:16px minmax(0,1fr);width:100%;border:0;background:none;border-radius:8px;text-align:left;
padding:5px 7px;line-height:1.35}
.region:hover{background:var(--code)}
.region.chosen{background:var(--tint);box-shadow:inset 0 0 0 1px var(--accent)}
.region i{width:9px;height:9px;border-radius:3px;margin-top:5px;background:#1ba7cf}
.region.failure i{background:#e5483b}.region.noise i{background:#f0972b}.region.nonfinite i{background:#12c24a}
.region>:not(i){grid-column:2;overflow-wrap:anywhere}
.region b{font-weight:550}
.region span,.region small{color:var(--soft);font-size:12.5px}
.none{color:var(--soft);padding:0 7px}
#measures .bad td:not(.limit),#measures .bad th{color:var(--bad);font-weight:650}
#measures .limit,#measures small,#size{color:var(--soft);font-weight:400}
#notes{margin:8px 0 0;padding-left:1.1em;color:var(--soft);line-height:1.4}
#notes:empty{display:none}
#paths div{display:grid;grid-template-columns:18px minmax(0,1fr)}
#paths code{font-size:12.5px;overflow-wrap:anywhere}
#help{border:1px solid var(--rule);border-radius:14px;background:var(--card);color:var(--ink);padding:22px 26px;
width:min(560px,calc(100vw - 32px));box-shadow:var(--over)}
#help::backdrop{background:rgba(0,0,0,.35)}
#help h2{margin:0 0 12px}
#help form{float:right;margin:-6px -10px 0 0}
#help dl{margin:0;display:grid;gap:7px}
#help dl div{display:grid;grid-template-columns:96px minmax(0,1fr)}
#help dd{margin:0;color:var(--soft)}
kbd{font:12.5px ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;border:1px solid var(--rule);border-bottom-width:2px;
border-radius:5px;padding:1px 6px;background:var(--code);color:var(--ink)}
@media (max-width:900px){
#viewer{height:auto;overflow:visible}
#viewer.over{overflow-y:auto}
#work{grid-template-columns:minmax(0,1fr);grid-template-rows:auto auto}
#stage{height:min(66vh,110vw);min-height:300px}
#panel{border-left:0;overflow:visible}
#which{flex:1 1 0}#modes{flex:1 1 100%;order:3}#modes button{padding:5px 8px;flex:1 0 auto}}
@media (max-width:480px){#layer{max-width:104px}#name{flex:1}#modes button{font-size:12.5px;padding:5px 5px}#panel>section{padding:13px 14px}}
@media (max-width:760px){
#pictures thead{display:none}
#pictures,#pictures tbody{display:block}
#pictures .row{display:grid;grid-template-columns:repeat(3,1fr);border-bottom:1px solid var(--rule);padding:10px 0}
#pictures .row td{border:0;display:block;padding:4px 6px;width:auto}
#pictures td.s,#pictures td.n{grid-column:1/-1}
#pictures td.p:empty{display:none}
td.p img{width:100%;max-height:none}
td.m{text-align:left!important}
td.m::before{content:attr(data-label);color:var(--soft);font:11.5px ui-monospace,Menlo,Consolas,monospace}
td.m:empty{display:none!important}}
@media print{#viewer{display:none}}
)css";

}  // namespace whit
