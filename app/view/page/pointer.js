// SPDX-License-Identifier: Apache-2.0
// Handles the pointer and the keys on the picture.
let dragging = null, lastPlace = null, stillTimer = 0;
const pointers = new Map();

function stopMoving() {
  flush();
  post({ type: "still" });
}
/// Ends a movement by keys or wheel after a pause, since no event marks its end.
function soonStill() {
  clearTimeout(stillTimer);
  stillTimer = setTimeout(stopMoving, 250);
}

canvas.addEventListener("pointerdown", (event) => {
  canvas.focus();
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  dragging = event.button === 2 || event.button === 1 || event.shiftKey ? "pan" : event.ctrlKey ? "dolly" : "orbit";
  event.preventDefault();
});
canvas.addEventListener("pointermove", (event) => {
  lastPlace = placeOf(event);
  tell("pointed", lastPlace);
  const before = pointers.get(event.pointerId);
  if (!before || !dragging) return;
  const by = [event.clientX - before[0], event.clientY - before[1]], [, high] = stageSize();
  if (!by[0] && !by[1]) return;
  if (pointers.size === 2) {  // two fingers
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const apart = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1;
    dolly(apart(before) / apart([event.clientX, event.clientY]));
    pan(by[0] / high / 2, by[1] / high / 2);
  } else if (dragging === "orbit") {
    orbit(by[0] / high * Math.PI, by[1] / high * Math.PI);
  } else if (dragging === "pan") {
    pan(by[0] / high, by[1] / high);
  } else {
    dolly(Math.exp(2 * by[1] / high));
  }
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
});
for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, (event) => {
  pointers.delete(event.pointerId);
  if (pointers.size || !dragging) return;
  dragging = null;
  stopMoving();
});
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  dolly(Math.exp(0.0015 * event.deltaY));
  soonStill();
}, { passive: false });
/// Sets the pivot to the surface point that a pixel shows.
function setPivot(place = pointed) {
  if (place) askPixel(...place, (pixel) => {
    if (!pixel.position) return;
    view = { ...view, target: pixel.position };
    sendCamera(false);
  });
}
canvas.addEventListener("dblclick", (event) => setPivot(placeOf(event)));
canvas.addEventListener("keydown", (event) => {
  const does = event.ctrlKey || event.metaKey || event.altKey ? null : keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!does) return;
  event.preventDefault();
  does();
  soonStill();
});
