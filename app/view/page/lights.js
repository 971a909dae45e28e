// SPDX-License-Identifier: Apache-2.0
// Lights as numbers: shows a light's values, changes them, and undoes changes.
let lights = [], off = [], solo = "", saved = { scene: "scene.json", pictures: {} }, history = [], undone = [], lightsBefore = "[]";
const kinds = ["rectangle", "ellipse", "disk", "polygon", "sphere", "sun"];
const kindOf = (light) => kinds.find((kind) => kind in light);
const chosenLight = () => lights.find((light) => light.name === byId("light").value) || lights[0];
const snapshot = () => JSON.stringify([lights, off, solo]);

function centreOf(light) {
  const kind = kindOf(light);
  if (!kind || kind === "sun") return null;
  if (kind === "polygon") return times(light.polygon.reduce(add), 1 / light.polygon.length);
  return light[kind].center;
}
/// Returns the direction in which a flat light shines; for a sun, the direction toward it.
function axisOf(light) {
  const kind = kindOf(light);
  if (kind === "rectangle" || kind === "ellipse") return unit(cross(light[kind].halfU, light[kind].halfV));
  if (kind === "disk") return unit(light.disk.normal);
  if (kind === "sun") return unit(times(light.sun.direction, -1));
  if (kind !== "polygon") return null;
  const [first, ...rest] = light.polygon;
  let sum = [0, 0, 0];
  for (let i = 0; i + 1 < rest.length; ++i) sum = add(sum, cross(sub(rest[i], first), sub(rest[i + 1], first)));
  return unit(sum);
}
/// Returns a copy of the light with its positions and directions changed by these functions.
function mapLight(light, place, direction) {
  const made = structuredClone(light), kind = kindOf(light), shape = made[kind];
  if (kind === "polygon") made.polygon = shape.map(place);
  if (shape.center) shape.center = place(shape.center);
  for (const key of ["halfU", "halfV", "normal", "direction"]) if (shape[key]) shape[key] = direction(shape[key]);
  return made;
}
const movedLight = (light, by) => mapLight(light, (p) => add(p, by), (d) => d);
function turnedLight(light, turning) {
  const centre = centreOf(light) || [0, 0, 0];
  return mapLight(light, (p) => add(centre, turning(sub(p, centre))), turning);
}
function scaledLight(light, factor) {
  const centre = centreOf(light), made = mapLight(light, (p) => add(centre, times(sub(p, centre), factor)), (d) => d), shape = made[kindOf(light)];
  for (const key of ["halfU", "halfV"]) if (shape[key]) shape[key] = times(shape[key], factor);
  if (shape.radius) shape.radius *= factor;
  return made;
}

/// Replaces the light of the same name, and sends the change.
function setLight(light, moving) {
  lights = lights.map((one) => (one.name === light.name ? light : one));
  const { fixed, textured, ...words } = light;
  change("light " + light.name, { type: "light", name: light.name, light: words, moving });
  tell("moved");
}
function setLightsOn() {
  change("lights", { type: "lights", off, solo });
  showLight();
}
/// To be called when a change is complete, so that it can be undone.
function keepLights() {
  const now = snapshot();
  if (now === lightsBefore) return;
  history.push(lightsBefore);
  undone = [];
  lightsBefore = now;
  showLight();
}
function goTo(from, to) {
  if (!from.length) return;
  to.push(snapshot());
  const [then, thenOff, thenSolo] = JSON.parse(from.pop());
  for (const light of then) {
    const now = lights.find((one) => one.name === light.name);
    if (now && JSON.stringify(now) !== JSON.stringify(light)) setLight(light, false);
  }
  if (JSON.stringify([off, solo]) !== JSON.stringify([thenOff, thenSolo])) {
    off = thenOff;
    solo = thenSolo;
    setLightsOn();
  }
  lightsBefore = snapshot();
  showLight();
}

/// Returns the light's rows of numbers: name, values, and a function that returns the light with other values.
function numbersOf(light) {
  const kind = kindOf(light), shape = light[kind], rows = [];
  const row = (name, values, set, step, more = {}) => rows.push({ name, values, set, step, ...more });
  const put = (key) => (value) => ({ ...light, [kind]: { ...shape, [key]: value } });
  const centre = centreOf(light);
  if (centre) row("position", centre, (value) => movedLight(light, sub(value, centre)), 0.05);
  if (kind === "rectangle" || kind === "ellipse") {
    row("half size", [length(shape.halfU), length(shape.halfV)], (value) => ({ ...light, [kind]: { ...shape,
      halfU: times(unit(shape.halfU), value[0]), halfV: times(unit(shape.halfV), value[1]) } }), 0.05, { least: 1e-6 });
  }
  if (shape && shape.radius !== undefined) row("radius", [shape.radius], (value) => put("radius")(value[0]), 0.05, { least: 1e-6 });
  if (kind === "disk") row("normal", shape.normal, put("normal"), 0.1);
  if (kind === "polygon") row("scale by", [1], (value) => scaledLight(light, value[0]), 0.1, { least: 1e-3 });
  if (kind === "sun") {
    row("direction", shape.direction, put("direction"), 0.05);
    row("angle \u00b0", [shape.angle], (value) => put("angle")(value[0]), 0.1, { least: 0, most: 179 });
  }
  if (kind && kind !== "sphere") {
    row("turn by \u00b0", [0, 0, 0], (value) => turnedLight(light, (d) => value.reduce((v, angle, i) =>
      turn(v, [[1, 0, 0], [0, 1, 0], [0, 0, 1]][i], angle * Math.PI / 180), d)), 5);
  }
  const bright = light.irradiance ? "irradiance" : "radiance";
  row(bright, light[bright], (value) => ({ ...light, [bright]: value }), 0.5, { least: 0 });
  row("by stops", [0], (value) => ({ ...light, [bright]: times(light[bright], 2 ** value[0]) }), 0.5);
  return rows;
}

