// SPDX-License-Identifier: Apache-2.0
// Converts numbers to pictures, for any exposure and scale, by the formulas of the program's own pictures
// (compare/error_picture.cpp).

function srgbByte(linear) {
  const x = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

// Returns the colour of an error: white is right, blue too bright, red too dark. The depth grows with the square root
// of the error divided by the limit.
function errorColor(error, limit) {
  const arm = error > 0 ? report.tooBright : report.tooDark;
  const depth = Math.sqrt(Math.min(1, Math.abs(error) / limit)) * (arm.length - 1);
  const from = Math.min(Math.floor(depth), arm.length - 2), share = depth - from;
  return [0, 1, 2].map((c) => Math.round(arm[from][c] * (1 - share) + arm[from + 1][c] * share));
}

// Returns a canvas of the picture's own size. `what`: {layer: beauty|v|error, entry, light}; `look`: {stops, limit}.
function pictureOf(what, look) {
  const { layer, entry, light } = what;
  const setting = layer === "beauty" ? look.stops : layer === "error" ? look.limit : 0;
  const place = `picture ${layer} ${entry} ${layer === "beauty" ? 0 : light}`;
  // Only the last setting of each picture is kept; otherwise a slider would fill the memory.
  if (kept.get(place)?.setting !== setting) {
    const promise = paint(what, look);
    promise.setting = setting;
    kept.set(place, promise);
  }
  return kept.get(place);
}

async function paint({ layer, entry, light }, { stops, limit }) {
  const canvas = document.createElement("canvas");
  canvas.width = report.width;
  canvas.height = report.height;
  const context = canvas.getContext("2d");
  const image = context.createImageData(report.width, report.height);
  const set = (i, r, g, b) => image.data.set([r, g, b, 255], 4 * i);
  if (layer === "beauty") {
    const codes = await radianceCodesOf(entry);
    const factor = report.exposure * 2 ** stops;
    const bytes = new Uint8Array(65536);
    for (let code = 0; code < bytes.length; ++code) bytes[code] = srgbByte(factor * linearOfCode(code));
    for (let i = 0; i < codes.length / 3; ++i) {
      set(i, bytes[codes[3 * i]], bytes[codes[3 * i + 1]], bytes[codes[3 * i + 2]]);
    }
  } else {
    const [classes, v, truth] = await Promise.all([classesOf(light), visibilityOf(entry, light), visibilityOf(0, light)]);
    for (let i = 0; i < v.length; ++i) {
      const value = layer === "v" ? v[i] : v[i] - truth[i];
      if (classes[i] === 0 || Number.isNaN(value)) {
        set(i, ...report.background);
      } else if (layer === "v") {
        const grey = Math.round(255 * Math.min(1, Math.max(0, value)));
        set(i, grey, grey, grey);
      } else {
        set(i, ...errorColor(value, limit));
      }
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

// Draws the light as seen from a view sample: a dot for each light sample, bright if visible; a ring around it if rays
// on the same light samples disagree. `seen`, `rays`: arrays of booleans; rays may be null.
function paintLight(canvas, light, points, seen, rays) {
  const context = canvas.getContext("2d");
  const size = canvas.width, middle = size / 2, reach = middle - 3;
  const wide = Math.min(1, light.aspect), high = Math.min(1, 1 / light.aspect);
  context.clearRect(0, 0, size, size);
  context.fillStyle = "#15171c";
  context.strokeStyle = "#8a8f99";
  context.beginPath();
  if (light.round) context.ellipse(middle, middle, reach * wide + 2, reach * high + 2, 0, 0, 2 * Math.PI);
  else context.rect(middle - reach * wide - 2, middle - reach * high - 2, 2 * reach * wide + 4, 2 * reach * high + 4);
  context.fill();
  context.stroke();
  const radius = Math.max(0.8, Math.min(6, 0.72 * reach * Math.sqrt(wide * high / points.length)));
  points.forEach(([s, t], j) => {
    context.beginPath();
    context.arc(middle + s * reach * wide, middle - t * reach * high, radius, 0, 2 * Math.PI);
    context.fillStyle = seen[j] ? "#ffd45e" : "#3b3f49";
    context.fill();
    if (rays && rays[j] !== seen[j]) {
      context.strokeStyle = "#ff3b30";
      context.lineWidth = Math.max(1.5, radius / 2);
      context.stroke();
    }
  });
}
