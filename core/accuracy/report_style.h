// The style of the page, beside what all pages have.
#pragma once

namespace whit {

inline constexpr const char* kReportStyle = R"css(
:root{--k0:#0b6e99;--k1:#c2410c;--k2:#15803d;--k3:#9333ea;--k4:#b45309;--k5:#be185d;--k6:#4d7c0f}
@media (prefers-color-scheme:dark){:root{--k0:#5bb8e0;--k1:#fb8a5c;--k2:#5fcf88;--k3:#c79bff;--k4:#e8b04a;--k5:#f47fb2;--k6:#a8cf5e}}
.early{background:var(--warn-paper);color:var(--warn);border-radius:8px;padding:10px 14px;margin:16px 0 0}
code.paste{display:block;background:var(--code);border-radius:7px;padding:8px 12px;margin-top:10px;overflow-wrap:anywhere;
user-select:all}
.answers{display:grid;gap:12px;grid-template-columns:repeat(auto-fit,minmax(min(100%,430px),1fr));list-style:none;padding:0;margin:12px 0 0}
.answers p{margin:0;font-size:17px;line-height:1.4;font-weight:550}
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
td.text{white-space:normal;min-width:180px}
td.effect{white-space:normal;min-width:300px}
td.effect code{font-size:12.5px;color:var(--soft);overflow-wrap:anywhere;user-select:all}
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
@media (max-width:640px){.wide{display:none}.narrow{display:block}}
)css";

}  // namespace whit
