// Robots as skinned meshes, what they stand on, and what carries them. World: x forward, z up.
(() => {
  if (!shared) return;
  const { $, meta, canvas, gl, take, add, cross, dot, unit, program, asked, framed, state, pace, fineness, redraw } = shared;
  const live = "live" in document.body.dataset; // frames arrive while it plays: no record yet

  // ---- vectors and quaternions (wxyz) --------------------------------------------------------------------------
  const sub = (a, b) => add(a, b, -1);
  const turn = (q, v) => { const u = [q[1], q[2], q[3]], t = cross(u, v).map((c) => 2 * c);
    return add(add(v, t, q[0]), cross(u, t)); };
  const times = (a, b) => { // column-major 4 x 4
    const out = new Float32Array(16);
    for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++)
      for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return out;
  };

  // ---- programs ------------------------------------------------------------------------------------------------
  const LIGHT = unit([-0.35, -0.45, 1.0]);
  const lit = `
    uniform vec3 uEye; uniform vec4 uTint; uniform float uNight;
    vec3 lit(vec3 colour, vec3 n, vec3 at) {
      vec3 L = normalize(vec3(${LIGHT})), V = normalize(uEye - at), H = normalize(L + V);
      float sky = 0.5 + 0.5 * n.z;
      vec3 c = colour * (mix(vec3(0.42, 0.39, 0.35), vec3(0.55, 0.58, 0.62), sky) + 0.66 * max(dot(n, L), 0.0) + 0.24 * max(dot(n, V), 0.0));
      c += 0.16 * pow(max(dot(n, H), 0.0), 28.0) + 0.10 * pow(1.0 - max(dot(n, V), 0.0), 3.0) * sky;
      return c * mix(1.0, 0.86, uNight);
    }`;
  const lines = `
    float line(vec2 at, float each, float wide) {
      vec2 from = abs(fract(at / each - 0.5) - 0.5) * each, w = fwidth(at);
      vec2 hit = 1.0 - smoothstep(vec2(wide * 0.5), vec2(wide * 0.5) + 1.2 * w, from);
      return max(hit.x, hit.y) * clamp(each / (6.0 * max(w.x, w.y)), 0.0, 1.0);
    }
    float lines(vec2 at) { return max(0.22 * line(at, 0.1, 0.0006), 0.70 * line(at, 1.0, 0.002)); }`;
  const skinned = program(`
    layout(location=0) in vec3 aAt; layout(location=1) in vec3 aNormal; layout(location=2) in vec3 aColour;
    layout(location=3) in uvec2 aBone; layout(location=4) in float aWeight;
    uniform mat4 uView; uniform float uScale; uniform vec4 uTurn[${meta.bones}]; uniform vec4 uShift[${meta.bones}];
    uniform vec4 uFlat; out vec3 vAt, vNormal, vColour;
    vec3 turn(vec4 q, vec3 v) { vec3 t = 2.0 * cross(q.yzw, v); return v + q.x * t + cross(q.yzw, t); }
    void main() {
      vec3 p = aAt * uScale;
      uint a = aBone.x, b = aBone.y;
      vAt = mix(turn(uTurn[b], p) + uShift[b].xyz, turn(uTurn[a], p) + uShift[a].xyz, aWeight);
      vNormal = mix(turn(uTurn[b], aNormal), turn(uTurn[a], aNormal), aWeight);
      if (uFlat.w > 0.5) vAt = vec3(vAt.xy - uFlat.xy * vAt.z, 0.0006);
      vColour = aColour;
      gl_Position = uView * vec4(vAt, 1.0);
    }`, `
    in vec3 vAt, vNormal, vColour; uniform vec4 uFlat; out vec4 colour; ${lit}
    void main() {
      if (uFlat.w > 0.5) { colour = vec4(0.0, 0.0, 0.0, uFlat.z); return; }
      colour = vec4(lit(mix(vColour, uTint.rgb, uTint.a), normalize(vNormal), vAt), uFlat.z);
    }`);
  const plain = program(`
    layout(location=0) in vec3 aAt; layout(location=1) in vec3 aNormal; layout(location=2) in vec4 aColour;
    uniform mat4 uView; out vec3 vAt, vNormal; out vec4 vColour;
    void main() { vAt = aAt; vNormal = aNormal; vColour = aColour; gl_Position = uView * vec4(aAt, 1.0); }`, `
    in vec3 vAt, vNormal; in vec4 vColour; uniform float uLined; uniform vec3 uFar; out vec4 colour; ${lit} ${lines}
    void main() {
      bool flat_ = dot(vNormal, vNormal) < 0.01;
      vec3 own = mix(vColour.rgb, vec3(0.45, 0.43, 0.38), uLined * lines(vAt.xy));
      float near = uFar.z > 0.0 ? 1.0 - smoothstep(0.4, 1.0, length(vAt.xy - uFar.xy) / uFar.z) : 1.0;
      colour = vec4(flat_ ? own : lit(own, normalize(vNormal), vAt), vColour.a * near);
    }`);
  const floor = program(`
    layout(location=0) in vec3 aAt; uniform mat4 uView; uniform vec3 uEye; uniform float uLevel; out vec2 vAt;
    void main() { vAt = aAt.xy * 14.0 + uEye.xy; gl_Position = uView * vec4(vAt, uLevel, 1.0); }`, `
    in vec2 vAt; uniform vec3 uEye, uBack, uLine; out vec4 colour; ${lines}
    void main() {
      float fade = 1.0 - smoothstep(2.0, 9.0, length(vAt - uEye.xy));
      colour = vec4(mix(uBack, uLine, lines(vAt) * fade), 1.0);
    }`);

  const buffer = (data, target = gl.ARRAY_BUFFER) => {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return made;
  };
  const attribute = (at, size, kind, normalised) => {
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, kind, normalised, 0, 0);
  };
  const COARSE_CELLS = 60; // in the length of the robot; of the vertices in a cell of space one stays
  function coarseFaces({ vertices, bones, faces, scale }) { // fewer triangles, for shadows and for slow devices
    const [places, hung, corners] = [vertices, bones, faces].map(take), cell = meta.size / COARSE_CELLS / scale * 32767;
    const kept = new Map(), stands = Array.from({ length: places.length / 3 }, (_, i) => {
      const key = [places[3 * i], places[3 * i + 1], places[3 * i + 2]].map((x) => Math.floor(x / cell)).join() + "," + hung[2 * i];
      if (!kept.has(key)) kept.set(key, i);
      return kept.get(key);
    }), coarse = [];
    for (let k = 0; k < corners.length; k += 3) {
      const [a, b, c] = [0, 1, 2].map((i) => stands[corners[k + i]]);
      if (a !== b && b !== c && c !== a) coarse.push(a, b, c);
    }
    return Uint16Array.from(coarse);
  }
  const skin = { ...meta.skin, array: gl.createVertexArray() };
  gl.bindVertexArray(skin.array);
  buffer(take(skin.vertices)); attribute(0, 3, gl.SHORT, true);
  buffer(take(skin.normals)); attribute(1, 3, gl.BYTE, true);
  buffer(take(skin.colours)); attribute(2, 3, gl.UNSIGNED_BYTE, true);
  buffer(take(skin.bones)); gl.enableVertexAttribArray(3); gl.vertexAttribIPointer(3, 2, gl.UNSIGNED_BYTE, 0, 0);
  buffer(take(skin.weights)); attribute(4, 1, gl.UNSIGNED_BYTE, true);
  const coarse = coarseFaces(skin), faces = { fine: { start: 0, count: skin.faces.count }, coarse: { start: 2 * skin.faces.count, count: coarse.length } };
  const corners = new Uint16Array(skin.faces.count + coarse.length);
  corners.set(take(skin.faces));
  corners.set(coarse, skin.faces.count);
  buffer(corners, gl.ELEMENT_ARRAY_BUFFER);
  const quad = gl.createVertexArray();
  gl.bindVertexArray(quad);
  buffer(new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0])); attribute(0, 3, gl.FLOAT, false);

  // triangles that are made anew for each picture: position, normal, colour
  const dynamic = gl.createVertexArray();
  gl.bindVertexArray(dynamic);
  const dynamicBuffer = buffer(new Float32Array(0));
  const lay = () => { for (const [at, size, start] of [[0, 3, 0], [1, 3, 12], [2, 4, 24]]) {
    gl.enableVertexAttribArray(at); gl.vertexAttribPointer(at, size, gl.FLOAT, false, 40, start); } };
  lay();
  let relief = null;
  if (meta.relief) {
    const made = [];
    solid(meta.relief, made);
    relief = { array: gl.createVertexArray(), count: made.length / 10 };
    gl.bindVertexArray(relief.array);
    buffer(new Float32Array(made)); lay();
  }
  gl.bindVertexArray(null);

  function push(to, a, b, c, colour, n) {
    n = n || unit(cross(sub(b, a), sub(c, a)));
    for (const p of [a, b, c]) to.push(...p, ...n, ...colour);
  }
  function solid(piece, to) { // a grid of heights, or a block
    const colour = [...meta.colours.relief, 1];
    if (piece.heights) {
      const z = take(piece.heights), [rows, columns] = piece.shape;
      const at = (i, j) => [piece.x0 + j * piece.cell, piece.y0 + i * piece.cell, piece.scale * z[i * columns + j]];
      for (let i = 0; i + 1 < rows; i++) for (let j = 0; j + 1 < columns; j++) {
        const [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        push(to, a, b, c, colour); push(to, a, c, d, colour);
      }
      return;
    }
    const [x0, x1, y0, y1, z] = piece.block;
    const corner = (i) => [i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z : 0];
    for (const [a, b, c, d] of [[4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]]) {
      push(to, corner(a), corner(b), corner(c), colour); push(to, corner(a), corner(c), corner(d), colour);
    }
  }

  // ---- state ---------------------------------------------------------------------------------------------------
  Object.assign(state, { time: meta.start, forces: true, support: true, tracks: true, follow: true, run: 0,
    compare: meta.chosen || meta.actors.length < 2 ? "hidden" : meta.overlaid ? "over" : "beside" });
  const bodyLength = meta.length; // sizes of marks [m] were chosen for a robot as long as the article's, 1 m
  const camera = { azimuth: -0.95, elevation: 0.36, distance: 2.2 * meta.size, target: [0, 0, 0.06 * meta.length], moved: [0, 0, 0] };
  let shown = null;

  const actors = meta.actors.map((actor) => {
    const read = Object.fromEntries(Object.entries(actor.arrays).map(([name, ref]) => [name, take(ref)]));
    if (live) for (const name in read) read[name] = Float32Array.from(read[name]);
    return { ...actor, ...read, side: 0 };
  });
  const lastTime = () => meta.start + (Math.max(...actors.map((actor) => actor.frames)) - 1) / meta.rate;

  // ---- frames of a live run --------------------------------------------------------------------------------------
  const FULL = 32767; // places and turns are fractions of it
  const LIVE_TRACK = 10; // [s]; tracks of a live run are drawn for so long
  function append(actor, frame) { // numbers in metres, newtons and unit quaternions
    const packed = { ...frame, turns: frame.turns.map((value) => FULL * value),
      places: frame.places.map((value, k) => FULL * (value - actor.origin[k % 3]) / actor.reach) };
    for (const [name, values] of Object.entries(packed)) {
      if (actor[name].length < (actor.frames + 1) * values.length) {
        const longer = new Float32Array(2 * (actor.frames + 1) * values.length);
        longer.set(actor[name]);
        actor[name] = longer;
      }
      actor[name].set(values, actor.frames * values.length);
    }
    actor.frames += 1;
  }
  const restart = () => { for (const actor of actors) actor.frames = 0; state.time = meta.start; };

  const limbs = 3 * meta.radii.length; // numbers for each frame

  function frame(actor, time) { // bones, feet, forces and centre of mass between two samples
    const f = Math.min(Math.max((time - meta.start) * meta.rate, 0), actor.frames - 1);
    const i = Math.min(Math.floor(f), Math.max(actor.frames - 2, 0)), s = actor.frames > 1 ? f - i : 0, n = skin.rest.length;
    const j = Math.min(i + 1, actor.frames - 1);
    const turns = new Float32Array(4 * meta.bones), shifts = new Float32Array(4 * meta.bones);
    for (let b = 0; b < n; b++) {
      const u = 4 * (i * n + b), v = 4 * (j * n + b), q = [0, 0, 0, 0];
      let same = 0;
      for (let k = 0; k < 4; k++) same += actor.turns[u + k] * actor.turns[v + k];
      for (let k = 0; k < 4; k++) q[k] = (1 - s) * actor.turns[u + k] + s * Math.sign(same || 1) * actor.turns[v + k];
      const size = Math.hypot(...q) || 1;
      for (let k = 0; k < 4; k++) q[k] /= size;
      const at = [0, 1, 2].map((k) => actor.origin[k] + actor.reach *
        ((1 - s) * actor.places[3 * (i * n + b) + k] + s * actor.places[3 * (j * n + b) + k]) / 32767);
      at[1] += actor.side;
      turns.set(q, 4 * b);
      shifts.set(sub(at, turn(q, skin.rest[b])), 4 * b);
    }
    const mix = (array, size, k, o) => (1 - s) * array[size * i + k] + s * array[size * j + k] + o;
    const three = (array, size, k, o = 0) => [mix(array, size, k, 0), mix(array, size, k + 1, o), mix(array, size, k + 2, 0)];
    return { turns, shifts, mass: three(actor.mass, 3, 0, actor.side),
      feet: meta.radii.map((_, leg) => three(actor.feet, limbs, 3 * leg, actor.side)),
      forces: meta.radii.map((_, leg) => three(actor.forces, limbs, 3 * leg)),
      tail: [0, 1, 2, 3].map((k) => mix(actor.tail, 4, k, k === 1 ? actor.side : 0)) };
  }

  // ---- shapes made anew ----------------------------------------------------------------------------------------
  function arrow(to, from, along, colour) {
    const long = Math.hypot(...along);
    if (long < 0.006 * bodyLength) return;
    const d = unit(along), u = unit(cross(d, Math.abs(d[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1])), v = cross(d, u);
    const head = Math.min(0.028 * bodyLength, 0.5 * long), neck = long - head, n = 10;
    const ring = (k, r, at) => { const a = 2 * Math.PI * k / n;
      return add(add(add(from, d, at), u, r * Math.cos(a)), v, r * Math.sin(a)); };
    const away = (k) => { const a = 2 * Math.PI * k / n; return add(u.map((c) => c * Math.cos(a)), v, Math.sin(a)); };
    const facet = (a, b, c, na, nb, nc) => to.push(...a, ...na, ...colour, ...b, ...nb, ...colour, ...c, ...nc, ...colour);
    for (let k = 0; k < n; k++) {
      const a = ring(k, 0.0045 * bodyLength, 0), b = ring(k + 1, 0.0045 * bodyLength, 0), c = ring(k + 1, 0.0045 * bodyLength, neck), e = ring(k, 0.0045 * bodyLength, neck);
      facet(a, b, c, away(k), away(k + 1), away(k + 1)); facet(a, c, e, away(k), away(k + 1), away(k));
      push(to, ring(k, 0.0115 * bodyLength, neck), ring(k + 1, 0.0115 * bodyLength, neck), add(from, d, long), colour);
    }
  }
  function disc(to, at, radius, colour, n = 20) {
    for (let k = 0; k < n; k++) {
      const p = (i) => [at[0] + radius * Math.cos(2 * Math.PI * i / n), at[1] + radius * Math.sin(2 * Math.PI * i / n), at[2]];
      push(to, at, p(k), p(k + 1), colour, [0, 0, 0]);
    }
  }
  function ball(to, at, radius, colour) {
    const p = (i, j) => { const a = Math.PI * i / 8, b = 2 * Math.PI * j / 12;
      return [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)]; };
    for (let i = 0; i < 8; i++) for (let j = 0; j < 12; j++)
      for (const t of [[p(i, j), p(i + 1, j), p(i + 1, j + 1)], [p(i, j), p(i + 1, j + 1), p(i, j + 1)]])
        for (const n of t) to.push(...add(at, n, radius), ...n, ...colour);
  }
  function ribbon(to, a, b, wide, colour) { // flat on the ground
    const d = sub(b, a), size = Math.hypot(d[0], d[1]);
    if (size < 1e-6) return;
    const n = [-d[1] / size * wide / 2, d[0] / size * wide / 2, 0];
    push(to, add(a, n, -1), add(b, n, -1), add(b, n), colour, [0, 0, 0]);
    push(to, add(a, n, -1), add(b, n), add(a, n), colour, [0, 0, 0]);
  }
  function hull(points) { // Andrew's monotone chain
    const p = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const left = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
    const half = (list) => list.reduce((kept, c) => {
      while (kept.length > 1 && !left(kept[kept.length - 2], kept[kept.length - 1], c)) kept.pop();
      return [...kept, c]; }, []).slice(0, -1);
    return p.length < 3 ? p : [...half(p), ...half(p.reverse())];
  }
  const rough = meta.relief !== null;
  const under = (foot, radius, lift) => [foot[0], foot[1], Math.max(foot[2] - radius, rough ? meta.floor : 0) + lift];

  function tracks(to, actor, faint) {
    const until = Math.min(Math.floor((state.time - meta.start) * meta.rate), actor.frames - 1), step = 2;
    const from = live ? Math.max(0, until - until % step - step * Math.round(LIVE_TRACK * meta.rate / step)) : 0;
    for (let leg = 0; leg < meta.radii.length; leg++) {
      const colour = [...meta.colours.legs[leg], faint ? 0.35 : 0.85];
      const at = (i) => { const k = limbs * i + 3 * leg;
        return under([actor.feet[k], actor.feet[k + 1] + actor.side, actor.feet[k + 2]], meta.radii[leg], 0.0011 * bodyLength); };
      for (let i = from; i + step <= until; i += step) {
        const stands = actor.forces[limbs * i + 3 * leg + 2] > meta.loaded;
        const a = at(i), b = at(i + step);
        if (!stands && rough) continue; // where the ground lies under a swinging foot is not recorded
        if (!stands) a[2] = b[2] = 0.0011 * bodyLength;
        ribbon(to, a, b, stands ? 0.008 * bodyLength : 0.0025 * bodyLength, colour);
      }
    }
    const mass = (i) => [actor.mass[3 * i], actor.mass[3 * i + 1] + actor.side, 0.0012 * bodyLength];
    for (let i = from; i + step <= until; i += step) ribbon(to, mass(i), mass(i + step), 0.003 * bodyLength, [...meta.colours.mass, faint ? 0.3 : 0.8]);
  }
  function support(to, actor, now) {
    const standing = now.feet.map((foot, leg) => [under(foot, meta.radii[leg], 0.0014 * bodyLength), now.forces[leg][2] > meta.loaded])
      .filter(([, stands]) => stands).map(([at]) => at);
    if (now.tail[3] > meta.loaded) standing.push(under(now.tail, rough ? 0 : now.tail[2], 0.0014 * bodyLength)); // its tip, as in metrics
    const corners = hull(standing), colour = meta.colours.support;
    for (let i = 1; i + 1 < corners.length; i++) push(to, corners[0], corners[i], corners[i + 1], [...colour, 0.40], [0, 0, 0]);
    for (let i = 0; i < corners.length; i++) ribbon(to, corners[i], corners[(i + 1) % corners.length], 0.005 * bodyLength, [...colour, 0.95]);
    const shadow = [now.mass[0], now.mass[1], 0.0018 * bodyLength];
    disc(to, shadow, 0.012 * bodyLength, [...meta.colours.mass, 1]);
    disc(to, add(shadow, [0, 0, 0.0002 * bodyLength]), 0.007 * bodyLength, [1, 1, 1, 1]);
  }

  // ---- drawing -------------------------------------------------------------------------------------------------
  const aground = (v) => turn([meta.slope[0], ...meta.slope.slice(1).map((c) => -c)], v); // all is drawn as if it were level
  function view() {
    const { azimuth, elevation, distance } = camera, e = Math.cos(elevation);
    const target = add(camera.target, camera.moved);
    const away = aground([e * Math.cos(azimuth), e * Math.sin(azimuth), Math.sin(elevation)]);
    const eye = add(target, away, distance);
    const right = unit(cross(aground([0, 0, 1]), away)), up = cross(away, right);
    const look = new Float32Array([right[0], up[0], away[0], 0, right[1], up[1], away[1], 0, right[2], up[2], away[2], 0,
      -dot(right, eye), -dot(up, eye), -dot(away, eye), 1]);
    const aspect = canvas.width / canvas.height, f = 1 / Math.tan(0.30 * Math.max(1, 0.75 / aspect)), near = 0.02 * bodyLength, far = 60;
    const lens = new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
    return { matrix: times(lens, look), eye, right, up };
  }
  function usePlain(seen) {
    gl.useProgram(plain.made);
    gl.uniformMatrix4fv(plain.uniforms.uView, false, seen.matrix);
    gl.uniform3fv(plain.uniforms.uEye, seen.eye);
    gl.uniform1f(plain.uniforms.uNight, +state.dark);
  }
  let levels = meta.water ? take(meta.water.levels) : null;
  function levelNow() { // of the water above the origin, against gravity
    const f = Math.min(Math.max((state.time - meta.start) * meta.rate, 0), levels.length - 1), i = Math.floor(f);
    return levels[i] + (f - i) * (levels[Math.min(i + 1, levels.length - 1)] - levels[i]);
  }
  function surface(seen) { // the water's, drawn last and half transparent; only where it stands above the ground
    if (!levels) return;
    const level = levelNow(), up = meta.water.up;
    const reach = 9 * meta.length, c = camera.target; // it fades into the distance: no edge is seen
    const at = (x, y) => [x, y, (level - up[0] * x - up[1] * y) / up[2]];
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => at(c[0] + a * reach, c[1] + b * reach));
    const wet = [];
    corners.forEach((p, k) => { // clipped at the ground, after Sutherland and Hodgman
      const q = corners[(k + 1) % 4], dp = p[2] - meta.floor, dq = q[2] - meta.floor;
      if (dp >= 0) wet.push(p);
      if (dp * dq < 0) wet.push(add(p, sub(q, p), dp / (dp - dq)));
    });
    const made = [], colour = [...meta.colours.water, 0.3];
    for (let k = 1; k + 1 < wet.length; k++) push(made, wet[0], wet[k], wet[k + 1], colour, [0, 0, 0]);
    triangles(made, seen, false, [c[0], c[1], reach]);
  }
  function triangles(made, seen, write, far = [0, 0, 0]) {
    if (!made.length) return;
    usePlain(seen);
    gl.uniform3fv(plain.uniforms.uFar, far);
    gl.bindVertexArray(dynamic);
    gl.bindBuffer(gl.ARRAY_BUFFER, dynamicBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(made), gl.DYNAMIC_DRAW);
    gl.depthMask(write);
    gl.drawArrays(gl.TRIANGLES, 0, made.length / 10);
    gl.depthMask(true);
  }
  function robot(now, seen, { flat = 0, alpha = 1, tint = [0, 0, 0, 0] } = {}) {
    const u = skinned.uniforms;
    gl.useProgram(skinned.made);
    gl.uniformMatrix4fv(u.uView, false, seen.matrix);
    gl.uniform3fv(u.uEye, seen.eye);
    gl.uniform1f(u.uNight, +state.dark);
    gl.uniform1f(u.uScale, skin.scale);
    gl.uniform4fv(u.uTurn, now.turns);
    gl.uniform4fv(u.uShift, now.shifts);
    gl.uniform4fv(u.uTint, tint);
    gl.uniform4f(u.uFlat, LIGHT[0] / LIGHT[2], LIGHT[1] / LIGHT[2], alpha, flat);
    gl.bindVertexArray(skin.array);
    const { start, count } = fineness().fine && !flat ? faces.fine : faces.coarse;
    gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_SHORT, start);
  }
  function shadow(now, seen, alpha) {
    gl.enable(gl.STENCIL_TEST);
    gl.clear(gl.STENCIL_BUFFER_BIT);
    gl.stencilFunc(gl.EQUAL, 0, 255);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
    gl.depthMask(false);
    robot(now, seen, { flat: 1, alpha });
    gl.depthMask(true);
    gl.disable(gl.STENCIL_TEST);
  }
  const through = (now, seen) => shared.nearest(
    () => robot(now, seen), () => robot(now, seen, { alpha: 0.5, tint: [...meta.colours.ghost, 0.6] }));

  function draw() {
    const back = shared.clear([0.925, 0.925, 0.905], [0.085, 0.098, 0.106]);
    const seenActors = meta.chosen ? [actors[state.run]] : state.compare === "hidden" ? actors.slice(0, 1) : actors;
    actors.forEach((actor, i) => { actor.side = i && state.compare === "beside" ? meta.aside : 0; });
    const now = seenActors.map((actor) => frame(actor, state.time));
    if (state.follow) {
      const sum = now.reduce((at, one) => add(at, one.mass, 1 / now.length), [0, 0, 0]);
      if (live) sum[0] = now[0].mass[0]; // the other robot may stay far behind
      camera.target = [sum[0], sum[1], levels ? sum[2] : Math.max(0.06 * meta.length, 0.8 * sum[2])];
    }
    const seen = view();
    gl.useProgram(floor.made);
    gl.uniformMatrix4fv(floor.uniforms.uView, false, seen.matrix);
    gl.uniform3fv(floor.uniforms.uEye, seen.eye);
    gl.uniform3fv(floor.uniforms.uBack, back);
    gl.uniform1f(floor.uniforms.uLevel, meta.floor);
    gl.uniform3fv(floor.uniforms.uLine, state.dark ? [0.42, 0.46, 0.48] : [0.60, 0.60, 0.57]);
    gl.bindVertexArray(quad);
    gl.depthMask(false); // drawn first and under everything: what lies on it cannot flicker against it
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.depthMask(true);
    if (relief) {
      usePlain(seen);
      gl.uniform3fv(plain.uniforms.uFar, [0, 0, 0]);
      gl.uniform1f(plain.uniforms.uLined, 1);
      gl.bindVertexArray(relief.array);
      gl.drawArrays(gl.TRIANGLES, 0, relief.count);
      gl.uniform1f(plain.uniforms.uLined, 0);
    } else if (fineness().shadows) now.forEach((one, i) => shadow(one, seen, (state.dark ? 0.45 : 0.22) / (i + 1)));
    const flat = [], solids = [];
    seenActors.forEach((actor, i) => {
      if (state.tracks) tracks(flat, actor, i > 0);
      if (state.support && !i) support(flat, actor, now[i]);
      if (state.forces) now[i].forces.forEach((force, leg) =>
        arrow(solids, under(now[i].feet[leg], meta.radii[leg], 0), force.map((f) => f * meta.metres_per_newton), [...meta.colours.force, 1]));
      if (state.support && !i) ball(solids, now[i].mass, 0.009 * bodyLength, [...meta.colours.mass, 1]);
    });
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(-1, -4);
    triangles(flat, seen, false);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    robot(now[0], seen);
    triangles(solids, seen, true);
    if (now.length > 1) through(now[1], seen);
    surface(seen);
    if (state.support) { gl.disable(gl.DEPTH_TEST); const mark = []; hoop(mark, now[0].mass, seen); triangles(mark, seen, false); gl.enable(gl.DEPTH_TEST); }
    labels(seen);
    readout(now, seenActors);
    shown = now;
  }
  function hoop(to, at, seen) { // the centre of mass is inside the body: a ring seen through it
    for (let k = 0; k < 24; k++) {
      const p = (i, r) => add(add(at, seen.right, r * Math.cos(Math.PI * i / 12)), seen.up, r * Math.sin(Math.PI * i / 12));
      push(to, p(k, 0.008 * bodyLength), p(k + 1, 0.008 * bodyLength), p(k + 1, 0.012 * bodyLength), [...meta.colours.mass, 0.95], [0, 0, 0]);
      push(to, p(k, 0.008 * bodyLength), p(k + 1, 0.012 * bodyLength), p(k, 0.012 * bodyLength), [...meta.colours.mass, 0.95], [0, 0, 0]);
    }
  }

  // ---- words on the picture --------------------------------------------------------------------------------------
  const scale = $("scale");
  const marks = Array.from({ length: meta.marks[1] - meta.marks[0] + 1 }, (_, i) => {
    const mark = document.createElement("span");
    mark.textContent = `${meta.marks[0] + i} m`.replace("-", "−");
    scale.append(mark);
    return { mark, at: [meta.marks[0] + i, meta.mark_side, 0] };
  });
  const names = actors.map((actor, i) => { const mark = document.createElement("span"); mark.className = i ? "name ghost" : "name";
    mark.textContent = actors.length > 1 && !meta.chosen ? actor.label : ""; scale.append(mark); return mark; });
  const heads = actors.map(() => { const mark = document.createElement("span"); mark.className = "head"; mark.textContent = "head"; scale.append(mark); return mark; });
  const HEAD_DISTANCE = 0.08; // of the word from the snout [body length]
  function headOf({ turns, shifts }) {
    const b = meta.head.bone, part = (array, size) => Array.from(array.subarray(4 * b, 4 * b + size));
    return add(turn(part(turns, 4), add(meta.head.at, [HEAD_DISTANCE * bodyLength, 0, 0])), part(shifts, 3));
  }
  function put(mark, at, seen, visible = true) {
    const m = seen.matrix, w = m[3] * at[0] + m[7] * at[1] + m[11] * at[2] + m[15];
    const x = (m[0] * at[0] + m[4] * at[1] + m[8] * at[2] + m[12]) / w, y = (m[1] * at[0] + m[5] * at[1] + m[9] * at[2] + m[13]) / w;
    mark.style.display = visible && w > 0.05 && Math.abs(x) < 1 && Math.abs(y) < 1 ? "" : "none";
    mark.style.transform = `translate(${(x + 1) / 2 * canvas.clientWidth}px, ${(1 - y) / 2 * canvas.clientHeight}px) translate(-50%, -50%)`;
  }
  function labels(seen) {
    for (const { mark, at } of marks) put(mark, at, seen);
    heads.forEach((mark, i) => put(mark, headOf(frame(actors[i], state.time)), seen, meta.chosen ? i === state.run : !i || state.compare === "beside"));
    actors.forEach((actor, i) => put(names[i], add(frame(actor, state.time).mass, [0, 0, (i && state.compare === "over" ? 0.22 : 0.16) * meta.size]), seen, i === 0 || state.compare !== "hidden"));
  }
  const places = meta.length < 0.5 ? 3 : 2;
  const metres = (v) => `${v.toFixed(places).replace(/^-(?=[0.]+$)/, "").replace("-", "−")} m`;
  function readout(now, seenActors) {
    $("clock").textContent = `${state.time.toFixed(2)} s`;
    if (live) $("time").max = lastTime();
    $("time").value = state.time;
    $("time").setAttribute("aria-valuetext", `${state.time.toFixed(1)} seconds`);
    const way = (i) => now[i].mass[0] - seenActors[i].mass[0];
    const below = (mass) => levelNow() - mass.reduce((sum, one, k) => sum + one * meta.water.up[k], 0);
    const where = (mass) => !levels ? `${metres(mass[2])} high` : below(mass) < 0 ? `${metres(-below(mass))} above the water` : `${metres(below(mass))} deep`;
    $("told").textContent = now.map((_, i) => `${actors.length > 1 && !meta.chosen ? actors[i].label + ": " : ""}${metres(way(i))} forward, ` +
      `centre of mass ${where(now[i].mass)}`).join("  ·  ");
  }

  // ---- controls ------------------------------------------------------------------------------------------------
  let advance = null; // of a live run: simulates until a time and returns the time that it reached
  const seek = (time) => { state.time = Math.min(Math.max(time, meta.start), lastTime()); redraw(); };
  const play = (on) => { if (on && !live && state.time >= lastTime() - 1e-6) state.time = meta.start; shared.play(on); };
  const step = (by) => seek(state.time + by / meta.rate);
  const views = { corner: [-0.95, 0.36], left: [Math.PI / 2, 0.06], right: [-Math.PI / 2, 0.06], front: [0, 0.12], above: [-Math.PI / 2, 1.55] };
  const look = (name) => { [camera.azimuth, camera.elevation] = views[name]; camera.moved = [0, 0, 0]; camera.distance = fitted(); redraw(); };
  const move = (by) => { camera.moved = add(camera.moved, by); };
  const fitted = () => { // farther on narrow pictures, nearer on wide ones
    const aspect = canvas.clientWidth / Math.max(canvas.clientHeight, 1);
    return meta.size * (state.compare === "beside" ? 2.0 : 1.6) * Math.max(0.78, Math.min(1, 1.7 / aspect), (state.compare === "beside" ? 1.2 : 1.15) / aspect);
  };
  $("time").min = meta.start; $("time").max = lastTime(); $("time").step = 1 / meta.rate;
  const choose = (run) => { state.run = run; $("choice").textContent = actors[run].label; $("chosen").setAttribute("aria-valuetext", actors[run].label); redraw(); };
  if ($("chosen")) { choose(0); $("chosen").addEventListener("input", (e) => choose(+e.target.value)); }
  if ($("compare")) $("compare").addEventListener("change", (e) => { state.compare = e.target.value; camera.distance = fitted(); redraw(); });
  shared.hold({ camera, lowest: -0.12, move, seen: view, look, seek, step, start: meta.start, end: lastTime, boxes: ["forces", "support", "tracks", "follow"], play });
  shared.begin(draw, (time) => {
    const next = state.time + time;
    if (live) state.time = advance ? advance(next) : state.time;
    else state.time = next > lastTime() ? meta.start : next;
  });
  if (asked.has("view") && views[asked.get("view")]) { $("view").value = asked.get("view"); look(asked.get("view")); }
  camera.distance = fitted();
  if (asked.has("t")) seek(+asked.get("t"));
  else if (framed) seek(meta.start + 0.4 * (lastTime() - meta.start));
  function project(at, side = 0) { // where a point of the world is on the canvas [CSS pixel]; null behind the camera
    const m = view().matrix, p = [at[0], at[1] + side, at[2]];
    const [x, y, , w] = [0, 1, 2, 3].map((row) => m[row] * p[0] + m[row + 4] * p[1] + m[row + 8] * p[2] + m[row + 12]);
    return w > 0 ? [(x / w + 1) / 2 * canvas.clientWidth, (1 - y / w) / 2 * canvas.clientHeight] : null;
  }
  const flood = (level, up) => { meta.water = level === null ? null : { up }; levels = level === null ? null : new Float32Array([level]); };
  if (live) window.laboratory = { meta, actors, state, append, restart, flood, project, redraw, seek, play,
    attach: (simulate) => { advance = simulate; } };
  window.suchus = { state, camera, pace, faces, seek, play, up: () => view().up, mass: () => shown && shown.map((one) => one.mass) };
})();
