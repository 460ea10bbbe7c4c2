/** Positions for the screen: the middle of the surface's box at the origin, its farthest vertex at distance 1. */
function placed(stored, axes) {
  const n = vertices.length;
  const fine = stored.length > 3 * n;
  const box = axes.map((axis, k) => {
    let low = Infinity, high = -Infinity;
    for (let i = k * n; i < (k + 1) * n; i++) {
      low = Math.min(low, stored[i]);
      high = Math.max(high, stored[i]);
    }
    return { middle: low / 2 + high / 2, half: high / 2 - low / 2, exponent: axis.exponent };
  });
  const first = Math.max(...box.map(({ half, exponent }) => (half ? Math.log2(half) + exponent : -Infinity)));
  const found = new Float32Array(3 * n);
  if (first === -Infinity) return found;
  box.forEach(({ middle, exponent }, k) => {
    const factor = 2 ** (exponent - first);
    for (let i = 0; i < n; i++) found[3 * i + k] = (stored[k * n + i] - middle + (fine ? stored[(k + 3) * n + i] : 0)) * factor;
  });
  let farthest = 0;
  for (let i = 0; i < 3 * n; i += 3) farthest = Math.max(farthest, Math.hypot(found[i], found[i + 1], found[i + 2]));
  for (let i = 0; i < 3 * n; i++) found[i] /= farthest;
  return found;
}

/** Where between the ends of its colours each value of a column lies, and which are defined; rounding lies at 0. */
function spread(stored, of, rounded) {
  const n = vertices.length;
  const place = new Float32Array(n), known = new Float32Array(n);
  const half = of.high / 2 - of.low / 2;
  for (let i = 0; i < n; i++) {
    const value = rounded?.[i] ? 0 : real(stored[i], of, stored.length > n ? stored[n + i] : 0);
    if (Number.isNaN(value) || of.low === null) continue;
    known[i] = 1;
    place[i] = half > 0
      ? Math.min(Math.max((value / 2 - of.low / 2) / half, -1), 2)
      : Math.abs(value - of.low) <= 1e-6 * Math.abs(of.low) ? 0.5 // float32 has no more digits
      : value < of.low ? 0 : 1;
  }
  return { place, known };
}

const first = data.columns.findIndex(({ name }) => name === $("column")?.value);
if (first >= 0) column(first);
const [vertices, positions, status, facesPacked, normals, boundaryPacked, crowdedPacked] = await Promise.all([
  numbers("vertices", Uint32Array), numbers("positions", Float32Array),
  data.status.length ? numbers("status", Uint8Array) : null, numbers("faces", Uint32Array),
  numbers("normals", Int8Array), numbers("boundary", Uint32Array), numbers("crowded", Uint32Array),
]);
for (let i = 1; i < vertices.length; i++) vertices[i] += vertices[i - 1];
const bend = data.bend.length ? rows(await numbers("bend", Uint32Array), 2) : null;
const menu = $("column"), input = $("vertex"), said = $("picked"), hover = $("hover");
let scene = null, chosen = null;

const text = (stored, of) => {
  const value = real(stored, of);
  return Number.isNaN(value) ? "undefined" : shortest(value);
};

/** The place of a vertex of the file among those shown, or where it would be. */
function search(vertex) {
  let low = 0, high = vertices.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (vertices[middle] < vertex) low = middle + 1; else high = middle;
  }
  return low;
}

/** Show the values of a vertex, given by its place among those shown. */
async function choose(index) {
  chosen = index;
  const n = vertices.length;
  for (const cell of document.querySelectorAll("#values [data-axis]")) {
    const axis = Number(cell.dataset.axis);
    cell.textContent = text(positions[axis * n + index], data.axes[axis]);
  }
  const word = status ? data.status[status[index]] : "";
  if (status) document.querySelector("#values [data-status]").textContent = word;
  const cells = [...document.querySelectorAll("#values [data-column]")];
  const values = await Promise.all(cells.map((_, k) => column(k)));
  if (chosen !== index) return;
  cells.forEach((cell, k) => { cell.textContent = text(values[k][index], data.columns[k]); });
  const shown = menu ? `, ${menu.value} ${cells[menu.selectedIndex].textContent}` : "";
  said.textContent = `vertex ${vertices[index]}${word ? `, ${word}` : ""}${shown}`;
  document.documentElement.dataset.vertex = vertices[index];
  scene?.mark(index);
}

/** The vertex whose number was typed. */
function typed() {
  if (input.value === "") return;
  const wanted = Number(input.value);
  const index = search(wanted);
  if (vertices[index] === wanted) {
    choose(index);
    scene?.face(index);
    return;
  }
  const known = Number.isInteger(wanted) && wanted >= 0 && wanted < data.of;
  const near = [vertices[index - 1], vertices[index]].filter((one) => one !== undefined).join(" and ");
  said.textContent = known
    ? `vertex ${wanted} is not shown; ${near} are. The table of the vertices has them all.`
    : `there is no vertex ${input.value}; the last is ${data.of - 1}`;
}

