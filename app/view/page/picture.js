// SPDX-License-Identifier: Apache-2.0
// Draws the picture on a canvas with the size of the final picture: one answer, or two by wipe, flip or side by side.
let shown = null;  // the frame's header, and its bitmaps by their contents (a, b, difference …)
const canvas = byId("picture"), overlay = byId("overlay");
let flipped = false;       // whether `flip` shows B
/// Returns how the answers are shown: both (wipe, side), or one (a, b).
function mode() {
  if (!shown || !shown.by.a || !shown.by.b) return "a";
  const how = byId("compare").value;
  return how === "flip" ? (flipped ? "b" : "a") : how;
}

function draw() {
  if (!shown) return;
  const { header, by } = shown, how = mode(), [width, height] = [header.width, header.height];
  const wide = how === "side" ? 2 * width : width, isAnother = canvas.width !== wide || canvas.height !== height;
  if (isAnother) {
    canvas.width = wide;
    canvas.height = height;
  }
  const pen = canvas.getContext("2d"), one = by.a || by.difference || by.all;
  pen.imageSmoothingEnabled = !header.final;
  if (how === "side") {
    pen.drawImage(by.a, 0, 0, width, height);
    pen.drawImage(by.b, width, 0, width, height);
  } else if (how === "wipe") {
    const at = Math.round(width * byId("wipe").value / 100);
    pen.drawImage(by.b, 0, 0, width, height);
    pen.save();
    pen.beginPath();
    pen.rect(0, 0, at, height);
    pen.clip();
    pen.drawImage(by.a, 0, 0, width, height);
    pen.restore();
    pen.fillStyle = "#fff";
    pen.fillRect(at - 0.5, 0, 1, height);
  } else {
    pen.drawImage(how === "b" ? by.b : one, 0, 0, width, height);
  }
  if (isAnother) fit();
}

/// Makes the canvas as large as the stage and its shape allow. canvasSize keeps the size, since reading it from the
/// browser would lay out the page.
let canvasSize = [canvas.width, canvas.height];
function fit() {
  const room = byId("frame").getBoundingClientRect(), scale = Math.min(room.width / canvas.width, room.height / canvas.height);
  const width = canvas.width * scale, height = canvas.height * scale;
  canvasSize = [width, height];
  for (const element of [canvas, overlay]) {
    Object.assign(element.style, { width: `${width}px`, height: `${height}px`, left: `${(room.width - width) / 2}px`, top: `${(room.height - height) / 2}px` });
  }
  tell("moved");
}

/// Returns the width and height of one answer's picture in the page.
function stageSize() {
  return [mode() === "side" ? canvasSize[0] / 2 : canvasSize[0], canvasSize[1]];
}

/// Returns the pointer's position in the picture of the answer that it is over, from 0 to 1 along each axis. canvasBox
/// is not read again during a drag, since the canvas does not move.
let canvasBox = null;
function placeOf(event) {
  if (!canvasBox || (!dragging && !held)) canvasBox = canvas.getBoundingClientRect();
  const box = canvasBox, [width, height] = stageSize();
  let x = (event.clientX - box.left) / width;
  if (x >= 1 && mode() === "side") x -= 1;
  return [x, (event.clientY - box.top) / height];
}

const answerWords = (answer) => answer.method + (answer.lightSamples ? `, ${answer.lightSamples} light samples` : "");

/// Labels the answers, and shows the controls for the current kind of comparison.
function nameShown() {
  const two = shown && shown.header.answers.length > 1 && shown.by.b, answers = shown ? shown.header.answers : [];
  byId("label-a").textContent = two && mode() !== "b" ? "A: " + answerWords(answers[0]) : "";
  byId("label-b").textContent = two && mode() !== "a" ? "B: " + answerWords(answers[1]) : "";
  byId("wipe-row").hidden = mode() !== "wipe";
  byId("flip").hidden = !two || byId("compare").value !== "flip";
  byId("flip").textContent = flipped ? "Flip to A" : "Flip to B";
}
function flip() {
  if (byId("flip").hidden) return;
  flipped = !flipped;
  draw();
  nameShown();
}

/// Returns whether the error is requested although there is only one method, so that there is nothing to compare with.
const isErrorWithoutB = () => byId("channel").value === "error" && shown.header.answers.length < 2;

/// Shows the scale of the error picture. Colours deepen with the square root of the error: a quarter of the limit is
/// half way along the scale.
let errorColors = [];
function showErrorScale({ limit }) {
  byId("error-scale").hidden = !shown.by.difference;
  if (!shown.by.difference) return;
  const words = (share) => `${share < 0 ? "\u2212" : share > 0 ? "+" : ""}${Number(Math.abs(share * limit).toPrecision(4))}`;
  byId("error-bar").style.background = `linear-gradient(to right, ${errorColors.map((color) => `rgb(${color})`).join(", ")})`;
  byId("error-bar").setAttribute("aria-label", `Scale of V of A less V of B: red down to ${words(-1)}, white 0, blue up to ${words(1)}`);
  byId("error-ticks").replaceChildren(...[-1, -0.25, 0, 0.25, 1].map((share) => Object.assign(document.createElement("span"), { textContent: words(share) })));
  byId("limit").placeholder = limit;
}

on("frame", (header, images) => {
  if (shown) for (const image of Object.values(shown.by)) image.close();
  shown = { header, by: Object.fromEntries(images.map((image, i) => [header.images[i].shows, image])) };
  pictureSize = [header.width, header.height];
  draw();
  const root = document.documentElement.dataset, stamp = header.stamps[clientId];
  root.frame = String(Number(root.frame || 0) + 1);
  root.exact = String(header.final && !(sentStamp > (stamp ?? 0)));
  root.stamp = String(stamp ?? "");
  root.ms = (stamp === undefined ? header.milliseconds : performance.now() - stamp).toFixed(1);
  root.method = header.answers.map((answer) => answer.method).join(" | ");
  const reduced = header.images[0].width < header.width ? `, ${header.images[0].width}\u00d7${header.images[0].height}` : "";
  byId("shown").textContent = `${answerWords(header.answers[0])}${header.answers[1] ? " | " + answerWords(header.answers[1]) : ""}: ` +
    `${header.final ? "final" : "preview" + reduced}, ${Math.round(root.ms)} ms`;
  nameShown();
  showErrorScale(header);
  byId("difference").textContent = isErrorWithoutB() ? "There is no B: V of A is shown. The error of A against B needs a method for B." : header.difference
    ? `V of A \u2212 B: RMSE ${header.difference.rmse.toFixed(5)}, bias ${header.difference.bias.toFixed(5)}, largest ${header.difference.largest.toFixed(3)}; ` +
      `shadow ${header.answers.map((answer) => answer.milliseconds.toFixed(1)).join(" and ")} ms` : "";
  byId("stops").dataset.stops = header.stops;
  if (byId("auto-stops").checked && document.activeElement !== byId("stops")) byId("stops").value = header.stops.toFixed(2);
});
byId("wipe").addEventListener("input", draw);
byId("compare").addEventListener("change", () => { draw(); nameShown(); });
byId("flip").addEventListener("click", flip);
new ResizeObserver(fit).observe(byId("frame"));
