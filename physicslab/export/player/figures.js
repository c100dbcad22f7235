// Energies and graphs against time, and the values of a body.

const LEFT = 46, RIGHT = 6;
let charts = [];

// The look of a line: of energies by kind, of a body's quantity in its colour.
function look(line) {
  if (line.body) {
    const body = run.bodies.find(one => one.entity === line.body);
    return { colour: body?.paint ?? colours.text, width: 2 };
  }
  const own = [colours.accent, colours.b1, colours.b2, colours.b5][(line.place ?? lines.indexOf(line)) % 4];
  return line.name === "total" ? { colour: colours.text, width: 2.6 } : { colour: own, width: 2 };
}

function ranges(all) {
  let low = Infinity, high = -Infinity;
  for (const values of all) for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (!(low <= high)) [low, high] = [0, 1];
  return [low, high > low ? high : low + (Math.abs(low) || 1)];
}

function chart(canvas, shown, across) {
  const [low, high] = ranges(shown.map(line => line.values));
  const one = { canvas, ink: canvas.getContext("2d"), shown, across, xs: across ? across.values : times };
  [one.lowest, one.highest] = across ? [low, high] : [Math.min(0, low), Math.max(0, high)];
  [one.first, one.last] = across ? ranges([across.values]) : [0, end || 1];
  const pointed = event => {
    if (!event.buttons || across) return;
    play(false);
    const share = (event.offsetX - LEFT) / (canvas.clientWidth - LEFT - RIGHT);
    seek(times[frameAt(share * end)]);
  };
  canvas.onpointerdown = canvas.onpointermove = pointed;
  return one;
}

loaders.push(() => {
  const holder = $("graphs");
  holder.replaceChildren();
  charts = [chart($("chart"), lines, null)];
  run.graphs.forEach((graph, n) => {
    const shown = graph.lines.map((k, place) => ({ ...quantities[k], dash: DASHES[place % 5], place }));
    const across = graph.across === null ? null : quantities[graph.across];
    const part = document.createElement("section"), canvas = document.createElement("canvas");
    const title = Object.assign(document.createElement("h2"), { id: `graph-${n}` });
    const units = [...new Set(shown.map(line => raised(line.unit)))].join(", ");
    title.textContent = `${say("Graph")} ${n + 1} (${units})${across ? ` ${say("against")} ${across.name} (${raised(across.unit)})` : ""}`;
    canvas.className = "chart";
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-labelledby", title.id);
    const table = document.createElement("table");
    part.append(title, canvas, table);
    holder.append(part);
    charts.push(Object.assign(chart(canvas, shown, across), { table }));
  });
});

function drawChart(one, frame) {
  const { ink, shown, xs, lowest, highest, first, last } = one;
  const [width, height] = sized(one.canvas, ink), low = height - 18, room = width - LEFT - RIGHT;
  const x = value => LEFT + room * (value - first) / (last - first);
  const y = value => low - (low - 8) * (value - lowest) / (highest - lowest);
  const line = (...points) => {
    ink.beginPath();
    for (const at of points) ink.lineTo(...at);
    ink.stroke();
  };
  const tick = nice((highest - lowest) / 2.2);
  ink.clearRect(0, 0, width, height);
  ink.font = "12px system-ui, sans-serif";
  ink.fillStyle = colours.faint;
  ink.lineWidth = 1;
  ink.textAlign = "right";
  for (let k = Math.ceil(lowest / tick); k * tick <= highest; k++) {
    ink.strokeStyle = k ? colours.line : colours.axis;
    line([LEFT, y(k * tick)], [width - RIGHT, y(k * tick)]);
    ink.fillText(short(k * tick, 2), LEFT - 6, y(k * tick) + 4);
  }
  const scale = one.across ? 0 : run.start, unit = one.across ? raised(one.across.unit) : "s";
  ink.fillText(`${short(scale + last, 4)} ${unit}`, width - RIGHT, height - 3);
  ink.textAlign = "left";
  ink.fillText(short(scale + first, 4), LEFT, height - 3);
  const stride = Math.max(1, Math.floor(COUNT / (2 * room)));
  for (const each of [...shown].reverse()) {  // the total first, below the rest
    const { colour, width: wide } = look(each), points = [];
    for (let k = 0; k < COUNT; k += stride) points.push([x(xs[k]), y(each.values[k])]);
    ink.strokeStyle = colour;
    ink.lineWidth = wide;
    ink.setLineDash(each.dash);
    line(...points, [x(xs[COUNT - 1]), y(each.values[COUNT - 1])]);
  }
  ink.setLineDash([]);
  ink.strokeStyle = ink.fillStyle = colours.text;
  ink.lineWidth = 1;
  if (!one.across) line([x(time), 2], [x(time), low]);
  else for (const each of shown) { ink.beginPath(); ink.arc(x(xs[frame]), y(each.values[frame]), 4, 0, 7); ink.fill(); }
}

