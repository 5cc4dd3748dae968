// WebGL 2: shaders compiled, the scene copied to the card once.

let gl = null;
let programs = {};
let parts = {};
const shown = { surface: true, wire: false, paths: true, cells: Boolean(scene.cells && scene.cells.shown), colours: true, isolines: Boolean(scene.scalar && scene.scalar.isolines), labels: true };

function compile([vertex, fragment]) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\nprecision highp int;\n" + source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(gl.getProgramInfoLog(program));
  }
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
    const name = gl.getActiveUniform(program, i).name;
    at[name.replace("[0]", "")] = gl.getUniformLocation(program, name);
  }
  return { program, at };
}

function buffer(target, data) {
  const result = gl.createBuffer();
  gl.bindBuffer(target, result);
  gl.bufferData(target, data, gl.STATIC_DRAW);
  return result;
}

// attributes: [location, numbers or a buffer, components, { stride, offset }]
function vertexArray(attributes, index) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  for (const [location, data, components, { stride = 0, offset = 0 } = {}] of attributes) {
    if (data instanceof WebGLBuffer) gl.bindBuffer(gl.ARRAY_BUFFER, data);
    else buffer(gl.ARRAY_BUFFER, data);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, components, gl.FLOAT, false, stride, offset);
  }
  if (index) buffer(gl.ELEMENT_ARRAY_BUFFER, index);
  gl.bindVertexArray(null);
  return array;
}

function build() {
  programs = Object.fromEntries(Object.entries(shaders).map(([name, source]) => [name, compile(source)]));
  parts = {};
  parts.meshes = scene.meshes.map((mesh) => {
    const attributes = [[0, mesh.positions, 3], [1, mesh.normals, 3]];
    if (mesh.scalar) attributes.push([2, mesh.scalar.map((s) => (Number.isNaN(s) ? -1e30 : s)), 1]);
    if (mesh.colours) attributes.push([3, mesh.colours, 3]);
    return { mesh, array: vertexArray(attributes, mesh.faces), count: mesh.faces.length };
  });
  parts.lines = scene.lines.map((lines) => (
    { array: vertexArray([[0, lines.positions, 3]], lines.segments), count: lines.segments.length, colour: rgb(lines.colour) }
  ));
  const tubes = makeTubes();
  if (tubes.index.length === 0) return;
  const shared = buffer(gl.ARRAY_BUFFER, tubes.data);
  const attributes = [[0, 3, 0], [1, 3, 12], [2, 3, 24], [3, 1, 36]];
  const array = vertexArray(attributes.map(([at, n, offset]) => [at, shared, n, { stride: 40, offset }]), tubes.index);
  parts.tubes = { array, count: tubes.index.length };
}
