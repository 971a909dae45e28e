// SPDX-License-Identifier: Apache-2.0
// The outside camera, which shows the scene in 3D: it turns around a point of the scene, by pointer and by keys.
const outside = { target: [0, 0, 0], away: [0, 0, 1], size: 1 };
const spaceCanvas = byId("space-canvas");
let spacePointer = null;

function outsideMoved() { drawSpaceSoon(); }
function outsideOrbit(across, upward) {
  const axis = [0, 1, 0], turned = turn(outside.away, axis, -across), side = unit(cross(axis, turned));
  const angle = Math.acos(Math.max(-1, Math.min(1, dot(unit(turned), axis))));
  outside.away = turn(turned, side, Math.max(0.02, Math.min(Math.PI - 0.02, angle - upward)) - angle);
  outsideMoved();
}
function outsideDolly(factor) {
  const far = length(outside.away) * factor;
  outside.away = times(unit(outside.away), Math.max(1e-4 * outside.size, Math.min(50 * outside.size, far)));
  outsideMoved();
}
/// Moves the outside camera sideways and up; 1 is the view's height.
function outsidePan(across, upward) {
  const forward = unit(times(outside.away, -1)), right = unit(cross(forward, [0, 1, 0])), up = cross(right, forward), high = 0.83 * length(outside.away);
  outside.target = add(outside.target, add(times(right, -across * high), times(up, upward * high)));
  outsideMoved();
}
/// Puts the outside camera on the side of the picture's camera, far enough to see everything.
function outsideHome() {
  const middle = times(add(space.lower, space.upper), 0.5);
  outside.size = length(sub(space.upper, space.lower)) || 1;
  let towards = sub(view.eye, view.target);
  towards = turn([towards[0], 0, towards[2]], [0, 1, 0], 0.6);
  const level = length(towards) > 1e-9 ? unit(towards) : [0, 0, 1];
  outside.target = middle;
  outside.away = times(unit(add(level, [0, 0.55, 0])), 1.35 * outside.size);
  outsideMoved();
}

const spaceKeys = {
  ArrowLeft: () => outsideOrbit(-0.08, 0), ArrowRight: () => outsideOrbit(0.08, 0), ArrowUp: () => outsideOrbit(0, 0.08), ArrowDown: () => outsideOrbit(0, -0.08),
  w: () => outsidePan(0, -0.06), s: () => outsidePan(0, 0.06), a: () => outsidePan(0.06, 0), d: () => outsidePan(-0.06, 0),
  "+": () => outsideDolly(0.9), "=": () => outsideDolly(0.9), "-": () => outsideDolly(1.1), Home: () => outsideHome(),
  n: () => chooseWedge(spaceNumber("space-wedge", 0) + 1), p: () => chooseWedge(spaceNumber("space-wedge", 0) - 1),
};
spaceCanvas.addEventListener("keydown", (event) => {
  const does = event.ctrlKey || event.metaKey || event.altKey ? null : spaceKeys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!does || !space) return;
  event.preventDefault();
  does();
});
spaceCanvas.addEventListener("pointerdown", (event) => {
  spaceCanvas.focus();
  spaceCanvas.setPointerCapture(event.pointerId);
  const how = event.button === 2 || event.button === 1 || event.shiftKey ? "pan" : event.ctrlKey ? "dolly" : "orbit";
  spacePointer = { at: [event.clientX, event.clientY], how, moved: 0 };
  event.preventDefault();
});
spaceCanvas.addEventListener("pointermove", (event) => {
  if (!spacePointer || !space) return;
  const high = spaceCanvas.clientHeight || 1, by = [event.clientX - spacePointer.at[0], event.clientY - spacePointer.at[1]];
  spacePointer.at = [event.clientX, event.clientY];
  spacePointer.moved += Math.abs(by[0]) + Math.abs(by[1]);
  if (spacePointer.how === "pan") outsidePan(by[0] / high, by[1] / high);
  else if (spacePointer.how === "dolly") outsideDolly(Math.exp(2 * by[1] / high));
  else outsideOrbit(by[0] / high * Math.PI, by[1] / high * Math.PI);
});
for (const type of ["pointerup", "pointercancel"]) spaceCanvas.addEventListener(type, (event) => {
  if (spacePointer && type === "pointerup" && spacePointer.moved < 4 && space) pickWedge(event);
  spacePointer = null;
});
spaceCanvas.addEventListener("contextmenu", (event) => event.preventDefault());
spaceCanvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (space) outsideDolly(Math.exp(0.0015 * event.deltaY));
}, { passive: false });