// Rows of a label, drawn before it a line if it has one, and a value.
function fill(table, rows) {
  while (table.rows.length < rows.length) {
    const row = table.insertRow();
    row.insertCell();
    row.insertCell();
  }
  while (table.rows.length > rows.length) table.deleteRow(-1);
  rows.forEach(([label, value, line], i) => {
    const [first, second] = table.rows[i].cells;
    const key = label + (line ? JSON.stringify(look(line)) : "");
    if (first.dataset.key !== key) {
      first.textContent = label;
      if (line) first.prepend(sample(line));
      first.dataset.key = key;
    }
    if (second.textContent !== value) second.textContent = value;
  });
}

function sample(line) {
  const { colour, width } = look(line), holder = document.createElement("span");
  holder.innerHTML = `<svg aria-hidden="true"><path d="M0 4h30" stroke="${colour}" stroke-width="${width}"
    stroke-dasharray="${line.dash}"/></svg>`;
  return holder;
}

function showFigures(frame) {
  const digits = playing ? 4 : 7;
  const value = (amount, unit) => isNaN(amount) ? "\u2013" : `${number(amount, digits)} ${raised(unit)}`;
  fill($("legend"), lines.map(line => [say(line.name), value(line.values[frame], "J"), line]));
  fill($("momenta"), quantities.slice(0, 3).map(one => [say(one.name), value(one.values[frame], one.unit)]));
  for (const { table, shown } of charts.slice(1)) {
    fill(table, shown.map(line => [line.name, value(line.values[frame], line.unit), line]));
  }
  const crossed = run.gates.flatMap(gate => gate.crossings.map(([t, body, speed]) => [t, gate.name, body, speed]));
  const past = crossed.filter(([t]) => t <= times[frame]).sort((a, b) => a[0] - b[0]).slice(-6);
  $("gates").hidden = !run.gates.length;
  fill($("crossings"), past.length ? past.map(([t, gate, body, speed]) =>
    [`${body} ${say("through")} ${gate}, ${number(speed, 4)} m/s`, `${number(run.start + t, 7)} s`]) : [[say("nothing yet"), ""]]);
  const rows = [];
  if (selected) {
    const [x, y, angle, vx, vy, spin] = selected.at(frame), { mass, inertia } = selected;
    rows.push([say("position x"), value(x, "m")], [say("position y"), value(y, "m")], [say("angle"), value(angle, "rad")]);
    if (selected.columns) {
      rows.push([say("velocity x"), value(vx, "m/s")], [say("velocity y"), value(vy, "m/s")],
        [say("speed"), value(Math.hypot(vx, vy), "m/s")], [say("angular velocity"), value(spin, "rad/s")]);
    }
    if (selected.columns && mass) {
      const kinetic = (mass * (vx * vx + vy * vy) + inertia * spin * spin) / 2;
      rows.push([say("mass"), `${short(mass, 7)} kg`], [say("kinetic energy"), value(kinetic, "J")]);
      const potential = run.gravity && -mass * (run.gravity[0] * x + run.gravity[1] * y);
      if (run.gravity) rows.push([say("potential, 0 at the origin"), value(potential, "J")]);
    }
  }
  fill($("values"), rows);
}

function select(body) {
  selected = body;
  $("body").value = body ? run.bodies.indexOf(body) : "";
  stale = true;
}
