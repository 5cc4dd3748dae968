// Mouse, touch and keyboard.

function listenToPointers() {
  const fingers = new Map();
  const middle = () => {
    const all = [...fingers.values()];
    return [0, 1].map((i) => all.reduce((sum, f) => sum + f[i], 0) / all.length);
  };
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));
  };
  const fromMiddle = (x, y) => {
    const box = canvas.getBoundingClientRect();
    return [x - box.left - box.width / 2, y - box.top - box.height / 2];
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    if (fingers.size === 1) {
      const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
      if (event.buttons & 6 || event.shiftKey || scene.flat) pan(dx, dy);
      else turn(dx * 0.008, dy * 0.008);
      fingers.set(event.pointerId, now);
    } else if (fingers.size === 2) {
      const [oldMiddle, oldSpread] = [middle(), spread()];
      fingers.set(event.pointerId, now);
      const newMiddle = middle();
      pan(newMiddle[0] - oldMiddle[0], newMiddle[1] - oldMiddle[1]);
      zoom(oldSpread / spread(), ...fromMiddle(...newMiddle));
    }
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
    canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", reset);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const unitPixels = [1, 16, 400][event.deltaMode];
    const amount = event.deltaY * unitPixels * (event.ctrlKey ? 4 : 1);
    zoom(Math.exp(0.0016 * Math.max(-300, Math.min(300, amount))), ...fromMiddle(event.clientX, event.clientY));
  }, { passive: false });
}

function listenToKeys() {
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const step = Math.PI / 36;
  const acts = {
    "+": () => zoom(1 / 1.15), "=": () => zoom(1 / 1.15), "-": () => zoom(1.15),
    "[": () => roll(step), "]": () => roll(-step),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = event.target === canvas && arrows[event.key];
    const act = acts[event.key] || (!event.repeat && shortcuts[event.key.toLowerCase()]);
    if (arrow && (event.shiftKey || scene.flat)) pan(30 * arrow[0], 30 * arrow[1]);
    else if (arrow) turn(step * arrow[0], step * arrow[1]);
    else if (act) act();
    else return;
    event.preventDefault();
  });
}
