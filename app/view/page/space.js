// SPDX-License-Identifier: Apache-2.0
// The 3D view of the scene, drawn by three.js: meshes, lights, the camera's frustum, silhouettes, shadow volume,
// wedges and defects. Positions are relative to the scene's origin, as in the program.
let space = null;          // renderer, groups and the server's answers; null until the view is first opened
let spaceShown = false, spaceBusy = false, spaceSoon = false, spaceImpossible = false, meshesNumber = 0;
let spaceAsked = { key: "", exact: false };
const spaceLayers = ["meshes", "lights", "frustum", "silhouettes", "volume", "wedges", "floor", "defects"];
const layerOn = (layer) => byId("layer-" + layer).checked;
const spaceColors = { closed: 0xff9d2e, open: 0xe0402a, other: 0xe03fd8, volume: 0x22263a, wedge: 0x3f7fe0, chosen: 0xffd23f, inside: 0x2fc46b, floor: 0x111111,
  light: 0xffc94a, dark: 0x888888, frustum: 0x3fb6c4, back: 0xf58a1f };
const outcomeNames = ["wedge", "split", "everywhere", "empty"];

function spaceSay(text) { byId("space-facts").textContent = text; }

function makeSpace(three) {
  const renderer = new three.WebGLRenderer({ canvas: spaceCanvas, antialias: true });
  renderer.localClippingEnabled = true;
  renderer.setPixelRatio(window.devicePixelRatio);
  const scene = new three.Scene(), eye = new three.PerspectiveCamera(45, 1, 0.1, 1000), groups = {};
  eye.add(new three.DirectionalLight(0xffffff, 0.5));
  scene.add(eye, new three.HemisphereLight(0xffffff, 0x606070, 0.62));
  for (const layer of spaceLayers) scene.add(groups[layer] = new three.Group());
  return { three, renderer, scene, eye, groups, cut: new three.Plane(new three.Vector3(0, 1, 0), 0), meshes: null, shadows: null, defects: null, lower: [0, 0, 0], upper: [1, 1, 1] };
}
const localOf = (point) => sub(point, space.meshes.origin);

function fillLayer(layer, objects) {
  const group = space.groups[layer];
  for (const old of [...group.children]) {
    group.remove(old);
    old.geometry.dispose();
    old.material.dispose();
  }
  for (const made of objects) if (made) group.add(made);
}
function geometryOf(points) {
  const geometry = new space.three.BufferGeometry();
  geometry.setAttribute("position", new space.three.BufferAttribute(points instanceof Float32Array ? points : new Float32Array(points), 3));
  return geometry;
}
function linesOf(points, color, more = {}) {
  if (!points.length) return null;
  const { colors, ...material } = more, geometry = geometryOf(points);
  if (colors) geometry.setAttribute("color", new space.three.BufferAttribute(colors, 3, true));
  return new space.three.LineSegments(geometry, new space.three.LineBasicMaterial({ color, vertexColors: colors ? space.three.VertexColors : space.three.NoColors, ...material }));
}
/// Returns a transparent, two-sided surface.
function veilOf(points, color, opacity, more = {}) {
  if (!points.length) return null;
  const made = new space.three.Mesh(geometryOf(points), new space.three.MeshBasicMaterial({ color, opacity, transparent: true, depthWrite: false, side: space.three.DoubleSide, ...more }));
  made.renderOrder = 1;
  return made;
}
const clips = () => (byId("space-cut").checked ? { clippingPlanes: [space.cut] } : {});
/// Returns the colours as bytes, three for each corner; `corners`: the number of corners of an element.
function bytesOf(colors, corners) {
  const bytes = new Uint8Array(3 * corners * colors.length);
  for (let i = 0, at = 0; i < colors.length; ++i) for (let k = 0; k < corners; ++k) for (const shift of [16, 8, 0]) bytes[at++] = (colors[i] >> shift) & 255;
  return bytes;
}

