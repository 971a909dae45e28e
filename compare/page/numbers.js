// SPDX-License-Identifier: Apache-2.0
// Writes the tables of numbers: failures, errors, exactness pair by pair, seconds, passes and counters.

const { metrics } = report;
const results = metrics.methods;
const succeeded = results.filter((result) => !result.failure);
const several = report.lights.length > 1;
const under = (light) => (several ? ` under light “${report.lights[light].name}”` : "");

const raysLabel = () => {
  const rays = metrics.sameSamples ?? metrics.reference;
  return `${rays.method}, ${rays.lightSamples} light samples`;
};
const rmseOf = (result) => result.errorAllLights?.rmse ?? null;
const shadowOf = (stats) => stats.seconds.shadow;
const methodOf = (result) => report.methods[results.indexOf(result)];
const methodPlace = (name) => `method-${name}`;

// Returns the entries with the smallest number, compared as displayed: entries that look equal are all returned.
function smallest(numberOf, textOf) {
  const known = results.filter((result) => numberOf(result) !== null);
  const best = textOf(Math.min(...known.map(numberOf)));
  return known.filter((result) => textOf(numberOf(result)) === best);
}

const numberCell = (value, textOf) => (value === null || value === undefined ? kNotThere : { text: textOf(value), value });
const countCell = (value) => numberCell(value, countText);
const errorCell = (value) => numberCell(value, errorText);
const secondsCell = (value) => numberCell(value, secondsText);

function failuresTable() {
  return tableOf("Methods that gave no answer, and why. Nothing else on this page is about them.", ["Method", "What went wrong"],
    results.filter((result) => result.failure).map((result) => [result.entry, result.failure.message]));
}

function errorCells(error, isBest) {
  if (!error) return Array(6).fill(kNotThere);
  return [errorCell(error.mean), { ...errorCell(error.rmse), best: isBest }, errorCell(error.p999), errorCell(error.max),
    numberCell(error.over05, percentText), numberCell(error.bias, signedText)];
}

// Returns a table of errors. `errorOf`: returns the error of a result; `rays`: the error that comes from the
// number of light samples alone.
function errorsTable(caption, errorOf, { withBeauty = false, rays = null } = {}) {
  const best = errorText(Math.min(...succeeded.map((result) => errorOf(result)?.rmse ?? Infinity)));
  const rows = succeeded.map((result) => {
    const error = errorOf(result);
    const row = [{ text: result.entry, href: `#${encodeURIComponent(methodPlace(result.method))}` },
      ...errorCells(error, error && errorText(error.rmse) === best)];
    return withBeauty ? [...row, numberCell(result.beautyError?.relativeRmse, percentText)] : row;
  });
  if (rays) {
    rows.push([{ text: "rays on the same light samples", small: `${raysLabel()}: the cost of that number of light samples` },
      ...errorCells(rays, false), ...(withBeauty ? [kNotThere] : [])]);
  }
  return tableOf(caption, ["Method", "Mean", "RMSE", "99.9 % within", "Largest", "Off by over 0.05", "Bias",
    ...(withBeauty ? ["RMSE of the beauty"] : [])], rows);
}

// Returns the tables of errors: under all lights together, under each light, and at horizon pixels.
function errorTables() {
  const against = `Error of V against ${metrics.reference.method}`;
  const whole = several ? [errorsTable(`${against} under all lights together. 0 would be perfect.`, (result) => result.errorAllLights,
    { withBeauty: true, rays: metrics.sameSamples?.errorAllLights })] : [];
  const each = [], horizon = [];
  report.lights.forEach((_, light) => {
    const pixels = succeeded.find((result) => result.lights[light])?.lights[light];
    if (!pixels) return;
    (several ? each : whole).push(errorsTable(`${against}${under(light)}. 0 would be perfect. ${countText(pixels.judgedPixels)} judged pixels, `
      + `${countText(pixels.horizonPixels)} horizon pixels.`, (result) => result.lights[light]?.error,
      { withBeauty: !several, rays: metrics.sameSamples?.lights[light]?.error }));
    if (pixels.horizonPixels === 0) return;
    horizon.push(errorsTable(`${against}${under(light)} at ${countText(pixels.horizonPixels)} horizon pixels.`,
      (result) => result.lights[light]?.horizonError));
  });
  return { whole, each, horizon };
}

