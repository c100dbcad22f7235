// The world as it is drawn.

const COLOURS = [
  "background", "panel", "line", "text", "faint", "accent", "grid", "axis", "static", "static-fill", "spring",
  "bounds", "arrow", "fill", "b0", "b1", "b2", "b3", "b4", "b5", "b6",
];
const world = $("world"), pen = world.getContext("2d");
let colours = {}, marks = [];

function readColours() {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(COLOURS.map(name => [name, style.getPropertyValue(`--${name}`).trim()]));
  const tile = document.createElement("canvas"), line = tile.getContext("2d");
  tile.width = tile.height = 10;
  line.fillStyle = colours["static-fill"];
  line.fillRect(0, 0, 10, 10);
  line.strokeStyle = colours.static;
  line.globalAlpha = 0.6;
  for (const shift of [-10, 0, 10]) {
    line.beginPath(); line.moveTo(shift - 1, 11); line.lineTo(shift + 11, -1); line.stroke();
  }
  colours.hatch = pen.createPattern(tile, "repeat");
  run.bodies.forEach(body => {
    const own = "mass" in body ? colours[`b${body.entity % 7}`] : colours.text;
    body.colour = body.columns ? own : colours.static;
  });
  stale = true;
}

// As many pixels as the screen has; returns the size in pixels of the page.
function sized(canvas, context) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  const across = Math.round(width * ratio), down = Math.round(height * ratio);
  if (canvas.width !== across || canvas.height !== down) { canvas.width = across; canvas.height = down; }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [width, height];
}

const toX = x => world.clientWidth / 2 + (x - camera.x) * camera.scale;
const toY = y => world.clientHeight / 2 - (y - camera.y) * camera.scale;

function fit() {
  const [x0, y0, x1, y1] = run.view;
  camera.x = (x0 + x1) / 2;
  camera.y = (y0 + y1) / 2;
  camera.scale = Math.min(world.clientWidth / (x1 - x0), world.clientHeight / (y1 - y0)) || 1;
  camera.fitted = stale = true;
}

// The point under a pixel stays there.
function zoom(factor, px, py) {
  const u = px - world.clientWidth / 2, v = world.clientHeight / 2 - py;
  const x = camera.x + u / camera.scale, y = camera.y + v / camera.scale;
  camera.scale = Math.min(Math.max(camera.scale * factor, 1e-12), 1e9);
  camera.x = x - u / camera.scale;
  camera.y = y - v / camera.scale;
  camera.fitted = false;
  stale = true;
}

function path(...points) {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
}

function written(text, x, y, align, colour) {
  pen.textAlign = align;
  pen.lineWidth = 3;
  pen.lineJoin = "round";
  pen.strokeStyle = colours.background;
  pen.strokeText(text, x, y);
  pen.fillStyle = colour;
  pen.fillText(text, x, y);
}

function drawGrid(width, height) {
  const metres = nice(160 / camera.scale), pixels = metres * camera.scale;
  pen.lineWidth = 1;
  for (let k = Math.ceil(-toX(0) / pixels), at; (at = toX(k * metres)) <= width; k++) {
    const x = Math.round(at) + 0.5;
    pen.strokeStyle = k ? colours.grid : colours.axis;
    path([x, 0], [x, height]); pen.stroke();
    if (x > 40 && x < width - 24) marks.push([short(k * metres, 7), x, height - 7, "center"]);
  }
  for (let k = Math.ceil((toY(0) - height) / pixels), at; (at = toY(k * metres)) >= 0; k++) {
    const y = Math.round(at) + 0.5;
    pen.strokeStyle = k ? colours.grid : colours.axis;
    path([0, y], [width, y]); pen.stroke();
    if (y > 18 && y < height - 22) marks.push([short(k * metres, 7), 7, y - 5, "left"]);
  }
}

// A core of vertices, counter-clockwise, rounded by a radius: an arc around each, between the normals of two faces.
function outline({ core, radius, reach, kind }, [x, y, angle], grow = 0) {
  const c = Math.cos(angle), s = Math.sin(angle);
  pen.beginPath();
  if (core.length === 1 || reach * camera.scale < 1) {
    pen.arc(toX(x), toY(y), (kind === "point" ? 5 : Math.max(reach * camera.scale, 1)) + grow, 0, 2 * Math.PI);
    return;
  }
  const normal = k => {
    const [u, v] = core[k], [p, q] = core[(k + 1) % core.length];
    return -angle - Math.atan2(u - p, q - v);
  };
  core.forEach(([u, v], k) => {
    const before = normal((k + core.length - 1) % core.length);
    pen.arc(toX(x + c * u - s * v), toY(y + s * u + c * v), radius * camera.scale + grow, before, normal(k), true);
  });
  pen.closePath();
}

