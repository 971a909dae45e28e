// SPDX-License-Identifier: Apache-2.0
// Projection of points onto the light from a receiver (docs/coverage.md). Requires `push`.

/// The orthogonal projection of p onto the light's plane, and the inverse of the light's height over p.
struct Foot {
  dvec2 at;
  double inverse;
};

Foot foot_of(dvec3 p) {
  const dvec3 P = p - push.c;
  return Foot(dvec2(dot(push.u_dual, P), dot(push.v_dual, P)), -1.0LF / dot(push.n, P));
}

/// Returns the projection (X, Y, W) of x, which is relative to p. The result is the same for all edges that end in x,
/// since their parts along the ray to x must cancel.
dvec3 project(dvec3 x, Foot foot) {
  precise const double w = dot(push.n, x) * foot.inverse;
  precise const double u = dot(push.u_dual, x) + foot.at.x * w;
  precise const double v = dot(push.v_dual, x) + foot.at.y * w;
  return dvec3(u, v, w);
}

/// Returns 1 if p is on the side that n points to, else −1.
int facing_of(Foot foot) { return foot.inverse < 0.0LF ? 1 : -1; }

/// Returns the side of the plane (c, a, b) that p is on. This sign decides whether the count at c changes at the edge.
int turn_of(dvec3 a, dvec3 b, dvec3 p, Foot foot) {
  const Value side = det(a - push.c, b - push.c, p - push.c);
  return side.value > side.bound ? facing_of(foot) : side.value < -side.bound ? -facing_of(foot) : kNoTurn;
}

/// Returns an upper bound of the terms of X and Y at both ends.
double size_of(dvec3 a, dvec3 b, dvec3 p, dvec3 from, dvec3 to) {
  return (norm1(push.u_dual) + norm1(push.v_dual)) *
         (norm1(a - p) + norm1(b - p) + norm1(p - push.c) * (abs(from.z) + abs(to.z)));
}
