// SPDX-License-Identifier: Apache-2.0
// The socket: JSON in both directions, and pictures as binary messages. Of several changes of the same kind within one
// frame of the screen, only the newest is sent.
const token = new URLSearchParams(location.search).get("token") || "";
const listeners = {};
let socket = null, clientId = 0, retries = 0;
const waiting = new Map();  // changes that have not been sent: the newest of each kind
let sentStamp = 0;          // time of the last change that needs another picture
const on = (type, listener) => { (listeners[type] ||= []).push(listener); };
const tell = (type, ...values) => { for (const listener of listeners[type] || []) listener(...values); };

function connect() {
  socket = new WebSocket(`ws://${location.host}/live?token=${encodeURIComponent(token)}`);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => { retries = 0; tell("connected"); };
  socket.onmessage = (event) => {
    if (typeof event.data !== "string") return takeFrame(event.data);
    const message = JSON.parse(event.data);
    if (message.type === "hello") clientId = message.client;
    tell(message.type, message);
  };
  socket.onclose = () => {
    tell("lost");
    if (retries++ < 100) setTimeout(connect, Math.min(200 * retries, 3000));
  };
}

function post(message) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

/// Sends a change with the next frame of the screen. It replaces an unsent one with the same `key`.
function change(key, message) {
  const stamp = performance.now();
  if (message.type !== "display" && message.type !== "masks") {
    sentStamp = stamp;
    document.documentElement.dataset.exact = "false";
  }
  if (!waiting.size) requestAnimationFrame(flush);
  waiting.delete(key);
  waiting.set(key, { ...message, stamp });
}

function flush() {
  for (const message of waiting.values()) post(message);
  waiting.clear();
}

/// Decodes a picture's message; the server sends the next one after the answer "taken".
async function takeFrame(buffer) {
  const size = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  let at = 4 + size;
  try {
    const images = await Promise.all(header.images.map((image) => {
      const bytes = new Uint8Array(buffer, at, image.bytes);
      at += image.bytes;
      return createImageBitmap(new Blob([bytes], { type: image.type }));
    }));
    tell("frame", header, images);
  } finally {
    post({ type: "taken" });
  }
}
