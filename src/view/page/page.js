"use strict";
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const canvas = document.getElementById("view");
  const tanHalf = Math.tan(Math.PI / 12); // of half the field of view
  const pathLift = 0.012 * scene.radius; // as in the pictures: a path is lifted this far off the mesh
  const pathPixels = 3.2; // half the width of a path, CSS pixels

  // ---- data ----

  function decode(text, Type) {
    return new Type(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  }
  const types = {
    positions: Float32Array, normals: Float32Array, scalar: Float32Array, colours: Float32Array,
    centres: Float32Array, faces: Uint32Array, segments: Uint32Array,
  };
  for (const part of [...scene.meshes, ...scene.lines, ...scene.paths, ...(scene.cells ? [scene.cells] : [])]) {
    for (const key in types) {
      if (key in part) part[key] = decode(part[key], types[key]);
    }
  }
  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);

  // ---- small vectors ----

  const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
  const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const norm = (a) => Math.hypot(a[0], a[1], a[2]);
  const unit = (a) => times(a, 1 / (norm(a) || 1));
  const anyNormalTo = (a) => unit(cross(a, Math.abs(a[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0]));

  // ---- camera: a turntable about the scene's up direction ----

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

  // ---- shapes made here ----

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

  // ---- drawing ----

  // The light of the pictures (shading.hpp), in camera axes.
  const light = `
    vec3 toLinear(vec3 s) { return mix(s / 12.92, pow((s + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), s)); }
    vec3 toSrgb(vec3 l) {
      l = clamp(l, 0.0, 1.0);
      return mix(12.92 * l, 1.055 * pow(l, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), l));
    }
    vec3 shade(vec3 base, vec3 n, vec3 view, float gloss) {
      float facing = dot(n, view);
      if (facing < 0.0) { n = -n; facing = -facing; base *= vec3(0.80, 0.72, 0.64); }
      vec3 key = normalize(vec3(-0.45, 0.70, 0.60));
      vec3 fill = normalize(vec3(0.80, 0.05, 0.50));
      float sky = 0.5 + 0.5 * n.y;
      vec3 lit = 0.84 * max(0.0, dot(n, key)) * vec3(1.0, 0.98, 0.95)
        + 0.20 * max(0.0, dot(n, fill)) * vec3(0.85, 0.93, 1.0)
        + 0.42 * (sky * vec3(0.96, 0.98, 1.0) + (1.0 - sky) * vec3(0.58, 0.57, 0.58));
      float shine = gloss * pow(max(0.0, dot(n, normalize(key + view))), 48.0);
      float grazing = 1.0 - facing;
      return base * lit * (1.0 - 0.38 * grazing * grazing * grazing) + shine;
    }`;
  const shaders = {
    surface: [`
      uniform mat4 view, projection;
      layout(location = 0) in vec3 position;
      layout(location = 1) in vec3 normal;
      layout(location = 2) in float scalar;
      layout(location = 3) in vec3 tint;
      out vec3 n, p, t;
      out float s;
      void main() {
        vec4 x = view * vec4(position, 1.0);
        p = x.xyz;
        n = mat3(view) * normal;
        s = scalar;
        t = tint;
        gl_Position = projection * x;
      }`, `
      uniform vec3 colour;
      uniform bool coloured, tinted, isolines, flatScene;
      uniform vec3 range;  // lowest, highest, step of the isolines
      uniform vec3 map[11];
      in vec3 n, p, t;
      in float s;
      out vec4 pixel;
      ${light}
      void main() {
        vec3 base = toLinear(tinted ? t : colour);
        float slope = max(fwidth(s), 1e-30);
        if (coloured && s > -1e29) {
          float at = clamp((s - range.x) / (range.y - range.x), 0.0, 1.0) * 10.0;
          int i = min(int(at), 9);
          base = toLinear(mix(map[i], map[i + 1], at - float(i)));
          float away = abs(fract(s / range.z + 0.5) - 0.5) * range.z / slope;
          float crowded = clamp(range.z / slope / 6.0, 0.0, 1.0);
          if (isolines) base *= 1.0 - 0.5 * clamp(1.2 - away, 0.0, 1.0) * crowded;
        }
        vec3 towards = flatScene ? vec3(0.0, 0.0, 1.0) : normalize(-p);
        pixel = vec4(toSrgb(shade(base, normalize(n), towards, 0.10)), 1.0);
      }`],
    tube: [`
      uniform mat4 view, projection;
      uniform float lift, thickness;
      uniform bool flatScene;
      layout(location = 0) in vec3 centre;
      layout(location = 1) in vec3 direction;
      layout(location = 2) in vec3 tint;
      layout(location = 3) in float width;
      out vec3 n, p, t;
      void main() {
        vec4 c = view * vec4(centre, 1.0);
        float r = thickness * width * (flatScene ? 1.0 : max(-c.z, 0.0));
        n = mat3(view) * direction;
        p = c.xyz + r * n;
        t = tint;
        gl_Position = projection * vec4(p, 1.0);
        // Only its depth is lifted towards the viewer.
        vec3 towards = flatScene ? vec3(0.0, 0.0, 1.0) : normalize(-p);
        float most = flatScene ? lift : min(lift + max(width - 1.0, 0.0) * r, 0.5 * length(p));
        vec4 nearer = projection * vec4(p + most * towards, 1.0);
        gl_Position.z = nearer.z / nearer.w * gl_Position.w;
      }`, `
      uniform float opacity;
      uniform bool flatScene;
      in vec3 n, p, t;
      out vec4 pixel;
      ${light}
      void main() {
        vec3 towards = flatScene ? vec3(0.0, 0.0, 1.0) : normalize(-p);
        pixel = vec4(toSrgb(shade(toLinear(t), normalize(n), towards, 0.22)) * opacity, opacity);
      }`],
    wire: [`
      uniform mat4 view, projection;
      layout(location = 0) in vec3 position;
      void main() {
        gl_Position = projection * view * vec4(position, 1.0);
        gl_PointSize = 2.0;
      }`, `
      uniform vec4 ink;
      out vec4 pixel;
      void main() { pixel = vec4(ink.rgb * ink.a, ink.a); }`],
  };

  let gl = null;
  let programs = {};
  let parts = {};
  const shown = { surface: true, wire: false, paths: true, cells: Boolean(scene.cells && scene.cells.shown), colours: true, isolines: true, labels: true };

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

  // ---- text ----

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

  // ---- tools ----

  const tools = document.getElementById("tools");
  const shortcuts = {};
  function addTool(text, key, title, act) {
    const button = element("button", text, tools);
    button.type = "button";
    button.title = `${title} (${key})`;
    button.setAttribute("aria-keyshortcuts", key);
    button.addEventListener("click", act);
    shortcuts[key] = () => button.click();
    return button;
  }
  function addToggle(text, key, title, what) {
    const button = addTool(text, key, title, () => {
      shown[what] = !shown[what];
      button.setAttribute("aria-pressed", String(shown[what]));
      redraw();
    });
    button.setAttribute("aria-pressed", String(shown[what]));
  }
  function savePicture() {
    draw();
    canvas.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${document.title.replace(/[^\w-]+/g, "_").replace(/^_+|_+$/g, "") || "taut"}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }
  function addTools() {
    if (scene.meshes.length > 0) {
      addToggle("Surface", "s", "Show the surface", "surface");
      addToggle("Triangles", "t", "Show the mesh's edges", "wire");
    }
    if (scene.paths.length + scene.points.length > 0) addToggle("Paths", "p", "Show paths and points", "paths");
    if (labels.length > 0) addToggle("Labels", "l", "Show the points' names", "labels");
    if (scene.cells) addToggle("Cells", "c", "Show the grid's cells", "cells");
    if (scene.scalar) {
      addToggle("Colours", "v", `Colour by ${scene.scalar.name}`, "colours");
      addToggle("Isolines", "i", "Show lines of equal value", "isolines");
    }
    element("span", "", tools).className = "gap";
    addTool("Reset view", "r", "Look as at the start", reset);
    addTool("Save picture", "d", "Download what is seen as PNG", savePicture);
  }

  // ---- hands ----

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

  function listenToWindow() {
    // Called just before the page is painted: drawing at once keeps the picture from being stretched meanwhile.
    new ResizeObserver(() => {
      if (atStart) fit();
      if (!gl.isContextLost()) draw();
    }).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      build();
      redraw();
    });
  }

  function showStill(reason) {
    for (const id of ["view", "tools", "labels", "keys"]) document.getElementById(id).hidden = true;
    document.getElementById("still").style.display = "block";
    const message = document.getElementById("message");
    message.hidden = false;
    message.textContent = `A still picture, because ${reason}. In a current browser with WebGL 2 this page can be turned.`;
  }

  fillPanel();
  gl = canvas.getContext("webgl2", { antialias: true });
  if (!gl) {
    showStill("this browser offers no WebGL 2");
    return;
  }
  try {
    build();
  } catch (error) {
    gl = null;
    showStill(`the graphics driver refuses the page's shaders (${error.message.trim()})`);
    return;
  }
  addTools();
  listenToPointers();
  listenToKeys();
  listenToWindow();
  reset();
  draw();
})();
