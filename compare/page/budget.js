// SPDX-License-Identifier: Apache-2.0
// Shows the causes of each method's error: the error without one cause alone, and without all (docs/error-budget.md).

const kCauses = ["resolution", "view", "layers", "fusion", "gaps", "bias", "samples", "falloff"];
const kAllButView = "all but the view", kAllAtOnce = "all at once";

function budgetBar(from, x, width, kind) {
  return drawn("svg", { class: "plot bar-of-budget", viewBox: "0 0 80 10", "aria-hidden": "true" },
    drawn("path", { class: "frame", d: `M${from} 0V10` }),
    drawn("rect", { class: kind, x: x.toFixed(1), y: 2, width: width.toFixed(1), height: 6 }));
}
// Draws a change of the error: to the left of the middle if it becomes smaller; the largest change has the length 38.
function changeBar(change, largest) {
  const length = largest > 0 ? 38 * Math.abs(change) / largest : 0;
  return budgetBar(40, change < 0 ? 40 - length : 40, length, change < 0 ? "better" : "worse");
}
const rmseBar = (rmse, largest) => budgetBar(1, 1, largest > 0 ? 78 * rmse / largest : 0, "worse");

function causesTable(light, explained, largest) {
  return tableOf(`Why each method is wrong${under(light)}: by how much its RMSE of V changes when one cause alone is repaired `
    + "(negative: the error shrinks), and what is left of it when all are.",
  ["Method", "RMSE as it is", ...kCauses, "remainder"],
  explained.map((result) => {
    const { errorBudget: budget, errorBudgetRuns: runs } = result.lights[light];
    const withBar = (value, textOf, bar) => (value === null ? kNotThere : { text: textOf(value), value, picture: bar(value) });
    const error = (value) => withBar(value, errorText, (rmse) => rmseBar(rmse, largest.error));
    return [result.entry, error(runs.rmse),
      ...kCauses.map((cause) => withBar(budget[cause] ?? null, signedText, (change) => changeBar(change, largest.change))), error(budget.remainder)];
  }));
}

function runWords(run) {
  const parts = run.lightParts > 1 ? `, each of ${run.lightParts} × ${run.lightParts} parts of the light` : "";
  const samples = run.lightSamples > 0 ? `, ${run.lightSamples} light samples${run.lightParts > 1 ? " a part" : ""}` : "";
  const options = Object.entries(run.options).map(([key, value]) => `:${key}=${value}`).join("");
  return `${run.method}${options}${parts}${samples}: ${run.rmse === null ? `failed: ${run.failure}` : `RMSE ${errorText(run.rmse)}`}`;
}

function runsTable(name, runs) {
  const row = (what, how, rmse, made) => {
    const actsOn = made.map((run) => run.actsOn).filter((share) => share !== null && share !== undefined).pop();
    return [what, how, errorCell(rmse), numberCell(actsOn, percentText), made.map(runWords).join("; ") || "none"];
  };
  const rows = kCauses.filter((cause) => runs[cause]).map((cause) => {
    const { words, rmse, reached, runs: made } = runs[cause];
    return row(cause, words + (reached === false ? "; the runs have not converged: this is the value of the last one" : ""), rmse, made);
  });
  if (runs.allButView) rows.push(row(kAllButView, "all of the others that can be combined", runs.allButView.rmse, [runs.allButView]));
  rows.push(row(kAllAtOnce, "all of the above that can be combined", runs.together.rmse, [runs.together]));
  return tableOf(`What was run for ${name}`, ["Repaired", "How, or why not", "RMSE without it", "Pixels that it changes", "Runs"], rows);
}

// Shows where a repair changes V, in pictures that can be enlarged to the size of the window.
function repairPictures(name, pictures, { errorBudget: budget, errorBudgetRuns: runs }) {
  if (pictures.length === 0) return [];
  const figures = pictures.map(({ repaired, png }) => {
    const atOnce = repaired === kAllButView && runs.allButView ? runs.allButView.rmse : runs.together.rmse;
    const change = budget[repaired] ?? (atOnce === null ? null : atOnce - runs.rmse);
    const caption = change === null ? "" : `RMSE ${signedText(change)}`;
    const alt = `By how much V of ${name} changes with ${repaired} repaired: ${caption}`;
    return make("figure", {}, make("label", { class: "picture" }, make("input", { type: "checkbox", "aria-label": `Enlarge: ${alt}` }),
      make("img", { alt, src: png, width: report.width, height: report.height })), make("figcaption", {}, make("b", {}, repaired), make("span", {}, caption)));
  });
  return [folded(`Where repairs change V of ${name}`,
    make("p", { class: "note" }, "Blue becomes brighter, red darker, in the scale of the errors; white stays."),
    make("div", { class: "gallery" }, figures))];
}

function budgetUnder(light, largest) {
  const explained = succeeded.filter((result) => result.lights[light]?.errorBudget);
  if (explained.length === 0) return [];
  return [causesTable(light, explained, largest), ...explained.flatMap((result) => {
    const own = result.lights[light], name = result.entry + under(light);
    return [...repairPictures(name, methodOf(result).repairs[light] ?? [], own),
      folded(`How the budget of ${name} was measured`, runsTable(name, own.errorBudgetRuns), make("p", { class: "note" },
        `If causes added up, ${signedText(own.errorBudgetRuns.ifCausesAddedUp)} would be left.`))];
  })];
}

function errorBudget() {
  const all = succeeded.flatMap((result) => result.lights).filter((light) => light.errorBudget);
  if (all.length === 0) return [];
  const largest = {  // maxima over all lights, so that tables can be compared
    change: Math.max(...all.flatMap(({ errorBudget: budget }) => kCauses.map((cause) => Math.abs(budget[cause] ?? 0)))),
    error: Math.max(...all.flatMap(({ errorBudget: budget, errorBudgetRuns: runs }) => [runs.rmse, budget.remainder ?? 0])) };
  return [make("h3", { id: "error-budget" }, "Error budget"), make("p", { class: "note" }, "Over each light’s judged pixels. A dash: this cause cannot be separated "
    + "for that method. The changes need not add up, since causes mask and amplify one another; the remainder is the error when all causes that can be combined "
    + "are repaired at once."), ...report.lights.flatMap((_, light) =>
    (light === 0 ? budgetUnder(0, largest) : [folded(`Error budget${under(light)}`, budgetUnder(light, largest))]))];
}