function showMeshes() {
  const { meshes, three } = space, count = meshes.shown, points = new Float32Array(9 * count), colors = new Uint8Array(9 * count);
  const shades = meshes.objects.map((object) => (object.emits ? [255, 214, 110] : object.color.map((part) => Math.round(255 * Math.min(1, Math.max(0, part)) ** (1 / 2.2)))));
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) {
      const corner = meshes.trianglesArray[3 * i + k];
      for (let j = 0; j < 3; ++j) {
        points[9 * i + 3 * k + j] = meshes.positionsArray[3 * corner + j];
        colors[9 * i + 3 * k + j] = shades[meshes.objectsArray[i]][j];
      }
    }
  }
  const geometry = geometryOf(points);
  geometry.setAttribute("color", new three.BufferAttribute(colors, 3, true));
  geometry.computeVertexNormals();
  const offset = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, ...(byId("space-glass").checked ? { transparent: true, opacity: 0.3, depthWrite: false } : {}) };
  const front = new three.Mesh(geometry, new three.MeshLambertMaterial({ vertexColors: three.VertexColors, side: three.FrontSide, ...offset }));
  // If defects are shown, back faces have a special colour: a flipped triangle shows its back between its neighbours.
  const back = new three.Mesh(geometry, new three.MeshLambertMaterial(layerOn("defects") ? { color: spaceColors.back, side: three.BackSide, ...offset }
    : { vertexColors: three.VertexColors, side: three.BackSide, ...offset }));
  fillLayer("meshes", count ? [front, back] : []);
  spaceCanvas.dataset.triangles = meshes.triangles;
  spaceCanvas.dataset.shown = count;
}

function showDefects() {
  const { defects, three } = space, list = byId("space-defects");
  list.hidden = !layerOn("defects") || !defects;
  fillLayer("defects", []);
  if (list.hidden) return;
  const points = defects.pointsArray.length ? new three.Points(geometryOf(defects.pointsArray), new three.PointsMaterial({ size: 7, sizeAttenuation: false, vertexColors: three.VertexColors })) : null;
  if (points) points.geometry.setAttribute("color", new three.BufferAttribute(bytesOf(defects.pointColorsArray, 1), 3, true));
  const faces = veilOf(defects.trianglesArray, 0xffffff, 0.85, { vertexColors: three.VertexColors });
  if (faces) faces.geometry.setAttribute("color", new three.BufferAttribute(bytesOf(defects.triangleColorsArray, 3), 3, true));
  fillLayer("defects", [linesOf(defects.linesArray, 0xffffff, { colors: bytesOf(defects.lineColorsArray, 2), depthTest: false, transparent: true }), points, faces]);
  const rows = [{ what: "the backs of triangles", color: spaceColors.back, count: "" }, ...defects.kinds];
  list.replaceChildren(...rows.map((kind) => {
    const row = document.createElement("li"), mark = document.createElement("span");
    mark.style.background = `#${kind.color.toString(16).padStart(6, "0")}`;
    row.append(mark, `${kind.what}${kind.count === "" ? "" : `: ${kind.count.toLocaleString("en")}`}`);
    return row;
  }));
  spaceCanvas.dataset.defectLines = defects.linesArray.length / 6;
}

/// Returns the parts of an array that belong to the bodies that `keep` accepts. `column`: index of the element count in
/// a body's entry of bodiesArray; `size`: numbers per element.
function partsOf(array, column, size, keep) {
  const { bodiesArray } = space.shadows, parts = [];
  for (let i = 0, at = 0; i < bodiesArray.length; i += 4) {
    const next = at + size * bodiesArray[i + column];
    if (keep(bodiesArray[i])) parts.push(array.subarray(at, next));
    at = next;
  }
  const made = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    made.set(part, at);
    at += part.length;
  }
  return made;
}
const edgeOf = (number) => space.shadows.wedgeEdgesArray.subarray(6 * number, 6 * number + 6);

