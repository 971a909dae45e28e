// SPDX-License-Identifier: Apache-2.0
// Writes the page's texts: the findings at a glance, the question, scene, methods, machine and warnings.

const place = (id) => document.getElementById(id);
const referenceIsMask = report.reference.output === "mask";
// Describes the reference's light samples; `same`: text that is added if they are those of the methods.
const referenceQuestion = (same) => report.reference.question + (referenceIsMask && report.sameSamples ? same : "");

// Lists the first three names, and the number of further ones.
function namesText(named) {
  const names = named.slice(0, 3).map((result) => result.entry).join(", ");
  return named.length > 3 ? `${names} and ${named.length - 3} more` : names;
}

// Returns a card (title, names, text) with the methods that have the fewest pairs differing from rays.
function exactnessCard() {
  const sums = results.map((result) => {
    const same = result.lights.map((light) => light.sameSamples).filter(Boolean);
    const sum = (key) => same.reduce((total, pairs) => total + pairs[key], 0);
    return { result, all: sum("pairsAll"), differing: sum("pairsDiffering") };
  }).filter(({ all }) => all > 0);
  if (sums.length === 0) return [];
  const fewest = Math.min(...sums.map(({ differing }) => differing)), tied = sums.filter(({ differing }) => differing === fewest);
  return ["Most exact", namesText(tied.map(({ result }) => result)),
    `${fewest === 0 ? "none" : countText(fewest)} of ${countText(tied.at(-1).all)} answers differ from rays on the same light samples`];
}

function fastestCard() {
  const fastest = smallest(shadowOf, secondsText);
  if (fastest.length === 0) return [];
  const [best] = fastest, method = methodOf(best);
  const speed = method.sameQuestion ? speedText(shadowOf(best), shadowOf(metrics.reference)) : kNotThere;
  const ratio = speed === kNotThere ? "" : `: ${speed} ${speed === "as fast" ? "as" : "than"} the reference`;
  return ["Least time", namesText(fastest),
    `${fastest.length > 1 ? "a tie: " : ""}${secondsText(shadowOf(best))} for the shadow, ${method.question}${ratio}`];
}

function closestCard() {
  const closest = smallest(rmseOf, errorText);
  if (closest.length === 0) return [];
  const { mean, rmse } = closest[0].errorAllLights;
  return ["Closest to the reference", namesText(closest),
    `${closest.length > 1 ? "a tie: " : ""}V is off by ${errorText(mean)} on average (RMSE ${errorText(rmse)})`];
}

function showGlance() {
  const { reference } = metrics, count = results.length;
  place("title").textContent = `Soft shadows of ${reference.scene}`;
  place("lead").textContent = `How much of the light does each point see? ${count} method${count === 1 ? "" : "s"} answered; ${reference.method} judged `
    + `${count === 1 ? "it" : "them"}.`;
  const cards = [closestCard(), exactnessCard(), fastestCard(),
    ["Judged by", reference.method, `${referenceQuestion(", the same as the methods’")}, ${secondsText(shadowOf(reference))} for the shadow`],
    ["Compared on", reference.scene, `${report.width} × ${report.height} pixels, ${countText(metrics.judgedPixels)} of them judged`]];
  place("glance").append(...cards.filter((card) => card.length > 0).map(([title, name, text]) =>
    make("div", {}, make("dt", {}, title), make("dd", {}, make("b", {}, name), make("br"), text))));
}

function showQuestion() {
  const samples = Math.max(0, ...results.map((result) => result.lightSamples));
  const { method, lightSamples } = metrics.reference;
  const what = several ? `each of the scene’s ${report.lights.length} lights is judged by itself, and all together`
    : `the light in question is “${report.lights[0].name}”`;
  const judge = !referenceIsMask ? "The reference needs no points of the light: it measures the area that is visible."
    : report.sameSamples ? "The reference looked for the same points of the light, so that every single answer can be compared, not only their sums."
      : `The reference looked for ${countText(lightSamples)} points of the light. Its own V is an estimate too, in steps of 1/${lightSamples}: errors of about `
        + `that size belong to both sides.${metrics.sameSamples ? " So methods that look for points are also compared with rays to their own points, answer by "
          + "answer." : ""}`;
  document.querySelector("#question .two > div").append(
    make("p", {}, "Each pixel of the picture became one point of the scene, and every method below was asked about the very same points. ",
      samples === 0 ? "" : `Those that look for points of the light (not every method does) looked for the very same ${countText(samples)}. `,
      "The methods differ in how they find out what stands between, and so in speed and in the mistakes they make. ", make("strong", {}, method),
      ` served as the reference; ${what}.`), make("p", {}, judge));
}

