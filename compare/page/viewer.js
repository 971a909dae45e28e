// SPDX-License-Identifier: Apache-2.0
// The viewer: one picture, two with a wipe between them, or all at once, with one zoom for all. All settings are in
// `state`: every control and key changes it and calls update(). The page's address contains it (#look?…), so that it
// can be used as a link.

const find = (id) => document.getElementById(id);
const viewer = find("viewer"), stage = find("viewer-stage"), canvas = stage.querySelector("canvas");
const kLayers = ["beauty", "v", "error"], kLayerNames = { beauty: "Beauty", v: "V", error: "Error" };
const kLimits = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1];
const kMostZoom = 64;

const state = {
  layer: "v", light: 0, view: "one",
  a: 0, b: 0, bLayer: "",  // indices of entries; bLayer: layer of b, empty: that of a
  wipe: 0.5, stops: 0, limit: report.errorLimit,
  zoom: 1, x: report.width / 2, y: report.height / 2,  // x, y: pixel in the middle of the view
  pixel: null, held: false,  // shown [column, row]; held: chosen by a click, not changed by moving the pointer
};

const has = (entry, layer) => (layer === "beauty" ? report.entries[entry].beauty !== null
  : layer === "error" ? entry !== 0 : true);
const entriesWith = (layer) => [...report.entries.keys()].filter((entry) => has(entry, layer));
const pictureName = (entry, layer) => `${kLayerNames[layer]}: ${report.entries[entry].label}`;
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

function next(list, current, step) {
  const at = list.indexOf(current);
  return list[(at + step + list.length) % list.length];
}

// --- Positions on the canvas ------------------------------------------------------------------------------------------

// Returns the boxes on the canvas, in canvas pixels, each with its picture and its visible columns `from` … `to`.
function panes() {
  const { width, height } = canvas;
  const whole = { x: 0, y: 0, width, height };
  if (state.view === "one") return [{ entry: state.a, layer: state.layer, box: whole, from: 0, to: width }];
  if (state.view === "wipe") {
    const split = state.wipe * width;
    return [{ entry: state.a, layer: state.layer, box: whole, from: 0, to: split },
      { entry: state.b, layer: state.bLayer || state.layer, box: whole, from: split, to: width }];
  }
  const entries = entriesWith(state.layer);
  let best = { scale: 0, columns: 1 };
  const most = Math.max(1, Math.floor(width / (130 * devicePixelRatio)));  // room for a name in each column
  for (let columns = 1; columns <= Math.min(most, entries.length); ++columns) {
    const scale = Math.min(width / columns / report.width, height / Math.ceil(entries.length / columns) / report.height);
    if (scale > best.scale) best = { scale, columns };
  }
  const rows = Math.ceil(entries.length / best.columns), gap = 2 * devicePixelRatio;
  return entries.map((entry, i) => {
    const x = (i % best.columns) * width / best.columns, y = Math.floor(i / best.columns) * height / rows;
    const box = { x, y, width: width / best.columns - gap, height: height / rows - gap };
    return { entry, layer: state.layer, box, from: x, to: x + box.width };
  });
}

// Returns the size of a picture's pixel in canvas pixels: at zoom 1 the whole picture just fits.
const scaleIn = (box) => state.zoom * Math.min(box.width / report.width, box.height / report.height);

// Returns the picture's coordinates at a point of the canvas, as fractions of pixels; null outside all pictures.
function pictureAt(x, y) {
  const pane = panes().find((p) => x >= p.from && x < p.to && y >= p.box.y && y < p.box.y + p.box.height);
  if (!pane) return null;
  const scale = scaleIn(pane.box);
  return { pane, scale,
    x: state.x + (x - pane.box.x - pane.box.width / 2) / scale,
    y: state.y + (y - pane.box.y - pane.box.height / 2) / scale };
}

function pixelAt(x, y) {
  const at = pictureAt(x, y);
  const inside = at && at.x >= 0 && at.y >= 0 && at.x < report.width && at.y < report.height;
  return inside ? [Math.floor(at.x), Math.floor(at.y)] : null;
}