function drawBody(body, at) {
  const x = toX(at[0]), y = toY(at[1]), reach = body.reach * camera.scale + 9;
  const seen = x > -reach && x < world.clientWidth + reach && y > -reach && y < world.clientHeight + reach;
  if (!seen) return;
  outline(body, at);
  pen.lineWidth = 1.8;
  pen.strokeStyle = body.colour;
  if (!body.columns && body.kind !== "point") {
    pen.fillStyle = colours.hatch;
    pen.fill(); pen.stroke();
    return;
  }
  pen.fillStyle = colours.background;
  pen.fill();
  pen.globalAlpha = body.kind === "point" ? 1 : Number(colours.fill);
  pen.fillStyle = body.colour;
  pen.fill();
  pen.globalAlpha = 1;
  pen.stroke();
  const mark = (Math.max(...body.core.map(corner => corner[0])) + body.radius) * camera.scale;
  if (mark > 7) { path([x, y], [x + mark * Math.cos(at[2]), y - mark * Math.sin(at[2])]); pen.stroke(); }
}

function ends(spring, now) {
  const place = (number, [u, v]) => {
    if (number === null) return [u, v];
    const [x, y, angle] = now(run.bodies[number]), c = Math.cos(angle), s = Math.sin(angle);
    return [x + c * u - s * v, y + s * u + c * v];
  };
  return [place(spring.a, spring.anchor_a), place(spring.b, spring.anchor_b)];
}
for (const spring of run.springs) {  // one that keeps its length is a string, and drawn straight
  const looks = Math.min(COUNT, 100);
  const lengths = Array.from({ length: looks }, (_, i) => {
    const [a, b] = ends(spring, body => body.at(Math.floor(i * COUNT / looks)));
    return Math.hypot(b[0] - a[0], b[1] - a[1]);
  });
  spring.longest = Math.max(...lengths);
  spring.straight = spring.longest - Math.min(...lengths) < 0.03 * spring.longest;
}

function drawSpring(spring, now) {
  const [a, b] = ends(spring, now).map(([x, y]) => [toX(x), toY(y)]);
  const dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy), points = [a];
  if (!spring.straight && length > 14) {
    const half = 2 * Math.round(Math.min(Math.max(spring.longest * camera.scale / 18, 4), 14));
    const along = (share, side) => [a[0] + share * dx - side * dy, a[1] + share * dy + side * dx];
    points.push(along(0.1, 0));
    const coil = k => along(0.1 + 0.8 * (k + 0.5) / half, (k % 2 ? 6 : -6) / length);
    for (let k = 0; k < half; k++) points.push(coil(k));
    points.push(along(0.9, 0));
  }
  pen.strokeStyle = pen.fillStyle = colours.spring;
  pen.lineWidth = 1.6;
  pen.lineJoin = "round";
  path(...points, b); pen.stroke();
  if (spring.b === null) { pen.beginPath(); pen.arc(...b, 4, 0, 2 * Math.PI); pen.fill(); }
}

function drawJoint(joint, now) {  // the head of a screw, whose slot turns; on a bracket where it is fixed
  const [x, y, angle] = now(run.bodies[joint.body]), [u, v] = joint.anchor;
  const c = Math.cos(angle), s = Math.sin(angle), at = [toX(x + c * u - s * v), toY(y + s * u + c * v)];
  pen.strokeStyle = colours.spring;
  pen.lineWidth = 2;
  pen.fillStyle = colours.background;
  if (joint.fixed) { pen.beginPath(); pen.rect(at[0] - 9, at[1] - 9, 18, 18); pen.fill(); pen.stroke(); }
  pen.beginPath(); pen.arc(...at, 5, 0, 2 * Math.PI); pen.fill(); pen.stroke();
  path([at[0] - 3.4 * c, at[1] + 3.4 * s], [at[0] + 3.4 * c, at[1] - 3.4 * s]); pen.stroke();
}

