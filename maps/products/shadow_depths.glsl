// SPDX-License-Identifier: Apache-2.0
// Returns the depth at which the shadow of a texel's surfaces begins, in place of the nearest depth. Both are fractions
// of far, 1 for empty texels. A look-up's bias reduces a receiver's own height by the fraction `forgiven`, whatever
// texel is compared. Depths that need no bias (a second surface, or a middle) are therefore reduced by the same
// fraction: for level receivers the shadow then begins at the right depth, for sloped ones later, by the slope's part
// of the bias. README.md has the table.
float shadow_begins(uint depth_use, float nearest, float second, float forgiven) {
  const bool single = second >= 1.0;
  if (depth_use == kDepthSecond) return single ? 1.0 : second * (1.0 - forgiven);
  if (depth_use == kDepthFirst || single) return nearest;
  const float middle = (nearest + 0.5 * (second - nearest)) * (1.0 - forgiven);
  return depth_use == kDepthMidpoint ? middle : min(nearest, middle);
}
