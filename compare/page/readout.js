// SPDX-License-Identifier: Apache-2.0
// Shows the values of the pixel under the pointer: V by every method, the error, and the visible light samples.

const digits = (value) => (Number.isNaN(value) ? "not evaluated" : String(+value.toFixed(6)).replace("-", "−"));
const signed = (value) => (value > 0 ? "+" : "") + digits(value);

let asked = 0;

async function showValues() {
  const mine = ++asked;
  delete viewer.dataset.read;
  const light = report.lights[state.light];
  find("viewer-caption").textContent = `V under light “${light.name}”, and V less the reference’s`;
  if (!state.pixel) {
    find("viewer-place").textContent = "Move over a picture, or press Shift with an arrow: here is what the pixel says.";
    find("viewer-values").replaceChildren();
    return;
  }
  const [x, y] = state.pixel, pixel = y * report.width + x;
  const entries = [...report.entries.keys()];
  const values = await Promise.all(entries.map(async (entry) => (await visibilityOf(entry, state.light))[pixel]));
  const masks = await Promise.all(entries.map((entry) => masksOf(entry, state.light)));
  const classes = await classesOf(state.light);
  if (mine !== asked) return;
  const kind = report.classNames[classes[pixel]];
  const own = values[state.a];
  find("viewer-place").textContent = `Pixel ${x}, ${y}: ${kind}. ${report.entries[state.a].label}: V ${digits(own)}`
    + (state.a > 0 ? `, error ${signed(own - values[0])}` : ", the reference");
  const background = classes[pixel] === 0;
  const points = (entry) => light[report.entries[entry].samples];
  const seen = entries.map((entry) => masks[entry] && seenSamples(masks[entry], pixel, points(entry).length));
  const rays = entries.find((entry) => report.entries[entry].judgesPairs && seen[entry]);
  find("viewer-values").replaceChildren(...entries.map((entry) => valuesRow({
    entry, v: values[entry], error: values[entry] - values[0], background, light,
    points: points(entry), seen: seen[entry],
    rays: rays !== undefined && entry !== rays && points(entry) === points(rays) ? seen[rays] : null })));
  viewer.dataset.read = `${x},${y}`;
}

function valuesRow({ entry, v, error, background, light, points, seen, rays }) {
  const row = document.createElement("tr");
  row.dataset.entry = entry;
  row.classList.toggle("shown", entry === state.a);
  const name = document.createElement("th");
  name.scope = "row";
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = report.entries[entry].label;
  button.setAttribute("aria-pressed", entry === state.a);
  button.addEventListener("click", () => {
    state.a = entry;
    update();
    find("viewer-values").querySelector(`[data-entry="${entry}"] button`)?.focus();
  });
  name.append(button);
  const cell = (text, value) => {
    const made = document.createElement("td");
    made.textContent = text;
    if (value !== undefined) made.dataset.value = value;
    return made;
  };
  const errorCell = entry === 0 ? cell("–") : cell(background ? "–" : signed(error), error);
  if (entry !== 0 && !background && !Number.isNaN(error)) {
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = `rgb(${errorColor(error, state.limit)})`;
    errorCell.prepend(swatch, " ");
  }
  const samples = cell(seen ? "" : "–");
  if (seen) {
    const others = rays ? seen.filter((visible, j) => visible !== rays[j]).length : 0;
    const picture = document.createElement("canvas");
    picture.width = picture.height = 144;
    picture.setAttribute("aria-hidden", "true");
    paintLight(picture, light, points, seen, rays);
    samples.dataset.seen = seen.map(Number).join("");
    samples.append(picture, `${seen.filter(Boolean).length} of ${seen.length} `);
    if (others) {
      const note = document.createElement("small");
      note.textContent = `${others} other than rays`;
      samples.append(note);
    }
  }
  row.append(name, cell(digits(v), v), errorCell, samples);
  return row;
}
