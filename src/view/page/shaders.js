// The programs of the graphics card, in GLSL: surface, tube (paths and points) and wire (edges, lines, cells).

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
