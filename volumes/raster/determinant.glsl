// SPDX-License-Identifier: Apache-2.0
// Determinants in double with a bound of their error (volumes/README.md, Doubt).

struct Value {
  double value, bound;
};

double norm1(dvec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

Value det(dvec3 a, dvec3 b, dvec3 c) {
  precise const double x = b.y * c.z - b.z * c.y;
  precise const double y = b.z * c.x - b.x * c.z;
  precise const double z = b.x * c.y - b.y * c.x;
  precise const double value = a.x * x + a.y * y + a.z * z;
  return Value(value, kDeterminantError * norm1(a) * norm1(b) * norm1(c));
}
