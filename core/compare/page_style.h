// The style that whit's pages share: colours by day and by night, headings, tables.
#pragma once

namespace whit {

inline constexpr const char* kPageStyle = R"css(
:root{--paper:#fbfaf8;--card:#fff;--ink:#1c1b19;--soft:#6b6862;--rule:#e4e0d9;--code:#f3f0ea;--grey:#b4afa6;
--accent:#0b6e99;--warn:#a85a00;--warn-paper:#fdf3e3;--bad:#b3261e;--bad-paper:#fcebe9;--good:#15803d}
@media (prefers-color-scheme:dark){:root{--paper:#161514;--card:#1f1e1c;--ink:#ece8e1;--soft:#a09a90;--rule:#383530;
--code:#2a2825;--grey:#837d73;--accent:#5bb8e0;--warn:#f0b35a;--warn-paper:#33291a;--bad:#ff8a80;--bad-paper:#3a2220;
--good:#5fcf88}}
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
.card{background:var(--card);border:1px solid var(--rule);border-radius:12px;padding:18px 20px}
code{font:13.5px/1.5 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
.chips{display:flex;flex-wrap:wrap;gap:6px;margin-top:8px;font-size:13px;color:var(--soft)}
.chips span{border:1px solid var(--rule);border-radius:99px;padding:1px 10px}
.scroll{overflow-x:auto;padding:6px 0}
table{border-collapse:collapse;width:100%;font-size:13.5px}
th{font-weight:550;color:var(--soft);text-align:right;vertical-align:bottom;line-height:1.3;min-width:62px;padding:8px 8px;border-bottom:1px solid var(--rule)}
td{text-align:right;padding:6px 8px;border-bottom:1px solid var(--rule);white-space:nowrap}
tr:last-child td{border-bottom:0}
th.left,td.left{text-align:left}
td small{color:var(--soft);font-size:12px}
sup{font-size:.75em;line-height:0}
figure{margin:0}
figcaption{font-size:13.5px;line-height:1.4;color:var(--soft);margin-top:6px}
figcaption b{color:var(--ink);font-weight:600}
@media (max-width:640px){main{padding:24px 14px 48px}h1{font-size:25px}.card{padding:14px 12px;border-radius:10px}
th,td{padding:6px}}
@media print{.card{break-inside:avoid}}
)css";

}  // namespace whit
