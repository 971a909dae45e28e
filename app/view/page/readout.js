// SPDX-License-Identifier: Apache-2.0
// Shows the values at a pixel, and the times of pictures.
let asking = null, wanted = null, pointed = null;
let typed = false;  // the pixel comes from the number fields, not from the pointer
const pixelFields = [byId("pixel-x"), byId("pixel-y")];
const frameTimes = [];

/// Requests a pixel's values. Only one request is sent at a time; of those waiting, the newest is kept.
function askPixel(x, y, then) {
  const place = { x: Math.min(Math.max(Math.floor(x * pictureSize[0]), 0), pictureSize[0] - 1), y: Math.min(Math.max(Math.floor(y * pictureSize[1]), 0), pictureSize[1] - 1), then };
  if (asking) {
    if (then || !(wanted && wanted.then)) wanted = place;  // a request with a callback is not replaced by one without
    return;
  }
  asking = place;
  post({ type: "pixel", x: place.x, y: place.y });
}
on("pixel", (pixel) => {
  const then = asking && asking.then;
  asking = null;
  if (then) then(pixel);
  else showPixel(pixel);
  if (wanted) {
    const { x, y, then: after } = wanted;
    wanted = null;
    askPixel((x + 0.5) / pictureSize[0], (y + 0.5) / pictureSize[1], after);
  }
});
on("lost", () => { asking = wanted = null; });
on("say", (message) => { if (message.level === "error") asking = null; });  // the pixel may no longer exist
on("pointed", (place) => {
  if (place.some((part) => part < 0 || part >= 1)) return;
  pointed = place;
  if (typed) tell("moved");  // removes the typed pixel's mark
  typed = false;
  if (!dragging) askPixel(...place);
});
on("frame", () => { if (pointed && !pointers.size) askPixel(...pointed); });

for (const field of pixelFields) field.addEventListener("change", () => {
  const numbers = pixelFields.map((one, i) => Math.min(Math.max(Math.floor(Number(one.value)), 0), pictureSize[i] - 1));
  pixelFields.forEach((one, i) => { one.value = numbers[i]; });
  pointed = numbers.map((number, i) => (number + 0.5) / pictureSize[i]);
  typed = true;
  askPixel(...pointed);
  askSpace();
  tell("moved");
});
byId("pivot").addEventListener("click", () => setPivot());

function showPixel(pixel) {
  const box = byId("readout"), lines = [`Pixel ${pixel.x}, ${pixel.y}${pixel.final ? "" : " (preview)"}${pixel.surface ? `: ${pixel.object}, triangle ${pixel.id}` : ": background"}`];
  for (const [i, answer] of (pixel.answers || []).entries()) {
    const of = Object.entries(answer.V).map(([light, v]) => `V ${light} = ${v.toPrecision(6)}`).join(", ");
    lines.push(`${pixel.answers.length > 1 ? "AB"[i] + ", " : ""}${answer.method}${answer.lightSamples ? `, ${answer.lightSamples} light samples` : ""}: ${of}`);
  }
  if (pixel.position) lines.push(`at ${pixel.position.map((value) => value.toFixed(4)).join(", ")}; depth ${pixel.depth.toFixed(4)}`);
  box.setAttribute("aria-live", typed && pixel.final ? "polite" : "off");  // silent under a moving pointer
  if (box.dataset.text !== lines.join()) box.replaceChildren(...lines.map((line) => Object.assign(document.createElement("p"), { textContent: line })));
  box.dataset.text = lines.join();
  box.dataset.pixel = `${pixel.x},${pixel.y}`;
  pixelFields.forEach((field, i) => {
    field.max = pictureSize[i] - 1;
    if (document.activeElement !== field) field.value = [pixel.x, pixel.y][i];
  });
  byId("pivot").disabled = !pixel.position;
  drawSeen(pixel.seen);
  drawOutline(pixel.outline, pixel);
}
/// Draws a cross over the pixel that was typed, since no pointer marks it.
function drawTypedPixel(drawing) {
  if (!typed) return;
  const [x, y] = stageSize().map((side, i) => pointed[i] * side), d = `M${x - 9},${y}h6m6,0h6M${x},${y - 9}v6m0,6v6`;
  for (const name of ["mark under", "mark"]) element("path", { d, class: name }, drawing);
}
/// Draws the light as seen from the pixel, and the triangles in front of it. Their red edges are drawn first, so that
/// only those that bound the visible part of the light remain uncovered.
function drawOutline(outline, pixel) {
  const sheet = byId("outline"), pen = sheet.getContext("2d"), middle = sheet.width / 2, reach = 0.9 * middle;
  sheet.hidden = !byId("show-seen").checked;
  pen.clearRect(0, 0, sheet.width, sheet.height);
  byId("outline-facts").textContent = "";
  if (!outline || sheet.hidden) return;
  const walk = (places) => {
    for (let i = 0; i < places.length; i += 2) pen.lineTo(middle + reach * places[i], middle - reach * places[i + 1]);
    pen.closePath();
  };
  const rim = () => {
    pen.beginPath();
    if (outline.rim === "circle") pen.arc(middle, middle, reach, 0, 2 * Math.PI);
    else walk(outline.rim === "square" ? [-1, -1, 1, -1, 1, 1, -1, 1] : outline.corners);
  };
  pen.save();
  rim();
  pen.fillStyle = "#ffd27a";
  pen.fill();
  pen.clip();
  pen.strokeStyle = "#d0472f";
  pen.lineWidth = 4;
  pen.lineJoin = "round";
  pen.beginPath();
  outline.blockers.forEach((places) => {
    pen.moveTo(middle + reach * places[0], middle - reach * places[1]);
    walk(places);
  });
  pen.stroke();
  pen.fillStyle = pen.strokeStyle = "#454a55";
  pen.lineWidth = 0.7;  // covers seams between neighbouring triangles
  for (const places of outline.blockers) {
    pen.beginPath();
    walk(places);
    pen.fill();
    pen.stroke();
  }
  pen.restore();
  rim();
  pen.strokeStyle = getComputedStyle(document.documentElement).color;
  pen.lineWidth = 1;
  pen.stroke();
  const before = `${outline.blockers.length}${outline.whole ? "" : " and more"} triangles in front of it`, v = pixel.answers[0].V[outline.light];
  byId("outline-facts").textContent = `${outline.light}: ${before}; edges that bound its visible part are red`;
  sheet.setAttribute("aria-label", `The outline of ${outline.light} as pixel ${pixel.x}, ${pixel.y} sees it: ${before}${v === undefined ? "" : `, V = ${v.toPrecision(6)}`}`);
  sheet.dataset.blockers = outline.blockers.length;
}
/// Draws the light's samples; those that are visible from the pixel are bright.
function drawSeen(seen) {
  const sheet = byId("seen"), pen = sheet.getContext("2d"), size = sheet.width;
  sheet.hidden = !byId("show-seen").checked;
  pen.clearRect(0, 0, size, size);
  if (!seen) return;
  const cell = 0.8 * size / Math.sqrt(seen.places.length);
  seen.places.forEach(([s, t], i) => {
    pen.fillStyle = seen.bits[i] === "1" ? "#ffd27a" : "#454a55";
    pen.fillRect((1 + s) / 2 * (size - cell), (1 - t) / 2 * (size - cell), cell, cell);
  });
  sheet.dataset.bits = seen.bits;
  sheet.setAttribute("aria-label", `${[...seen.bits].filter((bit) => bit === "1").length} of ${seen.bits.length} light samples of ${seen.light} are seen`);
}
byId("show-seen").addEventListener("change", () => {
  change("masks", { type: "masks", wanted: byId("show-seen").checked });
  byId("seen").hidden = byId("outline").hidden = !byId("show-seen").checked;
  if (!byId("show-seen").checked) byId("outline-facts").textContent = "";
  for (const after of [400, 1500]) setTimeout(() => { if (pointed) askPixel(...pointed); }, after);
});

