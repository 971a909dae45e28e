// Where the shadow of a texel's surfaces begins, as a depth that stands in the nearest one's place. Both are shares of far,
// 1 where nothing is. What forgives a receiver takes a share `forgiven` off its own height, whatever texel it meets; of what
// needs no bias, a second surface or a middle, as much is taken off: to level receivers the shadow begins where it should,
// to others as much later as the slope adds. README.md has the table.
float shadow_begins(uint depth_use, float nearest, float second, float forgiven) {
  const bool single = second >= 1.0;
  if (depth_use == kDepthSecond) return single ? 1.0 : second * (1.0 - forgiven);
  if (depth_use == kDepthFirst || single) return nearest;
  const float middle = (nearest + 0.5 * (second - nearest)) * (1.0 - forgiven);
  return depth_use == kDepthMidpoint ? middle : min(nearest, middle);
}
