// The camera: a turntable about the scene's up direction.

const up = unit(scene.up);
const east = anyNormalTo(up);
const north = cross(up, east);
const camera = { azimuth: 0, elevation: 0, roll: 0, distance: 1, target: [0, 0, 0] };

function axes() {
  let right = [1, 0, 0];
  let back = [0, 0, 1];
  if (!scene.flat) {
    const [c, s] = [Math.cos(camera.azimuth), Math.sin(camera.azimuth)];
    const level = add(times(east, c), times(north, s));
    back = add(times(level, Math.cos(camera.elevation)), times(up, Math.sin(camera.elevation)));
    right = sub(times(north, c), times(east, s));
  }
  const top = cross(back, right);
  const [c, s] = [Math.cos(camera.roll), Math.sin(camera.roll)];
  return { right: add(times(right, c), times(top, s)), top: sub(times(top, c), times(right, s)), back };
}

function everyPosition(visit) {
  const lists = [...scene.meshes, ...scene.lines, ...scene.paths].map((part) => part.positions);
  lists.push(Float32Array.from(scene.points.flatMap((p) => p.at)));
  if (scene.cells && (scene.cells.shown || lists.every((list) => list.length === 0))) {
    const half = scene.cells.size / 2;
    lists.push(scene.cells.centres.map((x) => x - half), scene.cells.centres.map((x) => x + half));
  }
  for (const list of lists) {
    const step = 3 * Math.max(1, Math.floor(list.length / 300000));
    for (let i = 0; i + 2 < list.length; i += step) visit(list[i], list[i + 1], list[i + 2]);
  }
}

// Goes back until everything fits, and looks at the middle of what is seen.
function fit() {
  const { right, top, back } = axes();
  const aspect = Math.max(0.2, canvas.clientWidth / Math.max(1, canvas.clientHeight));
  // Tangents to the left, right, lower and upper margin; below stand the buttons.
  const margin = [0.9 * aspect, 0.9 * aspect, 0.78, 0.88].map((part) => part * tanHalf);
  const depth = scene.flat ? 0 : 1;
  const most = [-Infinity, -Infinity, -Infinity, -Infinity];
  everyPosition((x, y, z) => {
    const px = right[0] * x + right[1] * y + right[2] * z;
    const py = top[0] * x + top[1] * y + top[2] * z;
    const pz = depth * (back[0] * x + back[1] * y + back[2] * z);
    most[0] = Math.max(most[0], pz * margin[0] - px);
    most[1] = Math.max(most[1], pz * margin[1] + px);
    most[2] = Math.max(most[2], pz * margin[2] - py);
    most[3] = Math.max(most[3], pz * margin[3] + py);
  });
  const needed = [0, 2].map((i) => (most[i] + most[i + 1]) / (margin[i] + margin[i + 1]));
  const d = Math.max(...needed, 1e-3 * scene.radius);
  const middle = [0, 2].map((i) => (d * margin[i] - most[i] + most[i + 1] - d * margin[i + 1]) / 2);
  camera.distance = d;
  camera.target = add(times(right, middle[0]), times(top, middle[1]));
}

function reset() {
  const view = unit(scene.view);
  camera.elevation = Math.asin(Math.max(-1, Math.min(1, dot(view, up))));
  camera.azimuth = Math.atan2(dot(view, north), dot(view, east));
  camera.roll = 0;
  fit();
  redraw();
  atStart = true;
}

let atStart = true; // nobody has moved the camera yet
const worldPerPixel = () => (2 * camera.distance * tanHalf) / Math.max(1, canvas.clientHeight);

function turn(dx, dy) {
  const limit = Math.PI / 2 - 1e-3;
  camera.azimuth -= dx;
  camera.elevation = Math.max(-limit, Math.min(limit, camera.elevation + dy));
  atStart = false;
  redraw();
}
function pan(dx, dy) {
  const { right, top } = axes();
  const s = worldPerPixel();
  camera.target = add(camera.target, add(times(right, -dx * s), times(top, dy * s)));
  atStart = false;
  redraw();
}
// x, y: the place that stays where it is, in pixels from the middle.
function zoom(factor, x = 0, y = 0) {
  const distance = Math.max(1e-3 * scene.radius, Math.min(60 * scene.radius, camera.distance * factor));
  const moved = worldPerPixel() * (1 - distance / camera.distance);
  const { right, top } = axes();
  camera.target = add(camera.target, add(times(right, x * moved), times(top, -y * moved)));
  camera.distance = distance;
  atStart = false;
  redraw();
}
function roll(angle) {
  camera.roll += angle;
  atStart = false;
  redraw();
}

// Column by column, as WebGL takes them.
function matrices() {
  const { right, top, back } = axes();
  const eye = add(camera.target, times(back, camera.distance));
  const view = [
    right[0], top[0], back[0], 0, right[1], top[1], back[1], 0, right[2], top[2], back[2], 0,
    -dot(right, eye), -dot(top, eye), -dot(back, eye), 1,
  ];
  const aspect = canvas.width / canvas.height;
  const reach = 1.3 * scene.radius + pathLift;
  const middle = dot(eye, back);
  if (scene.flat) {
    const h = camera.distance * tanHalf;
    const [near, far] = [middle - reach, middle + reach];
    const projection = [
      1 / (h * aspect), 0, 0, 0, 0, 1 / h, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0, -(far + near) / (far - near), 1,
    ];
    return { view, projection };
  }
  const far = Math.max(middle + reach, 1e-2 * scene.radius);
  const near = Math.max(middle - reach, 2e-3 * far);
  const projection = [
    1 / (tanHalf * aspect), 0, 0, 0, 0, 1 / tanHalf, 0, 0,
    0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0,
  ];
  return { view, projection };
}
