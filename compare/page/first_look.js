// SPDX-License-Identifier: Apache-2.0
// Paints the pictures on the page itself when they become visible, and the wipe at the top of the page.

// Paints one canvas of the page; `what` is that of pictureOf().
async function paintOn(canvas, what) {
  const picture = await pictureOf(what, { stops: 0, limit: report.errorLimit });
  canvas.width = report.width;
  canvas.height = report.height;
  canvas.getContext("2d").drawImage(picture, 0, 0);
  canvas.dataset.painted = "yes";
}

function paintWhenSeen() {
  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      const { layer, entry, light } = target.parentElement.querySelector("input").dataset;
      paintOn(target, { layer, entry: Number(entry), light: Number(light) });
    }
  }, { rootMargin: "300px" });
  for (const canvas of document.querySelectorAll("figure canvas")) seen.observe(canvas);
}

async function lookFirst() {
  const look = document.getElementById("look");
  if (look.hidden) return;
  const canvas = look.querySelector("canvas"), line = look.querySelector("input");
  const left = Number(look.dataset.left), right = Number(look.dataset.right);
  look.querySelector("button").addEventListener("click", () => open({
    view: "wipe", layer: "v", light: 0, a: left, b: right, bLayer: "", wipe: line.value / 100 }));
  const pictures = await Promise.all([left, right].map((entry) => pictureOf({ layer: "v", entry, light: 0 }, {})));
  const context = canvas.getContext("2d");
  const paint = () => {
    const split = Math.round(line.value / 100 * canvas.width), rest = canvas.width - split;
    if (split > 0) context.drawImage(pictures[0], 0, 0, split, canvas.height, 0, 0, split, canvas.height);
    if (rest > 0) context.drawImage(pictures[1], split, 0, rest, canvas.height, split, 0, rest, canvas.height);
    context.fillStyle = "#ffb000";
    context.fillRect(split - 1, 0, Math.max(2, canvas.width / 256), canvas.height);
    look.dataset.painted = line.value;
  };
  line.addEventListener("input", paint);
  const follow = (event) => {
    const box = canvas.getBoundingClientRect();
    line.value = 100 * (event.clientX - box.left) / box.width;
    paint();
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    follow(event);
  });
  canvas.addEventListener("pointermove", (event) => event.buttons > 0 && follow(event));
  paint();
}

// Opens the folded parts that contain the target of a link.
function unfold() {
  let element = document.getElementById(decodeURIComponent(location.hash.slice(1).replace(/%(?![0-9A-Fa-f]{2})/g, "%25")));
  if (!element) return;
  const target = element;
  for (; element; element = element.parentElement) {
    if (element.tagName === "DETAILS") element.open = true;
  }
  target.scrollIntoView();
}