// Returns a table with a row for each method that has parts: [{name, pixels, rmse, bias}]. If all methods have the same
// pixels, the headers contain their number.
function partsTable(caption, partsOf, samePixels) {
  const known = succeeded.filter((result) => partsOf(result)?.length > 0);
  if (known.length === 0) return null;
  const signed = (bias) => `${bias < 0 ? "−" : "+"}${Math.abs(bias).toFixed(4)}`;
  const headers = partsOf(known[0]).map((part) => (samePixels ? `${part.name} (${countText(part.pixels)})` : part.name));
  return tableOf(caption, ["Method", ...headers], known.map((result) => [result.entry, ...partsOf(result).map(({ pixels, rmse, bias }) =>
    numberCell(rmse, () => `${rmse.toFixed(4)} (${signed(bias)})${samePixels ? "" : ` of ${countText(pixels)}`}`))]));
}

// Returns tables of errors by class of pixel, by width of the penumbra, and by distance of the hiding object.
function classTables() {
  const classes = (of) => of && Object.entries(of).map(([name, part]) => ({ name, ...part }));
  const ranges = (of) => of?.map((part) => ({ name: part.to === null ? `from ${part.from}` : `${part.from} … ${part.to}`, ...part }));
  return report.lights.flatMap((_, light) => {
    const rmse = `RMSE of V${under(light)}`;
    const parts = (caption, of, samePixels = true) =>
      partsTable(`${rmse} ${caption}`, (result) => result.lights[light] && of(result.lights[light]), samePixels);
    return [
      parts("by class of pixel: all, some or none of the light is visible; another object hides some of it (cast), or the object "
        + "visible at the pixel does (self). + is too bright.", (result) => classes(result.classes)),
      parts("in penumbrae, by their width there, in pixels.", (result) => ranges(result.penumbraWidth?.pixels)),
      parts("in penumbrae, by their width there, in texels of the method's map.", (result) => ranges(result.penumbraWidth?.texels), false),
      parts("in shadows, by the distance in pixels of the nearest object that hides some of the light.", (result) => ranges(result.contactDistance?.pixels)),
    ];
  });
}

// Returns tables of perceived errors, and of the error that methods with V alone make by separating V from shading.
function eyeTables() {
  const eyes = report.lights.map((_, light) => {
    const flip = light === 0;
    return tableOf(`What an eye sees${under(light)}: the share of judged pixels off by more than 1/255; steps between neighbours in the penumbra that the `
      + "reference does not have (banding and noise, RMS)"
      + (flip ? "; and FLIP of the beauty, 0 to 1, for a screen 0.7 m wide with 3840 pixels, 0.7 m away." : "."),
    ["Method", "Off by over 1/255", "Banding", ...(flip ? ["FLIP", "FLIP at most"] : [])],
    succeeded.filter((result) => result.lights[light]?.eye).map((result) => {
      const { over255, banding } = result.lights[light].eye;
      return [result.entry, numberCell(over255, percentText), errorCell(banding),
        ...(flip ? [errorCell(result.eye.flip?.mean), errorCell(result.eye.flip?.max)] : [])];
    }));
  });
  const separated = succeeded.filter((result) => result.separation);
  const share = (value) => numberCell(value, percentText);
  return [...eyes, tableOf("The error of beauty that methods with V alone make by computing V · ∫G in place of ∫G V (separation). RMSE of the luminance of judged pixels, "
    + "relative to its mean: of the method; of separation alone, with the reference’s V; of the errors of V alone; and by how much the "
    + "method’s RMSE changes when separation alone is repaired.",
  ["Method", "Beauty", "Separation alone", "Errors of V alone", "Change without separation"],
  separated.map((result) => [result.entry, share(result.beautyError.relativeRmse), share(result.separation.alone.relativeRmse),
    share(result.separation.ofV.relativeRmse), numberCell(result.separation.change, signedText)]))];
}

