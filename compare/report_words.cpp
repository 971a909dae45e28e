// Glossary of the report, independent of the numbers.
#include "compare/report_parts.hpp"

namespace penumbra::compare {

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