function drawTrail(body, frame, at) {
  const first = frameAt(time - (body.trail ?? Math.min(2 * natural, end / 3))), [xs, ys] = body.columns;
  pen.strokeStyle = body.colour;
  pen.lineWidth = 2;
  pen.lineJoin = "round";
  for (let part = 0; part < 8; part++) {  // fainter the longer ago
    const from = first + Math.floor((frame - first) * part / 8);
    const to = first + Math.floor((frame - first) * (part + 1) / 8);
    pen.globalAlpha = (part + 1) / 10;
    pen.beginPath();
    for (let k = from; k <= to; k++) pen.lineTo(toX(xs[k]), toY(ys[k]));
    if (part === 7) pen.lineTo(toX(at[0]), toY(at[1]));
    pen.stroke();
  }
  pen.globalAlpha = 1;
}

// An arrow is the way of so many seconds, such that the usual speed has an arrow of usual length.
const looks = Array.from({ length: 20 }, (_, i) => Math.floor(i * COUNT / 20));
const speeds = movers.flatMap(body => looks.map(frame => Math.hypot(...body.at(frame).slice(3, 5))));
speeds.sort((a, b) => a - b);
const extent = Math.max(run.view[2] - run.view[0], run.view[3] - run.view[1]);
const arrowSeconds = nice(0.12 * extent / (speeds[Math.floor(0.95 * speeds.length)] || 1));

function drawArrow([x, y, , vx, vy]) {
  const scale = arrowSeconds * camera.scale, dx = vx * scale, dy = -vy * scale, length = Math.hypot(dx, dy);
  if (!(length > 5)) return;
  const head = Math.min(9, 0.6 * length) / length, tip = [toX(x) + dx, toY(y) + dy];
  const neck = [tip[0] - head * dx, tip[1] - head * dy], u = head * dx / 2, v = head * dy / 2;
  pen.strokeStyle = pen.fillStyle = colours.arrow;
  pen.lineWidth = 2.4;
  path([toX(x), toY(y)], neck); pen.stroke();
  path(tip, [neck[0] - v, neck[1] + u], [neck[0] + v, neck[1] - u]); pen.fill();
}

// Names above bodies; one that another is in the way of goes higher.
function drawNames(now) {
  const taken = [], overlaps = (one, other) =>
    Math.abs(one.x - other.x) < one.half + other.half && Math.abs(one.y - other.y) < 15;
  const wanted = show.names ? movers.filter(body => body.named || !named) : [];
  for (const body of new Set([...(selected ? [selected] : []), ...wanted])) {
    if (body.kind === "none") continue;
    const at = now(body), above = body.columns ? body.half * camera.scale + 9 : 0;
    const wide = pen.measureText(body.name).width / 2 + 4;
    const label = { x: toX(at[0]), y: Math.max(toY(at[1]) - above, 16), half: wide };
    for (let i = 0; i < 3 && taken.some(other => overlaps(label, other)); i++) label.y -= 16;
    taken.push(label);
    written(body.name, label.x, label.y, "center", colours.text);
  }
}

function drawWorld(frame, share) {
  const [width, height] = sized(world, pen), poses = new Map();
  const now = body => poses.get(body) ?? poses.set(body, pose(body, frame, share)).get(body);
  pen.fillStyle = colours.background;
  pen.fillRect(0, 0, width, height);
  marks = [];
  if (show.grid) drawGrid(width, height);
  if (run.bounds) {
    const [x0, y0, x1, y1] = run.bounds;
    pen.strokeStyle = colours.bounds;
    pen.lineWidth = 2;
    pen.strokeRect(toX(x0), toY(y1), (x1 - x0) * camera.scale, (y1 - y0) * camera.scale);
  }
  colours.hatch.setTransform(new DOMMatrix().translate(toX(0) % 10, toY(0) % 10));
  for (const body of drawn) if (!body.columns) drawBody(body, now(body));
  const trailed = body => show.trails && (movers.length <= 200 || body === selected);
  for (const body of movers) if (trailed(body)) drawTrail(body, frame, now(body));
  for (const spring of run.springs) drawSpring(spring, now);
  for (const body of drawn) if (body.columns) drawBody(body, now(body));
  for (const joint of run.joints) drawJoint(joint, now);
  if (show.arrows) for (const body of movers) drawArrow(now(body));
  if (selected) {
    outline(selected, now(selected), 4);
    pen.strokeStyle = colours.text;
    pen.lineWidth = 2;
    pen.setLineDash([5, 3]); pen.stroke(); pen.setLineDash([]);
  }
  pen.font = "12px system-ui, sans-serif";
  for (const mark of marks) written(...mark, colours.faint);
  pen.font = "13px system-ui, sans-serif";
  drawNames(now);
  const scale = [show.grid && "axes in metres", show.arrows && `arrows: path in ${short(arrowSeconds, 1)} s`];
  $("scale").textContent = scale.filter(Boolean).join("; ");
}
