// SPDX-License-Identifier: Apache-2.0
// The camera: its position and direction, and its movements by hand. The formulas are those of visibility/view_samples.
let view = { eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], verticalFov: 45, shift: [0, 0] };
let pictureSize = [512, 512];

function frameOf(camera) {
  const forward = unit(sub(camera.target, camera.eye)), right = unit(cross(forward, camera.up)), up = cross(right, forward);
  const tangent = Math.tan(camera.verticalFov * Math.PI / 360);
  const half = camera.orthographicHeight ? camera.orthographicHeight / 2 : tangent;
  const shift = camera.shift || [0, 0], moved = add(times(right, 2 * half * shift[0]), times(up, 2 * half * shift[1]));
  return { forward, right, up, half, moved, aspect: pictureSize[0] / pictureSize[1] };
}

/// Returns a point's position in the picture, from (0, 0) at the top left to (1, 1) at the bottom right, and its depth;
/// null for a point behind the eye.
function project(point) {
  const f = frameOf(view), flat = view.orthographicHeight;
  const away = sub(point, flat ? add(view.eye, f.moved) : view.eye), depth = dot(away, f.forward);
  if (depth < 1e-6 * length(away) && !flat) return null;
  const scale = flat ? 1 : depth;
  const aside = flat ? away : sub(away, times(f.moved, depth));
  const x = dot(aside, f.right) / (scale * f.half * f.aspect), y = dot(aside, f.up) / (scale * f.half);
  return { x: (1 + x) / 2, y: (1 - y) / 2, depth: scale };
}

/// Returns the ray through a position in the picture: its start and direction.
function rayAt(x, y) {
  const f = frameOf(view);
  const aside = add(times(f.right, (2 * x - 1) * f.aspect * f.half), times(f.up, (1 - 2 * y) * f.half));
  if (view.orthographicHeight) return { start: add(add(view.eye, f.moved), aside), direction: f.forward };
  return { start: view.eye, direction: unit(add(add(f.forward, f.moved), aside)) };
}

function cameraWords() {
  const made = { eye: view.eye, target: view.target, up: view.up };
  if (view.orthographicHeight) made.orthographicHeight = view.orthographicHeight;
  else made.verticalFov = view.verticalFov;
  return made;
}

function sendCamera(moving) {
  change("camera", { type: "camera", camera: cameraWords(), moving });
  tell("moved");
}

/// Turns the camera around the pivot by two angles, but never over the poles.
function orbit(across, upward, moving = true) {
  const axis = unit(view.up);
  let away = turn(sub(view.eye, view.target), axis, -across);
  const side = unit(cross(axis, away)), angle = Math.acos(Math.max(-1, Math.min(1, dot(unit(away), axis))));
  away = turn(away, side, Math.max(0.02, Math.min(Math.PI - 0.02, angle - upward)) - angle);
  view = { ...view, eye: add(view.target, away) };
  sendCamera(moving);
}

/// Moves the camera sideways and up; 1 is the picture's height.
function pan(across, upward, moving = true) {
  const f = frameOf(view), high = 2 * f.half * (view.orthographicHeight ? 1 : length(sub(view.target, view.eye)));
  const by = add(times(f.right, -across * high), times(f.up, upward * high));
  view = { ...view, eye: add(view.eye, by), target: add(view.target, by) };
  sendCamera(moving);
}

/// Multiplies the camera's distance from the pivot by a factor.
function dolly(factor, moving = true) {
  if (view.orthographicHeight) view = { ...view, orthographicHeight: view.orthographicHeight * factor };
  else view = { ...view, eye: add(view.target, times(sub(view.eye, view.target), factor)) };
  sendCamera(moving);
}

/// Moves the camera and the pivot together.
function walk(ahead, across, upward) {
  const f = frameOf(view), step = 0.04 * length(sub(view.target, view.eye));
  const by = add(add(times(f.forward, ahead * step), times(f.right, across * step)), times(f.up, upward * step));
  view = { ...view, eye: add(view.eye, by), target: add(view.target, by) };
  sendCamera(true);
}

const keys = {
  ArrowLeft: () => orbit(-0.06, 0), ArrowRight: () => orbit(0.06, 0), ArrowUp: () => orbit(0, 0.06), ArrowDown: () => orbit(0, -0.06),
  w: () => walk(1, 0, 0), s: () => walk(-1, 0, 0), a: () => walk(0, -1, 0), d: () => walk(0, 1, 0), q: () => walk(0, 0, -1),
  e: () => walk(0, 0, 1), "+": () => dolly(0.9), "=": () => dolly(0.9), "-": () => dolly(1.1), Home: () => byId("home").click(),
  f: () => flip(), p: () => setPivot(),
};
