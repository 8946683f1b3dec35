// Figures that are read and zoomed: the cursor reads the curves, dragging zooms, a double click shows all of it again.
(() => {
  "use strict";
  const STEPS = 10000;
  for (const figure of document.querySelectorAll("figure[data-axes]")) {
    const all = JSON.parse(figure.dataset.axes);
    const svg = figure.querySelector("svg");
    const whole = svg.getAttribute("viewBox").split(" ").map(Number);
    const words = document.createElement("output");
    words.className = "readout";
    words.setAttribute("aria-hidden", "true");
    figure.querySelector("figcaption").before(words);
    const mark = add("path", { fill: "none", stroke: "var(--soft)", "stroke-width": 0.7, "stroke-dasharray": "3 3" });
    const frame = add("rect", { fill: "var(--sky)", "fill-opacity": 0.2, stroke: "var(--blue)", "stroke-width": 0.7, visibility: "hidden" });
    let from = null;

    function add(tag, attributes) {
      const element = document.createElementNS(svg.namespaceURI, tag);
      for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
      element.style.pointerEvents = "none";
      svg.append(element);
      return element;
    }
    // Where the pointer is, in the units of the drawing.
    function place(event) {
      const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return [point.x, point.y];
    }
    function axesAt([x, y]) {
      const [u, v] = [(x - whole[0]) / whole[2], (y - whole[1]) / whole[3]];
      return all.find(({ box }) => u >= box[0] && u <= box[2] && v >= box[1] && v <= box[3]);
    }
    const value = ([low, high, log], share) => (log ? low * (high / low) ** share : low + share * (high - low));
    const text = (number) => (number === 0 ? "0" : Number(number.toPrecision(4)).toString()).replace("-", "−").replace(".", WORDS.decimal);

    // A curve at a share of the width, by halving; null beside it.
    function at([xs, ys], share) {
      const x = share * STEPS;
      if (x < xs[0] || x > xs[xs.length - 1]) return null;
      let low = 0, high = xs.length - 1;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (xs[middle] <= x) low = middle; else high = middle;
      }
      const width = xs[high] - xs[low];
      return (ys[low] + (width ? (x - xs[low]) / width : 0) * (ys[high] - ys[low])) / STEPS;
    }
    function read(event) {
      const here = place(event), axes = axesAt(here);
      mark.setAttribute("d", "");
      words.replaceChildren();
      if (!axes) return;
      const [left, top, right, bottom] = axes.box.map((share, k) => whole[k % 2] + share * whole[2 + (k % 2)]);
      const [u, v] = [(here[0] - left) / (right - left), (bottom - here[1]) / (bottom - top)];
      mark.setAttribute("d", `M${here[0]} ${top}V${bottom}`);
      words.append(`${axes.over || "x"} ${text(value(axes.x, u))}`);
      const curves = axes.curves.map((curve) => [curve, at(curve.points, u)]).filter(([, share]) => share !== null);
      for (const [curve, share] of curves) {
        const item = document.createElement("span");
        item.style.borderColor = curve.colour;
        item.textContent = `${curve.label} ${text(value(axes.y, share))}`;
        words.append(item);
      }
      if (!curves.length) words.append(`   ${text(value(axes.y, v))}`);
    }
    function drawFrame(here) {
      const [x, y] = [Math.min(from[0], here[0]), Math.min(from[1], here[1])];
      for (const [key, number] of Object.entries({ x, y, width: Math.abs(here[0] - from[0]), height: Math.abs(here[1] - from[1]) })) frame.setAttribute(key, number);
      frame.setAttribute("visibility", "visible");
    }
    svg.addEventListener("pointermove", (event) => {
      if (from) drawFrame(place(event));
      read(event);
    });
    svg.addEventListener("pointerleave", () => {
      if (from) return;
      mark.setAttribute("d", "");
      words.replaceChildren();
    });
    svg.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse" || event.button !== 0) return;
      from = place(event);
      svg.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    svg.addEventListener("pointerup", (event) => {
      if (!from) return;
      const here = place(event);
      const [width, height] = [Math.abs(here[0] - from[0]), Math.abs(here[1] - from[1])];
      frame.setAttribute("visibility", "hidden");
      // The view keeps its shape, so that letters do.
      const share = Math.max(width / whole[2], height / whole[3]);
      if (share > 0.02) {
        const [x, y] = [(from[0] + here[0] - share * whole[2]) / 2, (from[1] + here[1] - share * whole[3]) / 2];
        svg.setAttribute("viewBox", [x, y, share * whole[2], share * whole[3]].join(" "));
      }
      from = null;
    });
    svg.addEventListener("dblclick", () => svg.setAttribute("viewBox", whole.join(" ")));
  }
})();
