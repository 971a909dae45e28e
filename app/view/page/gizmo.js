// SPDX-License-Identifier: Apache-2.0
// Draws all lights over the picture, and the chosen light's handles: arrows move it along the axes, squares in the
// planes of two axes, a disk in the picture's plane; a diamond aims it, a ring rolls it about its axis, dots change its
// size or a sun's angle.
const names = ["X", "Y", "Z"], axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], colors = ["#ff5a52", "#5fd35f", "#5b9dff"];
let held = null;

function element(name, attributes, parent) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}
function onStage(point) {
  const place = project(point), [width, height] = stageSize();
  return place && { x: place.x * width, y: place.y * height, depth: place.depth };
}
/// Returns points on the light's rim, in world space.
function rimOf(light) {
  const kind = kindOf(light), shape = light[kind];
  if (kind === "polygon") return light.polygon;
  if (kind === "rectangle") return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([s, t]) => add(shape.center, add(times(shape.halfU, s), times(shape.halfV, t))));
  let u, v, centre;
  if (kind === "ellipse") [u, v, centre] = [shape.halfU, shape.halfV, shape.center];
  else if (kind === "disk" || kind === "sphere") {
    const n = kind === "disk" ? unit(shape.normal) : frameOf(view).forward;
    u = times(anyAcross(n), shape.radius);
    v = cross(n, u);
    centre = shape.center;
  } else return [];
  return Array.from({ length: 40 }, (_, i) => add(centre, add(times(u, Math.cos(i * Math.PI / 20)), times(v, Math.sin(i * Math.PI / 20)))));
}
/// Returns the position of the handles: the light's centre; for a sun, the pivot.
const anchorOf = (light) => centreOf(light) || (kindOf(light) === "sun" ? view.target : null);
/// Returns the length in world space that covers this number of the page's pixels at the point.
function worldOf(point, pixels) {
  const place = onStage(point);
  return place ? pixels * 2 * frameOf(view).half * place.depth / stageSize()[1] : 0;
}

function handlesOf(light) {
  const anchor = anchorOf(light), kind = kindOf(light), made = [];
  if (!anchor || light.fixed) return made;
  const reach = worldOf(anchor, 74), axis = axisOf(light);
  if (kind !== "sun") {
    axes.forEach((direction, i) => made.push({ name: `move along ${names[i]}`, shape: "arrow", color: colors[i], at: add(anchor, times(direction, reach)), from: anchor,
      begin: () => alongLine(anchor, direction), drag: (start, ray) => movedLight(start.light, times(direction, onLine(ray, anchor, direction) - start.at)) }));
    axes.forEach((normal, i) => {
      const [a, b] = axes.filter((_, j) => j !== i);
      made.push({ name: `move in the plane across ${names[i]}`, shape: "square", color: colors[i], at: add(anchor, times(add(a, b), 0.36 * reach)), begin: () => inPlane(anchor, normal),
        drag: (start, ray) => movedLight(start.light, sub(onPlane(ray, anchor, normal) || start.at, start.at)) });
    });
    const forward = frameOf(view).forward;
    made.push({ name: "move", shape: "disk", color: "#ffffff", at: anchor, begin: () => inPlane(anchor, forward),
      drag: (start, ray) => movedLight(start.light, sub(onPlane(ray, anchor, forward) || start.at, start.at)) });
  }
  if (axis) {
    const far = 1.5 * reach;
    made.push({ name: kind === "sun" ? "direction of the sun" : "aim", shape: "diamond", color: "#ffd27a", at: add(anchor, times(axis, far)), from: anchor, begin: () => ({}),
      drag: (start, ray) => { const to = onBall(ray, anchor, far); return turnedLight(start.light, (d) => turnFromTo(d, axisOf(start.light), to)); } });
  }
  if (["rectangle", "ellipse", "polygon"].includes(kind)) {
    const toward = kind === "polygon" ? cross(axis, sub(light.polygon[0], anchor)) : add(unit(light[kind].halfU), unit(light[kind].halfV));
    made.push({ name: "roll", shape: "ring", color: "#e3b0ff", at: add(anchor, times(unit(toward), 1.2 * reach)), from: anchor, begin: () => inPlane(anchor, axis),
      drag: (start, ray) => {
        const from = sub(start.at, anchor), to = sub(onPlane(ray, anchor, axis) || start.at, anchor);
        return turnedLight(start.light, (d) => turn(d, axis, Math.atan2(dot(cross(from, to), axis), dot(from, to))));
      } });
  }
  if (kind === "sun") {
    // The distance from the axis grows with the square root of the angle, so that small suns can be told apart.
    const tip = add(anchor, times(axis, 1.5 * reach)), facing = cross(axis, frameOf(view).forward), across = length(facing) > 1e-3 ? unit(facing) : anyAcross(axis);
    const least = worldOf(anchor, 16), most = worldOf(anchor, 110), widest = 179;
    made.push({ name: "angle of the sun", shape: "dot", color: "#ffd27a", at: add(tip, times(across, least + most * Math.sqrt(light.sun.angle / widest))), from: tip, begin: () => ({}),
      drag: (start, ray) => {
        const share = Math.min(Math.max((onLine(ray, tip, across) - least) / most, 0.02), 1);
        return { ...start.light, sun: { ...start.light.sun, angle: widest * share * share } };
      } });
  }
  const size = (name, from, direction, set) => made.push({ name, shape: "dot", color: "#ffffff", at: add(from, direction), begin: () => ({}),
    drag: (start, ray) => set(start.light, Math.max(onLine(ray, from, unit(direction)), 1e-3 * length(direction)) / length(direction)) });
  const shape = light[kind];
  if (kind === "rectangle" || kind === "ellipse") {
    for (const half of ["halfU", "halfV"]) size(`size along ${half}`, anchor, shape[half], (one, factor) => ({ ...one, [kind]: { ...one[kind], [half]: times(one[kind][half], factor) } }));
  } else if (kind === "disk" || kind === "sphere") {
    const across = kind === "sphere" ? frameOf(view).right : anyAcross(axis);
    size("radius", anchor, times(across, shape.radius), (one, factor) => ({ ...one, [kind]: { ...one[kind], radius: one[kind].radius * factor } }));
  } else if (kind === "polygon") {
    size("size", anchor, sub(light.polygon[0], anchor), scaledLight);
  }
  return made;
}

