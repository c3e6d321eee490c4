// SVG drawn directly: previews, axis ticks and lines of the figures.

const NAMESPACE = "http://www.w3.org/2000/svg";

export function svg(name, attributes = {}, children = []) {
  const made = document.createElementNS(NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// Four significant digits, with an exponent only if it is needed.
export function digits(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}

// The range from the least to the largest value of each interval, as one line.
export function preview(intervals, label) {
  const seen = intervals.filter(Boolean);
  const [width, height] = [240, 56];
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "preview", role: "img", "aria-label": label, preserveAspectRatio: "none" });
  if (!seen.length) return picture;
  const low = Math.min(...seen.map((own) => own[0]));
  const high = Math.max(...seen.map((own) => own[1]));
  const scale = high > low ? (height - 6) / (high - low) : 0;
  const y = (value) => (scale ? height - 3 - scale * (value - low) : height / 2);
  let path = "";
  let last = null;
  intervals.forEach((own, index) => {
    if (!own) {
      last = null;
      return;
    }
    const x = ((index + 0.5) * width) / intervals.length;
    // Start from the end nearer to the last value, so that a rising signal stays one line.
    const first = last === null || Math.abs(own[0] - last) <= Math.abs(own[1] - last) ? 0 : 1;
    const points = own[0] === own[1] ? [own[0]] : [own[first], own[1 - first]];
    for (const value of points) path += `${path && last !== null ? "L" : "M"}${x.toFixed(1)} ${y(value).toFixed(1)}`, (last = value);
  });
  picture.append(svg("path", { d: path }));
  return picture;
}

// About five round values within a range.
export function ticks(low, high) {
  const raw = (high - low) / 4;
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((own) => own >= raw);
  const first = Math.ceil(low / step);
  const all = [];
  for (let k = first; k * step <= high + 1e-9 * step; k++) all.push(Number((k * step).toPrecision(12)));
  return all;
}

export function line(xs, ys, x, y) {
  let path = "";
  for (let i = 0; i < xs.length; i++) path += `${i ? "L" : "M"}${x(xs[i]).toFixed(1)} ${y(ys[i]).toFixed(1)}`;
  return path;
}
