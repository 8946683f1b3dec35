// The moving sketch: draws the parts of #scene at an instant, and lets the instant go on with the machine's own time.
(() => {
  "use strict";
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const svg = document.getElementById("sketch");
  const COLOURS = ["--blue", "--red", "--green", "--purple", "--orange", "--sky"];
  const last = scene.times.length - 1;
  const duration = scene.times[last];

  // A page's worth of units across, whatever the size of the machine; y points up in the machine, down on the page.
  const [left, bottom, right, top_] = scene.box;
  const scale = Math.min(640 / Math.max(right - left, 1e-9), 330 / Math.max(top_ - bottom, 1e-9));
  const MARGIN = 70;
  const width = Math.max((right - left) * scale, 200) + 2 * MARGIN;
  const height = (top_ - bottom) * scale + 2 * MARGIN;
  const slack = (width - (right - left) * scale) / 2;
  svg.setAttribute("viewBox", `0 0 ${width.toFixed(1)} ${height.toFixed(1)}`);
  const place = (x, y) => [(x - left) * scale + slack, (top_ - y) * scale + MARGIN];

  function add(tag, name, attributes = {}) {
    const element = document.createElementNS(svg.namespaceURI, tag);
    element.setAttribute("class", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    svg.append(element);
    return element;
  }

  // Where a point is at k, a place in the tables that may lie between two entries.
  function at(name, k) {
    const [xs, ys] = scene.points[name];
    const n = Math.min(Math.floor(k), last - 1), z = k - n;
    return place(xs[n] + z * (xs[n + 1] - xs[n]), ys[n] + z * (ys[n + 1] - ys[n]));
  }

  // Angle of a link at k, on the page in degrees: turned the other way, since y points down there.
  function turned(link, angle, k) {
    const values = link ? scene.headings[link] : null;
    const n = Math.min(Math.floor(k), last - 1);
    const own = values ? values[n] + (k - n) * (values[n + 1] - values[n]) : 0;
    return -(own + angle) * 180 / Math.PI;
  }

  // Moves a drawing made about the origin, along +x, to a point and turns it with a link.
  function carry(element, part, angle = 0) {
    return (k) => element.setAttribute("transform",
      `translate(${at(part.at, k).join(" ")}) rotate(${turned(part.link, angle, k)})`);
  }

  const colour = (part) => `var(${COLOURS[part.series % COLOURS.length]})`;
  const WIDTHS = { crank: 9, cable: 2.5, arm: 5 };

  // Names that the file does not give have their words in the language of the page.
  const labels = new Map(Object.entries(scene.labels ?? {}));
  const label = (part) => labels.get(part.name) ?? part.name;

  function title(element, text) {
    const words = document.createElementNS(svg.namespaceURI, "title");
    words.textContent = text;
    element.append(words);
  }

  function hatch(x, y, length, turn) {
    const lines = [];
    for (let s = -length / 2; s <= length / 2 + 0.01; s += 8) lines.push(`M${s} 0l-6 8`);
    add("path", "hatch", { d: lines.join(""), transform: `translate(${x} ${y}) rotate(${turn})` });
  }

  // Each maker draws a part once and gives back what moves it, if it moves.
  const makers = {
    guide(part) {
      const [a, b] = part.ends.map(([x, y]) => place(x, y));
      const turn = -part.angle * 180 / Math.PI;
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) + 76;
      const [x, y] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
      const offset = `translate(${x} ${y}) rotate(${turn}) translate(0 16)`;
      add("path", "guide", { d: `M${-length / 2} 0H${length / 2}`, transform: offset, "stroke-width": 1.5 });
      const radians = turn * Math.PI / 180;
      hatch(x - 16 * Math.sin(radians), y + 16 * Math.cos(radians), length, turn);
    },
    ground(part) {
      const [x, y] = at(part.name, 0);
      add("path", "ground", { d: `M${x} ${y}l-13 22h26z`, "stroke-width": 1.5 });
      hatch(x, y + 22, 38, 0);
      const words = add("text", "name", { x: x + 16, y: y + 18 });
      words.textContent = label(part);
    },
    trace(part) {
      const points = scene.points[part.name][0].map((_, k) => at(part.name, k).map((v) => v.toFixed(1)).join(" "));
      add("path", "trace", { d: "M" + points.join("L"), "stroke-width": 1.2 });
    },
    rail(part) {
      const [a, b] = part.span.map((s) => s * scale), y = -part.offset * scale;
      const d = [-9, 9].map((side) => `M${a - 16} ${y + side}H${b + 16}`).join("");
      return carry(add("path", "link", { d, stroke: colour(part), fill: "none", "stroke-width": 2 }), part, part.angle);
    },
    slot(part) {
      const group = add("g", "slot");
      const y = -part.offset * scale, [a, b] = part.bar.map((s) => s * scale), [c, d] = part.span.map((s) => s * scale);
      const bar = add("path", "link", { d: `M${a} ${y}H${b}`, stroke: colour(part), "stroke-width": 20 });
      const gap = add("path", "link gap", { d: `M${c} ${y}H${d}`, "stroke-width": 12 });
      const foot = add("path", "link", { d: `M0 0V${y}`, stroke: colour(part), "stroke-width": 6 });
      group.append(bar, gap, foot);
      title(bar, label(part));
      return carry(group, part, part.angle);
    },
    gear(part) {
      const r = part.radius * scale;
      const wheel = add("g", "gear");
      wheel.append(add("circle", "pitch", { r, stroke: colour(part) }));
      if (part.link) wheel.append(add("path", "pitch", { d: `M0 0H${r}`, stroke: colour(part) }));
      title(wheel, label(part));
      return carry(wheel, part);
    },
    cam(part) {
      const group = add("g", "cam");
      for (const [n, outline] of part.outlines.entries()) {
        const d = "M" + outline.map(([x, y]) => `${(x * scale).toFixed(2)} ${(-y * scale).toFixed(2)}`).join("L") + "Z";
        const look = n ? { fill: "none" } : { fill: colour(part) };
        group.append(add("path", "outline", { d, stroke: colour(part), ...look }));
      }
      const [x, y] = part.outlines[0][0];
      group.append(add("path", "mark", { d: `M0 0L${x * scale} ${-y * scale}`, stroke: colour(part) }));
      title(group, label(part));
      return carry(group, part, part.angle);
    },
    roller(part) {
      const group = add("g", "roller"), [x, y] = [part.place[0] * scale, -part.place[1] * scale];
      rod(group, part, x, y);
      group.append(add("circle", "roll", { cx: x, cy: y, r: Math.max(part.radius * scale, 4), stroke: colour(part) }));
      title(group, label(part));
      return carry(group, part, part.angle);
    },
    face(part) {
      const group = add("g", "face"), [x, y] = [part.place[0] * scale, -part.place[1] * scale];
      const [c, s] = [Math.cos(part.along), -Math.sin(part.along)], [a, b] = part.ends.map((end) => end * scale);
      rod(group, part, x, y);
      const d = `M${x + a * c} ${y + a * s}L${x + b * c} ${y + b * s}`;
      group.append(add("path", "link", { d, stroke: colour(part), "stroke-width": 5 }));
      title(group, label(part));
      return carry(group, part, part.angle);
    },
    belt(part) {
      const path = add("path", "belt");
      title(path, label(part));
      return (k) => path.setAttribute("d", belt(at(part.from, k), at(part.to, k), part.radii.map((r) => r * scale), part.crossed));
    },
    rack(part) {
      const [a, b] = part.span.map((s) => s * scale), side = part.side === "right" ? 8 : -8;
      let d = `M${a - 30} ${side}H${b + 30}`;
      for (let s = a - 30; s <= b + 30; s += 10) d += `M${s} ${side}V0`;
      const bar = add("path", "link", { d, stroke: colour(part), fill: "none", "stroke-width": 2.5 });
      title(bar, label(part));
      return carry(bar, part, part.angle);
    },
    arc(part) {
      const r = part.radius * scale, [low, high] = part.span;
      const end = (a) => `${(r * Math.cos(a)).toFixed(2)} ${(-r * Math.sin(a)).toFixed(2)}`;
      const d = `M${end(low)}A${r} ${r} 0 ${high - low > Math.PI ? 1 : 0} 0 ${end(high)}`;
      const curve = add("path", "link", { d, stroke: colour(part), fill: "none", "stroke-width": 6 });
      title(curve, label(part));
      // The arc is part of its link.
      const sector = add("path", "plate", { d: `${d}L0 0Z`, fill: colour(part), stroke: colour(part) });
      const [carrySector, carryCurve] = [carry(sector, part), carry(curve, part)];
      return (k) => [carrySector(k), carryCurve(k)];
    },
    link(part) {
      const line = add("line", "link", { stroke: colour(part), "stroke-width": WIDTHS[part.role] ?? 6 });
      title(line, label(part));
      return (k) => ends(line, at(part.from, k), at(part.to, k));
    },
    plate(part) {
      const plate = add("polygon", "plate", { fill: colour(part), stroke: colour(part) });
      return (k) => plate.setAttribute("points", part.corners.map((name) => at(name, k).join(" ")).join(" "));
    },
    spring(part) {
      const path = add("path", "spring", { "stroke-width": 2 });
      title(path, label(part));
      return (k) => path.setAttribute("d", coil(at(part.from, k), at(part.to, k)));
    },
    rods(part) {
      const { heights, shares } = scene.rods, count = scene.times.length, half = part.half * scale;
      const [x, top] = place(part.x, part.top), [foot, head] = part.barrel.map((y) => place(0, y)[1]);
      add("path", "ground", { d: [-half, half].map((side) => `M${x + side} ${top}V${head}`).join(""), "stroke-width": 1.2 });
      add("path", "barrel", { d: `M${x - 0.6 * half} ${head}V${foot}H${x + 0.6 * half}V${head}`, "stroke-width": 2 });
      hatch(x, top, 6 * half, 0);
      // The colour of high stress over that of low stress, more or less opaque.
      const mixed = (width) => ["--blue", "--red"].map((name) => add("path", "rod", { stroke: `var(${name})`, "stroke-width": width }));
      const rods = part.wide.slice(1).map((_, n) => mixed(6 * part.wide[n]));
      const plunger = add("rect", "block", { x: x - 0.45 * half, width: 0.9 * half, height: 1.8 * half, stroke: "var(--ink)", "stroke-width": 1.5 });
      const right = x + 2 * half, low = top + 8 * half;
      for (let n = 0; n < 12; n++) {
        for (const [k, step] of mixed(6).entries()) {
          step.setAttribute("d", `M${right} ${low - n * half / 2}v${-half / 2}`);
          if (k) step.setAttribute("stroke-opacity", n / 11);
        }
      }
      const [unit, size] = scene.stress_unit;
      for (const [n, value] of part.range.entries()) {
        const words = add("text", "name", { x: right + 8, y: (n ? low - 6 * half : low) + 4 });
        words.textContent = `${decimal(Number((value / size).toPrecision(3)).toString().replace("-", "−"))} ${WORDS.units[unit] ?? unit}`;
      }
      return (k) => {
        const at = (values, n) => between(values.slice(n * count, (n + 1) * count), k);
        const ys = part.wide.map((_, n) => place(0, at(heights, n))[1]);
        for (const [n, both] of rods.entries()) {
          for (const line of both) line.setAttribute("d", `M${x} ${ys[n]}V${ys[n + 1]}`);
          both[1].setAttribute("stroke-opacity", (at(shares, n) + at(shares, n + 1)) / 2);
        }
        plunger.setAttribute("y", ys[ys.length - 1] - 0.9 * half);
      };
    },
    slider(part) {
      const size = part.heavy ? [44, 30] : [30, 22];
      const box = { x: -size[0] / 2, y: -size[1] / 2, width: size[0], height: size[1], rx: 3, "stroke-width": 3 };
      const block = add("rect", "block", { ...box, stroke: colour(part) });
      title(block, label(part));
      return carry(block, part, part.angle);
    },
    mass(part) {
      const dot = add("circle", "mass", part.place
        ? { r: 4, cx: part.place[0] * scale, cy: -part.place[1] * scale } : { r: 9 });
      title(dot, label(part));
      return carry(dot, part);
    },
    point(part) {
      const joint = add("circle", "joint", { r: 5, "stroke-width": 2 });
      title(joint, label(part));
      const words = add("text", "name");
      words.textContent = label(part);
      // Above a block; else beside the joint, away from the middle of the drawing.
      if (!part.slides) words.setAttribute("text-anchor", "middle");
      function aside(x, y) {
        if (part.slides) return [-16, -24 - 15 * part.series];
        const [dx, dy] = [x - width / 2, y - height / 2], r = Math.hypot(dx, dy) || 1;
        return [(dx / r) * (12 + 4 * label(part).length), (dy / r) * 16 + 4];
      }
      return (k) => {
        const [x, y] = at(part.name, k);
        centre(joint, [x, y]);
        const [right, down] = aside(x, y);
        words.setAttribute("x", x + right);
        words.setAttribute("y", y + down);
      };
    },
  };

  // The rod that holds what touches a cam; an arm is drawn as a link of its own.
  function rod(group, part, x, y) {
    if (!part.rod) return;
    const d = `M${x} ${y}L${part.rod[0] * scale} ${-part.rod[1] * scale}`;
    group.append(add("path", "link", { d, stroke: colour(part), "stroke-width": 6 }));
  }
  function ends(line, [x1, y1], [x2, y2]) {
    for (const [key, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(key, value);
  }
  function centre(circle, [x, y]) {
    circle.setAttribute("cx", x);
    circle.setAttribute("cy", y);
  }
  // Two straight runs between pulleys: along the outside, or crossing between the axes.
  function belt([x1, y1], [x2, y2], [r1, r2], crossed) {
    const distance = Math.hypot(x2 - x1, y2 - y1), line = Math.atan2(y2 - y1, x2 - x1);
    const lean = Math.acos((crossed ? r1 + r2 : r1 - r2) / distance);
    return [lean, -lean].map((a) => {
      const [c, s] = [Math.cos(line + a), Math.sin(line + a)], far = crossed ? -r2 : r2;
      return `M${x1 + r1 * c} ${y1 + r1 * s}L${x2 + far * c} ${y2 + far * s}`;
    }).join("");
  }
  function coil([x1, y1], [x2, y2]) {
    const length = Math.hypot(x2 - x1, y2 - y1) || 1, [nx, ny] = [-(y2 - y1) / length, (x2 - x1) / length];
    const zigzag = Array.from({ length: 13 }, (_, n) => {
      const side = n < 2 || n > 10 ? 0 : (n % 2 ? 9 : -9), z = n / 12;
      return `${x1 + z * (x2 - x1) + side * nx} ${y1 + z * (y2 - y1) + side * ny}`;
    });
    return "M" + zigzag.join("L");
  }

  const movers = scene.parts.map((part) => makers[part.kind](part)).filter(Boolean);
  const [play, angle, pace, state] = ["play", "angle", "pace", "state"].map((id) => document.getElementById(id));

  // Place in the tables of an instant, by halving.
  function index(time) {
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (scene.times[middle] <= time) low = middle; else high = middle;
    }
    return low + (time - scene.times[low]) / (scene.times[high] - scene.times[low]);
  }
  function between(values, k) {
    const n = Math.min(Math.floor(k), last - 1);
    return values[n] + (k - n) * (values[n + 1] - values[n]);
  }
  function draw(k) {
    for (const move of movers) move(k);
    const counted = (between(scene.angles, k) - scene.angle_zero) * 180 / Math.PI;
    const degrees = scene.angle_zero ? (counted % 360 + 360) % 360 : counted % 360;
    const [unit, size] = scene.speed_unit;
    const speed = between(scene.speeds, k) / size;
    const words = `φ = ${degrees.toFixed(0).padStart(3, "\u2007")}°`;
    state.textContent = scene.true_speed ? `${words}   ω = ${decimal(speed.toPrecision(4))} ${WORDS.units[unit] ?? unit}` : words;
  }

  // One revolution in two seconds at the middle of the slider, or in its own time if that is longer and still watchable.
  const usual = Math.min(Math.max(duration, 2), 8);
  let time = 0, way = 1, before = null;
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let playing = !still;

  function step(now) {
    if (playing) {
      if (before !== null) {
        time += way * Math.min(now - before, 100) / 1000 * (duration / usual) * 10 ** Number(pace.value);
      }
      before = now;
      if (scene.swings && (time >= duration || time <= 0)) {
        way = time <= 0 ? 1 : -1;
        time = Math.min(Math.max(time, 0), duration);
      }
      if (!scene.swings) time %= duration;
      const k = index(time);
      angle.value = k / last;
      draw(k);
      requestAnimationFrame(step);
    }
  }
  function setPlaying(on) {
    playing = on;
    before = null;
    play.textContent = on ? say("Pause") : say("Play");
    play.setAttribute("aria-pressed", String(on));
    if (on) requestAnimationFrame(step);
  }
  play.addEventListener("click", () => setPlaying(!playing));
  angle.addEventListener("input", () => {
    setPlaying(false);
    const k = Number(angle.value) * last;
    time = between(scene.times, k);
    draw(k);
  });

  const shown = usual / duration;
  const factor = shown > 1.05 ? say("# times slower than the machine", shown.toPrecision(2)) : say("as fast as the machine");
  const below = scene.parts.some(({ kind }) => kind === "rods") ? ` ${say("Displacements of the rods are to scale, their depth is shortened; colour: stress.")}` : "";
  document.getElementById("sketch-words").textContent = (scene.true_speed
    ? say("Speed of steady motion; at the middle playback speed #. Dots: centres of mass.", factor)
    : scene.swings
      ? say("The mechanism does not close over the whole revolution: it oscillates within its range. Dots: centres of mass.")
      : say("Drawn at constant speed. Dots: centres of mass.")) + below;
  draw(0);
  setPlaying(playing);
})();