// Zooms so that the point `fixed` (from pictureAt) stays in place.
function zoomTo(zoom, fixed = { x: state.x, y: state.y }) {
  const before = state.zoom;
  state.zoom = clamp(zoom, 1, kMostZoom);
  state.x = fixed.x + (state.x - fixed.x) * before / state.zoom;
  state.y = fixed.y + (state.y - fixed.y) * before / state.zoom;
}

// --- Drawing ----------------------------------------------------------------------------------------------------------

let turn = 0;

async function draw() {
  const mine = ++turn;
  delete viewer.dataset.drawn;
  canvas.width = Math.round(stage.clientWidth * devicePixelRatio);
  canvas.height = Math.round(stage.clientHeight * devicePixelRatio);
  const shown = panes();
  const pictures = await Promise.all(shown.map(({ entry, layer }) => pictureOf({ layer, entry, light: state.light }, state)));
  if (mine !== turn) return;  // another call of draw() has begun since
  const context = canvas.getContext("2d");
  context.clearRect(0, 0, canvas.width, canvas.height);
  shown.forEach((pane, i) => drawPane(context, pane, pictures[i]));
  if (state.view === "wipe") {
    context.fillStyle = "#ffd45e";
    context.fillRect(state.wipe * canvas.width - devicePixelRatio, 0, 2 * devicePixelRatio, canvas.height);
  }
  viewer.dataset.drawn = `${mine}`;
}

function drawPane(context, { entry, layer, box, from, to }, picture) {
  const scale = scaleIn(box);
  const left = box.x + box.width / 2 - state.x * scale, top = box.y + box.height / 2 - state.y * scale;
  context.save();
  context.beginPath();
  context.rect(from, box.y, to - from, box.height);
  context.clip();
  context.imageSmoothingEnabled = scale < 1;
  context.drawImage(picture, left, top, report.width * scale, report.height * scale);
  if (state.pixel) {
    const [x, y] = state.pixel, size = Math.max(scale, 7 * devicePixelRatio), grow = (size - scale) / 2;
    context.lineWidth = 3 * devicePixelRatio;
    for (const color of ["#000", "#fff"]) {
      context.strokeStyle = color;
      context.strokeRect(left + x * scale - grow, top + y * scale - grow, size, size);
      context.lineWidth = devicePixelRatio;
    }
  }
  if (state.view !== "one") {
    context.font = `${14 * devicePixelRatio}px system-ui, sans-serif`;
    const text = layer === state.layer ? report.entries[entry].label : pictureName(entry, layer);
    const wide = context.measureText(text).width + 12 * devicePixelRatio, high = 22 * devicePixelRatio;
    const x = state.view === "wipe" && from > 0 ? Math.max(from, to - wide) : from;
    context.fillStyle = "#000a";
    context.fillRect(x, box.y, wide, high);
    context.fillStyle = "#fff";
    context.fillText(text, x + 6 * devicePixelRatio, box.y + 15.5 * devicePixelRatio);
  }
  context.restore();
}

// --- Writing the state to the controls and to the address -------------------------------------------------------------

function fill(select, options, value) {
  select.replaceChildren(...options.map(([key, text]) => new Option(text, key, false, key === value)));
}

