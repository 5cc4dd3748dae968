// Text: the names beside points, and the panel with legend and colour bar.

function element(name, text, parent) {
  const result = document.createElement(name);
  result.textContent = text;
  parent.append(result);
  return result;
}

const labels = scene.points.filter((point) => point.label).map((point) => (
  { point, span: element("span", point.label, document.getElementById("labels")) }
));
function placeLabels({ view, projection }) {
  const apply = (m, v) => [0, 1, 2, 3].map((i) => m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2] + m[12 + i] * v[3]);
  for (const { point, span } of labels) {
    const clip = apply(projection, apply(view, [...point.at, 1]));
    span.hidden = !shown.labels || !shown.paths || !(clip[3] > 0);
    if (span.hidden) continue;
    const x = (0.5 + (0.5 * clip[0]) / clip[3]) * canvas.clientWidth;
    const y = (0.5 - (0.5 * clip[1]) / clip[3]) * canvas.clientHeight;
    const room = [x, canvas.clientWidth - x].map((width) => width > span.offsetWidth + 16);
    const left = room[0] && (!room[1] || x < canvas.clientWidth / 2);
    span.style.transform = `translate(${x + (left ? -12 - span.offsetWidth : 12)}px, ${y - 20}px)`;
  }
}

function fillPanel() {
  const legend = document.getElementById("legend");
  for (const line of scene.legend) {
    const mark = element("i", "", legend);
    mark.className = line.mark;
    mark.style.setProperty("--mark", line.colour);
    const text = element("span", line.text, legend);
    element("b", line.value, text);
  }
  if (!scene.scalar) return;
  const { name, min, max, ticks } = scene.scalar;
  const box = document.getElementById("scale");
  box.hidden = false;
  element("strong", name, box);
  const bar = element("div", "", box);
  bar.className = "bar";
  bar.style.background = `linear-gradient(to right, ${scene.colourMap.join(", ")})`;
  const marks = element("div", "", box);
  marks.className = "ticks";
  for (const [value, text] of ticks) {
    const at = Math.min(0.97, Math.max(0.02, (value - min) / (max - min)));
    element("span", text, marks).style.left = `${100 * at}%`;
  }
}
