// The viewer of a report: two meshes under one camera. It reads what `pack.py` writes.

const MODES = ["faces", "wires", "energy", "dihedral", "flips", "reflection"];
const ROW = 2048; // texels in a row of a texture, as in the vertex shader

const byId = (id) => document.getElementById(id);
const all = (selector) => [...document.querySelectorAll(selector)];
const head = JSON.parse(byId("head").textContent);
const canvas = byId("canvas");
const panes = all(".pane");
const gl = canvas.getContext("webgl2");

async function inflated(text) {
  const byLetter = () => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const bytes = Uint8Array.fromBase64?.(text) ?? byLetter(); // slower, in browsers before 2025
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const data = new Uint8Array(await new Response(stream).arrayBuffer());
  let offset = 0;
  return (count) => data.subarray(offset, (offset += count));
}

// Reads one mesh, as such or as what differs from an old one of the same size.
function readMesh(take, { vertices, faces }, old) {
  const numbers = (count, planes) => {
    const result = new Uint32Array(count);
    for (let plane = 0; plane < planes; plane++) {
      take(count).forEach((byte, i) => (result[i] |= byte << (8 * plane)));
    }
    return result;
  };
  const changed = (bytes, before) => (before ? bytes.map((byte, i) => byte + before[i]) : bytes);

  const positions = old?.positions ?? new Int16Array(3 * vertices);
  numbers(old ? 0 : 3 * vertices, 2).forEach((step, i) => {
    const at = 3 * (i % vertices) + Math.floor(i / vertices);
    positions[at] = step + (i % vertices ? positions[at - 3] : 0);
  });
  const energy = changed(take(vertices), old?.energy);
  const corners = numbers(3 * faces, 4);
  let seen = 0;
  corners.forEach((code, i) => {
    if (old) corners[i] = old.corners[i] + (code & 1 ? -(code + 1) / 2 : code / 2);
    else corners[i] = code ? seen - code : seen++;
  });
  const dihedral = changed(take(3 * faces), old?.dihedral);
  return { positions, energy, corners, dihedral, flips: take(faces) };
}

const view = { turn: head.view, target: [0, 0, 0], half: head.half, mode: 0, place: null };
const home = { turn: view.turn, target: view.target, half: view.half };
let meshes = [];
let program;
const uniform = (name) => gl.getUniformLocation(program, name);

function makeProgram() {
  program = gl.createProgram();
  for (const stage of ["VERTEX_SHADER", "FRAGMENT_SHADER"]) {
    const shader = gl.createShader(gl[stage]);
    gl.shaderSource(shader, byId(stage).textContent.trim());
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error("its shaders don't link");
  gl.useProgram(program);
}

function makeTexture(internal, format, type, texels) {
  const rows = Math.max(1, Math.ceil(texels.length / 4 / ROW));
  const padded = new texels.constructor(rows * ROW * 4);
  padded.set(texels);
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  // Whole numbers are not mixed with their neighbours; else the texture would be black.
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texStorage2D(gl.TEXTURE_2D, 1, internal, ROW, rows);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, rows, format, type, padded);
  return texture;
}

// The textures of a mesh: positions with energies, normals, and faces with what is at their sides.
function upload({ positions: p, energy, corners, dihedral, flips }) {
  const [points, normals] = [new Int16Array(4 * energy.length), new Int16Array(4 * energy.length)];
  const sums = new Float64Array(p.length); // of the normals of faces, as long as twice their areas
  const faces = new Uint32Array(4 * flips.length);
  flips.forEach((bits, f) => {
    const [a, b, c] = [3 * corners[3 * f], 3 * corners[3 * f + 1], 3 * corners[3 * f + 2]];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    faces[4 * f + 3] = bits << 24;
    for (let side = 0; side < 3; side++) {
      const v = corners[3 * f + side];
      sums[3 * v] += uy * vz - uz * vy;
      sums[3 * v + 1] += uz * vx - ux * vz;
      sums[3 * v + 2] += ux * vy - uy * vx;
      faces[4 * f + side] = v;
      faces[4 * f + 3] |= dihedral[3 * f + side] << (8 * side);
    }
  });
  energy.forEach((level, v) => {
    const length = Math.hypot(sums[3 * v], sums[3 * v + 1], sums[3 * v + 2]) || 1;
    for (let axis = 0; axis < 3; axis++) {
      points[4 * v + axis] = p[3 * v + axis];
      normals[4 * v + axis] = (sums[3 * v + axis] / length) * 32767;
    }
    points[4 * v + 3] = level;
  });
  const textures = [
    ...[points, normals].map((array) => makeTexture(gl.RGBA16I, gl.RGBA_INTEGER, gl.SHORT, array)),
    makeTexture(gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, faces),
  ];
  return { textures, count: corners.length };
}

