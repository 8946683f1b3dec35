// Plots as files: CSV, PNG, SVG.
import { blank } from "./frame.js";
import { number } from "./units.js";

/** @param {Blob} blob @param {string} name */
export function download(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name.replace(/[^\p{L}\p{N}_.-]+/gu, "_");
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** @param {string} cell */
const quoted = (cell) => (/[",\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell);

/** @param {Sheet} sheet */
export function csv({ heads, rows }) {
  const lines = Array.from({ length: rows[0].length }, (_, n) => rows.map((row) => (Number.isFinite(row[n]) ? String(row[n]) : "")).join(","));
  return `${heads.map(quoted).join(",")}\n${lines.join("\n")}\n`;
}

const escaped = (/** @type {string} */ text) => text.replace(/[&<>"]/g, (letter) => /** @type {any} */ ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[letter]);

/** Round numbers between two ends. @param {number} low @param {number} high @param {number} [most] */
export function ticks(low, high, most = 6) {
  const raw = (high - low) / most || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((each) => each * power >= raw) ?? 10);
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.max(0, Math.floor(high / step + 1e-9) - first) + 1;
  return Array.from({ length: count }, (_, n) => (first + n) * step);
}

/** A plot as an SVG of its own, with axes, curves and a legend. @param {Sheet} sheet @param {string[]} colours */
export function svg({ title, heads, rows, isToScale = false, isPairs = false }, colours) {
  const [width, height, left, top, right, bottom] = [720, 420, 80, 46 + 16 * Math.floor((heads.length - 2) / 4), 20, 54];
  // Of cards every load has its own positions.
  const [across, ys] = isPairs ? [0, 1].map((side) => rows.filter((_, n) => n % 2 === side)) : [[rows[0]], rows.slice(1)];
  const places = across.flatMap((row) => Array.from(row));
  const all = ys.flatMap((row) => Array.from(row).filter(Number.isFinite));
  let [x0, x1] = [Math.min(...places), Math.max(...places)];
  const pad = 0.05 * (Math.max(...all) - Math.min(...all)) || 1;
  let [y0, y1] = [Math.min(...all) - pad, Math.max(...all) + pad];
  if (isToScale) {
    const [wide, high] = [width - left - right, height - top - bottom];
    const size = Math.max((x1 - x0) / wide, (y1 - y0) / high);
    [x0, x1] = [(x0 + x1 - size * wide) / 2, (x0 + x1 + size * wide) / 2];
    [y0, y1] = [(y0 + y1 - size * high) / 2, (y0 + y1 + size * high) / 2];
  }
  const X = (/** @type {number} */ x) => left + ((x - x0) / (x1 - x0 || 1)) * (width - left - right);
  const Y = (/** @type {number} */ y) => height - bottom - ((y - y0) / (y1 - y0)) * (height - top - bottom);
  const grid = [
    ...ticks(x0, x1, 8).map((x) => `<path d="M${X(x)} ${top}V${height - bottom}" stroke="#d9dde2"/><text x="${X(x)}" y="${height - bottom + 18}" text-anchor="middle">${number(x, 4)}</text>`),
    ...ticks(y0, y1).map((y) => `<path d="M${left} ${Y(y)}H${width - right}" stroke="#d9dde2"/><text x="${left - 8}" y="${Y(y) + 4}" text-anchor="end">${number(y, 4)}</text>`),
  ];
  const curves = ys.map((row, n) => {
    const xs = across[n] ?? across[0];
    let move = "M";
    const path = Array.from(row, (y, k) => {
      if (!Number.isFinite(y)) return (move = "M"), "";
      const word = `${move}${X(xs[k]).toFixed(2)} ${Y(y).toFixed(2)}`;
      move = "L";
      return word;
    }).join("");
    return `<path d="${path}" fill="none" stroke="${colours[n % colours.length]}" stroke-width="2"/>`;
  });
  const legend = (isPairs ? heads.filter((_, n) => n % 2) : heads.slice(1)).map((head, n) => `<text x="${left + (n % 4) * 160}" y="${36 + 16 * Math.floor(n / 4)}" fill="${colours[n % colours.length]}">${escaped(head)}</text>`);
  const words = `<text x="${left}" y="20" font-size="15" font-weight="600">${escaped(title)}</text><text x="${(left + width - right) / 2}" y="${height - 12}" text-anchor="middle">${escaped(heads[0])}</text>`;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif" font-size="12" fill="#1d2329"><rect width="${width}" height="${height}" fill="#fff"/>${grid.join("")}${curves.join("")}${words}${legend.join("")}</svg>`;
}

/** The canvas of a plot on its paper. @param {HTMLCanvasElement} canvas @param {string} title @param {string[]} names @param {Record<string, any>} colours @returns {Promise<Blob>} */
export function png(canvas, title, names, { paper, ink, series }) {
  const ratio = devicePixelRatio || 1;
  const [wide, top] = [canvas.width / ratio, 28 + 16 * Math.ceil(names.length / 4)];
  const whole = document.createElement("canvas");
  const ctx = blank(whole, wide, canvas.height / ratio + top);
  ctx.fillStyle = paper;
  ctx.fillRect(0, 0, wide, whole.height);
  ctx.fillStyle = ink;
  ctx.font = "600 14px system-ui, sans-serif";
  ctx.fillText(title, 10, 20, wide - 20);
  ctx.font = "12px system-ui, sans-serif";
  names.forEach((name, n) => {
    ctx.fillStyle = series[n % 6];
    ctx.fillText(name, 10 + ((n % 4) * wide) / 4, 40 + 16 * Math.floor(n / 4), wide / 4 - 12);
  });
  ctx.drawImage(canvas, 0, top, wide, canvas.height / ratio);
  return new Promise((resolve) => whole.toBlob((blob) => resolve(/** @type {Blob} */ (blob))));
}