/** Colour the surface by the column of the menu. */
async function recolor() {
  const index = menu.selectedIndex, of = data.columns[index];
  document.querySelectorAll(".scale").forEach((figure, k) => { figure.hidden = k !== index; });
  const stored = await column(index);
  const rounded = of.rounded ? await numbers("rounded-" + index, Uint8Array) : null;
  const map = await inflated(data.maps[of.map]);
  if (menu.selectedIndex !== index) return;
  $("undefined-swatch").style.background = `rgb(${of.undefined})`;
  $("view").setAttribute("aria-label", `The surface coloured by ${of.name}`);
  if (scene) {
    const { place, known } = spread(stored, of, rounded);
    const half = of.high / 2 - of.low / 2;
    const zero = half > 0 ? Math.min(Math.max(-of.low / 2 / half, 0), 1) : 0.5;
    scene.setColors(place, known, map, of.undefined, of.cells ? zero : null);
  }
  if (chosen !== null) choose(chosen);
  document.documentElement.dataset.column = of.name;
}

const KEYS = {
  ArrowLeft: () => scene.turn(-0.15, 0), ArrowRight: () => scene.turn(0.15, 0),
  ArrowUp: () => scene.turn(0, -0.15), ArrowDown: () => scene.turn(0, 0.15),
  "+": () => scene.zoom(0.85), "=": () => scene.zoom(0.85), "-": () => scene.zoom(1 / 0.85), 0: () => scene.look(...data.view),
};

/** Let the canvas hear pointers and keys. */
function listen(canvas) {
  const down = new Set();
  let pressed = null, waiting = null;
  canvas.addEventListener("pointerdown", (event) => {
    down.add(event.pointerId);
    pressed = down.size === 1 ? [event.clientX, event.clientY] : null; // two fingers choose nothing
    canvas.focus({ preventScroll: true });
    hover.hidden = true;
  });
  canvas.addEventListener("pointerup", (event) => {
    const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 5;
    pressed = null;
    down.delete(event.pointerId);
    const index = still && event.button === 0 ? scene.pick(event.clientX, event.clientY) : null;
    if (index === null) return;
    input.value = vertices[index];
    choose(index);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (down.size) { scene.draw(); return; }
    if (event.pointerType === "touch") return;
    clearTimeout(waiting);
    hover.hidden = true;
    waiting = setTimeout(() => point(event), 80);
  });
  canvas.addEventListener("pointercancel", (event) => { pressed = null; down.delete(event.pointerId); });
  canvas.addEventListener("pointerleave", () => { clearTimeout(waiting); hover.hidden = true; });
  // A page must scroll past the surface: the wheel zooms once it was clicked or reached by keyboard.
  canvas.addEventListener("wheel", () => {
    scene.controls.noZoom = document.activeElement !== canvas;
    scene.draw();
  }, { capture: true, passive: true });
  canvas.addEventListener("pointerdown", () => { scene.controls.noZoom = false; scene.controls.handleResize(); }, true);
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in KEYS)) return;
    event.preventDefault();
    KEYS[event.key]();
  });
}

/** Tell the vertex under a pointer that rests. */
async function point(event) {
  const index = scene.pick(event.clientX, event.clientY);
  if (index === null) return;
  const shown = menu ? ` ${menu.value} ${text((await column(menu.selectedIndex))[index], data.columns[menu.selectedIndex])}` : "";
  hover.textContent = `vertex ${vertices[index]}${shown}`;
  const box = $("view").getBoundingClientRect();
  hover.hidden = false;
  const left = Math.min(event.clientX - box.left + 14, box.width - hover.offsetWidth - 4);
  hover.style.left = `${Math.max(left, 4)}px`;
  hover.style.top = `${Math.max(event.clientY - box.top - 34, 4)}px`;
}

function start() {
  const canvas = $("view");
  try {
    scene = new Scene(canvas);
  } catch {
    $("trouble").textContent = "This browser draws no WebGL. The tables, and the values of a vertex by its number, are complete without it.";
    canvas.hidden = true;
    return;
  }
  $("trouble").hidden = true;
  const n = vertices.length, across = new Int8Array(3 * n);
  for (let k = 0; k < 3; k++) for (let i = 0; i < n; i++) across[3 * i + k] = normals[k * n + i];
  scene.setSurface(placed(positions, data.axes), across, rows(facesPacked, 3));
  scene.addLines(rows(boundaryPacked, 2), "--boundary");
  scene.addLines(rows(crowdedPacked, 2), "--crowded");
  let begin = 0;
  for (const [shade, count] of data.bend) {
    scene.addLines(bend.subarray(2 * begin, 2 * (begin + count)), null, shade);
    begin += count;
  }
  scene.uniforms.smoothly.value = data.smooth ? 1 : 0;
  scene.resize();
  scene.look(...data.view);
  scene.showEdges(data.edges);
  scene.paint();
  new ResizeObserver(() => scene.resize()).observe(canvas.parentElement);
  for (const query of ["(prefers-color-scheme: dark)", "print"]) {
    matchMedia(query).addEventListener("change", () => { scene.paint(); scene.now(); });
  }
  listen(canvas);
}

$("smooth").checked = data.smooth;
$("edges").checked = data.edges;
$("smooth").addEventListener("change", (event) => {
  if (scene) { scene.uniforms.smoothly.value = event.target.checked ? 1 : 0; scene.draw(); }
});
$("edges").addEventListener("change", (event) => scene?.showEdges(event.target.checked));
for (const button of document.querySelectorAll("[data-view]")) {
  button.addEventListener("click", () => scene?.view(button.dataset.view));
}
menu?.addEventListener("change", recolor);
input.addEventListener("change", typed);
input.addEventListener("keydown", (event) => { if (event.key === "Enter") typed(); });
start();
if (menu) await recolor();
scene?.now();
document.documentElement.dataset.state = "ready";
