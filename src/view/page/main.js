// The start, and what happens to the window.

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

function start() {
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
}
start();