function showShadows() {
  const { shadows } = space, refused = shadows.refused !== undefined;
  for (const layer of ["silhouettes", "volume", "wedges", "floor"]) fillLayer(layer, []);
  spaceCanvas.dataset.refused = String(refused);
  byId("space-wedge-facts").textContent = "";
  if (refused) return spaceSay(shadows.refused);
  space.cut.constant = space.meshes.origin[1] - shadows.floor;
  const colors = Array.from(shadows.multiplicitiesArray, (k) => (Math.abs(k) === 2 ? spaceColors.closed : Math.abs(k) === 1 ? spaceColors.open : spaceColors.other));
  const at = localOf(shadows.point), mark = 0.015 * outside.size;
  fillLayer("silhouettes", [linesOf(shadows.silhouettesArray, 0xffffff, { colors: bytesOf(colors, 2), transparent: true, depthTest: false }),
    linesOf(axes.flatMap((axis) => [...sub(at, times(axis, mark)), ...add(at, times(axis, mark))]), spaceColors.closed)]);
  const chosen = spaceNumber("space-wedge", 0), all = byId("space-all").checked, inside = shadows.inside && new Set(shadows.inside.wedges);
  const sideOf = shadows.silhouetteEdgesArray.indexOf(shadows.wedgeSourcesArray[chosen]);
  let first = 0;
  for (let i = 0; i < sideOf; ++i) first += shadows.sideTrianglesArray[i];
  const sides = all ? shadows.sidesArray : sideOf < 0 ? [] : shadows.sidesArray.subarray(9 * first, 9 * (first + shadows.sideTrianglesArray[sideOf]));
  fillLayer("volume", [veilOf(sides, spaceColors.volume, 0.2, clips())]);
  const rest = (number) => number !== chosen && (!inside || inside.has(number)), only = (number) => number === chosen;
  const { bodyTrianglesArray, bodyLinesArray, floorLinesArray, wedges, outcomesArray } = shadows;
  const insideEdges = inside ? Float32Array.from(shadows.inside.wedges.flatMap((number) => [...edgeOf(number)])) : [];
  fillLayer("wedges", [
    veilOf(partsOf(bodyTrianglesArray, 1, 9, rest), inside ? spaceColors.inside : spaceColors.wedge, 0.07, clips()),
    linesOf(partsOf(bodyLinesArray, 2, 6, rest), inside ? spaceColors.inside : spaceColors.wedge, { transparent: true, opacity: 0.3, ...clips() }),
    veilOf(partsOf(bodyTrianglesArray, 1, 9, only), spaceColors.chosen, 0.28, clips()),
    linesOf(partsOf(bodyLinesArray, 2, 6, only), spaceColors.chosen, { transparent: true, opacity: 0.9, ...clips() }),
    linesOf(insideEdges, spaceColors.inside, { depthTest: false, transparent: true }),
    chosen < wedges ? linesOf(edgeOf(chosen), spaceColors.chosen, { depthTest: false, transparent: true }) : null]);
  const cutLines = partsOf(floorLinesArray, 3, 6, (number) => all ? rest(number) || only(number) : only(number));
  fillLayer("floor", [linesOf(cutLines, spaceColors.wedge), linesOf(partsOf(floorLinesArray, 3, 6, only), spaceColors.chosen, { depthTest: false, transparent: true }),
    linesOf(shadows.shadowLinesArray, spaceColors.floor)]);
  const outcomes = Object.entries(shadows.outcomes).map(([name, count]) => `${count.toLocaleString("en")} ${name === "wedge" ? "bounded by planes" : name}`).join(", ");
  const coarse = space.meshes.shown < space.meshes.triangles ? ` Meshes are drawn with ${space.meshes.shown.toLocaleString("en")} of ${space.meshes.triangles.toLocaleString("en")} triangles; all else is of the whole meshes.` : "";
  spaceSay(`${shadows.silhouettes.toLocaleString("en")} silhouette edges from the point; ${wedges.toLocaleString("en")} wedges (${outcomes || "none"})` +
    `${shadows.leftOut ? `, of which ${shadows.leftOut.toLocaleString("en")} are not drawn: there are too many` : ""}` +
    `${shadows.sides < shadows.silhouettes ? `; the shadow volume is drawn of the first ${shadows.sides.toLocaleString("en")} edges` : ""}.${coarse}` +
    `${shadows.filteredBy ? ` "${shadows.filteredBy}" lets light through and casts no wedges.` : ""}` +
    `${byId("space-pixel").checked ? (shadows.inside ? ` The pixel is in ${shadows.inside.count} wedges.` : " The pixel shows no surface.") : ""}`);
  byId("space-wedge").max = Math.max(0, wedges - 1);
  if (chosen < wedges) {
    const places = [...edgeOf(chosen)], words = (from) => places.slice(from, from + 3).map((value, i) => (value + space.meshes.origin[i]).toFixed(3)).join(", ");
    byId("space-wedge-facts").textContent = `Wedge ${chosen}: edge from (${words(0)}) to (${words(3)})${outcomesArray[chosen] ? `, ${outcomeNames[outcomesArray[chosen]]}` : ""}` +
      `${sideOf >= 0 ? `, counts ${shadows.multiplicitiesArray[sideOf]} from the point` : ", no silhouette from the point"}`;
  }
  Object.assign(spaceCanvas.dataset, { silhouettes: shadows.silhouettes, sides: sides.length / 9, wedges, bodies: shadows.bodies, chosen, floorLines: cutLines.length / 6,
    shadowLines: shadows.shadowLinesArray.length / 6, inside: shadows.inside ? shadows.inside.count : "" });
}

