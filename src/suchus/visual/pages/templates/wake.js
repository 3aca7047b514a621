// A swimming body and the surfaces around its vortices. World: x to the tail, z up.
(() => {
  if (!shared) return;
  const { $, meta, canvas, gl, take, add, cross, dot, program, asked, state, redraw, play } = shared;

  // ---- one program for both: a mesh has points, normals and a shade from -1 to 1 --------------------------------
  const { made, uniforms: u } = program(`
    layout(location=0) in vec3 aAt; layout(location=1) in vec3 aNormal; layout(location=2) in float aShade;
    uniform mat4 uView; uniform float uSide; out vec3 vAt, vNormal; out float vShade;
    void main() {
      vec3 side = vec3(1.0, 1.0, uSide);
      vAt = aAt * side; vNormal = aNormal * side; vShade = aShade;
      gl_Position = uView * vec4(vAt, 1.0);
    }`, `
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
    }`);
  gl.useProgram(made);
  gl.uniform3fv(u.uRamp, meta.ramp.flat());

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
  const meshes = new Map(); // meshes are made when they are first seen
  const frame = (i) => { if (!meshes.has(i)) meshes.set(i, { body: body(i), vortices: vortices(meta.frames[i]) }); return meshes.get(i); };

  // ---- camera ----------------------------------------------------------------------------------------------------
  const count = meta.frames.length;
  Object.assign(state, { place: 0, vortices: true });
  const views = { corner: [-1.05, 0.62], above: [-Math.PI / 2, 1.56], side: [-Math.PI / 2, 0.03], behind: [0.35, 0.3] };
  const home = [meta.middle[0] + 0.12 * meta.length, 0, 0];
  const camera = { azimuth: -1.05, elevation: 0.62, distance: 1, target: [...home] };
  const fitted = () => meta.length * 1.45 * Math.max(1, 1.6 * canvas.clientHeight / Math.max(canvas.clientWidth, 1));
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
  const shown = () => Math.min(Math.floor(state.place), count - 1);
  function both(one, sides) { for (const side of sides) { gl.uniform1f(u.uSide, side); gl.bindVertexArray(one.array); gl.drawElements(gl.TRIANGLES, one.count, one.kind, 0); } }
  function draw() {
    shared.clear([0.965, 0.965, 0.95], [0.085, 0.098, 0.106]);
    const seen = view(), now = frame(shown());
    gl.uniformMatrix4fv(u.uView, false, seen.matrix);
    gl.uniform3fv(u.uEye, seen.eye); gl.uniform3fv(u.uLight, seen.light); gl.uniform1f(u.uNight, +state.dark);
    gl.uniform3fv(u.uOwn, meta.skin); gl.uniform1f(u.uAlpha, 1);
    both(now.body, [1]);
    if (state.vortices) {
      gl.uniform3fv(u.uOwn, [-1, 0, 0]); gl.uniform1f(u.uAlpha, 0.8);
      const surfaces = () => both(now.vortices, [1, -1]);
      shared.nearest(surfaces, surfaces);
    }
    $("clock").textContent = `${meta.phase[shown()].toFixed(2)} cycle`;
    $("time").value = shown();
    $("time").setAttribute("aria-valuetext", `phase ${meta.phase[shown()].toFixed(2)}`);
    $("told").textContent = `Instant ${shown() + 1} of ${count} of the last cycle; the body swims to the left.`;
  }

  // ---- controls --------------------------------------------------------------------------------------------------
  const seek = (place) => { state.place = Math.min(Math.max(Math.round(place), 0), count - 1); redraw(); };
  const step = (by) => { play(false); seek((shown() + by + count) % count); };
  const look = (name) => { [camera.azimuth, camera.elevation] = views[name]; camera.target = [...home]; camera.distance = fitted(); redraw(); };
  const move = (by) => { camera.target = add(camera.target, by); };
  $("time").max = count - 1;
  shared.hold({ camera, lowest: -1.56, move, seen: view, look, seek, step, start: 0, end: () => count - 1, boxes: ["vortices"], play });
  shared.begin(draw, (time) => { state.place = (state.place + time * count / 4) % count; });
  look(views[asked.get("view")] ? asked.get("view") : "corner");
  if (views[asked.get("view")]) $("view").value = asked.get("view");
  seek(asked.has("t") ? (+asked.get("t") || 0) * count : count - 1);
  window.suchus = { state, camera, seek, play, shown };
})();