const phases = ["load", "mesh", "view", "light", "evaluate", "beauty"];
/// Sets a text only if it differs, so that the browser does not lay out the page without need.
function say(element, text) { if (element.textContent !== text) element.textContent = text; }
/// Sets the texts of a table's rows. Cells are replaced only if the number of cells changes.
function showRows(section, rows, tag) {
  const cells = [...section.querySelectorAll("th, td")], texts = rows.flat();
  if (cells.length === texts.length && section.rows.length === rows.length) return cells.forEach((cell, i) => say(cell, texts[i]));
  section.replaceChildren(...rows.map((row) => {
    const line = document.createElement("tr");
    line.append(...row.map((text, i) => Object.assign(document.createElement(i ? tag : "th"), { textContent: text })));
    return line;
  }));
}
on("frame", (header) => {
  const two = header.answers.length > 1;
  showRows(byId("times").tHead, two ? [["", "A", "B"]] : [], "th");
  showRows(byId("times").tBodies[0], [...phases.map((phase) => [phase, ...header.answers.map((answer) => (1000 * (answer.seconds[phase] || 0)).toFixed(1))]),
    ["all", header.milliseconds.toFixed(1)].concat(two ? [""] : [])], "td");
  say(byId("size-facts"), `${header.triangles.toLocaleString("en")} triangles, ${header.edges === null ? "" : `${header.edges.toLocaleString("en")} edges, `}${header.width}\u00d7${header.height} pixels`);
  frameTimes.push({ at: performance.now(), ms: Number(document.documentElement.dataset.ms), final: header.final });
  if (frameTimes.length > 100) frameTimes.shift();
  drawPlot();
});
function drawPlot() {
  const sheet = byId("plot"), pen = sheet.getContext("2d"), most = Math.max(100, ...frameTimes.map((one) => Math.min(one.ms, 1000)));
  const style = getComputedStyle(document.documentElement), [final, quick, limit] = ["--accent", "--soft", "--bad"].map((name) => style.getPropertyValue(name));
  pen.clearRect(0, 0, sheet.width, sheet.height);
  const high = (ms) => sheet.height * (1 - Math.min(ms, most) / most);
  frameTimes.forEach((one, i) => {
    pen.fillStyle = one.final ? final : quick;
    pen.fillRect(i * 3, high(one.ms), 2, sheet.height - high(one.ms));
  });
  pen.fillStyle = limit;
  pen.fillRect(0, high(67), sheet.width, 1);
  const recent = frameTimes.filter((one) => one.at > performance.now() - 1000).length;
  byId("plot-facts").textContent = `${recent} pictures in the last second; from input to picture, up to ${Math.round(most)} ms; the line is 67 ms`;
}
