// SPDX-License-Identifier: Apache-2.0
// Makes elements of the page, and texts of numbers. All texts are added here, as text nodes: none becomes markup.

const kNotThere = "–";
const kSvg = "http://www.w3.org/2000/svg";

function filled(element, values, children) {
  for (const [name, value] of Object.entries(values)) {
    if (value !== undefined && value !== null && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== ""));
  return element;
}
const make = (tag, values = {}, ...children) => filled(document.createElement(tag), values, children);
const drawn = (tag, values = {}, ...children) => filled(document.createElementNS(kSvg, tag), values, children);

// Returns a part that opens on request; null if it has no content.
function folded(summary, ...children) {
  const inside = children.flat().filter(Boolean);
  return inside.length > 0 ? make("details", {}, make("summary", {}, summary), inside) : null;
}

// Returns three significant digits: 0, 0.0123, 1.2e-5.
function errorText(number) {
  if (number === 0) return "0";
  const [mantissa, exponent] = number.toExponential(2).split("e").map(Number);
  const text = exponent < -4 || exponent > 2 ? `${mantissa}e${exponent}` : `${Number(number.toPrecision(3))}`;
  return text.replace(/^-/, "−");  // a minus sign, as wide as a plus
}
const signedText = (number) => (number > 0 ? "+" : "") + errorText(number);
const percentText = (share) => `${errorText(100 * share)} %`;
const countText = (count) => `${count}`.replace(/\B(?=(\d{3})+$)/g, "\u202f");  // 1 234 567, with narrow spaces

function secondsText(seconds) {
  if (seconds === null || seconds === undefined) return kNotThere;
  if (seconds === 0) return "0";
  if (seconds < 1e-3) return `${errorText(seconds * 1e6)} µs`;
  if (seconds < 0.9995) return `${errorText(seconds * 1e3)} ms`;  // larger values would be rounded up to 1000 ms
  return seconds < 99.95 ? `${errorText(seconds)} s` : `${seconds.toFixed(0)} s`;
}

function bytesText(bytes) {
  const units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
  let unit = 0;
  for (; bytes >= 1024 && unit + 1 < units.length; ++unit) bytes /= 1024;
  return `${bytes.toFixed(unit === 0 || bytes >= 100 ? 0 : 1)} ${units[unit]}`;
}

// Returns "2.10× faster" or "1.40× slower", compared with the reference.
function speedText(seconds, reference) {
  if (!(seconds > 0) || !(reference > 0)) return kNotThere;
  const shown = Math.max(reference / seconds, seconds / reference);
  if (shown < 1.005) return "as fast";
  return `${shown.toFixed(shown < 9.995 ? 2 : shown < 99.95 ? 1 : 0)}× ${reference > seconds ? "faster" : "slower"}`;
}