function draw() {
  view.frame = null;
  const scale = devicePixelRatio;
  const frame = canvas.getBoundingClientRect();
  const size = [frame.width, frame.height].map((length) => Math.round(length * scale));
  if (`${size}` !== `${[canvas.width, canvas.height]}`) [canvas.width, canvas.height] = size;
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.uniformMatrix3fv(uniform("turn"), true, view.turn.flat());
  gl.uniform3fv(uniform("target"), view.target);
  gl.uniform1i(uniform("mode"), view.mode);
  gl.uniform1f(uniform("thickness"), scale);
  meshes.forEach((mesh, side) => {
    const pane = panes[side].getBoundingClientRect();
    const box = [pane.left - frame.left, frame.bottom - pane.bottom, pane.width, pane.height];
    gl.viewport(...box.map((length) => Math.round(length * scale)));
    const pixels = Math.min(pane.width, pane.height) / 2 / view.half;
    gl.uniform2f(uniform("zoom"), (2 * pixels) / pane.width, (2 * pixels) / pane.height);
    gl.uniform1i(uniform("side"), side);
    mesh.textures.forEach((texture, place) => {
      gl.activeTexture(gl.TEXTURE0 + place);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
    gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
    drawRing(panes[side], pane, pixels);
  });
}

// Puts the ring of a pane round the place that was flown to.
function drawRing(element, pane, pixels) {
  const ring = element.querySelector(".ring");
  ring.hidden = view.place === null;
  if (ring.hidden) return;
  const { target, half } = head.places[view.place];
  const [x, y] = view.turn.map((row) => pixels * dot(row, mix(target, view.target, -1)));
  const radius = Math.max((half / 4) * pixels, 10);
  ring.style.left = `${pane.width / 2 + x - radius}px`;
  ring.style.top = `${pane.height / 2 - y - radius}px`;
  ring.style.width = ring.style.height = `${2 * radius}px`;
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const mix = (a, b, share) => a.map((x, i) => x + b[i] * share);
const between = (a, b, share) => a.map((x, i) => x + (b[i] - x) * share);
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

// The rotation whose viewer is in the direction `towards`, with `up` upwards as far as possible.
function looking(towards, up) {
  const back = unit(towards);
  const aside = cross(up, back);
  const right = unit(Math.hypot(...aside) > 1e-6 ? aside : cross(home.turn[2], back));
  return [right, cross(back, right), back];
}

const redraw = () => (view.frame ??= requestAnimationFrame(draw));
const steer = (change) => redraw(Object.assign(view, change, { flight: null }));

function turnBy(x, y) {
  const [right, up, back] = view.turn;
  const towards = mix(mix(back, right, -Math.tan(x)), up, Math.tan(y));
  steer({ turn: looking(towards, mix(up, back, -Math.tan(y))) });
}

const panBy = (x, y) =>
  steer({ target: mix(mix(view.target, view.turn[0], -x), view.turn[1], -y) });
const zoomBy = (factor) => steer({ half: Math.min(Math.max(view.half / factor, 1e-5), 4) });

// Flies to the place of that number, or to where the whole mesh is seen.
function flyTo(number) {
  view.place = number in head.places ? number : null;
  all("[data-place]").forEach((button) => {
    button.setAttribute("aria-pressed", button.dataset.place === `${number}`);
  });
  const end = head.places[number] ?? home;
  byId("said").textContent = end.text ?? "The whole mesh";
  const start = { ...view, begun: performance.now() };
  const turn = end.turn ?? looking(end.normal, home.turn[1]);
  const lasts = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : 700;
  const step = () => {
    if (view.flight !== step) return;
    const time = lasts ? Math.min((performance.now() - start.begun) / lasts, 1) : 1;
    const share = time * time * (3 - 2 * time);
    view.target = between(start.target, end.target, share);
    view.half = start.half * (end.half / start.half) ** share;
    view.turn = looking(...[2, 1].map((row) => between(start.turn[row], turn[row], share)));
    draw();
    if (time < 1) requestAnimationFrame(step);
  };
  view.flight = step;
  step();
}

function nextPlace(step, count = head.places.length) {
  if (count) flyTo((Number(view.place ?? (step > 0 ? -1 : count)) + step + count) % count);
}

function choose(mode) {
  view.mode = MODES.indexOf(mode);
  all('input[name="mode"]').forEach((input) => (input.checked = input.value === mode));
  all("[data-legend]").forEach((legend) => (legend.hidden = legend.dataset.legend !== mode));
  redraw();
}

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const KEYS = {
  "+": () => zoomBy(1.2),
  "-": () => zoomBy(1 / 1.2),
  0: () => flyTo("whole"),
  n: () => nextPlace(1),
  p: () => nextPlace(-1),
};

function pressed(event) {
  const arrow = event.target === canvas && ARROWS[event.key]?.map((step) => 0.1 * step);
  const input = all('input[name="mode"]')[Number(event.key) - 1];
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  else if (arrow && event.shiftKey) panBy(...arrow.map((step) => step * view.half));
  else if (arrow) turnBy(...arrow);
  else if (input) choose(input.value);
  else if (event.key in KEYS) KEYS[event.key]();
  else return;
  event.preventDefault();
}

// One finger or button turns; two fingers, the other buttons, or Shift move; two fingers zoom.
const fingers = new Map();

function dragged(event) {
  const [last, here] = [fingers.get(event.pointerId), [event.clientX, event.clientY]];
  if (!last) return;
  const [x, y] = [here[0] - last[0], last[1] - here[1]];
  fingers.set(event.pointerId, here);
  const pane = panes[0].getBoundingClientRect();
  const pixel = (2 * view.half) / Math.min(pane.width, pane.height) / fingers.size;
  const [other] = [...fingers].filter(([id]) => id !== event.pointerId);
  if (!other && !event.shiftKey && !(event.buttons & 6)) return turnBy(x * 0.008, y * 0.008);
  const apart = ([left, top]) => Math.hypot(left - other[1][0], top - other[1][1]);
  if (other) zoomBy(apart(here) / Math.max(apart(last), 1));
  panBy(x * pixel, y * pixel);
}

function wheeled(event) {
  // The page scrolls until someone has clicked into the picture.
  if (document.activeElement !== canvas && !event.ctrlKey) return;
  event.preventDefault();
  zoomBy(Math.exp(-event.deltaY * 0.0015));
}

function listen() {
  const on = (name, listener) => canvas.addEventListener(name, listener, { passive: false });
  on("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  on("lostpointercapture", (event) => fingers.delete(event.pointerId));
  on("pointermove", dragged);
  on("contextmenu", (event) => event.preventDefault());
  on("wheel", wheeled);
  document.addEventListener("keydown", pressed);
  byId("modes").addEventListener("change", (event) => choose(event.target.value));
  byId("places").addEventListener("click", (event) => {
    const button = event.target.closest("[data-place]");
    if (!button) return;
    flyTo(button.dataset.place);
    canvas.scrollIntoView({ block: "nearest" });
  });
  new ResizeObserver(redraw).observe(canvas);
}

try {
  if (!gl) throw new Error("this browser has no WebGL 2");
  makeProgram();
  ["positions", "normals", "faces"].forEach((name, i) => gl.uniform1i(uniform(name), i));
  gl.enable(gl.DEPTH_TEST);
  const take = await inflated(byId("meshes").textContent);
  const first = readMesh(take, head.meshes[0]);
  meshes = [first, readMesh(take, head.meshes[1], head.isSame ? first : undefined)].map(upload);
  listen();
  choose(all('input[name="mode"]')[0].value);
  draw();
  document.documentElement.dataset.state = "ready";
} catch (error) {
  document.documentElement.dataset.state = "failed";
  byId("said").textContent = `The meshes can't be shown in 3D: ${error.message}.`;
}
