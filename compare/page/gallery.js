// SPDX-License-Identifier: Apache-2.0
// The pictures of the page: figures that open the viewer; their canvases are painted when they become visible.

// Old browsers can neither unpack the numbers nor show the viewer.
const canPaint = report.entries.length > 0 && typeof DecompressionStream === "function" && typeof HTMLDialogElement === "function";

const labelOf = ({ role, method }) => (role === "method" ? results[method].entry : role === "rays" ? raysLabel() : metrics.reference.method);
for (const entry of report.entries) entry.label = labelOf(entry) + (entry.role === "reference" ? " (reference)" : "");
// Returns an entry's error under a light; null for the reference.
const errorOf = ({ role, method }, light) =>
  (role === "reference" ? null : (role === "rays" ? metrics.sameSamples : results[method]).lights[light]?.error ?? null);

// Returns a figure; `what` is that of pictureOf().
function figureOf(what, note, name = labelOf(report.entries[what.entry])) {
  const alt = `${{ beauty: "Beauty", v: "V", error: "Signed error of V" }[what.layer]} by ${name}${note ? `: ${note}` : ""}`;
  return make("figure", {}, make("label", { class: "picture" },
    make("input", { type: "button", "aria-label": `Enlarge: ${alt}`, "data-layer": what.layer, "data-entry": what.entry, "data-light": what.light }),
    make("canvas", { width: report.width, height: report.height, role: "img", "aria-label": alt })),
  make("figcaption", {}, make("b", {}, name), note ? make("span", {}, note) : null));
}

function legendOf(label, ends, colors, ticks, note) {
  const swatch = make("span", { class: "swatch" });
  swatch.style.background = `rgb(${report.background})`;
  const bar = make("div", { class: "bar" });
  bar.style.background = `linear-gradient(to right, ${colors.map((color) => `rgb(${color})`).join(", ")})`;
  return [make("div", { class: "legend", role: "img", "aria-label": label }, make("div", { class: "ends" }, ends.map((end) => make("span", {}, end))), bar,
    make("div", { class: "ticks" }, ticks.map(([left, text]) => {
      const tick = make("span", {}, text);
      tick.style.left = `${left}%`;
      return tick;
    }))), make("p", { class: "note" }, note, swatch, " is background.")];
}

const visibilityLegend = () => legendOf("Grey scale of V: black is 0, the light is hidden; white is 1, the whole light is seen", ["light hidden", "light seen"],
  [[0, 0, 0], [255, 255, 255]], [0, 0.25, 0.5, 0.75, 1].map((v) => [100 * v, `${v}`]), "");

// Each tick is at the square root of its share of the limit, as the colours are: a quarter of the limit is half way.
function errorLegend() {
  const limit = report.errorLimit, text = errorText(limit);
  const places = Array.from({ length: 65 }, (_, i) => i / 32 - 1);
  return legendOf(`Scale of the error of V: red is too dark down to −${text}, white is right, blue is too bright up to +${text}`,
    ["◀ too dark", "right", "too bright ▶"], places.map((x) => errorColor(x * Math.abs(x) * limit, limit)),
    [-1, -0.25, -0.0625, 0, 0.0625, 0.25, 1].map((share) => [50 + 50 * Math.sign(share) * Math.sqrt(Math.abs(share)), signedText(share * limit)]),
    "V of the method less V of the reference. The colour deepens with the square root of the error, so that small errors show; what is further off than "
    + `±${text} has the deepest colour. `);
}

function showGallery() {
  const pictures = document.getElementById("pictures");
  if (!canPaint) {
    for (const element of pictures.querySelectorAll("p")) element.remove();
    pictures.append(make("p", {}, report.entries.length > 0 ? "This browser is too old to paint the pictures: look at the .exr and -error.png files beside this page."
      : "The page has no pictures."));
    return;
  }
  const figures = (layer, light, noteOf) => [...report.entries.keys()].filter((entry) => has(entry, layer))
    .map((entry) => figureOf({ layer, entry, light }, noteOf(report.entries[entry])));
  const part = (title, before, all) => (all.length === 0 ? [] : [make("h3", {}, title), ...before, make("div", { class: "gallery" }, all)]);
  const what = ({ role, method }) => (role === "reference" ? "the reference" : role === "rays" ? "on the methods’ light samples"
    : `${report.methods[method].family}, ${secondsText(shadowOf(results[method]))}`);
  const offBy = (light) => (entry) => {
    const error = errorOf(entry, light);
    return error ? `RMSE ${errorText(error.rmse)}, largest ${errorText(error.max)}` : "no judged pixel";
  };
  pictures.append(...part("Beauty", [make("p", {},
    `The shaded picture, by each method. All are exposed alike (linear colours × ${errorText(report.exposure)}).`)], figures("beauty", 0, what)),
  ...report.lights.flatMap((_, light) => [
    ...part(`V: how much of the light is seen${under(light)}`, light === 0 ? visibilityLegend() : [],
      figures("v", light, (entry) => (entry.role === "reference" ? "the reference" : ""))),
    ...part(`Where each method is wrong${under(light)}`, light === 0 ? errorLegend() : [], figures("error", light, offBy(light)))]));
}

// Shows the wipe at the top of the page: the largest error next to the smallest, or the only method and the reference.
function showFirstLook() {
  const judged = [...report.entries.keys()].filter((entry) => report.entries[entry].role === "method" && errorOf(report.entries[entry], 0));
  if (!canPaint || judged.length === 0) return;
  const rmse = (entry) => errorOf(report.entries[entry], 0).rmse;
  const worst = judged.reduce((a, b) => (rmse(b) > rmse(a) ? b : a)), best = judged.reduce((a, b) => (rmse(b) < rmse(a) ? b : a));
  const alone = worst === best, beside = alone ? 0 : best, look = document.getElementById("look");
  const name = (entry) => labelOf(report.entries[entry]);
  Object.assign(look.dataset, { left: worst, right: beside });
  filled(look.querySelector("canvas"), { width: report.width, height: report.height,
    "aria-label": `V${under(0)} by ${name(worst)} on the left of the line, by ${name(beside)} on the right` }, []);
  look.querySelector("h2").textContent = alone ? "The method and the reference" : "The worst and the best method";
  look.querySelector("p").append(`V, how much of the light each point sees${under(0)}: on the left of the line `, make("b", {}, name(worst)),
    `, RMSE ${errorText(rmse(worst))}; on the right `, make("b", {}, name(beside)), alone ? ", the reference." : `, RMSE ${errorText(rmse(best))}.`);
  look.hidden = false;
}
