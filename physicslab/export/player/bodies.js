// Bodies, in the colours and the light of the window.

const law = given.look, world = $("world"), pen = world.getContext("2d");
const darkly = matchMedia("(prefers-color-scheme: dark)");
let colours = {}, hatch;

// A share of one colour "#rrggbb" laid on another.
function mixed(under, over, share) {
  const part = (colour, at) => parseInt(colour.slice(at, at + 2), 16);
  return "#" + [1, 3, 5].map(at => {
    const whole = Math.round(part(under, at) + share * (part(over, at) - part(under, at)));
    return whole.toString(16).padStart(2, "0");
  }).join("");
}

function readColours() {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(law.colours.map(name => [name, style.getPropertyValue(`--${name}`).trim()]));
  const tile = document.createElement("canvas"), line = tile.getContext("2d"), side = law.hatch_spacing;
  tile.width = tile.height = side;
  line.globalAlpha = law.hatch;
  line.fillStyle = colours.static;
  line.fillRect(side / 2 - 0.75, 0, 1.5, side);
  hatch = pen.createPattern(tile, "repeat");
  if (run) paintBodies();
  stale = true;
}

// A body has a colour of its own, or that of its number, as in the window; light falls on it from above.
function paintBodies() {
  const points = drawn.filter(body => body.kind === "point");
  const heaviest = Math.max(...points.map(body => body.mass ?? 0)), all = points.reduce((sum, body) => sum + (body.mass ?? 0), 0);
  for (const body of run.bodies) {
    const ground = !body.columns && !body.fluid && !body.colour && body.kind !== "point", point = body.kind === "point";
    const own = colours["mass" in body || point ? `b${body.entity % law.bodies}` : "kinematic"];
    body.paint = body.colour ?? (body.fluid ? colours.fluid : ground ? colours.static : own);
    body.rim = body.edges && !point ? body.edges[darkly.matches ? 0 : 1] : body.paint;
    body.star = run.space && point && body.mass > law.star * (all - body.mass);
    if (body.star) body.paint = body.rim = colours.spark;
    const fill = ground ? colours.earth : body.colour || point ? body.paint
      : body.fluid ? colours.within_fluid : mixed(colours.background, body.paint, law.fill);
    const flat = body.fluid || body.star || point && !run.space, light = ground ? fill : mixed(fill, "#ffffff", law.bright);
    const shade = mixed(fill, "#000000", ground ? law.dim_deep : law.dim);
    body.light = flat ? [fill] : body.core.length > 1 ? [light, shade] : [0, 1, 2, 3, 4].map(k => mixed(light, shade, k * k / 16));
    body.size = point && run.space && heaviest > 0
      ? Math.max(law.planet * Math.cbrt((body.mass ?? 0) / heaviest), law.least_planet) : law.point_radius;
    body.ground = ground;
  }
}
loaders.push(paintBodies);

