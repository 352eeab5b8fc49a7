// The style of the page.
#pragma once

namespace whit {

inline constexpr const char* kReportStyle = R"css(
:root{--paper:#fbfaf8;--card:#fff;--ink:#1c1b19;--soft:#6b6862;--rule:#e4e0d9;--code:#f3f0ea;--grey:#b4afa6;
--accent:#0b6e99;--warn:#a85a00;--warn-paper:#fdf3e3;
--k0:#0b6e99;--k1:#c2410c;--k2:#15803d;--k3:#9333ea;--k4:#b45309;--k5:#be185d;--k6:#4d7c0f}
@media (prefers-color-scheme:dark){:root{--paper:#161514;--card:#1f1e1c;--ink:#ece8e1;--soft:#a09a90;--rule:#383530;
--code:#2a2825;--grey:#837d73;--accent:#5bb8e0;--warn:#f0b35a;--warn-paper:#33291a;
--k0:#5bb8e0;--k1:#fb8a5c;--k2:#5fcf88;--k3:#c79bff;--k4:#e8b04a;--k5:#f47fb2;--k6:#a8cf5e}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif;
font-variant-numeric:tabular-nums;color-scheme:light dark}
main{max-width:1180px;margin:0 auto;padding:40px 24px 64px}
header p{margin:.3em 0;color:var(--soft);max-width:80ch}
h1{font-size:30px;line-height:1.2;margin:0 0 .2em;letter-spacing:-.01em}
h2{font-size:20px;margin:44px 0 4px;letter-spacing:-.005em}
.scene{font:500 17px/1.4 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;color:var(--ink)!important;overflow-wrap:anywhere}
.lead,.under{color:var(--soft);margin:0 0 14px;max-width:84ch}
.under{font-size:14px;margin:10px 0 0}
.early{background:var(--warn-paper);color:var(--warn);border-radius:8px;padding:10px 14px;margin:16px 0 0}
.card{background:var(--card);border:1px solid var(--rule);border-radius:12px;padding:18px 20px}
code{font:13.5px/1.5 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
code.paste{display:block;background:var(--code);border-radius:7px;padding:8px 12px;margin-top:10px;overflow-wrap:anywhere;
user-select:all}
.answers{display:grid;gap:12px;grid-template-columns:repeat(auto-fit,minmax(min(100%,430px),1fr));list-style:none;padding:0;margin:12px 0 0}
.answers p{margin:0;font-size:17px;line-height:1.4;font-weight:550}
.chips{display:flex;flex-wrap:wrap;gap:6px;margin-top:8px;font-size:13px;color:var(--soft)}
.chips span{border:1px solid var(--rule);border-radius:99px;padding:1px 10px}
.chips .guess{border-color:var(--warn);color:var(--warn)}
.chart{display:block;width:100%;height:auto;font-size:12px}
.narrow{display:none}
.chart text{fill:var(--ink)}
.chart .tick,.chart .note,.chart .title{fill:var(--soft)}
.chart .title{font-size:12.5px;font-weight:550}
.middle{text-anchor:middle}.end{text-anchor:end}
.grid{stroke:var(--rule);fill:none}
.frame{stroke:var(--soft);fill:none}
.floor{stroke:var(--soft);stroke-dasharray:2 4;fill:none}
.k0{--c:var(--k0)}.k1{--c:var(--k1)}.k2{--c:var(--k2)}.k3{--c:var(--k3)}.k4{--c:var(--k4)}.k5{--c:var(--k5)}.k6{--c:var(--k6)}
.line{stroke:var(--c);stroke-width:1.6;fill:none;opacity:.65}
.line.guess{stroke-dasharray:5 4}
.line.k0{stroke-width:2.2;opacity:.9}
.band{fill:var(--c);opacity:.16}
.band.guess{opacity:.08}
.point .bar{stroke:var(--c);stroke-width:1.3;fill:none}
.point .mark{fill:var(--c);stroke:var(--card);stroke-width:1.5}
.point.beaten{--c:var(--grey)}
.point.beaten .mark{fill:var(--card);stroke:var(--c)}
.chart .name{fill:var(--c);font-weight:600}
.chart .name.beaten{fill:var(--soft);font-weight:400}
.legend{display:flex;flex-wrap:wrap;gap:4px 18px;list-style:none;padding:0;margin:8px 0 0;font-size:13.5px;color:var(--soft)}
.legend li{display:flex;align-items:center;gap:6px}
.legend svg{width:16px;height:16px}
.scroll{overflow-x:auto;padding:6px 0}
table{border-collapse:collapse;width:100%;font-size:13.5px}
th{font-weight:550;color:var(--soft);text-align:right;vertical-align:bottom;line-height:1.3;min-width:62px;padding:8px 8px;border-bottom:1px solid var(--rule)}
td{text-align:right;padding:6px 8px;border-bottom:1px solid var(--rule);white-space:nowrap}
tr:last-child td{border-bottom:0}
th.left,td.left{text-align:left}
td.text{white-space:normal;min-width:180px}
td.effect{white-space:normal;min-width:300px}
td.effect code{font-size:12.5px;color:var(--soft);overflow-wrap:anywhere;user-select:all}
td small{color:var(--soft);font-size:12px}
sup{font-size:.75em;line-height:0}
tr.beaten td{color:var(--soft)}
.star{color:var(--accent);font-weight:700}
.unresolved{color:var(--soft)}
.effect-bar{width:160px;height:22px;vertical-align:middle}
.amount{fill:var(--accent);opacity:.35}
.zero{stroke:var(--rule)}
.whisker{stroke:var(--soft);fill:none}
.thumb{display:block;width:112px;border-radius:4px;image-rendering:pixelated}
.strip{display:flex;gap:12px;overflow-x:auto;padding:4px 0 8px}
.strip figure{flex:0 0 auto;width:172px}
figure{margin:0}
figcaption{font-size:13.5px;line-height:1.4;color:var(--soft);margin-top:6px}
figcaption b{color:var(--ink);font-weight:600}
.strip img{display:block;width:172px;border-radius:6px;image-rendering:pixelated}
.pair{display:grid;gap:16px;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr))}
.marked{position:relative}
.marked img{display:block;width:100%;border-radius:8px}
.marked svg{position:absolute;inset:0;width:100%;height:100%}
.marked circle{fill:none;stroke:#4de1ff;stroke-width:2;vector-effect:non-scaling-stroke}
.ramp{display:inline-block;width:90px;height:9px;border-radius:5px;vertical-align:0;margin:0 4px;
background:linear-gradient(90deg,#000005,#400a69,#942666,#de523b,#fca60a,#fcffa3)}
.unknown{margin:8px 0 0;padding-left:1.2em;max-width:84ch}
.unknown li{margin:.25em 0}
@media (max-width:640px){main{padding:24px 14px 48px}h1{font-size:25px}.card{padding:14px 12px;border-radius:10px}
.wide{display:none}.narrow{display:block}th,td{padding:6px}}
@media print{.card{break-inside:avoid}}
)css";

}  // namespace whit
