// SPDX-License-Identifier: Apache-2.0
// Computes the part of a light that one edge takes or gives back as seen from p (U. Assarsson, T. Akenine-Möller 2003):
// the cone from the light's centre over the edge's projection, cut by the light, minus the triangle between centre and
// edge. docs/coverage.md derives it. The light is [−1, 1]² or the unit disk in its own coordinates, with centre (0, 0).
//
// (X, Y) / W is the projection of a point to the light; W is the point's height above p, relative to the light's.

/// Threshold below which the sign of a rounded quantity is doubtful, relative to the terms that X and Y are sums of: 2⁸
/// times their error. Trusted directions are therefore off by less than 2⁻⁸.
const double kNearCenter = 1.0 / 1099511627776.0;  // 2⁻⁴⁰

const double kHalfPi = 1.57079632679489661923LF;

/// Returns atan(r) for |r| ≤ √2 − 1, by Taylor: the next term is below 2⁻³⁶.
double small_atan(double r) {
  const double s = r * r;
  double sum = 0.0LF;
  for (int n = 23; n >= 1; n -= 2) sum = 1.0LF / double(n) - s * sum;
  return r * sum;
}

/// Returns the angle of (x, y) in (−π, π]; the built-in function has float precision only.
double angle_of(double y, double x) {
  const double ax = abs(x), ay = abs(y);
  const double high = max(ax, ay), low = min(ax, ay);
  const double r = low / high;
  const bool wide = r > 0.41421356237309503LF;
  double angle = small_atan(wide ? (low - high) / (low + high) : r) + (wide ? 0.5LF * kHalfPi : 0.0LF);
  angle = ay > ax ? kHalfPi - angle : angle;
  angle = x < 0.0LF ? 2.0LF * kHalfPi - angle : angle;
  return y < 0.0LF ? -angle : angle;
}

/// Returns the area of the square's fan from the centre, from direction (1, 0) to (x, y). Eight right triangles of area
/// 1/2 make up the square.
double square_fan(double y, double x) {
  const bool steep = abs(y) > abs(x);
  const double rest = (steep ? -x : y) / (steep ? y : x);
  const double quarter = steep ? (y > 0.0LF ? 1.0LF : 3.0LF) : (x > 0.0LF ? 0.0LF : 2.0LF);
  return quarter + 0.5LF * rest;
}

struct Segment {
  dvec3 from, to;  // X, Y, W
  bool any;
};

/// Removes the part of the parameter range where an affine function, d at 0 and e at 1, is negative.
void cut_range(double d, double e, inout double first, inout double last) {
  const double at = d / (d - e);
  if (d < 0.0LF) first = e < 0.0LF ? 2.0LF : max(first, at);
  if (d >= 0.0LF && e < 0.0LF) last = min(last, at);
}

/// Returns the part of the edge that appears in the light's square.
Segment cut_by_square(dvec3 a, dvec3 b) {
  double first = 0.0LF, last = 1.0LF;
  cut_range(a.z - a.x, b.z - b.x, first, last);
  cut_range(a.z + a.x, b.z + b.x, first, last);
  cut_range(a.z - a.y, b.z - b.y, first, last);
  cut_range(a.z + a.y, b.z + b.y, first, last);
  cut_range(1.0LF - a.z, 1.0LF - b.z, first, last);
  // An end that is not cut off is returned unchanged: the ends of neighbouring edges are then the same numbers.
  return Segment(first > 0.0LF ? a + (b - a) * first : a, last < 1.0LF ? a + (b - a) * last : b, first < last);
}

/// Returns the part of the edge where X² + Y² ≤ W² with W ≥ 0: between the roots of a quadratic, or beyond them on the
/// side of the cone with W ≥ 0.
Segment cut_by_disk(dvec3 a, dvec3 b) {
  double first = 0.0LF, last = 1.0LF;
  cut_range(a.z, b.z, first, last);
  cut_range(1.0LF - a.z, 1.0LF - b.z, first, last);
  const dvec3 d = b - a;
  const double square = d.x * d.x + d.y * d.y - d.z * d.z, middle = a.x * d.x + a.y * d.y - a.z * d.z;
  const double rest = a.x * a.x + a.y * a.y - a.z * a.z, root2 = middle * middle - square * rest;
  const double root = sqrt(max(root2, 0.0LF));
  // The two roots, computed without cancellation.
  const double big = -(middle + (middle < 0.0LF ? -root : root));
  const double r0 = big / square, r1 = rest / big;
  const double low = min(r0, r1), high = max(r0, r1);
  if (square > 0.0LF) {
    // The line leaves the cone on both ends.
    first = root2 > 0.0LF ? max(first, low) : 2.0LF;
    last = min(last, high);
  } else {
    // The line runs within the cone beyond one of the roots: the root on the side where W grows.
    if (d.z > 0.0LF) first = max(first, high);
    if (d.z < 0.0LF) last = min(last, low);
  }
  return Segment(first > 0.0LF ? a + d * first : a, last < 1.0LF ? a + d * last : b, first < last);
}

const int kNoTurn = 2;  // within rounding

/// Area of the cone from the centre over a clipped edge.
struct Cone {
  double from, to;  // areas of the square's fan up to either end, in [−1/2, 7/2]
  double sector;    // area of the sector within the light, counter-clockwise positive: to − from, if necessary ± the
                    // whole light
  double triangle;  // area of the triangle between the centre and the edge, with the same sign
  bool doubtful;
};

/// Returns the cone of `cut`. `turn` is the exact sign of the turn from a to b, or kNoTurn; `size` an upper bound of
/// the terms that X and Y are sums of.
Cone cone_of(Segment cut, int turn, double size, bool disk) {
  const dvec3 from = cut.from, to = cut.to;
  const double near = kNearCenter * size;
  const bool at_center = max(abs(from.x), abs(from.y)) <= near || max(abs(to.x), abs(to.y)) <= near;
  const double across = from.x * to.y - from.y * to.x, along = from.x * to.x + from.y * to.y;
  const double half_light = disk ? kHalfPi : 2.0LF, weight = from.z * to.z;
  Cone cone;
  cone.from = square_fan(from.y, from.x);
  cone.to = square_fan(to.y, to.x);
  if (disk) {
    cone.sector = 0.5LF * angle_of(across, along);
  } else {
    cone.sector = cone.to - cone.from;
    cone.sector += cone.sector > 2.0LF ? -4.0LF : cone.sector < -2.0LF ? 4.0LF : 0.0LF;
  }
  // Nearly half a turn: the count at c also depends on the direction of the turn, so one sign must decide both.
  if (along < 0.0LF && double(turn) * cone.sector < 0.0LF) cone.sector += 2.0LF * half_light * double(turn);
  cone.triangle = 0.5LF * across / weight;
  cone.doubtful = at_center || (along < 0.0LF && turn == kNoTurn) || !(weight > 0.0LF);
  return cone;
}
