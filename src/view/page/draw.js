// One picture: surface, wires, cells, then paths over them.

function use(name, values) {
  const { program, at } = programs[name];
  gl.useProgram(program);
  for (const [key, value] of Object.entries(values)) {
    const where = at[key];
    if (where === undefined) continue;
    if (typeof value === "boolean") gl.uniform1i(where, value ? 1 : 0);
    else if (typeof value === "number") gl.uniform1f(where, value);
    else if (value.length === 16) gl.uniformMatrix4fv(where, false, value);
    else if (value.length === 4) gl.uniform4fv(where, value);
    else gl.uniform3fv(where, value);
  }
}

function drawElements(mode, { array, count }) {
  gl.bindVertexArray(array);
  gl.drawElements(mode, count, gl.UNSIGNED_INT, 0);
}

function drawSurface(common) {
  const { min, max, step } = scene.scalar || { min: 0, max: 1, step: 1 };
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(1, 1);
  for (const part of parts.meshes) {
    use("surface", {
      ...common, colour: rgb(part.mesh.colour), tinted: Boolean(part.mesh.colours),
      coloured: Boolean(part.mesh.scalar) && shown.colours, isolines: shown.isolines,
      range: [min, max, step], map: scene.colourMap.flatMap(rgb),
    });
    drawElements(gl.TRIANGLES, part);
  }
  gl.disable(gl.POLYGON_OFFSET_FILL);
}

function drawWire(common, dark) {
  const overSurface = dark ? [0.04, 0.06, 0.09, 0.5] : [0.1, 0.15, 0.2, 0.38];
  const alone = dark ? [0.8, 0.86, 0.92, 0.4] : [0.1, 0.15, 0.2, 0.45];
  use("wire", { ...common, ink: shown.surface ? overSurface : alone });
  for (const part of parts.meshes) {
    if (!part.edges) {
      const edges = meshEdges(part.mesh.faces, part.mesh.positions.length / 3);
      part.edges = { array: vertexArray([[0, part.mesh.positions, 3]], edges), count: edges.length };
    }
    drawElements(gl.LINES, part.edges);
  }
}

function drawPaths(common) {
  const pixel = (2 * tanHalf) / Math.max(1, canvas.clientHeight);
  use("tube", { ...common, lift: pathLift, thickness: pathPixels * pixel * (scene.flat ? camera.distance : 1) });
  gl.enable(gl.CULL_FACE);
  // First what the surface hides, faintly; then what is in front.
  gl.depthMask(false);
  gl.depthFunc(gl.GREATER);
  use("tube", { opacity: 0.28 });
  drawElements(gl.TRIANGLES, parts.tubes);
  gl.depthMask(true);
  gl.depthFunc(gl.LEQUAL);
  use("tube", { opacity: 1 });
  drawElements(gl.TRIANGLES, parts.tubes);
  gl.disable(gl.CULL_FACE);
}

// A translucent skin between the surface and the paths; of cells without a size, only their centres.
function drawCells(common, dark) {
  const colour = rgb(scene.cells.colour);
  if (!parts.cells) {
    const boxes = scene.cells.size > 0;
    const skin = boxes ? cellSkin(scene.cells) : { positions: scene.cells.centres, triangles: [], edges: [] };
    const array = (index) => vertexArray([[0, skin.positions, 3]], boxes ? index : null);
    parts.cells = {
      boxes, count: skin.positions.length / 3, points: array(skin.edges),
      faces: { array: array(skin.triangles), count: skin.triangles.length },
      edges: { array: array(skin.edges), count: skin.edges.length },
    };
  }
  const edge = [...colour.map((c) => (dark ? 0.4 + 0.6 * c : 0.7 * c)), 0.75];
  if (!parts.cells.boxes) {
    use("wire", { ...common, ink: edge });
    gl.bindVertexArray(parts.cells.points);
    gl.drawArrays(gl.POINTS, 0, parts.cells.count);
    return;
  }
  // Only the nearest layer of it is drawn: first its depth, then its colours.
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(1, 1);
  gl.colorMask(false, false, false, false);
  use("wire", { ...common, ink: edge });
  drawElements(gl.TRIANGLES, parts.cells.faces);
  gl.colorMask(true, true, true, true);
  use("wire", { ...common, ink: [...colour, 0.28] });
  drawElements(gl.TRIANGLES, parts.cells.faces);
  gl.disable(gl.POLYGON_OFFSET_FILL);
  use("wire", { ...common, ink: edge });
  drawElements(gl.LINES, parts.cells.edges);
  // No cell hides a path: forget their depth.
  gl.clear(gl.DEPTH_BUFFER_BIT);
  gl.colorMask(false, false, false, false);
  if (shown.surface) drawSurface(common);
  gl.colorMask(true, true, true, true);
}

function draw() {
  const ratio = Math.min(window.devicePixelRatio || 1, 2.5);
  const w = Math.max(1, Math.round(canvas.clientWidth * ratio));
  const h = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  gl.viewport(0, 0, w, h);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  const common = { ...matrices(), flatScene: scene.flat };
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  if (shown.surface) drawSurface(common);
  if (shown.wire) drawWire(common, dark);
  for (const part of parts.lines) {
    use("wire", { ...common, ink: [...part.colour.map((c) => (dark ? 0.5 + 0.5 * c : c)), 1] });
    drawElements(gl.LINES, part);
  }
  if (shown.cells && scene.cells) drawCells(common, dark);
  if (shown.paths && parts.tubes) drawPaths(common);
  gl.bindVertexArray(null);
  placeLabels(common);
}

let waiting = false;
function redraw() {
  if (waiting || !gl) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    if (!gl.isContextLost()) draw();
  });
}
