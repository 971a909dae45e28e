// SPDX-License-Identifier: Apache-2.0
// Handles pointer, keys and controls of the viewer, and the page's links that open it.

function setPixel(pixel, hold) {
  state.held = hold && pixel !== null;
  state.pixel = pixel;
  update();
}

function listenToPointers() {
  const down = new Map();  // pressed pointers and their positions
  let moved = 0, wiping = false;
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return { x: (event.clientX - box.left) * devicePixelRatio, y: (event.clientY - box.top) * devicePixelRatio };
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    const at = place(event);
    down.set(event.pointerId, at);
    moved = 0;
    wiping = state.view === "wipe" && Math.abs(at.x - state.wipe * canvas.width) < 14 * devicePixelRatio;
  });
  canvas.addEventListener("pointermove", (event) => {
    const at = place(event), before = down.get(event.pointerId);
    if (!before) {
      const pixel = pixelAt(at.x, at.y);
      if (!state.held && pixel && String(pixel) !== String(state.pixel)) setPixel(pixel, false);
      return;
    }
    moved += Math.hypot(at.x - before.x, at.y - before.y);
    if (wiping) {
      state.wipe = at.x / canvas.width;
    } else if (down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)[1];
      const grown = Math.hypot(at.x - other.x, at.y - other.y) / Math.hypot(before.x - other.x, before.y - other.y);
      if (Number.isFinite(grown)) zoomTo(state.zoom * grown, pictureAt(other.x, other.y) ?? undefined);
    } else {
      const scale = scaleIn(panes()[0].box);
      state.x -= (at.x - before.x) / scale;
      state.y -= (at.y - before.y) / scale;
    }
    down.set(event.pointerId, at);
    update();
  });
  const up = (event) => {
    const at = down.get(event.pointerId);
    down.delete(event.pointerId);
    if (event.type === "pointerup" && at && !wiping && moved < 6 * devicePixelRatio) {
      const pixel = pixelAt(at.x, at.y);
      // A second click on the held pixel releases it.
      setPixel(pixel, !(state.held && String(pixel) === String(state.pixel)));
    }
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const at = place(event);
    zoomTo(state.zoom * 2 ** (-event.deltaY / 240), pictureAt(at.x, at.y) ?? undefined);
    update();
  }, { passive: false });
}

// Selects a neighbouring pixel, and scrolls so that it stays visible.
function step(x, y) {
  const [column, row] = state.pixel ?? [Math.floor(state.x), Math.floor(state.y)];
  setPixel(state.pixel ? [column + x, row + y] : [column, row], true);
  if (state.zoom > 1) {
    const { box } = panes()[0], scale = scaleIn(box);
    const wide = box.width / scale / 2 - 1, high = box.height / scale / 2 - 1;
    state.x = clamp(state.x, state.pixel[0] - wide, state.pixel[0] + wide);
    state.y = clamp(state.y, state.pixel[1] - high, state.pixel[1] + high);
    update();
  }
}

const flip = (by) => () => { state.a = next(entriesWith(state.layer), state.a, by); };
const layer = (by) => () => { state.layer = next(kLayers.filter((l) => entriesWith(l).length > 0), state.layer, by); };
const toggle = (view) => () => { state.view = state.view === view ? "one" : view; };
const swap = () => {
  [state.a, state.b] = [state.b, state.a];
  if (state.bLayer) [state.layer, state.bLayer] = [state.bLayer, state.layer];
};
// Changes the exposure of the beauty, or the scale of errors.
const brighter = (by) => () => {
  if (state.layer === "beauty") state.stops += 0.5 * by;
  else state.limit = kLimits[clamp(kLimits.indexOf(state.limit) - by, 0, kLimits.length - 1)];
};
const kKeys = {
  ArrowLeft: flip(-1), ArrowRight: flip(1), ArrowUp: layer(-1), ArrowDown: layer(1), " ": swap,
  w: toggle("wipe"), g: toggle("all"), "[": () => { state.wipe -= 0.05; }, "]": () => { state.wipe += 0.05; },
  l: () => { state.light = (state.light + 1) % report.lights.length; },
  "+": () => zoomTo(2 * state.zoom), "=": () => zoomTo(2 * state.zoom), "-": () => zoomTo(state.zoom / 2),
  0: () => zoomTo(1), ",": brighter(-1), ".": brighter(1),
};
const kSteps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function onKey(event) {
  // A control that has the focus keeps its own keys: a list all keys, a slider and a choice the arrows.
  const own = event.target.tagName;
  if (own === "SELECT" || event.altKey || event.metaKey) return;
  if (event.shiftKey && kSteps[event.key] && own !== "INPUT") {
    const far = event.ctrlKey ? 10 : 1;
    step(...kSteps[event.key].map((d) => d * far));
  } else if (!event.ctrlKey && kKeys[event.key]) {
    if (own !== "DIV" && (event.key === " " || (own === "INPUT" && event.key.startsWith("Arrow")))) return;
    kKeys[event.key]();
    update();
  } else {
    return;
  }
  event.preventDefault();
}

function listenToControls() {
  const on = (id, event, change) => find(id).addEventListener(event, () => { change(find(id).value); update(); });
  for (const radio of viewer.querySelectorAll("input[type=radio]")) {
    radio.addEventListener("change", () => { state[radio.name] = radio.value; update(); });
  }
  on("viewer-light", "change", (value) => { state.light = Number(value); });
  on("viewer-a", "change", (value) => { state.a = Number(value); });
  on("viewer-b", "change", (value) => { [state.bLayer, state.b] = [value.split(":")[0], Number(value.split(":")[1])]; });
  on("viewer-wipe", "input", (value) => { state.wipe = value / 100; });
  on("viewer-stops", "input", (value) => { state.stops = Number(value); });
  on("viewer-limit", "change", (value) => { state.limit = Number(value); });
  on("viewer-out", "click", () => zoomTo(state.zoom / 2));
  on("viewer-in", "click", () => zoomTo(2 * state.zoom));
  on("viewer-whole", "click", () => zoomTo(1));
  find("viewer-close").addEventListener("click", () => viewer.close());
  viewer.addEventListener("keydown", onKey);
  viewer.addEventListener("close", () => history.replaceState(null, "", "#pictures"));
  new ResizeObserver(() => viewer.open && draw()).observe(stage);
}

// Each picture is a button that opens the viewer with this picture.
function openFromPage() {
  for (const box of document.querySelectorAll("input[data-entry]")) {
    box.addEventListener("click", () => open({
      layer: box.dataset.layer, light: Number(box.dataset.light), a: Number(box.dataset.entry), view: "one" }));
  }
  for (const button of document.querySelectorAll("#pictures [data-open]")) {
    button.addEventListener("click", () => open({ view: button.dataset.open, a: 1, b: 0, bLayer: "" }));
  }
}

showAbout();
showFirstLook();
showNumbers();
showGallery();
showLive();
addEventListener("hashchange", unfold);
unfold();

if (canPaint) {
  listenToPointers();
  listenToControls();
  openFromPage();
  paintWhenSeen();
  lookFirst();
  if (readAddress()) open();
  addEventListener("hashchange", () => readAddress() && open());
}
