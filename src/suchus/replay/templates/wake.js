"use strict";
// A small WebGL2 player: a swimming body and the surfaces around its vortices. World: x to the tail, z up.
(() => {
  const $ = (id) => document.getElementById(id);
  const meta = JSON.parse($("meta").textContent);
  const canvas = $("scene");
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: true });
  if (!gl) return;
  const bytes = Uint8Array.from(atob($("data").textContent.trim()), (c) => c.charCodeAt(0));
  const kinds = { int8: Int8Array, int16: Int16Array, uint16: Uint16Array, uint32: Uint32Array, float32: Float32Array };
  const take = (ref) => new kinds[ref.kind](bytes.buffer, ref.start, ref.count);

  // ---- programs: one for both, a mesh has points, normals and a shade from -1 to 1 -------------------------------
  const compiled = (kind, text) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  };
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl.VERTEX_SHADER, `
    layout(location=0) in vec3 aAt; layout(location=1) in vec3 aNormal; layout(location=2) in float aShade;
    uniform mat4 uView; uniform float uSide; out vec3 vAt, vNormal; out float vShade;
    void main() {
      vec3 side = vec3(1.0, 1.0, uSide);
      vAt = aAt * side; vNormal = aNormal * side; vShade = aShade;
      gl_Position = uView * vec4(vAt, 1.0);
    }`));
  gl.attachShader(program, compiled(gl.FRAGMENT_SHADER, `
    in vec3 vAt, vNormal; in float vShade; uniform vec3 uEye, uRamp[9], uOwn, uLight; uniform float uAlpha, uNight;
    out vec4 colour;
    void main() {
      vec3 V = normalize(uEye - vAt), n = normalize(vNormal);
      n = dot(n, V) < 0.0 ? -n : n;
      float f = clamp(vShade, -1.0, 1.0) * 4.0 + 4.0; int i = min(int(f), 7);
      vec3 own = uOwn.x < 0.0 ? mix(uRamp[i], uRamp[i + 1], f - float(i)) : uOwn;
      vec3 c = own * (0.40 + 0.48 * max(dot(n, uLight), 0.0) + 0.22 * dot(n, V));
      c += 0.20 * pow(max(dot(n, normalize(uLight + V)), 0.0), 40.0);
      colour = vec4(c * mix(1.0, 0.9, uNight), uAlpha);
    }`));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);
  const u = Object.fromEntries(["View", "Side", "Eye", "Own", "Light", "Alpha", "Night"].map((name) => [name, uniform("u" + name)]));
  gl.uniform3fv(uniform("uRamp"), meta.ramp.flat());

  // ---- meshes ----------------------------------------------------------------------------------------------------
  function normals(points, faces) { // mean of the faces', weighted by their areas
    const found = new Float32Array(points.length);
    for (let k = 0; k < faces.length; k += 3) {
      const [a, b, c] = [3 * faces[k], 3 * faces[k + 1], 3 * faces[k + 2]];
      const p = [0, 1, 2].map((d) => points[b + d] - points[a + d]), q = [0, 1, 2].map((d) => points[c + d] - points[a + d]);
      for (let d = 0; d < 3; d++) {
        const n = p[(d + 1) % 3] * q[(d + 2) % 3] - p[(d + 2) % 3] * q[(d + 1) % 3];
        found[a + d] += n; found[b + d] += n; found[c + d] += n;
      }
    }
    return found;
  }
  function mesh(points, faces, shades) {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const put = (data, at, size, kind, normalised) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, kind, normalised, 0, 0);
    };
    put(points, 0, 3, gl.FLOAT, false);
    put(normals(points, faces), 1, 3, gl.FLOAT, false);
    if (shades) put(shades, 2, 1, gl.BYTE, true);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return { array, count: faces.length, kind: faces instanceof Uint32Array ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT };
  }
  const line = Object.fromEntries(Object.entries(meta.lines).map(([name, ref]) => [name, { values: take(ref.array), scale: ref.scale / 32767 }]));
  const high = take(meta.high), round = 32, stations = meta.stations;
  function body(frame) {
    const points = new Float32Array(3 * stations * round), faces = new Uint32Array(6 * (stations - 1) * round);
    const at = (name, s) => line[name].values[frame * stations + s] * line[name].scale;
    for (let s = 0; s < stations; s++) for (let k = 0; k < round; k++) {
      const turn = 2 * Math.PI * k / round, aside = at("half_width", s) * Math.cos(turn), heading = at("heading", s);
      points.set([at("x", s) - aside * Math.sin(heading), at("y", s) + aside * Math.cos(heading), high[s] * Math.sin(turn)], 3 * (s * round + k));
    }
    for (let s = 0, n = 0; s + 1 < stations; s++) for (let k = 0; k < round; k++, n += 6) {
      const a = s * round + k, b = s * round + (k + 1) % round;
      faces.set([a, b, b + round, a, b + round, a + round], n);
    }
    return mesh(points, faces, null);
  }
  function vortices(one) {
    const whole = take(one.points), points = new Float32Array(whole.length);
    for (let k = 0; k < whole.length; k++) points[k] = meta.middle[k % 3] + whole[k] * meta.scale / 32767;
    return mesh(points, take(one.faces), take(one.spin));
  }
  const made = new Map(); // meshes are made when they are first seen
  const frame = (i) => { if (!made.has(i)) made.set(i, { body: body(i), vortices: vortices(meta.frames[i]) }); return made.get(i); };

  // ---- camera ----------------------------------------------------------------------------------------------------
  const count = meta.frames.length, calm = matchMedia("(prefers-reduced-motion: reduce)").matches, framed = self !== top;
  const asked = new URLSearchParams(location.hash.slice(1));
  const state = { place: 0, playing: !calm && !framed && !asked.has("t"), speed: 1, vortices: true, dark: matchMedia("(prefers-color-scheme: dark)").matches };
  const views = { corner: [-1.05, 0.62], above: [-Math.PI / 2, 1.56], side: [-Math.PI / 2, 0.03], behind: [0.35, 0.3] };
  const home = [meta.middle[0] + 0.12 * meta.length, 0, 0];
  const camera = { azimuth: -1.05, elevation: 0.62, distance: 1, target: [...home] };
  const fitted = () => meta.length * 1.45 * Math.max(1, 1.6 * canvas.clientHeight / Math.max(canvas.clientWidth, 1));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const add = (a, b, k) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
  function view() {
    const { azimuth, elevation } = camera, e = Math.cos(elevation);
    const away = [e * Math.cos(azimuth), e * Math.sin(azimuth), Math.sin(elevation)], right = [-Math.sin(azimuth), Math.cos(azimuth), 0];
    const up = cross(away, right), eye = add(camera.target, away, camera.distance);
    const f = 1 / Math.tan(0.3), aspect = canvas.width / canvas.height, near = 0.02 * meta.length, far = 60 * meta.length;
    const rows = [right.map((c) => c * f / aspect), up.map((c) => c * f), away];
    const [x, y, z] = [right, up, away].map((axis) => -dot(axis, eye)), k = (far + near) / (near - far), m = 2 * far * near / (near - far);
    const column = (d) => [rows[0][d], rows[1][d], k * away[d], -away[d]];
    const matrix = new Float32Array([...column(0), ...column(1), ...column(2), x * f / aspect, y * f, k * z + m, -z]);
    return { matrix, eye, right, up, light: [0, 1, 2].map((d) => (-0.28 * right[d] + 0.8 * up[d] + 0.44 * away[d]) / 0.955) };
  }

  // ---- drawing ---------------------------------------------------------------------------------------------------
  let dirty = true, last = 0;
  const shown = () => Math.min(Math.floor(state.place), count - 1);
  function both(one, sides) { for (const side of sides) { gl.uniform1f(u.Side, side); gl.bindVertexArray(one.array); gl.drawElements(gl.TRIANGLES, one.count, one.kind, 0); } }
  function draw() {
    const wide = Math.round(canvas.clientWidth * Math.min(devicePixelRatio, 2)), tall = Math.round(canvas.clientHeight * Math.min(devicePixelRatio, 2));
    if (canvas.width !== wide || canvas.height !== tall) { canvas.width = wide; canvas.height = tall; }
    const seen = view(), now = frame(shown());
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...(state.dark ? [0.085, 0.098, 0.106] : [0.965, 0.965, 0.95]), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.BLEND); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniformMatrix4fv(u.View, false, seen.matrix);
    gl.uniform3fv(u.Eye, seen.eye); gl.uniform3fv(u.Light, seen.light); gl.uniform1f(u.Night, +state.dark);
    gl.uniform3fv(u.Own, meta.skin); gl.uniform1f(u.Alpha, 1);
    both(now.body, [1]);
    if (state.vortices) { // their nearest surface only, seen through
      gl.uniform3fv(u.Own, [-1, 0, 0]); gl.uniform1f(u.Alpha, 0.8);
      gl.colorMask(false, false, false, false); both(now.vortices, [1, -1]); gl.colorMask(true, true, true, true);
      gl.depthFunc(gl.EQUAL); both(now.vortices, [1, -1]); gl.depthFunc(gl.LESS);
    }
    $("clock").textContent = `${meta.phase[shown()].toFixed(2)} cycle`;
    $("time").value = shown();
    $("time").setAttribute("aria-valuetext", `phase ${meta.phase[shown()].toFixed(2)}`);
    $("told").textContent = `Instant ${shown() + 1} of ${count} of the last cycle; the body swims to the left.`;
  }

  // ---- controls --------------------------------------------------------------------------------------------------
  const redraw = () => { if (!dirty) { dirty = true; requestAnimationFrame(tick); } };
  const play = (on) => { state.playing = on; last = 0; $("play").textContent = on ? "Pause" : "Play"; redraw(); };
  const seek = (place) => { state.place = Math.min(Math.max(Math.round(place), 0), count - 1); redraw(); };
  const step = (by) => { play(false); seek((shown() + by + count) % count); };
  const look = (name) => { [camera.azimuth, camera.elevation] = views[name]; camera.target = [...home]; camera.distance = fitted(); redraw(); };
  const theme = (dark) => { state.dark = dark; document.documentElement.dataset.theme = dark ? "dark" : "light"; $("theme").textContent = dark ? "Light" : "Dark"; redraw(); };
  const orbit = (dx, dy) => { camera.azimuth -= 0.006 * dx; camera.elevation = Math.min(Math.max(camera.elevation + 0.006 * dy, -1.56), 1.56); redraw(); };
  const pan = (dx, dy) => { const s = view(), k = 0.62 * camera.distance / canvas.clientHeight; camera.target = add(add(camera.target, s.right, -k * dx), s.up, k * dy); redraw(); };
  const zoom = (by) => { camera.distance = Math.min(Math.max(camera.distance * by, 0.25 * meta.length), 12 * meta.length); redraw(); };
  $("time").max = count - 1;
  $("time").addEventListener("input", (e) => { if (state.playing) play(false); seek(+e.target.value); });
  $("play").addEventListener("click", () => play(!state.playing));
  $("speed").addEventListener("change", (e) => { state.speed = +e.target.value; });
  $("view").addEventListener("change", (e) => look(e.target.value));
  $("theme").addEventListener("click", () => theme(!state.dark));
  $("vortices").addEventListener("change", (e) => { state.vortices = e.target.checked; redraw(); });
  const fingers = new Map();
  canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, [e.clientX, e.clientY]); });
  canvas.addEventListener("pointermove", (e) => {
    const before = fingers.get(e.pointerId);
    if (!before) return;
    const dx = e.clientX - before[0], dy = e.clientY - before[1];
    if (fingers.size === 1) (e.shiftKey || e.buttons & 6 ? pan : orbit)(dx, dy);
    else {
      const other = [...fingers].find(([id]) => id !== e.pointerId)[1], far = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
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
      " ": () => play(!state.playing), Home: () => seek(0), End: () => seek(count - 1) };
    const act = acts[e.key];
    if (act && !e.ctrlKey && !e.metaKey && !e.altKey) { e.preventDefault(); act(); }
  });
  new ResizeObserver(redraw).observe(canvas);
  canvas.addEventListener("webglcontextlost", () => { document.body.classList.remove("alive"); state.playing = false; });

  function tick(stamp) {
    dirty = false;
    if (state.playing) {
      if (last) state.place = (state.place + state.speed * count / 4 * Math.min((stamp - last) / 1000, 0.25)) % count;
      last = stamp;
    }
    draw();
    if (state.playing) redraw();
  }
  document.body.classList.add("alive");
  theme(state.dark);
  look(views[asked.get("view")] ? asked.get("view") : "corner");
  if (views[asked.get("view")]) $("view").value = asked.get("view");
  seek(asked.has("t") ? (+asked.get("t") || 0) * count : count - 1);
  $("play").textContent = state.playing ? "Pause" : "Play";
  window.suchus = { state, camera, seek, play, shown };
  dirty = true;
  requestAnimationFrame(tick);
})();
