// What write_html put into the page: its JSON, and the numbers in it decoded to typed arrays.

const scene = JSON.parse(document.getElementById("scene").textContent);
const canvas = document.getElementById("view");
const tanHalf = Math.tan(Math.PI / 12); // of half the field of view
const pathLift = 0.012 * scene.radius; // as in the pictures: a path is lifted this far off the mesh
const pathPixels = 3.2; // half the width of a path, CSS pixels


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
