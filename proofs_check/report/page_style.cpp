#include <maximin/proofs_check/report/page_style.hpp>

namespace maximin::report {

// Series colours follow Okabe and Ito's palette, which people with any of the common colour deficiencies tell apart;
// yellow, illegible on white, is replaced by brown, and every series has a dash of its own besides.
std::string_view page_style() {
  return R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --card: #f6f8fa; --ink: #16191d; --soft: #505a65; --grid: #dfe4e9; --axis: #6b7682;
  --good: #0067a9; --on-good: #ffffff; --plain: #8a949f; --bad: #c1121f; --warn: #9a5b00;
  --s0: #0072b2; --s1: #d98200; --s2: #008f68; --s3: #b8578f; --s4: #3b9fd8; --s5: #8a4f10; --s6: #16191d;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171b; --card: #1c2127; --ink: #eceff2; --soft: #a7b1bc; --grid: #303841; --axis: #8a95a1;
    --good: #58b4f0; --on-good: #0c1116; --plain: #a3aeba; --bad: #ff6b6b; --warn: #f0b04a;
    --s0: #58b4f0; --s1: #f2a93b; --s2: #2fc79b; --s3: #e08fbd; --s4: #9bd4f7; --s5: #c98b4a; --s6: #eceff2;
  }
}
* { box-sizing: border-box; }
html { font-size: 18px; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, "Segoe UI", "Helvetica Neue", "Liberation Sans", Arial, sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 24px 64px; }
h1 { font-size: 1.8rem; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 1.5rem; line-height: 1.25; margin: 56px 0 8px; }
h3 { font-size: 1.1rem; margin: 24px 0 6px; }
p { margin: 8px 0; max-width: 76ch; }
.sub { color: var(--soft); margin: 0 0 20px; }
.sub.notation { margin-top: 14px; }
.verdict { border-left: 10px solid var(--good); background: var(--card); padding: 16px 22px; margin: 18px 0; }
.verdict.bad { border-color: var(--bad); }
.verdict.warn { border-color: var(--warn); }
.verdict p { font-size: 1.12rem; }
.verdict p:first-child { font-size: 1.5rem; line-height: 1.3; font-weight: 650; margin-top: 0; }
.verdict p:last-child { margin-bottom: 0; }
.bad-text { color: var(--bad); font-weight: 650; }
.tiles { display: grid; grid-template-columns: repeat(4, minmax(0, 1fr)); gap: 16px; margin: 20px 0; }
.tile { background: var(--card); padding: 12px 16px; }
.tile b { display: block; font-size: 2.1rem; line-height: 1.15; font-variant-numeric: tabular-nums; }
.tile span { display: block; color: var(--soft); font-size: .95rem; line-height: 1.3; }
.tile.bad b { color: var(--bad); }
.grid { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 26px 30px; margin: 18px 0; }
.wide { max-width: 1000px; margin: 18px 0; }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: 1rem; max-width: 76ch; margin: 2px 0 10px; }
.grid figcaption { font-size: .9rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 6px 10px; vertical-align: top; }
th:first-child, td:first-child, td.text { text-align: left; }
thead th { border-bottom: 2px solid var(--axis); font-size: .95rem; line-height: 1.25; vertical-align: bottom; }
tbody.claim { border-bottom: 1px solid var(--grid); }
tbody.claim tr:first-child td { padding-top: 12px; }
tr.detail i { color: var(--ink); font-style: normal; }
tr.detail td { text-align: left; color: var(--soft); font-size: .95rem; padding-top: 0; padding-bottom: 12px; }
table.facts { width: auto; }
table.facts td { border-bottom: 1px solid var(--grid); }
table.facts td:last-child { text-align: left; }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", Consolas, monospace; font-size: .86em; }
code { overflow-wrap: anywhere; }
code.command span { white-space: nowrap; }
table.claims th:first-child { width: 22%; }
pre { background: var(--card); padding: 14px 18px; overflow-x: auto; white-space: pre-wrap; overflow-wrap: anywhere; }
.legend { list-style: none; margin: 6px 0 0; padding: 0; display: flex; flex-wrap: wrap; gap: 4px 26px; }
.legend li { display: flex; align-items: center; gap: 10px; }
.reading { background: var(--card); padding: 14px 20px; align-self: center; }
.reading p { margin: 8px 0; }
.key-row { display: flex; gap: 12px; align-items: flex-start; margin: 8px 0; }
.key-row svg.plot { flex: none; width: 30px; height: 28px; }
svg.plot { display: block; width: 100%; height: auto; overflow: visible; }
svg.plot.key { flex: none; width: 44px; height: 16px; }
@media (max-width: 900px) {
  html { font-size: 16px; }
  main { padding: 20px 18px 48px; }
  .grid { gap: 20px 18px; }
  .tiles { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  th, td { padding: 5px 6px; }
}
@media (max-width: 560px) { .grid { grid-template-columns: minmax(0, 1fr); } }
@media print {
  :root {
    --paper: #ffffff; --card: #f6f8fa; --ink: #000000; --soft: #333333; --grid: #d5dae0; --axis: #555555;
    --good: #0067a9; --on-good: #ffffff; --plain: #8a949f; --bad: #c1121f; --warn: #9a5b00;
    --s0: #0072b2; --s1: #d98200; --s2: #008f68; --s3: #b8578f; --s4: #3b9fd8; --s5: #8a4f10; --s6: #000000;
  }
  html { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  h2 { margin-top: 24pt; }
  h2, h3, figcaption { break-after: avoid; }
  .grid > *, .wide, .verdict, .tile, tbody.claim, .reading { break-inside: avoid; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";
}

std::string_view plot_style() {
  return R"css(
svg.plot text { font: 15px system-ui, "Segoe UI", "Helvetica Neue", "Liberation Sans", Arial, sans-serif; fill: var(--ink); }
svg.plot text.title { font-size: 17px; font-weight: 650; }
svg.plot text.mid { text-anchor: middle; }
svg.plot text.end { text-anchor: end; }
svg.plot text.label, svg.plot text.note { fill: var(--soft); }
svg.plot text.note { font-size: 14px; font-style: italic; paint-order: stroke; stroke: var(--paper); stroke-width: 3px; }
svg.plot text.halo { paint-order: stroke; stroke: var(--paper); stroke-width: 4px; }
svg.plot text.note.good { fill: var(--good); }
svg.plot text.strong { font-weight: 650; }
svg.plot path { fill: none; }
svg.plot .grid { stroke: var(--grid); stroke-width: 1; }
svg.plot .axis { stroke: var(--axis); stroke-width: 1.3; }
svg.plot .rule { stroke: var(--ink); stroke-width: 1.4; stroke-dasharray: 5 4; }
svg.plot .diagonal { stroke: var(--ink); stroke-width: 1.6; }
svg.plot .region { fill: var(--good); fill-opacity: .07; }
svg.plot .marks circle { stroke: none; fill-opacity: .6; }
svg.plot .marks path { stroke-width: 1.3; }
svg.plot .plain circle { fill: var(--plain); }
svg.plot .good circle { fill: var(--good); }
svg.plot .plain { stroke: var(--plain); }
svg.plot .good { stroke: var(--good); }
svg.plot .bad { stroke: var(--bad); }
svg.plot .marks.bad path { stroke-width: 3; }
svg.plot .marks circle:hover { fill-opacity: 1; stroke: var(--ink); stroke-width: 2; }
svg.plot .specks { stroke-width: 4.4; stroke-linecap: round; stroke-opacity: .5; }
svg.plot .strokes { stroke-width: 1.1; stroke-opacity: .6; }
svg.plot text.good { stroke: var(--paper); }
svg.plot .line { stroke-width: 2.4; stroke-linejoin: round; }
svg.plot .s0 { stroke: var(--s0); }
svg.plot .s1 { stroke: var(--s1); stroke-dasharray: 9 3; }
svg.plot .s2 { stroke: var(--s2); stroke-dasharray: 2.5 2.5; }
svg.plot .s3 { stroke: var(--s3); stroke-dasharray: 9 3 2.5 3; }
svg.plot .s4 { stroke: var(--s4); stroke-width: 3.4; }
svg.plot .s5 { stroke: var(--s5); stroke-dasharray: 14 4; }
svg.plot .s6 { stroke: var(--s6); stroke-dasharray: 5 2 1.5 2 1.5 2; }
svg.plot .track { fill: var(--grid); fill-opacity: .55; }
svg.plot .bar { stroke: none; }
svg.plot .bar.good { fill: var(--good); }
svg.plot .bar.plain { fill: var(--plain); }
svg.plot .bar.bad { fill: var(--bad); }
svg.plot .cell rect { fill: var(--good); stroke: var(--grid); stroke-width: 1; }
svg.plot .cell.empty rect { fill: none; stroke-dasharray: 3 3; }
svg.plot .cell.deep text { fill: var(--on-good); }
svg.plot .interval path { stroke-width: 5; stroke-opacity: .35; }
svg.plot .interval path.stop { stroke-width: 4; stroke-opacity: 1; }
svg.plot .interval circle { stroke: none; }
svg.plot .bad circle { fill: var(--bad); }
)css";
}

}  // namespace maximin::report