function showControls() {
  for (const radio of viewer.querySelectorAll("input[type=radio]")) radio.checked = state[radio.name] === radio.value;
  fill(find("viewer-a"), entriesWith(state.layer).map((entry) => [`${entry}`, report.entries[entry].label]), `${state.a}`);
  const beside = [["", state.layer]].concat(kLayers.filter((l) => l !== state.layer).map((l) => [l, l]));
  fill(find("viewer-b"), beside.flatMap(([key, layer]) => entriesWith(layer).map((entry) =>
    [`${key}:${entry}`, key ? pictureName(entry, layer) : report.entries[entry].label])), `${state.bLayer}:${state.b}`);
  fill(find("viewer-light"), report.lights.map((light, i) => [`${i}`, light.name]), `${state.light}`);
  find("viewer-light").parentElement.hidden = report.lights.length < 2;
  fill(find("viewer-limit"), kLimits.map((limit) => [`${limit}`, `${limit}`]), `${state.limit}`);
  find("viewer-wipe").value = Math.round(100 * state.wipe);
  find("viewer-stops").value = state.stops;
  find("viewer-stops-text").value = `${state.stops > 0 ? "+" : ""}${state.stops} EV`;
  find("viewer-zoom-text").value = `${Math.round(100 * state.zoom)} %`;
  const layers = [state.layer, ...(state.view === "wipe" ? [state.bLayer || state.layer] : [])];
  for (const element of viewer.querySelectorAll(".for-beauty")) element.hidden = !layers.includes("beauty");
  for (const element of viewer.querySelectorAll(".for-error")) element.hidden = !layers.includes("error");
  for (const element of viewer.querySelectorAll(".for-wipe")) element.hidden = state.view !== "wipe";
  const name = pictureName(state.a, state.layer);
  const title = state.view === "one" ? name : state.view === "all" ? `${kLayerNames[state.layer]}: all`
    : `${name} | ${pictureName(state.b, state.bLayer || state.layer)}`;
  find("viewer-title").textContent = title;
  stage.setAttribute("aria-label", title);
}

// Writes and reads the settings of a link to this view.
const kKept = { layer: String, light: Number, view: String, a: Number, b: Number, bLayer: String, wipe: Number,
  stops: Number, limit: Number, zoom: Number, x: Number, y: Number };

function writeAddress() {
  const words = new URLSearchParams();
  for (const key of Object.keys(kKept)) words.set(key, typeof state[key] === "number" ? +state[key].toFixed(4) : state[key]);
  if (state.pixel) words.set("pixel", state.pixel.join(","));
  history.replaceState(null, "", `#look?${words}`);
}

// An address may contain anything: update() replaces values that are not valid for this report.
function readAddress() {
  if (!location.hash.startsWith("#look")) return false;
  for (const [key, value] of new URLSearchParams(location.hash.slice(6))) {
    if (key === "pixel") {
      const pixel = value.split(",").map(Number);
      state.pixel = pixel.length === 2 && pixel.every(Number.isInteger) ? pixel : null;
      state.held = state.pixel !== null;
    } else if (kKept[key] === String || Number.isFinite(Number(value))) {
      if (key in kKept) state[key] = kKept[key](value);
    }
  }
  return true;
}

function repair() {
  if (!kLayers.includes(state.layer) || entriesWith(state.layer).length === 0) state.layer = "v";
  if (!["one", "wipe", "all"].includes(state.view)) state.view = "one";
  if (!kLayers.includes(state.bLayer) || state.bLayer === state.layer) state.bLayer = "";
  if (!report.lights[state.light]) state.light = 0;
  if (!entriesWith(state.layer).includes(state.a)) state.a = entriesWith(state.layer)[0];
  const beside = entriesWith(state.bLayer || state.layer);
  if (state.view === "wipe" && !beside.includes(state.b)) state.b = beside[0];
  if (!(state.limit > 0)) state.limit = report.errorLimit;
  state.wipe = clamp(state.wipe, 0, 1);
  state.stops = clamp(state.stops, -8, 12);
  state.zoom = clamp(state.zoom, 1, kMostZoom);
  state.x = state.zoom === 1 ? report.width / 2 : clamp(state.x, 0, report.width);
  state.y = state.zoom === 1 ? report.height / 2 : clamp(state.y, 0, report.height);
  if (state.pixel) {
    const [x, y] = state.pixel;
    state.pixel = [clamp(x, 0, report.width - 1), clamp(y, 0, report.height - 1)];
  }
}

let addressTimer = 0;

function update() {
  repair();
  showControls();
  draw();
  showValues();
  clearTimeout(addressTimer);  // browsers reject hundreds of changes per second
  addressTimer = setTimeout(() => viewer.open && writeAddress(), 200);
}

function open(change = {}) {
  Object.assign(state, change);
  if (!viewer.open) viewer.showModal();
  update();
}
