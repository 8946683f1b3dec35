// The knife of a topper over the heads of a row, from above: the swept area grows, what is left uncut is hatched.
(() => {
  "use strict";
  const scene = JSON.parse(document.getElementById("topper-scene").textContent);
  const svg = document.getElementById("topper");
  const TURN = 2 * Math.PI, [first, last] = scene.span;
  const sin = Math.sin(scene.angle), cos = Math.cos(scene.angle), radius = scene.diameter / 2;

  // y points to the left of the travel: up on the page.
  const [x0, y0, x1, y1] = scene.box;
  const scale = Math.min(760 / (x1 - x0), 340 / (y1 - y0)), MARGIN = 16, FOOT = 30;
  const width = Math.max((x1 - x0) * scale, 760) + 2 * MARGIN, slack = (width - (x1 - x0) * scale) / 2;
  const height = (y1 - y0) * scale + 2 * MARGIN + FOOT;
  svg.setAttribute("viewBox", `0 0 ${width.toFixed(1)} ${height.toFixed(1)}`);
  const X = (x) => (x - x0) * scale + slack, Y = (y) => (y1 - y) * scale + MARGIN;

  function add(tag, name, attributes = {}, parent = svg) {
    const element = document.createElementNS(svg.namespaceURI, tag);
    if (name) element.setAttribute("class", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    parent.append(element);
    return element;
  }

  // The law of the knife: its phase, place and speed at a time.
  let phase = scene.phase;
  const phaseAt = (t) => (((phase + scene.rate * t) % TURN) + TURN) % TURN;
  function across(t) {
    const k = phaseAt(t) / TURN * (scene.law.length - 1), n = Math.min(Math.floor(k), scene.law.length - 2);
    return scene.law[n] + (k - n) * (scene.law[n + 1] - scene.law[n]) + scene.drift * t;
  }
  // Over one step of the law.
  const pause = scene.rate ? TURN / scene.rate / (scene.law.length - 1) : 1e-3 * (last - first);
  const speed = (t) => (across(t + pause / 2) - across(t - pause / 2)) / pause;

  // What stands still, from behind to the front.
  const defs = add("defs");
  const hatch = add("pattern", "", { id: "topper-hatch", width: 7, height: 7, patternUnits: "userSpaceOnUse",
    patternTransform: "rotate(45)" }, defs);
  add("rect", "left-back", { width: 7, height: 7 }, hatch);
  add("path", "left-line", { d: "M0 0V7" }, hatch);
  const clip = add("clipPath", "", { id: "topper-heads" }, defs);
  const sweep = add("path", "", { id: "topper-sweep" }, defs);
  const disc = ([x, y]) => ({ cx: X(x), cy: Y(y), r: radius * scale });
  for (const head of scene.heads) add("circle", "", disc(head), clip);

  if (scene.offset) {
    const lane = { x: 0, width, y: Y(scene.offset), height: 2 * scene.offset * scale };
    add("rect", "lane", lane);
  }
  add("use", "band", { href: "#topper-sweep" });
  add("path", "row", { d: `M0 ${Y(0)}H${width}` });
  const discs = scene.heads.map((head) => add("circle", "haulm", disc(head)));
  const within = add("g", "", { "clip-path": "url(#topper-heads)" });
  add("use", "under", { href: "#topper-sweep" }, within);
  add("use", "cut", { href: "#topper-sweep" }, within);
  for (const head of scene.heads) add("circle", "rim", disc(head));
  const words = scene.heads.map(([x]) => add("text", "name", { x: X(x), y: height - 12, "text-anchor": "middle" }));
  const way = add("path", "way"), guide = add("path", "guide"), edge = add("path", "edge"), middle = add("circle", "middle", { r: 4 });

  // Places of the edge over the whole way; neighbours make a slice of what it sweeps, all turning the same way.
  const turns = scene.rate * (last - first) / TURN;
  const count = Math.round(Math.min(Math.max(600, 160 * turns), 3000));
  const instants = Array.from({ length: count + 1 }, (_, n) => first + (last - first) * n / count);
  let middles = [], slices = [], left = [];
  const ends = ([x, y]) => [-0.5, 0.5].map((s) => [X(x + s * scene.length * sin), Y(y + s * scene.length * cos)]);
  const spot = ([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`;

  function slice(one, other) {
    const [a, b] = ends(one), [d, c] = ends(other);
    const turned = (c[0] - a[0]) * (b[1] - d[1]) - (c[1] - a[1]) * (b[0] - d[0]) < 0;
    return "M" + (turned ? [a, b, c, d] : [a, d, c, b]).map(spot).join("L") + "Z";
  }

  // Share of a head that is farther than half an edge from all crossings of its chords.
  const CHORDS = 3000;
  function uncut([hx, hy], places) {
    const along = places.map(([x, y]) => (x - hx) * sin + (y - hy) * cos);
    const normal = places.map(([x, y]) => (x - hx) * cos - (y - hy) * sin);
    const crossed = Array.from({ length: CHORDS }, () => []);
    // Chords lie at p = −r cos u, u in even steps, so that their number at a p is known.
    const number = (p) => Math.acos(Math.min(Math.max(-p / radius, -1), 1)) / Math.PI * CHORDS - 0.5;
    for (let n = 0; n < places.length - 1; n++) {
      const [low, high] = normal[n] < normal[n + 1] ? [normal[n], normal[n + 1]] : [normal[n + 1], normal[n]];
      if (high <= -radius || low >= radius || high === low) continue;
      for (let k = Math.max(0, Math.ceil(number(low))); k < CHORDS && k <= number(high); k++) {
        const p = -radius * Math.cos((k + 0.5) * Math.PI / CHORDS);
        const share = (p - normal[n]) / (normal[n + 1] - normal[n]);
        crossed[k].push(along[n] + share * (along[n + 1] - along[n]));
      }
    }
    let area = 0;
    for (let k = 0; k < CHORDS; k++) {
      const u = (k + 0.5) * Math.PI / CHORDS, chord = radius * Math.sin(u), half = scene.length / 2;
      let from = -chord;
      for (const q of crossed[k].sort((one, other) => one - other)) {
        area += Math.max(0, Math.min(chord, q - half) - from) * radius * Math.sin(u) * Math.PI / CHORDS;
        from = Math.max(from, Math.min(chord, q + half));
      }
      area += Math.max(0, chord - from) * radius * Math.sin(u) * Math.PI / CHORDS;
    }
    return area / (Math.PI * radius * radius);
  }

  function prepare() {
    middles = instants.map((t) => [scene.speed * t, across(t)]);
    slices = middles.slice(1).map((place, n) => slice(middles[n], place));
    // Areas ask for more places than the picture.
    const FINE = 8 * count, fine = Array.from({ length: FINE + 1 }, (_, n) => first + (last - first) * n / FINE);
    const places = fine.map((t) => [scene.speed * t, across(t)]);
    left = scene.heads.map((head) => uncut(head, places));
  }

  // The last instant at which the edge is over a head.
  const behind = ([hx, hy]) => middles.findLastIndex(([x, y]) => Math.abs((x - hx) * cos - (y - hy) * sin) < radius);

  const [play, slider, pace, turn, state] =
    ["play", "time", "pace", "phase", "state"].map((id) => document.getElementById(`topper-${id}`));
  let passed = [];

  function draw(t) {
    const done = Math.min(Math.floor((t - first) / (last - first) * count), count);
    const here = [scene.speed * t, across(t)], [a, b] = ends(here);
    sweep.setAttribute("d", slices.slice(0, done).join("") + slice(middles[done], here));
    way.setAttribute("d", "M" + [...middles.slice(0, done + 1), here].map(([x, y]) => spot([X(x), Y(y)])).join("L"));
    guide.setAttribute("d", `M${X(here[0])} ${Y(y1)}V${Y(y0)}`);
    edge.setAttribute("d", `M${spot(a)}L${spot(b)}`);
    middle.setAttribute("cx", X(here[0]));
    middle.setAttribute("cy", Y(here[1]));
    scene.heads.forEach((_, n) => {
      const over = done >= passed[n];
      discs[n].setAttribute("class", over ? "left" : "haulm");
      words[n].textContent = !over ? "" : left[n] > 5e-5 ? say("# % left", (100 * left[n]).toPrecision(3)) : say("cut");
    });
    const sign = (value, digits) => (value < 0 ? "−" : "+") + Math.abs(value).toFixed(digits);
    const knife = scene.rate ? `φ = ${(phaseAt(t) * 180 / Math.PI).toFixed(0).padStart(3, "\u2007")}°   ` : "";
    state.textContent = `${knife}y = ${decimal(sign(1e3 * here[1], 1))} ${WORDS.units.mm}   ẏ = ${decimal(sign(speed(t), 2))} ${WORDS.units["m/s"]}`;
  }

  let time = first, before = null, rest = 0;
  let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  // Seconds at the end of the row before it begins again.
  const REST = 1.5;

  function step(now) {
    if (!playing) return;
    if (before !== null) {
      const passing = Math.min(now - before, 100) / 1000;
      if (time >= last) rest += passing;
      time = Math.min(last, time + passing * (last - first) / scene.seconds * 10 ** Number(pace.value));
      if (rest > REST) [time, rest] = [first, 0];
    }
    before = now;
    slider.value = (time - first) / (last - first);
    draw(time);
    requestAnimationFrame(step);
  }
  function setPlaying(on) {
    [playing, before] = [on, null];
    if (on && time >= last) time = first;
    play.textContent = on ? say("Pause") : say("Play");
    play.setAttribute("aria-pressed", String(on));
    if (on) requestAnimationFrame(step);
  }
  function setPhase(value) {
    phase = value;
    prepare();
    passed = scene.heads.map((head) => behind(head) + 1);
    draw(time);
  }
  function setTime(share) {
    setPlaying(false);
    time = first + share * (last - first);
    slider.value = share;
    draw(time);
  }
  play.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => setTime(Number(slider.value)));
  turn.addEventListener("input", () => setPhase(Number(turn.value) * Math.PI / 180));
  if (!scene.rate) turn.parentElement.style.display = "none";

  turn.value = Math.round(scene.phase * 180 / Math.PI);
  setPhase(scene.phase);
  const slow = scene.seconds / (last - first);
  document.getElementById("topper-words").textContent =
    say("Top view; the machine travels to the right.") + " " +
    say("At the middle playback speed it is # times slower than in the field.", slow.toPrecision(2)) + " " +
    say("Green: haulm; yellow: cut; hatched: uncut.") + " " + (scene.heads.length > 1
      ? say("The head in the middle is the worst one, unless its phase is changed; all are up to # mm off the row.",
        (1e3 * scene.offset).toPrecision(3))
      : say("This head is the worst one."));
  // An address that ends in #topper=0.4 shows the place 0.4 of the way.
  const asked = /^#topper=([\d.]+)$/.exec(location.hash);
  if (asked) setTime(Math.min(Math.max(Number(asked[1]), 0), 1)); else setPlaying(playing);
})();
