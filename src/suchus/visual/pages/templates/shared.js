"use strict";
// What the players share: the page's arrays, vectors, programs, the clock, and the hands on the picture.
const shared = (() => {
  const $ = (id) => document.getElementById(id);
  const meta = JSON.parse($("meta").textContent);
  const canvas = $("scene");
  const gl = canvas.getContext("webgl2", { antialias: false, stencil: true, alpha: false, preserveDrawingBuffer: true });
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

  // ---- how finely it is drawn: finely at rest; while it plays, as finely as the device keeps up with -----------------
  const FINENESS = [ // smooth: edges, in several samples; sharp: at most so many pixels in one of CSS; fine: all triangles
    { smooth: true, sharp: 2, shadows: true, fine: true }, { smooth: false, sharp: 1.5, shadows: true, fine: true },
    { smooth: false, sharp: 1, shadows: false, fine: false }, { smooth: false, sharp: 0.6, shadows: false, fine: false }];
  const MAX_INTERVAL = 1000 / 31, SHORT_INTERVAL = 1000 / 45; // between pictures [ms]: a longer one is too slow, a shorter one leaves time
  const OWN_FRACTION = 0.6; // of an interval; a page that computes for longer is not slow by drawing
  const MIN_GAIN = 0.08; // by which a coarser picture shortens the interval, at least
  const WINDOW = 700, MIN_WAIT = 4000, MAX_WAIT = 64000; // [ms]: over which pictures are timed, and until a finer one is tried
  const pace = { level: 0, coarsest: FINENESS.length - 1, wait: MIN_WAIT, changed: 0, before: 0, tried: false, from: 0, pictures: 0, own: 0 };
  const fineness = () => FINENESS[state.playing ? pace.level : 0];

  /** Take the time of one picture into account: the moment [ms] and the time that the page computed before it [ms]. */
  function keepPace(stamp, own) {
    if (!pace.from || stamp - pace.from > 4 * WINDOW) return Object.assign(pace, { from: stamp, pictures: 0, own: 0 }); // it begins, or it slept
    pace.pictures += 1;
    pace.own += own;
    const passed = stamp - pace.from;
    if (passed < WINDOW) return;
    const interval = passed / pace.pictures, isDrawing = pace.own < OWN_FRACTION * passed;
    Object.assign(pace, { from: stamp, pictures: 0, own: 0 });
    const { level, before } = pace;
    const change = (next, tried) => Object.assign(pace, { level: next, changed: stamp, before: next > level ? interval : 0, tried, from: 0 });
    if (before && interval > (1 - MIN_GAIN) * before) { pace.coarsest = level - 1; change(level - 1, false); } // coarser was no quicker
    else if (interval > MAX_INTERVAL && isDrawing && level < pace.coarsest) {
      if (pace.tried) pace.wait = Math.min(2 * pace.wait, MAX_WAIT); // the finer picture was too slow
      change(level + 1, false);
    } else if (interval < SHORT_INTERVAL && level > 0 && stamp - pace.changed > pace.wait) change(level - 1, true);
    else pace.before = 0;
  }

  // ---- edges in several samples: drawn into a buffer of its own, so that it can do without ----------------------------
  const MAX_SAMPLES = 4;
  let edges = null;
  function edgeBuffers(wide, high) {
    if (edges && edges.wide === wide && edges.high === high) return edges;
    if (edges) {
      for (const frame of [edges.many, edges.single]) gl.deleteFramebuffer(frame);
      for (const buffer of edges.buffers) gl.deleteRenderbuffer(buffer);
    }
    const samples = Math.min(MAX_SAMPLES, gl.getParameter(gl.MAX_SAMPLES)), buffers = [];
    const storage = (attachment, format, count) => {
      const made = gl.createRenderbuffer();
      buffers.push(made);
      gl.bindRenderbuffer(gl.RENDERBUFFER, made);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, count, format, wide, high);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, made);
    };
    const many = gl.createFramebuffer(), single = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, many);
    storage(gl.COLOR_ATTACHMENT0, gl.RGBA8, samples);
    storage(gl.DEPTH_STENCIL_ATTACHMENT, gl.DEPTH24_STENCIL8, samples);
    gl.bindFramebuffer(gl.FRAMEBUFFER, single);
    storage(gl.COLOR_ATTACHMENT0, gl.RGBA8, 0);
    edges = { wide, high, many, single, buffers };
    return edges;
  }
  function showEdges() { // the samples of each pixel become one, then the picture
    if (!fineness().smooth) return;
    const { wide, high, many, single } = edges;
    for (const [from, to] of [[many, single], [single, null]]) {
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
      gl.blitFramebuffer(0, 0, wide, high, 0, 0, wide, high, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  // ---- drawing, once when asked, again and again while it plays --------------------------------------------------
  let dirty = true, last = 0, draw, pass; // nothing is drawn before begin
  function tick(stamp) {
    dirty = false;
    if (state.playing) {
      const began = performance.now();
      if (last) pass(state.speed * Math.min((stamp - last) / 1000, 0.25));
      last = stamp;
      keepPace(stamp, performance.now() - began);
    }
    draw();
    showEdges();
    if (state.playing) redraw();
  }
  const redraw = () => { if (!dirty) { dirty = true; requestAnimationFrame(tick); } };
  const play = (on) => { state.playing = on; last = pace.from = 0; $("play").textContent = on ? "Pause" : "Play"; redraw(); };
  function clear(light, dark) { // fits the picture to the page and returns its background
    const back = state.dark ? dark : light, { smooth, sharp: most } = fineness(), sharp = Math.min(devicePixelRatio, most);
    const wide = Math.round(canvas.clientWidth * sharp), high = Math.round(canvas.clientHeight * sharp);
    if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
    gl.bindFramebuffer(gl.FRAMEBUFFER, smooth ? edgeBuffers(wide, high).many : null);
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
  const small = matchMedia("(max-width: 600px), (max-height: 430px)");
  function fold() { // on a phone and inside another page the scene comes first: all but the time is folded away
    const folded = framed || small.matches;
    document.body.classList.toggle("folded", folded);
    $("controls").open = !folded;
  }
  function begin(drawn, passed) {
    [draw, pass] = [drawn, passed];
    document.body.classList.add("alive");
    document.body.classList.toggle("framed", framed);
    fold();
    small.addEventListener("change", fold);
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

  return { $, meta, canvas, gl, take, add, cross, dot, unit, program, asked, framed, state, pace, fineness, redraw, play, clear, nearest, begin, hold };
})();
