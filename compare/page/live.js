// SPDX-License-Identifier: Apache-2.0
// "Open live": shows two of the methods in `penumbra view`, which the user starts by a copied command, or which already
// runs. A page from a file can neither start a program nor connect to one (its content policy forbids that too), and
// does not know the address: `penumbra view` prints it.

const quotedForShell = (text) => (/^[\w@%+=:,.\/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
// Returns a result's method with its options, in the form of `--method`.
const entryOf = (result) => [result.method, ...Object.entries(result.options).map(([key, value]) => `${key}=${value}`)].join(":");

function addressOf(text) {
  try {
    return new URL(text);
  } catch {
    return null;
  }
}

function showLive() {
  const live = document.getElementById("live"), command = document.getElementById("live-command"), say = document.getElementById("live-say");
  const [a, b] = ["live-a", "live-b"].map((id) => document.getElementById(id)), address = document.getElementById("live-address");
  if (succeeded.length === 0 || report.view === "") {
    for (const element of [live, ...document.querySelectorAll("a[href='#live']")]) element.remove();
    return;
  }
  const options = succeeded.map((result, i) => [`${i}`, result.entry]);
  const { left, right } = document.getElementById("look").dataset;
  const placeOf = (entry) => `${Math.max(0, succeeded.indexOf(results[report.entries[entry ?? 0]?.method]))}`;
  fill(a, options, placeOf(left));
  fill(b, options, placeOf(right));
  const chosen = () => [a, b].map((select) => entryOf(succeeded[Number(select.value)]));
  const samples = Math.max(...results.map((result) => result.lightSamples));
  const show = () => {
    const [first, second] = chosen();
    command.textContent = `./run.sh ${report.view}${samples > 0 ? ` --light-samples ${samples}` : ""} --method ${quotedForShell(first)} `
      + `--method-b ${quotedForShell(second)}`;
  };
  for (const select of [a, b]) select.addEventListener("change", show);
  show();
  document.getElementById("live-copy").addEventListener("click", () => {
    const selection = getSelection();
    selection.selectAllChildren(command);
    const copied = document.execCommand("copy");  // needs no permission, unlike navigator.clipboard
    say.textContent = copied ? "Copied: run it in a terminal, in the folder where the comparison was run." : "The browser does not copy; the command is selected.";
    if (copied) selection.removeAllRanges();
  });
  document.getElementById("live-form").addEventListener("submit", (event) => {
    event.preventDefault();
    const url = addressOf(address.value.trim());
    if (url?.protocol !== "http:" || !url.searchParams.has("token")) {
      say.textContent = "That is no address of a view: it begins with http:// and ends with a token, as penumbra view prints it.";
      address.focus();
      return;
    }
    const [first, second] = chosen();
    url.hash = new URLSearchParams({ scene: metrics.reference.scene, a: first, b: second, samples });
    say.textContent = `Opened: ${url.host}.`;
    window.open(url, "_blank", "noopener");
  });
}
