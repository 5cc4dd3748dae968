// A path in pieces with gaps between them.
function dashesOf(points) {
  const dashes = [];
  let piece = [points[0]];
  let left = scene.dash;
  let down = true;
  for (let i = 1; i < points.length; ++i) {
    let from = points[i - 1];
    for (let rest = norm(sub(points[i], from)); rest > 0;) {
      const step = Math.min(rest, left);
      from = add(from, times(sub(points[i], from), step / rest));
      if (down) piece.push(from);
      rest -= step;
      left -= step;
      if (left > 0) continue;
      if (down) dashes.push(piece);
      down = !down;
      left = down ? scene.dash : scene.dashGap;
      piece = [from];
    }
  }
  if (down && piece.length > 1) dashes.push(piece);
  return dashes;
}

// Round tubes about the paths and balls at the points. A vertex is a centre, a direction, a colour and a thickness:
// the shader moves it out, so that a tube stays as thick in pixels at any zoom.
function makeTubes() {
  const data = [];
  const index = [];
  let count = 0;
  const circle = (n) => Array.from({ length: n }, (_, s) => [Math.cos((2 * Math.PI * s) / n), Math.sin((2 * Math.PI * s) / n)]);
  function addRing(centre, directions, colour, thickness) {
    for (const d of directions) data.push(...centre, ...d, ...colour, thickness);
    count += directions.length;
  }
  function joinRings(first, sides) {
    for (let ring = first; ring + sides < count; ring += sides) {
      for (let s = 0; s < sides; ++s) {
        const [a, b] = [ring + s, ring + ((s + 1) % sides)];
        index.push(a, b, b + sides, a, b + sides, a + sides);
      }
    }
  }
  function addTube(points, colour, thickness) {
    const around = circle(12);
    const first = count;
    let tangent = unit(sub(points[1], points[0]));
    let side = anyNormalTo(tangent);
    const ring = (centre, angle) => {
      const other = cross(tangent, side);
      const out = ([c, s]) => add(times(side, c), times(other, s));
      addRing(centre, around.map((w) => add(times(tangent, Math.sin(angle)), times(out(w), Math.cos(angle)))), colour, thickness);
    };
    const cap = [1, 0.75, 0.5, 0.25].map((part) => (part * Math.PI) / 2);
    for (const angle of cap) ring(points[0], -angle);
    points.forEach((point, i) => {
      const before = i > 0 ? unit(sub(point, points[i - 1])) : [0, 0, 0];
      const after = i + 1 < points.length ? unit(sub(points[i + 1], point)) : [0, 0, 0];
      const turned = add(before, after);
      if (norm(turned) > 1e-3) tangent = unit(turned);
      side = sub(side, times(tangent, dot(side, tangent)));
      side = norm(side) > 1e-3 ? unit(side) : anyNormalTo(tangent);
      ring(point, 0);
    });
    for (const angle of cap.reverse()) ring(points[points.length - 1], angle);
    joinRings(first, around.length);
  }
  function addBall(centre, colour, thickness) {
    const around = circle(24);
    const first = count;
    for (let k = 0; k <= 12; ++k) {
      const [c, s] = [Math.cos((Math.PI * k) / 12), Math.sin((Math.PI * k) / 12)];
      addRing(centre, around.map(([x, y]) => [s * x, s * y, -c]), colour, thickness);
    }
    joinRings(first, around.length);
  }
  for (const path of scene.paths) {
    const points = [];
    for (let i = 0; i + 2 < path.positions.length; i += 3) {
      const x = Array.from(path.positions.subarray(i, i + 3));
      if (points.length === 0 || norm(sub(x, points[points.length - 1])) > 1e-6 * scene.radius) points.push(x);
    }
    if (points.length < 2) continue;
    for (const piece of path.failed ? dashesOf(points) : [points]) addTube(piece, rgb(path.colour), path.width);
  }
  for (const point of scene.points) addBall(point.at, rgb(point.colour), 2 * point.size);
  return { data: new Float32Array(data), index: new Uint32Array(index) };
}
