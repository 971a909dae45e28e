// SPDX-License-Identifier: Apache-2.0
// Controls for the two methods and their options, made from the program's description of its methods.
let methods = [];
const slots = { a: { select: byId("method"), options: byId("options-a"), given: {} }, b: { select: byId("method-b"), options: byId("options-b"), given: {} } };
const kBest = "best";

function fillMethods() {
  for (const [slot, { select }] of Object.entries(slots)) {
    select.replaceChildren(slot === "a" ? new Option("exact areas", "") : new Option("none", ""));
    if (slot === "b") select.append(new Option("exact areas", kBest));
    for (const family of ["geometry", "image", "reference"]) {
      const group = document.createElement("optgroup");
      group.label = family;
      for (const method of methods) if (method.family === family) group.append(new Option(method.name, method.name));
      if (group.children.length) select.append(group);
    }
    select.addEventListener("change", () => { slots[slot].given = {}; sendMethod(slot); });
  }
}
function sendMethod(slot) {
  const { select, given } = slots[slot], name = select.value === kBest ? "" : select.value;
  const entry = [name, ...Object.entries(given).map(([key, value]) => `${key}=${value}`)].join(":");
  change("method " + slot, { type: "method", slot, entry, none: slot === "b" && select.value === "" });
  showOptions(slot);
}
function showOptions(slot) {
  const { select, options, given } = slots[slot], method = methods.find((one) => one.name === select.value);
  options.hidden = !method || !method.options.length;
  if (options.hidden) return;
  const box = options.querySelector(".options");
  if (box.contains(document.activeElement)) return;
  box.replaceChildren();
  for (const option of method.options) {
    const label = document.createElement("label"), input = document.createElement(option.choices ? "select" : "input");
    label.textContent = option.name;
    if (option.choices) for (const choice of option.choices) input.append(new Option(choice, choice));
    else Object.assign(input, { type: "number", min: option.range.least, max: option.range.most, step: option.range.whole ? 1 : "any" });
    input.value = given[option.name] ?? option.default;
    input.dataset.option = option.name;
    input.addEventListener("change", () => {
      if (!input.checkValidity()) return trouble(`${option.name}: ${input.validationMessage}`);
      if (input.value === option.default) delete given[option.name];
      else given[option.name] = input.value;
      sendMethod(slot);
    });
    label.append(input);
    const help = document.createElement("small");
    help.textContent = option.help;
    box.append(label, help);
  }
}
/// Sets the controls to the methods and options in the server's state.
function takeMethods(state) {
  for (const [slot, entry] of [["a", state.method], ["b", state.other]]) {
    const [name, ...rest] = (entry ?? "").split(":");
    slots[slot].select.value = slot === "b" && entry === "" ? kBest : name;
    slots[slot].given = Object.fromEntries(rest.map((one) => [one.slice(0, one.indexOf("=")), one.slice(one.indexOf("=") + 1)]));
    showOptions(slot);
  }
  const samples = byId("light-samples"), count = String(state.lightSamples);
  if (![...samples.options].some((option) => option.value === count)) samples.append(new Option(count, count));
  samples.value = count;
}
byId("light-samples").addEventListener("change", () => change("samples", { type: "samples", count: Number(byId("light-samples").value) }));
