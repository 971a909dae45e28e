// SPDX-License-Identifier: Apache-2.0
// Vectors are arrays of three numbers.
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => times(a, 1 / (length(a) || 1));
/// Rotates v about a unit axis (Rodrigues).
function turn(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}
/// Rotates v by the shortest rotation from one unit vector to another.
function turnFromTo(v, from, to) {
  const axis = cross(from, to), sine = length(axis), cosine = dot(from, to);
  if (sine < 1e-9) return cosine > 0 ? v : turn(v, anyAcross(from), Math.PI);
  return turn(v, times(axis, 1 / sine), Math.atan2(sine, cosine));
}
function anyAcross(n) { return unit(cross(n, Math.abs(n[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0])); }
const byId = (id) => document.getElementById(id);
