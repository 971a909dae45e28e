// What the report says and looks like whatever the numbers are.
#include "compare/report_parts.hpp"

namespace penumbra::compare {

const std::string_view kReportStyle = R"css(
:root { color-scheme: light dark; --page: #fbfaf8; --card: #ffffff; --ink: #1d2026; --soft: #5c6370; --line: #dcdad5;
  --accent: #9a5b00; --band: #f4f2ee; }
@media (prefers-color-scheme: dark) { :root { --page: #14161a; --card: #1c1f25; --ink: #e7e5e0; --soft: #a2a8b4;
  --line: #343943; --accent: #f0b450; --band: #23272f; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
main, header, footer { max-width: 1500px; margin: 0 auto; padding: 0 clamp(1rem, 3vw, 3rem); }
header { padding-top: 2.5rem; }
h1 { font-size: clamp(1.7rem, 3.4vw, 2.6rem); line-height: 1.15; letter-spacing: -0.02em; margin: 0 0 0.4rem; }
h2 { font-size: 1.4rem; letter-spacing: -0.01em; margin: 3rem 0 0.6rem; padding-top: 1.2rem; border-top: 1px solid
  var(--line); }
p, li, dd { max-width: 75ch; }
a { color: var(--accent); }
code, kbd, pre { font-family: ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; font-size:
  0.9em; }
pre { background: var(--band); border: 1px solid var(--line); border-radius: 6px; padding: 0.8rem 1rem; white-space:
  pre-wrap;
  overflow-wrap: anywhere; }
nav { display: flex; flex-wrap: wrap; gap: 0.3rem 1.2rem; margin: 1.2rem 0 0; font-size: 0.93rem; }
.lead { font-size: 1.12rem; color: var(--soft); margin: 0; }
.note { color: var(--soft); font-size: 0.9rem; }
.glance { display: grid; grid-template-columns: repeat(auto-fit, minmax(15rem, 1fr)); gap: 1rem; margin: 1.6rem 0 0;
  padding: 0; }
.glance div { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 0.9rem 1.1rem; }
.glance dt { color: var(--soft); font-size: 0.85rem; }
.glance dd { margin: 0; } .glance dd b { font-size: 1.15rem; overflow-wrap: anywhere; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1.5rem 3rem;
  align-items: start; }
.two > * { min-width: 0; }
.drawing { width: 100%; max-width: 34rem; height: auto; }
.drawing .cone { fill: #f0b450; fill-opacity: 0.13; } .drawing .ray { stroke: #c98a1b; stroke-width: 1; fill: none; }
.drawing .shade { fill: #20222a; fill-opacity: 0.35; } .drawing .object { fill: var(--ink); } .drawing text { fill:
  var(--ink); font-size: 12px; }
.drawing .small { fill: var(--soft); font-size: 10px; }
.gallery { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 17rem), 1fr)); gap: 1.2rem;
  margin-top: 1rem; }
figure { margin: 0; max-width: 36rem; background: var(--card); border: 1px solid var(--line); border-radius: 8px;
  overflow: hidden; }
figure img { display: block; width: 100%; height: auto; background: #606874; }
figcaption { padding: 0.55rem 0.8rem 0.7rem; font-size: 0.9rem; overflow-wrap: anywhere; }
figcaption b { display: block; font-size: 1rem; } figcaption span { color: var(--soft); }
.picture { display: block; cursor: zoom-in; }
.picture input { position: absolute; opacity: 0; pointer-events: none; }
.picture input:focus-visible + img { outline: 3px solid var(--accent); outline-offset: -3px; }
.picture input:checked + img { position: fixed; inset: 0; z-index: 9; width: 100vw; height: 100vh; object-fit: contain;
  image-rendering: pixelated; background: #000c; cursor: zoom-out; }
.legend { max-width: 46rem; margin: 1rem 0 0.4rem; font-size: 0.85rem; padding: 0 1.6rem; }
.legend .ends { display: flex; justify-content: space-between; color: var(--soft); margin: 0 -1.6rem 0.2rem; }
.legend .bar { height: 1rem; border: 1px solid var(--line); border-radius: 3px; }
.legend .ticks { position: relative; height: 1.5rem; font-variant-numeric: tabular-nums; }
.legend .ticks span { position: absolute; transform: translateX(-50%); padding-top: 0.25rem; white-space: nowrap; }
.legend .ticks span::before { content: ""; position: absolute; left: 50%; top: 0; height: 0.3rem; border-left: 1px
  solid var(--soft); }
.swatch { display: inline-block; width: 1em; height: 1em; border-radius: 2px; vertical-align: -0.12em; }
.scroll { overflow-x: auto; margin: 1rem 0; border: 1px solid var(--line); border-radius: 8px; background:
  var(--card); }
table { border-collapse: collapse; width: 100%; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0.7rem 0.9rem; color: var(--soft); font-size: 0.9rem; }
th, td { padding: 0.45rem 0.9rem; text-align: right; vertical-align: top; border-top: 1px solid var(--line); }
th:first-child, .facts td, .facts th, #methods td, #methods th { text-align: left; }
#methods tbody th { min-width: 14rem; }
thead th { color: var(--soft); font-weight: 600; white-space: nowrap; vertical-align: bottom; }
tbody th { font-weight: 600; overflow-wrap: anywhere; min-width: 9rem; }
td small, th small { display: block; color: var(--soft); font-weight: 400; }
tbody tr:nth-child(even) { background: var(--band); }
.facts th { color: var(--soft); font-weight: 400; min-width: 7rem; width: 28%; } .facts td { overflow-wrap: anywhere; }
.best { color: var(--accent); font-weight: 700; }
.warnings { border-left: 4px solid var(--accent); background: var(--band); padding: 0.7rem 1.2rem; border-radius: 0
  6px 6px 0; }
.warnings ul { margin: 0.3rem 0; padding-left: 1.2rem; }
.glossary { columns: 24rem; column-gap: 3rem; } .glossary div { break-inside: avoid; margin-bottom: 0.9rem; }
.glossary dt { font-weight: 700; } .glossary dd { margin: 0; }
details { margin: 0.5rem 0; } summary { cursor: pointer; color: var(--accent); }
footer { margin-top: 3rem; padding-bottom: 2rem; color: var(--soft); font-size: 0.9rem; }
@media print { :root { --page: #fff; --card: #fff; --band: #f4f4f4; --ink: #000; --soft: #444; --line: #bbb; --accent:
  #000; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  nav { display: none; } body { font-size: 10pt; } h2 { break-after: avoid; margin-top: 1.5rem; }
  figure, tr, .glance div { break-inside: avoid; } .gallery { grid-template-columns: repeat(3, 1fr); gap: 0.6rem; }
  .scroll { overflow: visible; } th, td { padding: 0.25rem 0.4rem; font-size: 8pt; } }
)css";

const std::string_view kReportGlossary = R"html(
<dl class="glossary">
<div><dt>Area light</dt><dd>A light that has a size, like a window or a lamp's shade. From behind an object some
points see a part of it: that is what makes shadows soft.</dd></div>
<div><dt>Umbra</dt><dd>Where nothing of the light is seen: the dark core of a shadow, V = 0.</dd></div>
<div><dt>Penumbra</dt><dd>Where a part of the light is seen: the soft rim of a shadow, 0 &lt; V &lt; 1. Nearly all
errors are made here.</dd></div>
<div><dt>View sample</dt><dd>The point of the scene that a pixel shows, with the direction its surface faces. All
methods answer for the same view samples.</dd></div>
<div><dt>Light sample</dt><dd>One of the points spread over the light that stand for all of it. V is then the share of
light samples that are seen. More of them give finer steps.</dd></div>
<div><dt>V, visibility</dt><dd>The share of the light that a view sample sees, from 0 (none) to 1 (all).</dd></div>
<div><dt>Beauty</dt><dd>The picture itself: what a camera would see if all light came straight from the area
lights.</dd></div>
<div><dt>Reference</dt><dd>The method that the others are judged by: slow or not, it is the one built to be
right.</dd></div>
<div><dt>Mask, scalar</dt><dd>A method that answers with a mask says of every light sample whether it is seen. One
that answers with a scalar knows only V, not which part of the light it is.</dd></div>
<div><dt>Judged pixels</dt><dd>Those that errors are averaged over: they show a surface that is no light, have the
whole light above the plane of their own surface, and stand in front of it.</dd></div>
<div><dt>Horizon pixels</dt><dd>Those from which a part of the light lies below the plane of their own surface, as the
ground at sunset. Methods treat them by different rules, so they are counted apart.</dd></div>
<div><dt>Mean, RMSE, 99.9 %, largest</dt><dd>Four ways to put many errors of V in one number: the average of their
sizes; the root of the average of their squares, in which large errors weigh more; the size that 999 of 1000 pixels
stay within; and the worst pixel.</dd></div>
<div><dt>Bias</dt><dd>The average of the errors with their signs: positive means too bright on the whole, negative too
dark. Noise averages out of it, a systematic mistake does not.</dd></div>
<div><dt>Pair</dt><dd>One view sample and one light sample. Two methods on the same light samples can be compared pair
by pair: is this point of the light seen from there, yes or no?</dd></div>
<div><dt>Exact decision</dt><dd>An answer by arithmetic that does not round. Where two methods differ on a pair, it
says who is right.</dd></div>
<div><dt>Shadow seconds</dt><dd>The time for what must be redone when a light moves (“light”) and for finding what
each view sample sees (“evaluate”). What is done once for a mesh, and the view samples that all methods share, are not
part of it.</dd></div>
</dl>
)html";

}  // namespace penumbra::compare