// A core of vertices, counter-clockwise, rounded by a radius: an arc around each, between the normals of two faces.
function outline({ core, radius, reach, kind, size }, [x, y, angle], grow = 0) {
  const c = Math.cos(angle), s = Math.sin(angle);
  pen.beginPath();
  if (core.length === 1 || reach * camera.scale < 1) {
    pen.arc(toX(x), toY(y), Math.max((kind === "point" ? size : Math.max(reach * camera.scale, 1)) + grow, 0), 0, 2 * Math.PI);
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

// The half extents of a body up and across [px].
function extents({ core, radius, kind, size }, angle) {
  if (kind === "point") return [size, size];
  const c = Math.cos(angle), s = Math.sin(angle);
  const most = far => (Math.max(...core.map(far)) + radius) * camera.scale;
  return [most(([u, v]) => Math.abs(s * u + c * v)), most(([u, v]) => Math.abs(c * u - s * v))];
}
function isSeen(body, at) {
  const x = toX(at[0]), y = toY(at[1]), reach = Math.max(body.reach * camera.scale, body.size) + 9;
  return x > -reach && x < world.clientWidth + reach && y > -reach && y < world.clientHeight + reach;
}

function drawShadows(bodies, now) {
  const [dark, light] = law.shadows, ratio = pen.getTransform().a;
  if (bodies.length > law.max_shadows) return;
  pen.shadowColor = `rgb(0 0 0 / ${darkly.matches ? dark : light})`;
  pen.shadowBlur = law.shadow_soft * ratio;
  pen.shadowOffsetY = law.shadow_down * ratio;
  for (const body of bodies) {
    const at = now(body);
    if (body.fluid || body.kind === "point" || !isSeen(body, at)) continue;
    if (Math.min(...extents(body, at[2])) < law.shadow_from) continue;
    outline(body, at);
    pen.fillStyle = body.light[0];
    pen.fill();
  }
  pen.shadowColor = "transparent";
}

// What light makes of a body: a round one is brightest at its upper left, any other at its top.
function lit({ light, core, ground }, x, y, up) {
  if (light.length < 2) return light[0];
  const u = x - law.light_x * up, v = y - law.light_y * up, depth = ground ? Math.max(law.deep, 2 * up) : 2 * up;
  const made = core.length > 1 ? pen.createLinearGradient(0, y - up, 0, y - up + depth)
    : pen.createRadialGradient(u, v, 0, u, v, Math.sqrt(law.light_reach) * up);
  light.forEach((colour, k) => made.addColorStop(k / (light.length - 1), colour));
  return made;
}
function hatched(x, y, angle) {
  hatch.setTransform(new DOMMatrix().translate(x, y).rotate(45 - angle * 180 / Math.PI));
  pen.fillStyle = hatch;
  pen.fill();
}

function drawBody(body, at) {
  if (!isSeen(body, at)) return;
  const x = toX(at[0]), y = toY(at[1]), [up, across] = extents(body, at[2]);
  const rim = Math.min(law.rim, 0.35 * Math.min(up, across)), round = body.core.length === 1;
  if (body.star && darkly.matches) drawGlow(x, y, body.size);
  outline(body, at);
  pen.fillStyle = lit(body, x, y, up);
  pen.fill();
  if (body.ground) hatched(x, y, at[2]);
  if (round) outline(body, at, -rim / 2);
  pen.lineWidth = rim;
  pen.lineJoin = "miter";
  pen.strokeStyle = body.rim;
  pen.stroke();
  if (body.charge) written(body.charge > 0 ? "+" : "\u2212", x, y + 5, "center", colours.text);
  else if (round && body.kind !== "point" && !body.ground && !body.fluid && up >= law.wedge_from) {
    const half = law.wedge * (1 + 3 / up);
    path([x, y]);
    pen.arc(x, y, law.wedge_reach * up, -at[2] - half, -at[2] + half);
    pen.closePath();
    pen.fillStyle = `rgb(255 255 255 / ${law.wedge_share})`;
    pen.fill();
  }
}

function drawGlow(x, y, size) {
  pen.globalCompositeOperation = "lighter";
  for (const [share, strength] of law.glows) {
    const reach = share * law.glow * size, light = pen.createRadialGradient(x, y, 0, x, y, reach);
    for (const part of [0, 0.25, 0.5, 0.75, 1]) {
      light.addColorStop(part, mixed("#000000", colours.spark, strength * (1 - part) ** 2));
    }
    pen.fillStyle = light;
    pen.fillRect(x - reach, y - reach, 2 * reach, 2 * reach);
  }
  pen.globalCompositeOperation = "source-over";
}

// Beyond the bounds: all is ground below where things fall to; thin walls.
function drawBounds([x0, y0, x1, y1], across, down) {
  const [left, right, top, bottom] = [toX(x0), toX(x1), toY(y1), toY(y0)];
  const wall = law.wall, isGround = run.gravity && run.gravity[1] < 0;
  const below = isGround
    ? [0, bottom, across, Math.max(down - bottom, 0)]
    : [left - wall, bottom, right - left + 2 * wall, wall];
  for (const [x, y, width, height] of [
    [left - wall, top, wall, bottom - top], [right, top, wall, bottom - top],
    [left - wall, top - wall, right - left + 2 * wall, wall], below,
  ]) {
    pen.beginPath();
    pen.rect(x, y, width, height);
    pen.fillStyle = colours.earth;
    pen.fill();
    hatched(x + width / 2, y + height / 2, 0);
  }
  pen.strokeStyle = colours.static;
  pen.lineWidth = 1.5;
  pen.strokeRect(left, top, right - left, bottom - top);
}
