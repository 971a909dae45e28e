// SPDX-License-Identifier: Apache-2.0
// Requests the 3D view's data from the server: meshes, their defects, and the shadows of the chosen light, each as a
// header and arrays of numbers. Only one request is sent at a time, for the newest state.
const spaceArrays = { float32: Float32Array, uint32: Uint32Array, int32: Int32Array };

/// Returns the header of an answer, with its arrays as members NAMEArray.
async function fetchSpace(what, parameters = {}) {
  const answer = await fetch(`/space/${what}?${new URLSearchParams({ ...parameters, token })}`);
  if (!answer.ok) throw new Error((await answer.text()).trim());
  const buffer = await answer.arrayBuffer(), size = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  let at = 4 + size;
  for (const { name, type, count } of header.buffers) {
    header[name + "Array"] = new spaceArrays[type](buffer, at, count);
    at += 4 * count;
  }
  return header;
}

/// Loads three.js when it is first needed; null: the program was built without it.
const pageNonce = document.currentScript.nonce;
let threeComing = null;
function loadThree() {
  return threeComing ||= new Promise((resolve) => {
    const script = document.createElement("script");
    script.nonce = pageNonce;
    script.src = `/three.js?${new URLSearchParams({ token })}`;
    script.onload = script.onerror = () => resolve(window.THREE || null);
    document.head.append(script);
  });
}

const spaceNumber = (id, otherwise) => (byId(id).value.trim() === "" || !Number.isFinite(Number(byId(id).value)) ? otherwise : Number(byId(id).value));

/// Returns the request for shadows: its parameters from the controls, and a key of them and the light's current values.
function shadowsWanted() {
  const light = chosenLight(), wanted = { light: light.name, construction: byId("space-construction").value, from: byId("space-from").value,
    s: byId("space-s").value, t: byId("space-t").value };
  const floor = spaceNumber("space-floor", null);
  if (floor !== null) wanted.floor = floor;
  if (!byId("space-all").checked) wanted.wedge = Math.max(0, Math.floor(spaceNumber("space-wedge", 0)));
  if (byId("space-pixel").checked && pointed) {
    wanted.x = Math.floor(pointed[0] * pictureSize[0]);
    wanted.y = Math.floor(pointed[1] * pictureSize[1]);
  }
  return { parameters: wanted, key: JSON.stringify([wanted, light, meshesNumber]) };
}