/// Shows the lights at their current positions, and the view frustum of the picture's camera.
function showLooks() {
  const shapes = lights.flatMap((light) => {
    const rim = rimOf(light).map(localOf), color = off.includes(light.name) || (solo && solo !== light.name) ? spaceColors.dark : spaceColors.light;
    return rim.length ? [linesOf(rim.flatMap((point, i) => [...point, ...rim[(i + 1) % rim.length]]), color)] : [];
  });
  if (space.shadows && !space.shadows.refused) shapes.push(veilOf(space.shadows.hullArray, spaceColors.light, 0.6));
  fillLayer("lights", shapes);
  const f = frameOf(view), far = length(sub(view.target, view.eye));
  const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([x, y]) => {
    const { start, direction } = rayAt(x, y);
    return { start: localOf(start), end: localOf(add(start, times(direction, far / dot(direction, f.forward)))) };
  });
  fillLayer("frustum", [linesOf(corners.flatMap(({ start, end }, i) => [...start, ...end, ...end, ...corners[(i + 1) % 4].end]), spaceColors.frustum)]);
}

function drawSpaceSoon() {
  if (spaceSoon || !space || !space.meshes) return;
  spaceSoon = true;
  requestAnimationFrame(() => {
    spaceSoon = false;
    if (spaceShown) drawSpace();
  });
}
function drawSpace() {
  const { renderer, eye, scene, groups } = space, box = byId("space").getBoundingClientRect();
  if (!box.width || !box.height) return;
  for (const layer of spaceLayers) groups[layer].visible = layerOn(layer);
  showLooks();
  if (space.size !== `${box.width} ${box.height}`) renderer.setSize(box.width, box.height);
  space.size = `${box.width} ${box.height}`;
  renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue("--stage").trim());
  eye.aspect = box.width / box.height;
  const far = length(outside.away);
  eye.near = far / 200;
  eye.far = far + 4 * outside.size;
  eye.updateProjectionMatrix();
  eye.position.set(...add(outside.target, outside.away));
  eye.up.set(0, 1, 0);
  eye.lookAt(...outside.target);
  renderer.render(scene, eye);
  spaceCanvas.dataset.calls = renderer.info.render.calls;
  spaceCanvas.dataset.drawn = String(Number(spaceCanvas.dataset.drawn || 0) + 1);
}

/// Requests missing or outdated data for the newest state. `exact`: the server already has the page's current state.
async function askSpace() {
  if (!spaceShown || spaceBusy || spaceImpossible || !lights.length) return;
  const exact = document.documentElement.dataset.exact === "true", { parameters, key } = shadowsWanted();
  const wantsMeshes = !space || !space.meshes || space.meshes.number !== meshesNumber;
  const wantsDefects = layerOn("defects") && (!space || !space.defects || space.defects.number !== meshesNumber);
  const wantsShadows = wantsMeshes || key !== spaceAsked.key || (exact && !spaceAsked.exact);
  if (!wantsMeshes && !wantsDefects && !wantsShadows) return;
  spaceBusy = true;
  spaceCanvas.dataset.busy = "true";
  try {
    const number = meshesNumber;
    if (!space) {
      spaceSay("Loading \u2026");
      const three = await loadThree();
      if (!three) throw new Error("This program was built without three.js (Debian's libjs-three), which draws the 3D view.");
      space = makeSpace(three);
    }
    if (wantsMeshes) {
      const first = !space.meshes;
      space.meshes = { ...await fetchSpace("meshes"), number };
      space.defects = null;
      [space.lower, space.upper] = [localOf(space.meshes.lower), localOf(space.meshes.upper)];
      if (first) outsideHome();
      showMeshes();
    }
    if (layerOn("defects") && !space.defects) space.defects = { ...await fetchSpace("defects"), number };
    showDefects();
    if (wantsShadows) {
      spaceAsked = { key, exact };
      const shadows = await fetchSpace("shadows", parameters);
      if (space.shadows === null && shadows.wedges) {
        byId("space-wedge").value = Math.floor(shadows.wedges / 2);
        byId("space-all").checked = shadows.wedges <= 200;  // a larger number of wedges would hide one another
        spaceAsked.key = byId("space-all").checked ? key : "";
      }
      space.shadows = shadows;
      showShadows();
    }
    drawSpaceSoon();
  } catch (error) {
    spaceSay(error.message);
    spaceCanvas.dataset.trouble = error.message;
    spaceAsked = { key, exact };
    spaceImpossible = !space;  // no three.js, or no WebGL
    spaceBusy = false;
    spaceCanvas.dataset.busy = "false";
    return;
  }
  spaceBusy = false;
  spaceCanvas.dataset.busy = "false";
  askSpace();
}

