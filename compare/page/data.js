// SPDX-License-Identifier: Apache-2.0
// The page's data: `report`, whose `metrics` is metrics.json (compare/report.cpp writes both), and the numbers behind
// the pictures. The page contains these numbers deflated (zlib) as base64, each list in an element browsers ignore;
// a list is unpacked only when it is needed. compare/report_data.hpp packs the data that are unpacked here.

const report = JSON.parse(document.getElementById("report-data").textContent);

// Makes each value only once, at first use: `keep("v0", make)` returns the value, usually a promise, made by make().
const kept = new Map();
function keep(key, make) {
  if (!kept.has(key)) kept.set(key, make());
  return kept.get(key);
}

async function unpackBytes(id) {
  const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Joins planes of bytes, the most significant first, to numbers of `size` bytes each.
function joinPlanes(planes, size) {
  const count = planes.length / size;
  const numbers = size === 4 ? new Uint32Array(count) : new Uint16Array(count);
  for (let plane = 0; plane < size; ++plane) {
    for (let i = 0; i < count; ++i) numbers[i] |= planes[plane * count + i] << (8 * (size - 1 - plane));
  }
  return numbers;
}

// Returns V of each pixel: the same float32 as in the EXR file.
function visibilityOf(entry, light) {
  const id = report.entries[entry].lights[light].v;
  return keep(id, async () => new Float32Array(joinPlanes(await unpackBytes(id), 4).buffer));
}

// Returns the class of each pixel under a light: an index into report.classNames; 0 is background.
function classesOf(light) {
  const id = report.lights[light].classes;
  return keep(id, () => unpackBytes(id));
}

// Returns the masks: one bit per light sample, whole words of 32 bits per pixel; null for a method without masks.
function masksOf(entry, light) {
  const id = report.entries[entry].lights[light].masks;
  return id ? keep(id, () => unpackBytes(id)) : Promise.resolve(null);
}

// Returns the linear radiance of each pixel as codes, red green blue: 0 is black, c is 2^((c − 1) / 256 − 64). The
// reference's codes are packed as green, red minus green and blue minus green, each minus its left neighbour, modulo
// 2^16 (pack_radiance); those of other entries as steps of four codes from the reference (pack_radiance_over).
function radianceCodesOf(entry) {
  const id = report.entries[entry].beauty;
  if (entry !== 0 && report.entries[0].beauty !== null) {
    return keep(`over ${id}`, async () => {
      const [codes, planes] = await Promise.all([radianceCodesOf(0), unpackBytes(id)]);
      const steps = joinPlanes(planes, 2), count = report.width * report.height, own = new Uint16Array(codes.length);
      const stepsAt = (place) => (steps[place] >>> 1) ^ -(steps[place] & 1);
      for (let i = 0; i < count; ++i) {
        const green = stepsAt(i);
        const all = [green + stepsAt(count + i), green, green + stepsAt(2 * count + i)];
        for (let c = 0; c < 3; ++c) own[3 * i + c] = Math.min(32767, Math.max(0, codes[3 * i + c] + 4 * all[c]));
      }
      return own;
    });
  }
  return keep(id, async () => {
    const count = report.width * report.height;
    const steps = joinPlanes(await unpackBytes(id), 2);
    const codes = new Uint16Array(3 * count);
    for (const [plane, channel] of [[0, 1], [1, 0], [2, 2]]) {
      for (let i = 0, sum = 0; i < count; ++i) {
        sum = i % report.width === 0 ? steps[plane * count + i] : (sum + steps[plane * count + i]) & 0xffff;
        codes[3 * i + channel] = plane === 0 ? sum : (sum + codes[3 * i + 1]) & 0xffff;
      }
    }
    return codes;
  });
}

const linearOfCode = (code) => (code === 0 ? 0 : 2 ** ((code - 1) / 256 - 64));

// Returns for each light sample whether it is visible from the pixel.
function seenSamples(masks, pixel, count) {
  const first = pixel * 4 * Math.ceil(count / 32);
  return Array.from({ length: count }, (_, j) => (masks[first + (j >> 3)] >> (j & 7) & 1) === 1);
}
