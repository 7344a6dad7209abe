// Player of a bake. Everything it shows comes from the JSON block of the page: positions quantised to 16 bits per axis over the
// clip's bounds, strain and gap to 8 bits. window.followthrough lets a test ask where a vertex is.
(function () {
  'use strict';
  const bake = JSON.parse(document.getElementById('bake').textContent);
  const $ = (id) => document.getElementById(id);

  function bytes(base64) {
    const text = atob(base64), out = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
    return out;
  }
  for (const s of bake.systems) {
    s.positions = new Uint16Array(bytes(s.positions).buffer);
    s.triangles = new Uint32Array(bytes(s.triangles).buffer);
    if (s.strain) s.strain = new Int8Array(bytes(s.strain).buffer);
    if (s.gap) s.gap = bytes(s.gap);
  }
  const count = bake.frame_count, first = bake.first_frame;
  let frame = -1, playing = false, clock = 0, shown = null;

  // ---- data ----
  function coordinate(s, index, vertex, axis) {
    return s.low[axis] + s.positions[(index * s.vertices + vertex) * 3 + axis] * s.step[axis];
  }
  function vertex(system, i) {
    const s = bake.systems.find((t) => t.name === system);
    if (!s || i < 0 || i >= s.vertices) return null;
    return [0, 1, 2].map((axis) => coordinate(s, frame, i, axis));
  }

  // ---- scene ----
  const palette = [0x3f74c4, 0xc8694f, 0x4f9a6d, 0xb08a3e, 0x8560b5, 0x3d9aa8];
  let scene, camera, renderer, controls, sun, centre = null;
  const box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  for (const s of bake.systems)
    for (let axis = 0; axis < 3; ++axis) {
      box.low[axis] = Math.min(box.low[axis], s.low[axis]);
      box.high[axis] = Math.max(box.high[axis], s.low[axis] + 65535 * s.step[axis]);
    }

  function build() {
    renderer = new THREE.WebGLRenderer({ canvas: $('view'), antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(window.devicePixelRatio || 1);
    renderer.outputEncoding = THREE.sRGBEncoding;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    scene = new THREE.Scene();
    const dark = window.matchMedia('(prefers-color-scheme: dark)').matches;
    const ground = new THREE.Color(dark ? 0x23272d : 0xe9ebee);
    scene.background = ground;
    const size = Math.max(...[0, 1, 2].map((a) => box.high[a] - box.low[a]), 0.1);
    scene.fog = new THREE.Fog(ground, 6 * size, 14 * size);
    camera = new THREE.PerspectiveCamera(32, 1, size / 200, size * 40);
    scene.add(new THREE.HemisphereLight(0xffffff, dark ? 0x3a3f47 : 0x9aa0a8, 0.55));
    sun = new THREE.DirectionalLight(0xfff4e6, 0.75);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.bias = -0.0006;
    sun.shadow.normalBias = 0.004;
    for (const side of ['left', 'bottom']) sun.shadow.camera[side] = -0.9 * size;
    for (const side of ['right', 'top']) sun.shadow.camera[side] = 0.9 * size;
    sun.shadow.camera.far = 6 * size;
    scene.add(sun, sun.target);
    const fill = new THREE.DirectionalLight(0xcfe0ff, 0.22);
    fill.position.set(-1, 0.4, -0.8);
    scene.add(fill);
    const middle = [0, 1, 2].map((a) => 0.5 * (box.low[a] + box.high[a]));
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(40 * size, 40 * size), new THREE.ShadowMaterial({ opacity: 0.22 }));
    floor.rotation.x = -Math.PI / 2;
    floor.position.set(middle[0], box.low[1] - 0.001 * size, middle[2]);
    floor.receiveShadow = true;
    scene.add(floor);
    const cells = 2 * Math.ceil(3 * size);
    const grid = new THREE.GridHelper(cells, cells, dark ? 0x454c55 : 0xb9bfc7, dark ? 0x343a42 : 0xd2d6dc);
    grid.position.set(Math.round(middle[0]), floor.position.y, Math.round(middle[2]));
    scene.add(grid);

    let garment = 0;
    for (const s of bake.systems) {
      const cloth = s.role === 'cloth';
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * s.vertices), 3));
      geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * s.vertices).fill(1), 3));
      geometry.setIndex(new THREE.BufferAttribute(s.triangles, 1));
      s.plain = cloth ? palette[garment++ % palette.length] : 0xc4beb4;
      const material = new THREE.MeshStandardMaterial({ color: s.plain, roughness: cloth ? 0.82 : 0.62, metalness: 0,
        side: cloth ? THREE.DoubleSide : THREE.FrontSide, vertexColors: true });
      s.mesh = new THREE.Mesh(geometry, material);
      s.mesh.castShadow = s.mesh.receiveShadow = true;
      s.mesh.frustumCulled = false;
      s.mesh.visible = s.role !== 'collider';
      scene.add(s.mesh);
    }
    controls = new THREE.OrbitControls(camera, renderer.domElement);
    controls.enableDamping = false;
    controls.addEventListener('change', draw);
    new ResizeObserver(resize).observe($('view'));
    resize();
  }

  function resize() {
    const view = $('view'), width = view.clientWidth, height = view.clientHeight;
    if (!renderer || width === 0 || height === 0) return;
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  }
  function draw() {
    if (renderer) renderer.render(scene, camera);
  }
  /// Bounds of what is visible in the frame at hand.
  function bounds() {
    const b = new THREE.Box3();
    for (const s of bake.systems) if (s.mesh && s.mesh.visible) b.union(new THREE.Box3().setFromBufferAttribute(s.mesh.geometry.attributes.position));
    return b;
  }
  function fit() {
    if (!renderer) return;
    const b = bounds();
    if (b.isEmpty()) return;
    const middle = b.getCenter(new THREE.Vector3()), size = b.getSize(new THREE.Vector3());
    const tall = Math.max(size.y, Math.hypot(size.x, size.z) / camera.aspect);
    const away = 0.62 * tall / Math.tan(camera.fov * Math.PI / 360) + 0.5 * Math.max(size.x, size.z);
    camera.position.copy(middle).add(new THREE.Vector3(0.55, 0.18, 0.82).normalize().multiplyScalar(away));
    controls.target.copy(middle);
    controls.update();
    draw();
  }

  // ---- colours ----
  const ramps = {
    // blue: shorter, white: as cut, red: longer
    strain: { title: 'strain', low: '-10 %', high: '+10 %', stops: [[0.13, 0.35, 0.75], [0.92, 0.92, 0.92], [0.78, 0.1, 0.1]] },
    gap: { title: 'gap to the nearest surface', low: '0 mm', high: bake.gap_range * 1000 + ' mm', stops: [[0.75, 0.05, 0.05], [0.95, 0.75, 0.2], [0.25, 0.62, 0.4], [0.8, 0.84, 0.88]] },
  };
  function ramp(stops, t, out, at) {
    const x = Math.min(Math.max(t, 0), 1) * (stops.length - 1), k = Math.min(Math.floor(x), stops.length - 2), u = x - k;
    for (let c = 0; c < 3; ++c) out[at + c] = Math.pow(stops[k][c] + u * (stops[k + 1][c] - stops[k][c]), 2.2);
  }
  function paint(s) {
    const mode = $('colour').value, values = ramps[mode] ? s[mode] : null, colours = s.mesh.geometry.attributes.color;
    s.mesh.material.color.set(values ? 0xffffff : s.plain);
    if (!values) colours.array.fill(1);
    else
      for (let i = 0; i < s.vertices; ++i) {
        const value = values[frame * s.vertices + i];
        ramp(ramps[mode].stops, mode === 'strain' ? 0.5 + value / 80 : value / 255, colours.array, 3 * i);
      }
    colours.needsUpdate = true;
  }
  function legend() {
    const r = ramps[$('colour').value];
    $('legend').hidden = !r;
    if (!r) return;
    $('legend-title').textContent = r.title;
    $('legend-low').textContent = r.low;
    $('legend-high').textContent = r.high;
    $('legend-ramp').style.background = 'linear-gradient(90deg,' + r.stops.map((c) => 'rgb(' + c.map((x) => Math.round(255 * x)).join(',') + ')').join(',') + ')';
  }

  // ---- frames ----
  function show(index) {
    index = Math.min(Math.max(Math.round(index), 0), count - 1);
    frame = index;
    if (renderer && shown !== index) {
      for (const s of bake.systems) {
        const attribute = s.mesh.geometry.attributes.position, to = attribute.array, from = 3 * index * s.vertices;
        for (let i = 0, n = 3 * s.vertices; i < n; i += 3) {
          to[i] = s.low[0] + s.positions[from + i] * s.step[0];
          to[i + 1] = s.low[1] + s.positions[from + i + 1] * s.step[1];
          to[i + 2] = s.low[2] + s.positions[from + i + 2] * s.step[2];
        }
        attribute.needsUpdate = true;
        s.mesh.geometry.computeVertexNormals();
        paint(s);
      }
      const middle = bounds().getCenter(new THREE.Vector3());
      if (centre && $('follow').checked) {
        const move = middle.clone().sub(centre);
        camera.position.add(move);
        controls.target.add(move);
        controls.update();
      }
      centre = middle;
      const size = Math.max(...[0, 1, 2].map((a) => box.high[a] - box.low[a]), 0.1);
      sun.target.position.copy(middle);
      sun.position.copy(middle).add(new THREE.Vector3(0.9, 2.0, 1.1).multiplyScalar(size));
    }
    shown = index;
    $('scrub').value = index;
    $('frame-number').textContent = 'frame ' + (first + index) + ' / ' + (first + count - 1);
    for (const p of plots) p.draw();
    draw();
  }
  function play(on) {
    playing = on;
    clock = performance.now() - 1000 * Math.max(frame, 0) / (bake.fps * $('speed').value);
    $('play').textContent = on ? '\u275a\u275a' : '\u25b6';
    if (on) later();
  }
  /// By timer: the picture changes 24 times a second, and a page without a screen has no animation frames.
  function later() {
    setTimeout(() => tick(performance.now()), 8);
  }
  function tick(now) {
    if (!playing) return;
    let index = Math.floor((now - clock) / 1000 * bake.fps * $('speed').value);
    if (index >= count) {
      if (!$('loop').checked) {
        show(count - 1);
        play(false);
        return;
      }
      clock = now;
      index = 0;
    }
    if (index !== frame) show(index);
    later();
  }

  // ---- plots ----
  const plots = [];
  function plot(title, unit, series, worse) {
    const figure = document.createElement('figure'), caption = document.createElement('figcaption'), name = document.createElement('b');
    const value = document.createElement('span'), canvas = document.createElement('canvas');
    name.textContent = title;
    caption.append(name, value);
    figure.append(caption, canvas);
    $('plots').append(figure);
    const known = series.flatMap((s) => s.values).filter((v) => v !== null && isFinite(v));
    if (known.length === 0) {
      value.textContent = 'not recorded';
      canvas.remove();
      return;
    }
    const top = Math.max(...known, 1e-9) * 1.08;
    const index = (event) => Math.round((event.offsetX / canvas.clientWidth) * (count - 1));
    canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); play(false); show(index(event)); });
    canvas.addEventListener('pointermove', (event) => { if (event.buttons & 1) show(index(event)); });
    const style = getComputedStyle(document.documentElement);
    plots.push({ title, draw() {
      const scale = window.devicePixelRatio || 1, width = canvas.clientWidth || 300, height = 74;
      canvas.width = width * scale;
      canvas.height = height * scale;
      const pen = canvas.getContext('2d');
      pen.scale(scale, scale);
      const x = (i) => (count > 1 ? i / (count - 1) : 0.5) * (width - 1) + 0.5, y = (v) => height - 1 - (v / top) * (height - 4);
      pen.strokeStyle = style.getPropertyValue('--line');
      pen.strokeRect(0.5, 0.5, width - 1, height - 1);
      series.forEach((s, k) => {
        pen.strokeStyle = style.getPropertyValue(worse ? '--bad' : '--accent');
        pen.globalAlpha = k === 0 ? 1 : 0.4;
        pen.lineWidth = 1.4;
        pen.beginPath();
        let down = false;
        s.values.forEach((v, i) => {
          if (v === null || !isFinite(v)) { down = false; return; }
          down ? pen.lineTo(x(i), y(v)) : pen.moveTo(x(i), y(v));
          down = true;
        });
        pen.stroke();
      });
      pen.globalAlpha = 1;
      pen.strokeStyle = style.getPropertyValue('--ink');
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(x(frame), 1);
      pen.lineTo(x(frame), height - 1);
      pen.stroke();
      value.textContent = series.map((s) => {
        const v = s.values[frame];
        return s.name + ' ' + (v === null || v === undefined || !isFinite(v) ? '-' : v >= 100 ? v.toFixed(0) : +v.toPrecision(3)) + unit;
      }).join('   ');
    } });
  }
  const column = (key, factor) => bake.frames.map((f) => (f[key] === null || f[key] === undefined ? null : f[key] * factor));

  // ---- controls ----
  function wire() {
    $('title').textContent = bake.shot;
    const worst = bake.frames.reduce((a, f) => a + f.crossings_body + f.crossings_self, 0);
    $('summary').textContent = count + ' frames at ' + bake.fps + ' fps' + (bake.complete ? '' : ', not finished') +
      ', ' + (worst === 0 ? 'no crossing with the feasible collider' : worst + ' crossings');
    $('scrub').max = count - 1;
    $('scrub').addEventListener('input', () => { play(false); show(+$('scrub').value); });
    $('play').addEventListener('click', () => play(!playing));
    $('speed').addEventListener('change', () => play(playing));
    $('colour').addEventListener('change', () => { legend(); shown = null; show(frame); });
    $('home').addEventListener('click', fit);
    $('wireframe').addEventListener('change', () => {
      for (const s of bake.systems) if (s.mesh && s.role === 'cloth') s.mesh.material.wireframe = $('wireframe').checked;
      draw();
    });
    for (const s of bake.systems) {
      const label = document.createElement('label'), tick = document.createElement('input'), colour = document.createElement('i'), size = document.createElement('span');
      tick.type = 'checkbox';
      tick.checked = s.role !== 'collider';
      tick.addEventListener('change', () => { if (s.mesh) s.mesh.visible = tick.checked; draw(); });
      colour.style.background = '#' + (s.plain || 0x888888).toString(16).padStart(6, '0');
      size.textContent = s.vertices + ' vertices';
      label.append(tick, colour, document.createTextNode(s.name + (s.role === 'cloth' ? '' : ' (' + s.role + ')')), size);
      $('systems').append(label);
    }
    for (const i of bake.incidents.slice(0, 200)) {
      const item = document.createElement('li'), link = document.createElement('a');
      link.textContent = 'frame ' + i.frame;
      link.addEventListener('click', () => { play(false); show(i.frame - first); });
      item.append(link, document.createTextNode(' ' + (i.system ? i.system + ': ' : '') + i.text));
      $('incidents').append(item);
    }
    $('incidents-title').hidden = bake.incidents.length === 0;
    document.addEventListener('keydown', (event) => {
      if (event.target.tagName === 'SELECT') return;
      const step = event.shiftKey ? 10 : 1;
      if (event.key === ' ') play(!playing);
      else if (event.key === 'ArrowRight') { play(false); show(frame + step); }
      else if (event.key === 'ArrowLeft') { play(false); show(frame - step); }
      else if (event.key === 'Home') fit();
      else return;
      event.preventDefault();
    });
  }

  // #frame=12&colour=strain&test=skirt:0,40 : where to start; test writes those vertices into the page.
  const wish = new URLSearchParams(location.hash.slice(1));
  try {
    build();
  } catch (error) {
    renderer = null;
    $('trouble').hidden = false;
    $('trouble').textContent = 'This browser cannot draw the scene (' + error.message + '). The plots still work.';
  }
  wire();
  plot('strain', ' %', [{ name: 'p99', values: column('strain_p99', 100) }, { name: 'max', values: column('strain_max', 100) }]);
  plot('smallest gap', ' mm', [{ name: '', values: column('smallest_gap', 1000) }]);
  plot('crossings', '', [{ name: 'body', values: column('crossings_body', 1) }, { name: 'cloth', values: column('crossings_self', 1) }], true);
  for (const [title, unit, of] of [['force', ' N', (f) => f.force], ['torque', ' N m', (f) => f.torque]]) {
    const names = [...new Set(bake.frames.flatMap((row) => (row.forces ?? []).map((f) => f.system)))];
    if (names.length === 0) continue;
    plot(title, unit, names.map((name) => ({ name: names.length > 1 ? name : '', values: bake.frames.map((row) => {
      const force = (row.forces ?? []).find((f) => f.system === name);
      return force ? Math.hypot(...of(force)) : null;
    }) })));
  }
  plot('time', ' ms', [{ name: '', values: column('milliseconds', 1) }]);
  if (wish.has('colour')) $('colour').value = wish.get('colour');
  legend();
  show(wish.has('frame') ? +wish.get('frame') - first : 0);
  fit();
  window.followthrough = { firstFrame: first, frameCount: count, setFrame: (n) => show(n - first), frame: () => first + frame,
    vertex, play, playing: () => playing, drawn: () => renderer !== null, plots: plots.map((p) => p.title) };

  if (wish.has('test')) {
    const answer = { vertices: {}, drawn: renderer !== null, plots: plots.map((p) => p.title), frame: first + frame };
    const [name, list] = wish.get('test').split(':');
    answer.vertices[name] = list.split(',').map((i) => vertex(name, +i));
    $('scrub').value = 0;
    $('scrub').dispatchEvent(new Event('input'));
    answer.scrubbed = first + frame;
    play(true);
    const out = document.createElement('pre');
    out.id = 'test-answer';
    let waits = 0;
    const wait = setInterval(() => {
      if (frame === 0 && ++waits < 60) return;
      clearInterval(wait);
      answer.played = first + frame;
      play(false);
      if (renderer) {
        const gl = renderer.getContext(), pixel = new Uint8Array(4 * 64);
        const seen = new Set();
        for (let k = 0; k < 40; ++k) {
          gl.readPixels(Math.floor(gl.drawingBufferWidth * 0.5) - 32, Math.floor(gl.drawingBufferHeight * (0.1 + 0.02 * k)), 64, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
          for (let i = 0; i < 64; ++i) seen.add(pixel[4 * i] << 16 | pixel[4 * i + 1] << 8 | pixel[4 * i + 2]);
        }
        answer.colours = seen.size;
      }
      out.textContent = JSON.stringify(answer);
      document.body.append(out);
    }, 100);
  }
})();