function chooseWedge(number) {
  const most = space.shadows && !space.shadows.refused ? space.shadows.wedges - 1 : 0;
  byId("space-wedge").value = Math.max(0, Math.min(most, number));
  wedgeChosen();
}
function wedgeChosen() {
  if (space && space.shadows && byId("space-all").checked) showShadows();
  drawSpaceSoon();
  askSpace();
}
/// Chooses the wedge whose edge is nearest to the pointer.
function pickWedge(event) {
  if (!space.shadows || space.shadows.refused) return;
  const box = spaceCanvas.getBoundingClientRect(), place = [event.clientX - box.left, event.clientY - box.top], { three, eye } = space;
  const onScreen = (at) => {
    const p = new three.Vector3(...at).project(eye);
    return p.z > 1 ? null : [(1 + p.x) / 2 * box.width, (1 - p.y) / 2 * box.height];
  };
  let best = -1, nearest = 10;
  for (let i = 0; i < space.shadows.wedges; ++i) {
    const edge = edgeOf(i), a = onScreen(edge.subarray(0, 3)), b = onScreen(edge.subarray(3, 6));
    if (!a || !b) continue;
    const along = [b[0] - a[0], b[1] - a[1]], square = along[0] ** 2 + along[1] ** 2 || 1;
    const t = Math.max(0, Math.min(1, ((place[0] - a[0]) * along[0] + (place[1] - a[1]) * along[1]) / square));
    const apart = Math.hypot(place[0] - a[0] - t * along[0], place[1] - a[1] - t * along[1]);
    if (apart < nearest) [best, nearest] = [i, apart];
  }
  if (best >= 0) chooseWedge(best);
}

function showTab(name) {
  spaceShown = name === "space";
  for (const tab of ["picture", "space"]) {
    byId("tab-" + tab).setAttribute("aria-selected", String(tab === name));
    byId("tab-" + tab).tabIndex = tab === name ? 0 : -1;
  }
  byId("frame").hidden = spaceShown;
  byId("space").hidden = byId("space-controls").hidden = byId("space-keys").hidden = !spaceShown;
  byId("keys").hidden = spaceShown;
  if (!spaceShown) return fit();
  askSpace();
  drawSpaceSoon();
}
for (const tab of ["picture", "space"]) {
  byId("tab-" + tab).addEventListener("click", () => showTab(tab));
  byId("tab-" + tab).addEventListener("keydown", (event) => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    const other = tab === "picture" ? "space" : "picture";
    showTab(other);
    byId("tab-" + other).focus();
  });
}
for (const layer of spaceLayers) byId("layer-" + layer).addEventListener("change", () => {
  if (layer === "defects" && space && space.meshes) {
    showMeshes();
    showDefects();
    askSpace();
  }
  drawSpaceSoon();
});
for (const id of ["space-construction", "space-from", "space-floor", "space-all", "space-pixel"]) byId(id).addEventListener("change", askSpace);
for (const id of ["space-s", "space-t"]) byId(id).addEventListener("input", askSpace);
byId("space-cut").addEventListener("change", () => {
  if (space && space.shadows) showShadows();
  drawSpaceSoon();
});
byId("space-glass").addEventListener("change", () => {
  if (space && space.meshes) showMeshes();
  drawSpaceSoon();
});
byId("space-wedge").addEventListener("change", wedgeChosen);
byId("space-home").addEventListener("click", () => { if (space) outsideHome(); });
byId("light").addEventListener("change", () => askSpace());
new ResizeObserver(drawSpaceSoon).observe(byId("space"));
on("state", (state) => {
  meshesNumber = state.meshes;
  askSpace();
});
on("frame", () => askSpace());
on("moved", drawSpaceSoon);