function showLight() {
  const light = chosenLight();
  if (!light) return;
  byId("light-on").checked = !off.includes(light.name);
  byId("light-solo").checked = solo === light.name;
  byId("light-two-sided").checked = light.twoSided;
  byId("light-two-sided").disabled = ["sphere", "sun", undefined].includes(kindOf(light));
  byId("undo").disabled = !history.length;
  byId("redo").disabled = !undone.length;
  const box = byId("light-numbers");
  if (box.contains(document.activeElement) && box.dataset.light === light.name) return showNumbers(light, box);
  box.dataset.light = light.name;
  box.replaceChildren();
  numbersOf(light).forEach((row, number) => {
    const set = document.createElement("div");
    set.className = "triple";
    set.setAttribute("role", "group");
    set.setAttribute("aria-label", row.name);
    set.append(Object.assign(document.createElement("span"), { textContent: row.name }));
    row.values.forEach((value, i) => {
      const input = document.createElement("input");
      Object.assign(input, { type: "number", step: row.step });
      input.setAttribute("aria-label", `${row.name}${row.values.length > 1 ? " " + (row.name.includes("size") ? "uv" : row.name.includes("radiance") ? "rgb" : "xyz")[i] : ""}`);
      if (row.least !== undefined) input.min = row.least;
      if (row.most !== undefined) input.max = row.most;
      input.disabled = light.fixed && !/radiance|stops/.test(row.name);
      input.addEventListener("change", () => {
        const fresh = numbersOf(chosenLight())[number], values = [...fresh.values];
        values[i] = Number(input.value);
        if (!Number.isFinite(values[i]) || values[i] < (row.least ?? -Infinity) || values[i] > (row.most ?? Infinity)) return showLight();
        setLight(fresh.set(values), false);
        keepLights();
        showNumbers(chosenLight(), box);
      });
      set.append(input);
    });
    box.append(set);
  });
  showNumbers(light, box);
}
function showNumbers(light, box) {
  const values = numbersOf(light).flatMap((row) => row.values);
  [...box.querySelectorAll("input")].forEach((input, i) => {
    const text = String(Number(values[i].toPrecision(6)));
    if (input.value !== text) input.value = text;  // writing a field makes the browser lay out the page
  });
}
let numbersTimer = 0;
/// Shows the chosen light's numbers, at most five times a second: during a drag pictures matter more.
function showNumbersSoon() {
  if (!numbersTimer) numbersTimer = setTimeout(() => { numbersTimer = 0; showNumbers(chosenLight(), byId("light-numbers")); }, 200);
}

/// Requests `path` from the server and saves the answer as a file of this name.
async function saveAs(name, path, parameters = {}) {
  const answer = await fetch(`${path}?${new URLSearchParams({ token, ...parameters })}`);
  if (!answer.ok) throw new Error(await answer.text());
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await answer.blob());
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
/// Saves the scene, and the pictures of lights that it names; all files must be in one folder.
async function save() {
  try {
    await saveAs(saved.scene, "/scene.json");
    for (const [light, name] of Object.entries(saved.pictures)) await saveAs(name, "/scene/picture", { light });
    const count = Object.keys(saved.pictures).length;
    if (count) trouble(`Saved: ${saved.scene}, and ${count} picture${count > 1 ? "s" : ""} of lights beside it.`, false, "good");
  } catch (error) {
    trouble(error.message);
  }
}

byId("light").addEventListener("change", () => { showLight(); tell("moved"); showDisplay(); });
byId("light-on").addEventListener("change", () => {
  const name = chosenLight().name;
  off = byId("light-on").checked ? off.filter((one) => one !== name) : [...off, name];
  setLightsOn();
  keepLights();
});
byId("light-solo").addEventListener("change", () => {
  solo = byId("light-solo").checked ? chosenLight().name : "";
  setLightsOn();
  keepLights();
});
byId("light-two-sided").addEventListener("change", () => {
  setLight({ ...chosenLight(), twoSided: byId("light-two-sided").checked }, false);
  keepLights();
});
byId("undo").addEventListener("click", () => goTo(history, undone));
byId("redo").addEventListener("click", () => goTo(undone, history));
/// Moves the camera away from the pivot until the picture also shows the light.
byId("see-light").addEventListener("click", () => {
  const centre = centreOf(chosenLight());
  if (!centre) return;
  const inside = () => { const at = project(centre); return at && at.x > 0.15 && at.x < 0.85 && at.y > 0.18 && at.y < 0.82; };
  for (let i = 0; i < 60 && !inside(); ++i) {
    if (view.orthographicHeight) view = { ...view, orthographicHeight: view.orthographicHeight * 1.1 };
    else view = { ...view, eye: add(view.target, times(sub(view.eye, view.target), 1.1)) };
  }
  sendCamera(false);
});
byId("save").addEventListener("click", save);
document.addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.target.matches("input[type=number]")) return;
  const key = event.key.toLowerCase();
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  if (key === "y" || event.shiftKey) goTo(undone, history);
  else goTo(history, undone);
});
