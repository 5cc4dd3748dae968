// Each edge once, as pairs of vertices.
function meshEdges(faces, numVertices) {
  const keys = new Float64Array(faces.length);
  for (let i = 0; i < faces.length; ++i) {
    const a = faces[i];
    const b = faces[i - (i % 3) + ((i + 1) % 3)];
    keys[i] = Math.min(a, b) * numVertices + Math.max(a, b);
  }
  keys.sort();
  const edges = [];
  for (let i = 0; i < keys.length; ++i) {
    if (i === 0 || keys[i] !== keys[i - 1]) edges.push(Math.floor(keys[i] / numVertices), keys[i] % numVertices);
  }
  return new Uint32Array(edges);
}
