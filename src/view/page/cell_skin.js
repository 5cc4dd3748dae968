// The outside of the cells: the faces that no other cell shares, as triangles, and their edges.
function cellSkin({ centres, size }) {
  const place = (i) => [0, 1, 2].map((a) => Math.round((centres[i + a] - centres[a]) / size));
  const taken = new Set();
  for (let i = 0; i < centres.length; i += 3) taken.add(place(i).join());
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
  const [positions, triangles, edges] = [[], [], []];
  const addSide = (i, axis, sign) => {
    const first = positions.length / 3;
    for (const [u, v] of corners) {
      const corner = [centres[i], centres[i + 1], centres[i + 2]];
      if (!scene.flat) corner[axis] += (sign * size) / 2;
      corner[(axis + 1) % 3] += (u * size) / 2;
      corner[(axis + 2) % 3] += (v * size) / 2;
      positions.push(...corner);
    }
    triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
    for (let k = 0; k < 4; ++k) edges.push(first + k, first + ((k + 1) % 4));
  };
  for (let i = 0; i < centres.length; i += 3) {
    if (scene.flat) {
      addSide(i, 2, 1);
      continue;
    }
    for (const axis of [0, 1, 2]) {
      for (const sign of [-1, 1]) {
        const beyond = place(i);
        beyond[axis] += sign;
        if (!taken.has(beyond.join())) addSide(i, axis, sign);
      }
    }
  }
  return { positions: new Float32Array(positions), triangles: new Uint32Array(triangles), edges: new Uint32Array(edges) };
}
