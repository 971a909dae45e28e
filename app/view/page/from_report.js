// SPDX-License-Identifier: Apache-2.0
// A comparison's report opens this page with its scene and methods in the address: #scene=…&a=…&b=…&samples=….

function takeReport(state) {
  const wanted = new URLSearchParams(location.hash.slice(1));
  if (!wanted.has("scene")) return;
  window.history.replaceState(null, "", location.pathname + location.search);  // applied only once
  if (wanted.get("scene") !== state.scene) {
    trouble(`The report is about ${wanted.get("scene")}; this is ${state.scene}. Nothing is changed.`);
    return;
  }
  const samples = Number(wanted.get("samples"));
  if (Number.isInteger(samples)) change("samples", { type: "samples", count: samples });
  for (const slot of ["a", "b"]) {
    if (wanted.has(slot)) change(`method ${slot}`, { type: "method", slot, entry: wanted.get(slot), none: false });
  }
}
