// Player of one or several bakes, one at a time. Everything it shows comes from the JSON block of the page: positions quantised
// to 16 bits per axis over the clip's bounds, strain and gap to 8 bits. window.followthrough lets a test ask where a vertex is.
(function () {
  'use strict';
  const bakes = JSON.parse(document.getElementById('bake').textContent).bakes;
  const $ = (id) => document.getElementById(id);
  const element = (kind, ...inside) => { const out = document.createElement(kind); out.append(...inside); return out; };

  function bytes(base64) {
    const text = atob(base64), out = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
    return out;
  }
  function unpack(bake) {
    bake.unpacked = true;
    for (const s of bake.systems) {
      s.positions = new Uint16Array(bytes(s.positions).buffer);
      if (s.triangles) s.triangles = new Uint32Array(bytes(s.triangles).buffer);
      if (s.strain) s.strain = new Int8Array(bytes(s.strain).buffer);
      if (s.gap) s.gap = bytes(s.gap);
      for (const name in s.scalars) s.scalars[name] = bytes(s.scalars[name]);
      if (s.curves) s.curves.bounds = new Float64Array(bytes(s.curves.bounds).buffer);
    }
  }
  let bake = null, count = 0, first = 0;  // the bake that plays, its frames
  let frame = -1, playing = false, clock = 0, shown = null;

  // ---- data ----
  function coordinate(s, index, vertex, axis) {
    const packed = s.positions[((s.points ? s.points.starts[index] : index * s.vertices) + vertex) * 3 + axis];
    if (s.curves) return s.curves.bounds[6 * index + axis] + packed * s.curves.bounds[6 * index + 3 + axis];
    return s.low[axis] + packed * s.step[axis];
  }
  function vertex(system, i) {
    const s = bake.systems.find((t) => t.name === system);
    if (!s || i < 0 || i >= s.vertices) return null;
    return [0, 1, 2].map((axis) => coordinate(s, frame, i, axis));
  }

  // ---- scene ----
  const palette = [0x3f74c4, 0xc8694f, 0x4f9a6d, 0xb08a3e, 0x8560b5, 0x3d9aa8], hair_brown = 0x6b4528;
  let scene, camera, renderer, controls, sun, centre = null, marker = null;
  const box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  for (const s of bakes.flatMap((b) => b.systems).filter((s) => !s.stands))  // a ground is wider than what happens on it
    for (let axis = 0; axis < 3; ++axis) {
      box.low[axis] = Math.min(box.low[axis], s.low[axis]);
      box.high[axis] = Math.max(box.high[axis], s.low[axis] + 65535 * s.step[axis]);
    }
  const size = Math.max(...[0, 1, 2].map((a) => box.high[a] - box.low[a]), 0.1);
  const paths = makePaths(bakes), second = (index) => (first + index) / bake.fps;

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
    floor.position.set(middle[0], box.low[1] - 0.002 * size, middle[2]);
    floor.receiveShadow = true;
    scene.add(floor);
    const cells = 2 * Math.ceil(3 * size);
    const grid = new THREE.GridHelper(cells, cells, dark ? 0x454c55 : 0xb9bfc7, dark ? 0x343a42 : 0xd2d6dc);
    grid.position.set(Math.round(middle[0]), floor.position.y, Math.round(middle[2]));
    scene.add(grid);

    scene.add(paths.build());
    for (const b of bakes)
      if (b.wind) {
        b.air = makeWind(b.wind);
        scene.add(b.air.lines);
      }
    controls = new THREE.OrbitControls(camera, renderer.domElement);
    controls.enableDamping = false;
    controls.addEventListener('change', draw);
    new ResizeObserver(resize).observe($('view'));
    resize();
  }

  const secondary = (s) => s.role !== 'body' && s.role !== 'collider';
  function clothMaterial(s) {
    return new THREE.MeshStandardMaterial({ color: s.plain, roughness: secondary(s) ? 0.82 : 0.62, metalness: 0, flatShading: !!s.stands,
      side: s.sheet ? THREE.DoubleSide : THREE.FrontSide, vertexColors: true, wireframe: secondary(s) && $('wireframe').checked });
  }
  function meshes(systems) {
    const group = new THREE.Group();
    let garment = 0;
    const colour_of = (s) => s.colour || (s.curves ? hair_brown : palette[garment++ % palette.length]);
    for (const s of systems) {
      if (s.instances || s.curves || s.points) {
        s.plain = colour_of(s);
        s.drawing = (s.curves ? makeCurves : s.points ? makePoints : makeInstances)(s, s.plain, bytes);
        s.mesh = s.drawing.group;
        s.mesh.visible = !s.hidden;
        s.drawing.material.wireframe = $('wireframe').checked;
        group.add(s.mesh);
        continue;
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * s.vertices), 3));
      geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * s.vertices).fill(1), 3));
      geometry.setIndex(new THREE.BufferAttribute(s.triangles, 1));
      s.plain = secondary(s) ? colour_of(s) : 0xc4beb4;
      const material = s.liquid ? makeWaterMaterial(s.plain, scene.background) : clothMaterial(s);
      s.mesh = new THREE.Mesh(geometry, material);
      for (const name of s.liquid ? ['foam', 'wet'] : [])
        geometry.setAttribute(name, new THREE.BufferAttribute(new Uint8Array(s.vertices), 1, true));
      if (s.scalars?.wet) s.mesh.add(makeWetGround(geometry));
      s.mesh.castShadow = !s.stands && !s.liquid;
      s.mesh.receiveShadow = !s.liquid;
      s.mesh.frustumCulled = false;
      s.mesh.visible = s.role !== 'collider' && !s.hidden;
      group.add(s.mesh);
    }
    return group;
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
    if (!renderer) return;
    paths.group.visible = $('paths').checked;
    paths.face(camera, $('view').clientHeight);
    renderer.render(scene, camera);
  }
  /// Bounds of what is visible in the frame at hand.
  function bounds() {
    const b = new THREE.Box3();
    for (const s of bake.systems)
      if (s.mesh && s.mesh.visible && !s.stands) b.union(s.drawing ? s.drawing.box : new THREE.Box3().setFromBufferAttribute(s.mesh.geometry.attributes.position));
    return b;
  }
  function fit() {
    if (!renderer) return;
    const b = bounds();
    if ($('paths').checked) for (const path of paths.list) for (const c of path.centres) b.expandByPoint(c);
    if (b.isEmpty()) return;
    const middle = b.getCenter(new THREE.Vector3()), size = b.getSize(new THREE.Vector3());
    const tall = Math.max(size.y, Math.hypot(size.x, size.z) / camera.aspect);
    const away = 0.62 * tall / Math.tan(camera.fov * Math.PI / 360) + 0.5 * Math.max(size.x, size.z);
    const from = $('paths').checked ? paths.side() : new THREE.Vector3(0.55, 0.18, 0.82);
    camera.position.copy(middle).add(from.normalize().multiplyScalar(away));
    controls.target.copy(middle);
    controls.update();
    draw();
  }

  // ---- colours ----
  const ramps = {
    // blue: shorter, white: as cut, red: longer
    strain: { title: 'strain', low: '-10 %', high: '+10 %', stops: [[0.13, 0.35, 0.75], [0.92, 0.92, 0.92], [0.78, 0.1, 0.1]] },
    gap: { title: 'gap to the nearest surface', low: '0 mm', high: bakes[0].gap_range * 1000 + ' mm', stops: [[0.75, 0.05, 0.05], [0.95, 0.75, 0.2], [0.25, 0.62, 0.4], [0.8, 0.84, 0.88]] },
  };
  function ramp(stops, t, out, at) {
    const x = Math.min(Math.max(t, 0), 1) * (stops.length - 1), k = Math.min(Math.floor(x), stops.length - 2), u = x - k;
    for (let c = 0; c < 3; ++c) out[at + c] = Math.pow(stops[k][c] + u * (stops[k + 1][c] - stops[k][c]), 2.2);
  }
  const absent_tint = [0.45, 0.18, 0.75];  // of a primary's plain colour
  function paint(s) {
    const mode = $('colour').value, values = ramps[mode] ? s[mode] : null, colours = s.mesh.geometry.attributes.color;
    s.mesh.material.color.set(values ? 0xffffff : s.plain);
    if (!values) {
      colours.array.fill(1);
      const runs = s.absent ? s.absent[frame] : [];
      for (let k = 0; k < runs.length; k += 2)
        for (let i = runs[k]; i < runs[k] + runs[k + 1]; ++i) colours.array.set(absent_tint, 3 * i);
    } else
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
  /// A ball where something happened, until the next frame is shown.
  function mark(place) {
    if (!renderer || !place) return;
    if (!marker) {
      marker = new THREE.Mesh(new THREE.SphereGeometry(0.008 * size, 16, 12),
        new THREE.MeshBasicMaterial({ color: 0xff2020, transparent: true, opacity: 0.7, depthTest: false }));
      marker.renderOrder = 1;
      scene.add(marker);
    }
    marker.position.set(...place);
    marker.visible = true;
    draw();
  }
  function show(index) {
    if (marker) marker.visible = false;
    index = Math.min(Math.max(Math.round(index), 0), count - 1);
    frame = index;
    if (renderer && shown !== index) {
      for (const s of bake.systems) {
        if (s.drawing) {
          s.drawing.show(index);
          continue;
        }
        const attribute = s.mesh.geometry.attributes.position, to = attribute.array, from = 3 * index * s.vertices;
        for (let i = 0, n = 3 * s.vertices; i < n; i += 3) {
          to[i] = s.low[0] + s.positions[from + i] * s.step[0];
          to[i + 1] = s.low[1] + s.positions[from + i + 1] * s.step[1];
          to[i + 2] = s.low[2] + s.positions[from + i + 2] * s.step[2];
        }
        attribute.needsUpdate = true;
        for (const name in s.scalars) {
          const values = s.mesh.geometry.attributes[name];
          if (!values) continue;
          values.array.set(s.scalars[name].subarray(index * s.vertices, (index + 1) * s.vertices));
          values.needsUpdate = true;
        }
        s.mesh.geometry.computeVertexNormals();
        paint(s);
      }
      for (const b of bakes) {
        if (!b.air) continue;
        b.air.lines.visible = b === bake && $('wind').checked;
        if (b.air.lines.visible) b.air.show(index);
      }
      const middle = bounds().getCenter(new THREE.Vector3());
      if (centre && $('follow_camera').checked) {
        const move = middle.clone().sub(centre);
        camera.position.add(move);
        controls.target.add(move);
        controls.update();
      }
      centre = middle;
      sun.target.position.copy(middle);
      sun.position.copy(middle).add(new THREE.Vector3(0.9, 2.0, 1.1).multiplyScalar(size));
    }
    shown = index;
    $('scrub').value = index;
    $('frame-number').textContent = 'frame ' + (first + index) + ' / ' + (first + count - 1);
    for (const p of plots) p.draw(frame);
    paths.show(second(frame));
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

  // ---- one bake of several ----
  let plots = [];
  function draw_plots() {
    const column = (key, factor) => bake.frames.map((f) => (f[key] === null || f[key] === undefined ? null : f[key] * factor));
    const onPick = (index) => { play(false); show(index); };
    const plot = (title, unit, series, worse) => makePlot($('plots'), { title, unit, series, worse, onPick });
    $('plots').replaceChildren();
    plots = [
      plot('strain', ' %', [{ name: 'p99', values: column('strain_p99', 100) }, { name: 'max', values: column('strain_max', 100) }]),
      plot('smallest gap', ' mm', [{ name: '', values: column('smallest_gap', 1000) }]),
      plot('crossings', '', [{ name: 'body', values: column('crossings_body', 1) }, { name: 'among themselves', values: column('crossings_self', 1) }], true)];
    const label = (f) => f.system + (f.primary ? ' on ' + f.primary : '');
    const names = [...new Set(bake.frames.flatMap((row) => (row.forces ?? []).map(label)))];
    for (const [title, unit, of] of names.length === 0 ? [] : [['force', ' N', (f) => f.force], ['torque', ' N m', (f) => f.torque]])
      plots.push(plot(title, unit, names.map((name) => ({ name: names.length > 1 ? name : '', values: bake.frames.map((row) => {
        const force = (row.forces ?? []).find((f) => label(f) === name);
        return force ? Math.hypot(...of(force)) : null;
      }) }))));
    for (const { key, unit } of bake.metrics)
      if (bake.frames.some((row) => key in row)) plots.push(plot(key.replaceAll('_', ' '), unit === '' || unit === '1' ? '' : ' ' + unit, [{ name: '', values: column(key, 1) }]));
    plots.push(plot('time', ' ms', [{ name: '', values: column('milliseconds', 1) }]));
    plots = plots.filter((p) => p !== null);
  }
  function how_many(s) {
    if (s.instances) return s.vertices + ' instances';
    if (s.points) return 'up to ' + s.vertices + ' points';
    return (s.curves ? s.curves.strands + ' strands, ' : '') + s.vertices + ' vertices' + (s.curves?.note ? ' drawn' : '');
  }
  function describe() {
    const worst = bake.frames.reduce((a, f) => a + f.crossings_body + f.crossings_self, 0);
    $('title').textContent = bake.shot + (bakes.length > 1 ? ': ' + bake.name : '');
    $('summary').textContent = count + ' frames at ' + bake.fps + ' fps' + (bake.complete ? '' : ', not finished') +
      ', ' + (worst === 0 ? 'no crossing with the collider' : worst + ' crossings');
    $('scrub').max = count - 1;
    $('systems').replaceChildren(...bake.systems.map((s) => {
      const tick = element('input'), colour = element('i');
      tick.type = 'checkbox';
      tick.checked = s.mesh ? s.mesh.visible : s.role !== 'collider' && !s.hidden;
      tick.addEventListener('change', () => { if (s.mesh) s.mesh.visible = tick.checked; draw(); });
      colour.style.background = '#' + (s.plain || 0x888888).toString(16).padStart(6, '0');
      return element('label', tick, colour, s.name + (s.sheet ? '' : ' (' + s.role + ')'), element('span', how_many(s)));
    }));
    for (const s of bake.systems) if (s.curves?.note) $('systems').append(element('label', s.curves.note));
    if (bake.systems.some((s) => s.absent)) {
      const colour = element('i');
      colour.style.background = '#8b539e';
      $('systems').append(element('label', colour, 'absent for the cloth: no room'));
    }
    $('incidents').replaceChildren(...bake.incidents.slice(0, 200).map((i) => {
      const link = element('a', 'frame ' + i.frame);
      link.addEventListener('click', () => { play(false); show(i.frame - first); mark(i.place); });
      return element('li', link, ' ' + (i.system ? i.system + ': ' : '') + i.text);
    }));
    $('incidents-title').hidden = bake.incidents.length === 0;
    paths.legend($('paths-legend'), bake);
    draw_plots();
  }
  /// Plays another bake, from the frame at hand.
  function choose(next) {
    const number = first + frame, before = bake;
    bake = next;
    first = bake.first_frame;
    count = bake.frame_count;
    shown = null;
    if (!bake.unpacked) unpack(bake);
    if (renderer) {
      if (before) scene.remove(before.group);
      bake.group = bake.group || meshes(bake.systems);
      scene.add(bake.group);
    }
    describe();
    if (before) show(number - first);
  }

  // ---- controls ----
  function wire() {
    $('scrub').addEventListener('input', () => { play(false); show(+$('scrub').value); });
    $('play').addEventListener('click', () => play(!playing));
    $('speed').addEventListener('change', () => play(playing));
    $('colour').addEventListener('change', () => { legend(); shown = null; show(frame); });
    $('home').addEventListener('click', fit);
    $('wireframe').addEventListener('change', () => {
      for (const s of bakes.flatMap((b) => b.systems)) if (s.mesh && secondary(s)) (s.drawing || s.mesh).material.wireframe = $('wireframe').checked;
      draw();
    });
    $('bakes-row').hidden = bakes.length < 2;
    $('bakes').append(...bakes.map((b) => element('option', b.name)));
    $('bakes').addEventListener('change', () => choose(bakes[$('bakes').selectedIndex]));
    $('wind-row').hidden = !bakes.some((b) => b.wind);
    $('wind').checked = wish.get('wind') === '1';
    $('wind').addEventListener('change', () => { shown = null; show(frame); });
    $('paths-row').hidden = paths.list.length === 0;
    $('paths').checked = paths.list.length > 0 && (wish.has('paths') ? wish.get('paths') !== '0' : bakes.length > 1 || bakes[0].prop);
    const legend_of_paths = () => { $('paths-legend').hidden = !$('paths').checked; };
    $('paths').addEventListener('change', () => { legend_of_paths(); draw(); });
    legend_of_paths();
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

  // #frame=12&colour=strain&bake=two-way&paths=0&wind=1&incident=0&test=skirt:0,40 : where to start; test writes those vertices into the page.
  const wish = new URLSearchParams(location.hash.slice(1));
  try {
    build();
  } catch (error) {
    renderer = null;
    $('trouble').hidden = false;
    $('trouble').textContent = 'This browser cannot draw the scene (' + error.message + '). The plots still work.';
  }
  wire();
  $('bakes').selectedIndex = Math.max(bakes.findIndex((b) => b.name === wish.get('bake')), 0);
  choose(bakes[$('bakes').selectedIndex]);
  if (wish.has('colour')) $('colour').value = wish.get('colour');
  legend();
  show(wish.has('frame') ? +wish.get('frame') - first : 0);
  fit();
  if (wish.has('incident')) $('incidents').querySelectorAll('a')[+wish.get('incident')]?.click();
  window.followthrough = { firstFrame: first, frameCount: count, setFrame: (n) => show(n - first), frame: () => first + frame,
    vertex, play, playing: () => playing, drawn: () => renderer !== null, plots: plots.map((p) => p.title) };

  if (wish.has('test')) {
    const answer = { vertices: {}, drawn: renderer !== null, plots: plots.map((p) => p.title), frame: first + frame,
      bake: bake.name, paths: {} };
    if ($('paths').checked) for (const path of paths.list) answer.paths[path.name] = paths.place(path, second(frame)).toArray();
    const [name, list] = wish.get('test').split(':');
    answer.vertices[name] = list.split(',').map((i) => vertex(name, +i));
    const drawing = (bake.systems.find((s) => s.name === name) || {}).drawing;
    if (drawing && drawing.axis) answer.axes = list.split(',').map((i) => drawing.axis(+i));
    answer.systems = $('systems').textContent;
    answer.faults = renderer ? renderer.info.programs.filter((p) => p.diagnostics && !p.diagnostics.runnable).map((p) => p.diagnostics.programLog) : [];
    answer.triangles = renderer ? renderer.info.render.triangles : 0;
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
