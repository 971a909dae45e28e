// SPDX-License-Identifier: Apache-2.0
// Plots RMSE of V against seconds for the shadow, both axes logarithmic; marks without error are on a separate line.

const kNoError = 2 ** -25;  // half of the last digit of V, a float
const kPlot = { left: 64, right: 660, top: 16, bottom: 372, width: 860, height: 420 };

// Returns the whole powers of ten around all values except 0.
function decadesOf(values) {
  const known = values.filter((value) => value >= kNoError).map(Math.log10);
  const first = known.length > 0 ? Math.floor(Math.min(...known)) : 0;
  const last = Math.max(first + 1, known.length > 0 ? Math.ceil(Math.max(...known)) : 1);
  return { all: Array.from({ length: last - first + 1 }, (_, i) => first + i), share: (value) => (Math.log10(value) - first) / (last - first) };
}

const at = (number) => number.toFixed(1);
const plotText = (x, y, text, values = {}) => drawn("text", { x: at(x), y: at(y), ...values }, text);

function plotMark({ family, title, x, y }) {
  const shape = family === "geometry" ? drawn("circle", { class: family, cx: at(x), cy: at(y), r: 5.5 })
    : family === "image" ? drawn("rect", { class: family, x: at(x - 5), y: at(y - 5), width: 10, height: 10 })
      : drawn("path", { class: "reference", d: `M${at(x)} ${at(y - 6)}l6 6-6 6-6-6z` });
  return drawn("g", { class: "mark" }, shape, drawn("title", {}, title));
}

// Places names to the right of their marks, or to the left if there is no room, and moves them up or down if another
// text is already there. `taken`: other texts as {x, end, y}.
function plotNames(marks, taken) {
  const line = 15, boxes = [...taken, ...marks.map(({ x, y }) => ({ x: x - 7, end: x + 7, y }))];
  const isFree = (box) => box.y > kPlot.top + 4 && box.y < kPlot.bottom + 4
    && boxes.every((other) => box.x >= other.end || other.x >= box.end || Math.abs(box.y - other.y) >= line - 1);
  return [...marks].sort((a, b) => a.y - b.y || a.x - b.x).flatMap(({ name, x, y }) => {
    const width = 7 * name.length, isLeft = x + 10 + width > kPlot.width;
    const box = isLeft ? { x: x - 10 - width, end: x - 10, y } : { x: x + 10, end: x + 10 + width, y };
    for (let shift = 0; shift < 20 * line; shift += line / 3) {
      const free = [y - shift, y + shift].find((place) => isFree({ ...box, y: place }));
      box.y = free ?? y + shift;
      if (free !== undefined) break;
    }
    boxes.push(box);
    const leader = Math.abs(box.y - y) > 6
      ? [drawn("path", { class: "leader", d: `M${at(x)} ${at(y)}L${at(isLeft ? box.end + 1 : box.x - 1)} ${at(box.y)}` })] : [];
    return [...leader, plotText(isLeft ? box.end : box.x, box.y + 4, name, { class: "name", "text-anchor": isLeft ? "end" : null })];
  });
}

function errorPlot() {
  const marks = results.flatMap((result, i) => {
    const rmse = rmseOf(result), seconds = shadowOf(result);
    if (rmse === null || !(seconds > 0)) return [];
    return [{ name: result.entry, family: report.methods[i].family, rmse, seconds,
      title: `${result.entry}: RMSE ${errorText(rmse)}, ${secondsText(seconds)}` }];
  });
  if (marks.length === 0) return [];
  const level = metrics.sameSamples?.errorAllLights?.rmse ?? 0, { left, right, top, bottom, width, height } = kPlot;
  const across = decadesOf(marks.map((mark) => mark.seconds)), along = decadesOf([...marks.map((mark) => mark.rmse), level]);
  const hasZero = marks.some((mark) => mark.rmse < kNoError);
  const base = hasZero ? bottom - 34 : bottom;
  const xOf = (seconds) => left + (right - left) * across.share(seconds);
  const yOf = (rmse) => (rmse < kNoError ? bottom - 12 : base - (base - top) * along.share(rmse));
  const row = (y, text) => [drawn("path", { class: "grid", d: `M${left} ${at(y)}H${right}` }),
    plotText(left - 8, y + 4, text, { class: "axis", "text-anchor": "end" })];
  const middle = { class: "axis", "text-anchor": "middle" };
  const svg = drawn("svg", { class: "plot", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "Error of V against time, one mark a method; the tables "
    + "below have the numbers" },
  across.all.flatMap((decade) => {
    const x = xOf(10 ** decade);
    return [drawn("path", { class: "grid", d: `M${at(x)} ${top}V${bottom}` }), plotText(x, bottom + 18, secondsText(10 ** decade), middle)];
  }),
  along.all.flatMap((decade) => row(yOf(10 ** decade), decade < -4 ? `1e${decade}` : (10 ** decade).toFixed(Math.max(0, -decade)))),
  hasZero ? row(bottom - 12, "0") : [],
  drawn("path", { class: "frame", d: `M${left} ${top}V${bottom}H${right}` }),
  plotText((left + right) / 2, bottom + 40, `seconds for the shadow${several ? " of all lights" : ""}`, middle),
  drawn("text", { ...middle, transform: `translate(14 ${(top + bottom) / 2}) rotate(-90)` }, "RMSE of V"));
  const taken = [];
  if (level >= kNoError) {
    const y = yOf(level);
    taken.push({ x: right + 6, end: width, y });
    svg.append(drawn("path", { class: "cost", d: `M${left} ${at(y)}H${right}` }),
      plotText(right + 6, y + 4, `what ${metrics.sameSamples.lightSamples} light samples cost`, { class: "axis" }));
  }
  for (const mark of marks) Object.assign(mark, { x: xOf(mark.seconds), y: yOf(mark.rmse) });
  svg.append(...marks.map(plotMark), ...plotNames(marks, taken));
  return [make("h3", {}, "Error against time"), make("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Error against time" }, svg),
    folded("How to read the plot", make("p", { class: "note" }, "Further down is closer to the reference, further left is faster; both scales step by tens. "
      + "Circles are geometry-based methods, squares image-based ones, diamonds references.", level < kNoError ? "" : " The dashed line is how far rays on the "
      + `methods’ own ${metrics.sameSamples.lightSamples} light samples are from the reference: a method with a mask can be as exact as can be and yet come no `
      + "lower, and it is no fault of its own."))];
}