// Returns tables that compare methods with masks pair by pair with rays on the same light samples.
function pairTables() {
  const share = (part, whole) => (whole === 0 ? kNotThere : { text: errorText(part / whole), value: part / whole });
  const tables = report.lights.flatMap((_, light) => {
    const known = succeeded.filter((result) => result.lights[light]?.sameSamples);
    const same = (result) => result.lights[light].sameSamples;
    const of = several ? ` Under light “${report.lights[light].name}”.` : "";
    return [
      tableOf(`On how many pairs of view sample and light sample does a method's answer differ from that of ${raysLabel()} on the same light samples?${of}`,
        ["Method", "Differing pairs", "of all pairs", "share", "of pairs in penumbrae", "share", "RMSE of V"],
        known.map((result) => {
          const { pairs, pairsAll, pairsDiffering, error } = same(result);
          return [result.entry, countCell(pairsDiffering), countCell(pairsAll), share(pairsDiffering, pairsAll), countCell(pairs),
            share(pairsDiffering, pairs), errorCell(error?.rmse)];
        })),
      tableOf(`Who is right where they differ? Decided by exact arithmetic, which does not round.${of}`,
        ["Method", "Pairs decided", "of those that differ", "Method right", "Rays right", "Ties decided by rule"],
        known.filter((result) => same(result).pairsDecided > 0).map((result) => {
          const { pairsDecided, pairsDecidedShare, pairsMethodRight, pairsReferenceRight, pairsZeroPredicate } = same(result);
          return [result.entry, countCell(pairsDecided), numberCell(pairsDecidedShare, percentText), countCell(pairsMethodRight),
            countCell(pairsReferenceRight), countCell(pairsZeroPredicate)];
        })),
    ];
  }).filter(Boolean);
  return tables.length === 0 ? [] : [...tables, make("p", { class: "note" }, "Methods with a mask are compared with rays on their own light samples, so that equal "
    + "is compared with equal. A tie: the line of sight meets an edge or a corner exactly; the definition of visibility says how to read it. Where too "
    + "many pairs differ, an evenly spaced sample of them is decided.")];
}

function secondsTable() {
  const reference = metrics.reference, { question } = report.reference;
  const hasRatios = succeeded.some((result) => methodOf(result).sameQuestion);
  const best = smallest((result) => shadowOf(result), secondsText);
  const row = (label, stats, isBest, speed) => {
    const ratio = shadowOf(reference) / shadowOf(stats);
    const shadow = secondsText(shadowOf(stats));
    return [label, { text: shadow, value: shadowOf(stats), best: isBest },
      ...(hasRatios ? [speed.includes("×") ? { text: speed, value: ratio } : speed] : []),
      secondsCell(stats.seconds.light), secondsCell(stats.seconds.evaluate), secondsCell(stats.seconds.mesh), secondsCell(stats.seconds.warmup),
      numberCell(stats.peakMemoryBytes, bytesText), countCell(stats.passes.length)];
  };
  const rows = [row({ text: reference.method, small: `the reference, ${question}` }, reference, false, kNotThere)];
  for (const result of succeeded) {
    const method = methodOf(result);
    // Most methods run on one device, which the machine's table names; only other devices are named here.
    const device = result.device === results[0].device ? "" : `, ${result.device}`;
    rows.push(row({ text: result.entry, small: method.question + device }, result, best.includes(result),
      method.sameQuestion ? speedText(shadowOf(result), shadowOf(reference)) : kNotThere));
  }
  return tableOf("Seconds on the machine below; of repeated runs the median. Shadow = light + evaluate. Passes are kinds of work, each timed. "
    + (hasRatios ? "A ratio is given where a method answers the same question as the reference, with as many light samples."
      : `There are no ratios to the reference, which was asked another question: ${question}${report.sampledPixels === 0 ? "." : ", chosen pixels."}`),
  ["Method", "Shadow", ...(hasRatios ? ["against the reference"] : []), "Light", "Evaluate", "Mesh (once)", "Warm-up", "Memory", "Passes"], rows);
}

function passTables() {
  return results.map((result) => folded(`Passes and counters of ${result.entry}`,
    tableOf("Where the time goes", ["Pass", "Time"], result.passes.map(({ name, milliseconds }) => [name, secondsCell(milliseconds / 1000)])),
    tableOf("What was counted", ["Counter", "Count"], Object.entries(result.counters).map(([name, count]) => [name, countCell(count)]))));
}

function showNumbers() {
  const { whole, each, horizon } = errorTables();
  document.getElementById("numbers").append(...[failuresTable(), ...errorPlot(), make("h3", {}, "Errors"), ...whole, ...errorBudget(),
    folded("More numbers: errors of parts of the picture, time, exactness pair by pair, passes",
      folded("Errors under each light", each), folded("Errors by class of pixel", classTables()), folded("Errors to the eye", eyeTables()),
      folded("Errors at the horizon", horizon), folded("Time", secondsTable()), folded("Exactness, pair by pair", pairTables()),
      folded("Passes and counters", passTables()))].filter(Boolean));
}
