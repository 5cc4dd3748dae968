// The buttons and their keys.

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