const alongLine = (from, direction) => ({ along: [from, direction] });
const inPlane = (from, normal) => ({ plane: [from, normal] });
function onLine({ start, direction }, from, along) {
  const apart = sub(start, from), b = dot(direction, along), c = 1 - b * b;
  return c < 1e-9 ? 0 : (dot(apart, along) - b * dot(apart, direction)) / c;
}
function onPlane({ start, direction }, from, normal) {
  const across = dot(direction, normal);
  if (Math.abs(across) < 1e-3) return null;
  const t = dot(sub(from, start), normal) / across;
  return t > 0 ? add(start, times(direction, t)) : null;
}
/// Returns the direction from `middle` to the point where the ray meets a ball around it, or comes nearest to the ball.
function onBall({ start, direction }, middle, radius) {
  const nearest = dot(sub(middle, start), direction), aside = sub(add(start, times(direction, nearest)), middle), square = radius * radius - dot(aside, aside);
  return unit(square <= 0 ? aside : sub(aside, times(direction, Math.sqrt(square))));
}

function drawLights() {
  const drawing = document.createDocumentFragment();
  drawTypedPixel(drawing);
  if (!byId("frame").hidden && byId("show-lights").checked && lights.length && shown) drawInto(drawing);
  overlay.replaceChildren(drawing);
}
function drawInto(drawing) {
  const chosen = chosenLight();
  for (const light of lights) {
    const rim = rimOf(light).map(onStage);
    const classes = `light${light === chosen ? " chosen" : ""}${off.includes(light.name) || (solo && solo !== light.name) ? " off" : ""}`;
    if (rim.length && rim.every(Boolean)) {
      const path = element("path", { d: "M" + rim.map((p) => `${p.x.toFixed(1)},${p.y.toFixed(1)}`).join("L") + "Z", class: classes + (light === chosen ? "" : " hit") }, drawing);
      path.addEventListener("pointerdown", () => { byId("light").value = light.name; byId("light").dispatchEvent(new Event("change")); });
      element("title", {}, path).textContent = light.name;
    }
    const anchor = anchorOf(light), place = anchor && kindOf(light) !== "sun" ? onStage(anchor) : null;
    if (place) element("text", { x: place.x + 9, y: place.y - 7 }, drawing).textContent = light.name;
  }
  for (const handle of handlesOf(chosen)) drawHandle(handle, drawing);
}
function drawHandle(handle, drawing) {
  const at = onStage(handle.at), from = handle.from && onStage(handle.from);
  if (!at) return;
  if (from) element("line", { x1: from.x, y1: from.y, x2: at.x, y2: at.y, stroke: handle.color }, drawing);
  const s = 7, { x, y } = at;
  const paths = { arrow: `M${x},${y - s}L${x + s},${y}L${x},${y + s}L${x - s},${y}Z`, diamond: `M${x},${y - s}L${x + s},${y}L${x},${y + s}L${x - s},${y}Z`, square: `M${x - s},${y - s}h${2 * s}v${2 * s}h${-2 * s}Z` };
  const radii = { dot: 5, disk: 8, ring: 6 };
  const grip = handle.shape in radii ? element("circle", { cx: x, cy: y, r: radii[handle.shape] }, drawing)
    : element("path", { d: paths[handle.shape] }, drawing);
  grip.setAttribute("class", "hit");
  grip.setAttribute("data-handle", handle.name);
  grip.setAttribute("fill", handle.color);
  grip.setAttribute("fill-opacity", { square: 0.55, disk: 0.55, ring: 0.1 }[handle.shape] ?? 1);
  grip.setAttribute("stroke", handle.shape === "ring" ? handle.color : "#000");
  element("title", {}, grip).textContent = handle.name;
  grip.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    const ray = rayAt(...placeOf(event)), begin = handle.begin();
    const start = begin.along ? onLine(ray, ...begin.along) : begin.plane ? onPlane(ray, ...begin.plane) : 0;
    if (start === null) return;
    held = { handle, start: { light: chosenLight(), at: start } };
  });
}
window.addEventListener("pointermove", (event) => {
  if (!held) return;
  setLight(held.handle.drag(held.start, rayAt(...placeOf(event))), true);
  showNumbersSoon();
});
for (const type of ["pointerup", "pointercancel"]) window.addEventListener(type, () => {
  if (!held) return;
  held = null;
  stopMoving();
  keepLights();
});
byId("show-lights").addEventListener("change", drawLights);
let drawingSoon = false;
on("moved", () => {
  if (drawingSoon) return;
  drawingSoon = true;
  requestAnimationFrame(() => { drawingSoon = false; drawLights(); });
});
