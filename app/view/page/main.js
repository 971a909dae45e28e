// SPDX-License-Identifier: Apache-2.0
// Shows the state that the server sends, and handles the controls that no other script handles.
function trouble(text, lasting = true, kind = "bad") {
  byId("trouble").textContent = text;
  byId("trouble").className = kind;
  clearTimeout(trouble.timer);
  if (!lasting) trouble.timer = setTimeout(() => { byId("trouble").textContent = ""; }, 8000);
}
function fill(select, values, words = (value) => value) {
  const texts = values.map(String);
  if (JSON.stringify([...select.options].map((option) => option.value)) === JSON.stringify(texts)) return;
  select.replaceChildren(...values.map((value) => new Option(words(value), value)));
}
function showDisplay() {
  change("display", { type: "display", channel: byId("channel").value, light: chosenLight().name,
    stops: byId("auto-stops").checked ? null : Number(byId("stops").value), limit: byId("limit").value === "" ? null : Number(byId("limit").value) });
}

on("hello", (message) => {
  methods = message.methods;
  errorColors = message.errorColors;
  fillMethods();
});
let firstState = true;
on("state", (state) => {
  byId("scene-name").textContent = state.scene;
  document.title = `${state.scene} \u2013 Penumbra`;
  const light = byId("light").value;
  fill(byId("light"), state.lights.map((one) => one.name));
  byId("light").value = state.lights.some((one) => one.name === light) ? light : state.display.light;
  fill(byId("camera"), state.cameras.map((one) => one.name));
  byId("camera").value = state.camera.name;
  const [width, height] = state.ownSize, sizes = [1, 0.5, 0.25, 2].map((factor) => `${Math.round(width * factor)}x${Math.round(height * factor)}`);
  const size = state.size.join("x");
  fill(byId("size"), [...new Set([...sizes, size])]);
  byId("size").value = size;
  takeMethods(state);
  if (!dragging && !waiting.has("camera")) {
    view = state.camera;
    pictureSize = state.size;
  }
  if (!held && ![...waiting.keys()].some((key) => key.startsWith("light"))) {
    lights = state.lights;
    off = state.off;
    solo = state.solo;
    if (firstState) lightsBefore = snapshot();
  }
  saved = state.saved;
  if (firstState) takeReport(state);
  firstState = false;
  byId("channel").value = state.display.channel;
  byId("channel").querySelector("[value=error]").disabled = state.other === null;
  if (document.activeElement !== byId("limit")) byId("limit").value = state.display.limit ?? "";
  byId("auto-stops").checked = state.display.stops === null;
  if (state.display.stops !== null) byId("stops").value = state.display.stops;
  showLight();
  tell("moved");
});
on("say", (message) => {
  if (message.level === "error") trouble(message.text);
  else if (message.level === "warning") trouble(message.text, false);
});
on("frame", (header) => { if (header.final) trouble(byId("trouble").textContent, false, byId("trouble").className); });
on("connected", () => trouble(""));
on("lost", () => trouble("The connection to `penumbra view` is lost; trying again."));

byId("channel").addEventListener("change", showDisplay);
byId("limit").addEventListener("change", () => {
  if (!byId("limit").checkValidity()) return trouble(`End of the scale: ${byId("limit").validationMessage}`);
  showDisplay();
});
byId("auto-stops").addEventListener("change", showDisplay);
byId("stops").addEventListener("change", () => { byId("auto-stops").checked = false; showDisplay(); });
byId("size").addEventListener("change", () => {
  const [width, height] = byId("size").value.split("x").map(Number);
  change("size", { type: "size", width, height });
});
for (const id of ["home", "camera"]) byId(id).addEventListener(id === "home" ? "click" : "change", () =>
  change("camera", { type: "camera", name: byId("camera").value }));
byId("copy-camera").addEventListener("click", () => {
  const text = JSON.stringify({ name: byId("camera").value, ...cameraWords() });
  byId("copy-camera").dataset.copied = text;
  // This older method of copying to the clipboard needs no permission.
  const area = Object.assign(document.createElement("textarea"), { value: text });
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  byId("copy-camera").focus();
  trouble(copied ? "The camera is in the clipboard." : `The camera as JSON: ${text}`, !copied, "good");
});
/// The field accepts a camera as JSON, as copied on this page or from a scene file, or a whole scene with a `camera`.
byId("paste-camera").addEventListener("change", () => {
  const input = byId("paste-camera");
  if (!input.value.trim()) return;
  try {
    const given = JSON.parse(input.value), camera = { ...(given.camera || given) };
    delete camera.name;
    change("camera", { type: "camera", camera });
    input.value = "";
  } catch (error) {
    trouble(`This is not JSON: ${error.message}`);
  }
});
connect();