const factsTable = (facts) => make("div", { class: "scroll" }, make("table", { class: "facts" }, make("tbody", {}, facts.map(([name, value]) =>
  make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, value))))));

// Describes a method; links to the method lead to this element.
function methodText(name, method) {
  return make("details", { id: methodPlace(name) }, make("summary", {}, name),
    make("p", {}, `${method.family}-based; after ${method.paper}. Exact for ${method.exactFor}. Answers with ${method.output}.`,
      method.onRequest ? " Compared only on request: it is slow, or serves as a reference for others." : "", " ",
      make("code", {}, `penumbra methods ${name}`), " says the same; its derivation is in ", make("code", {}, `docs/${name}.md`), "."),
    tableOf("Options", ["Option", "Values", "Default", "What it does"],
      method.options.map((option) => [option.name, option.values, option.default, option.help])));
}

function showMethods() {
  const chosen = (stats) => Object.entries(stats.options).map(([key, value]) => `${key}=${value}`).join(", ") || "defaults";
  const row = (label, method, stats) => [label, method.family, method.output, method.exactFor, method.paper, chosen(stats)];
  const named = new Map(results.map((result, i) => [result.method, report.methods[i]]).reverse());
  place("methods").append(tableOf("What each method is", ["Method", "Family", "Answers with", "Exact for", "After", "Options"],
    [row({ text: metrics.reference.method, small: "the reference" }, report.reference, metrics.reference),
      ...results.map((result, i) => row(result.entry, report.methods[i], result))]),
  ...[...named].reverse().map(([name, method]) => methodText(name, method)),
  make("p", {}, "A method that answers with a mask is shaded light sample by light sample; one that knows only V (scalar) has the unshadowed light "
    + "multiplied by V; one that answers with radiance integrates the light that it sees itself."));
}

function showMachine() {
  const { machine } = report, first = results[0] ?? metrics.reference, sampled = results.find((result) => result.lightSamples !== 0);
  place("machine").append(factsTable([
    ["Processor", machine.processor], ["Hardware threads", machine.threads || ""], ["Memory", machine.memoryBytes && bytesText(machine.memoryBytes)],
    ["Device", first.device], ["System", machine.system], ["Program", `penumbra ${report.version}`],
    ["Light samples", sampled && `${sampled.lightSamples}, pattern ${sampled.samplePattern}`],
    ["Reference", `${metrics.reference.method}, ${referenceQuestion(" (the same)")}`],
    ["Compared pixels", report.sampledPixels && `${countText(report.sampledPixels)} chosen pixels`],
    ["Reading the scene", secondsText(first.seconds.load)], ["View samples", secondsText(first.seconds.view)]].filter(([, value]) => value)));
}

function showWarnings() {
  // A set, since every method repeats the warnings about the scene.
  const warnings = new Set([...report.warnings, ...[metrics.reference, ...results].flatMap((stats) => stats.warnings)]);
  const section = place("warnings");
  section.hidden = warnings.size === 0;
  document.querySelector("nav a[href='#warnings']").hidden = section.hidden;
  section.querySelector("h2").textContent = `Warnings: ${warnings.size}`;
  section.querySelector("ul").append(...[...warnings].map((warning) => make("li", {}, warning)));
}

function showAbout() {
  showGlance();
  showQuestion();
  const [facts, picture] = document.querySelectorAll("#scene .two > div");
  facts.append(factsTable(report.scene));
  if (canPaint && report.entries[0].beauty !== null) {
    picture.append(figureOf({ layer: "beauty", entry: 0, light: 0 }, `shaded by the reference, ${metrics.reference.method}`, metrics.reference.scene));
  }
  showMethods();
  showMachine();
  showWarnings();
  place("command").textContent = `./run.sh ${report.command}`;
  place("written").textContent = `Written by penumbra ${report.version}.`;
}
