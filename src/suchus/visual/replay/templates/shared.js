"use strict";
// What the players share: the page's arrays, vectors, programs, the clock, and the hands on the picture.
const shared = (() => {
  const $ = (id) => document.getElementById(id);
  const meta = JSON.parse($("meta").textContent);
  const canvas = $("scene");
  const gl = canvas.getContext("webgl2", { antialias: true, stencil: true, alpha: false, preserveDrawingBuffer: true });
  if (!gl) return null;

  const bytes = Uint8Array.from(atob($("data").textContent.trim()), (c) => c.charCodeAt(0));
  const kinds = { int8: Int8Array, uint8: Uint8Array, int16: Int16Array, uint16: Uint16Array, uint32: Uint32Array, float32: Float32Array };
  const take = (ref) => new kinds[ref.kind](bytes.buffer, ref.start, ref.count);

  const add = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const unit = (a) => { const n = Math.hypot(...a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };

  const program = (vertex, fragment) => {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    const uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
      const name = gl.getActiveUniform(made, i).name.replace("[0]", "");
      uniforms[name] = gl.getUniformLocation(made, name);
    }
    return { made, uniforms };
  };

  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches, framed = self !== top; // framed: in a report
  const asked = new URLSearchParams(location.hash.slice(1));
  const state = { playing: !calm && !framed && !asked.has("t"), speed: 1, dark: matchMedia("(prefers-color-scheme: dark)").matches };

  // ---- drawing, once when asked, again and again while it plays --------------------------------------------------
  let dirty = true, last = 0, draw, pass; // nothing is drawn before begin
  function tick(stamp) {
    dirty = false;
    if (state.playing) {
      if (last) pass(state.speed * Math.min((stamp - last) / 1000, 0.25));
      last = stamp;
    }
    draw();
    if (state.playing) redraw();
  }
  const redraw = () => { if (!dirty) { dirty = true; requestAnimationFrame(tick); } };
  const play = (on) => { state.playing = on; last = 0; $("play").textContent = on ? "Pause" : "Play"; redraw(); };
  function clear(light, dark) { // fits the picture to the page and returns its background
    const back = state.dark ? dark : light, sharp = Math.min(devicePixelRatio, 2);
    const wide = Math.round(canvas.clientWidth * sharp), high = Math.round(canvas.clientHeight * sharp);
    if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
    gl.viewport(0, 0, wide, high);
    gl.clearColor(...back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    return back;
  }
  function nearest(surface, shade) { // seen through: its nearest surface only, whose programs are the same twice
    gl.colorMask(false, false, false, false);
    surface();
    gl.colorMask(true, true, true, true);
    gl.depthFunc(gl.EQUAL);
    shade();
    gl.depthFunc(gl.LESS);
  }
  function begin(drawn, passed) {
    [draw, pass] = [drawn, passed];
    document.body.classList.add("alive");
    theme(state.dark);
    $("play").textContent = state.playing ? "Pause" : "Play";
    requestAnimationFrame(tick);
  }

  // ---- hands on the page -----------------------------------------------------------------------------------------
  const theme = (dark) => { state.dark = dark; document.documentElement.dataset.theme = dark ? "dark" : "light";
    $("theme").textContent = dark ? "Light" : "Dark"; redraw(); };
  function hold({ camera, lowest, move, seen, look, seek, step, start, end, boxes, play }) {
    const orbit = (dx, dy) => { camera.azimuth -= 0.006 * dx; camera.elevation = Math.min(Math.max(camera.elevation + 0.006 * dy, lowest), 1.56); redraw(); };
    const pan = (dx, dy) => { const { right, up } = seen(), k = 0.62 * camera.distance / canvas.clientHeight; move(add(right.map((c) => -k * dx * c), up, k * dy)); redraw(); };
    const zoom = (by) => { camera.distance = Math.min(Math.max(camera.distance * by, 0.25 * meta.length), 12 * meta.length); redraw(); };
    $("time").addEventListener("input", (e) => { if (state.playing) play(false); seek(+e.target.value); });
    $("play").addEventListener("click", () => play(!state.playing));
    $("speed").addEventListener("change", (e) => { state.speed = +e.target.value; });
    $("view").addEventListener("change", (e) => look(e.target.value));
    $("theme").addEventListener("click", () => theme(!state.dark));
    for (const name of boxes) $(name).addEventListener("change", (e) => { state[name] = e.target.checked; redraw(); });
    const fingers = new Map();
    canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, [e.clientX, e.clientY]); });
    canvas.addEventListener("pointermove", (e) => {
      const before = fingers.get(e.pointerId);
      if (!before) return;
      const dx = e.clientX - before[0], dy = e.clientY - before[1];
      if (fingers.size === 1) (e.shiftKey || e.buttons & 6 ? pan : orbit)(dx, dy);
      else { // two fingers: their distance zooms, their middle pans
        const other = [...fingers].find(([id]) => id !== e.pointerId)[1];
        const far = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        zoom(far(before) / far([e.clientX, e.clientY])); pan(dx / 2, dy / 2);
      }
      fingers.set(e.pointerId, [e.clientX, e.clientY]);
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (e) => fingers.delete(e.pointerId));
    canvas.addEventListener("wheel", (e) => { e.preventDefault(); zoom(Math.exp(0.0012 * e.deltaY)); }, { passive: false });
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("keydown", (e) => {
      const acts = { ArrowLeft: () => orbit(18, 0), ArrowRight: () => orbit(-18, 0), ArrowUp: () => orbit(0, 18), ArrowDown: () => orbit(0, -18),
        "+": () => zoom(0.88), "=": () => zoom(0.88), "-": () => zoom(1.14), ",": () => step(-1), ".": () => step(1),
        " ": () => play(!state.playing), Home: () => seek(start), End: () => seek(end()) };
      const act = acts[e.key];
      if (act && !e.ctrlKey && !e.metaKey && !e.altKey) { e.preventDefault(); act(); }
    });
    new ResizeObserver(redraw).observe(canvas);
    canvas.addEventListener("webglcontextlost", () => { document.body.classList.remove("alive"); state.playing = false; });
  }

  return { $, meta, canvas, gl, take, add, cross, dot, unit, program, asked, framed, state, redraw, play, clear, nearest, begin, hold };
})();
