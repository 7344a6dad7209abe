// The ways of the primaries' centres through the shot, those of several bakes over each other: lines with dots at equal times
// and a marker where each is now, drawn over all else and as wide as they are on the screen whatever the distance. Those of
// later bakes are wider and lie below, so that one path shows around another that it agrees with. bakes: as the page holds them.
function makePaths(bakes) {
  'use strict';
  const interval = 1 / 12;  // s between dots: the 0.0833 s of figure 3 of O'Brien, Zordan and Hodgins (2000)
  const palette = [0xe8a800, 0xd6336c, 0x1c7ed6, 0x2b8a3e, 0x7048e8, 0xe8590c];
  const list = [], dots = [], group = new THREE.Group();
  for (const bake of bakes)
    for (const path of bake.paths)
      list.push({ name: bake.paths.length > 1 ? bake.name + ': ' + path.name : bake.name, bake, primary: path.name,
        start: bake.first_frame / bake.fps, colour: palette[list.length % palette.length],
        centres: path.centres.map((c) => new THREE.Vector3(...c)) });
  const origin = bakes[0].first_frame / bakes[0].fps;

  /// Where a path is at a time [s], between its frames on a straight line.
  function place(path, time) {
    const last = path.centres.length - 1, x = Math.min(Math.max((time - path.start) * path.bake.fps, 0), last);
    const k = Math.min(Math.floor(x), Math.max(last - 1, 0));
    return path.centres[k].clone().lerp(path.centres[Math.min(k + 1, last)], x - k);
  }
  /// Half the width of a path's line [pixels].
  const width = (path) => 1.7 * (1 + path.order / Math.max(list.length - 1, 1));
  function line(path) {
    const material = new THREE.ShaderMaterial({ depthTest: false, side: THREE.DoubleSide,
      uniforms: { unit: { value: 0 }, width: { value: width(path) }, colour: { value: new THREE.Color(path.colour) } },
      vertexShader: 'uniform float unit, width; void main() { vec4 place = modelViewMatrix * vec4(position, 1.0);' +
        'place.xyz -= width * unit * place.z * (normalMatrix * normal); gl_Position = projectionMatrix * place; }',
      fragmentShader: 'uniform vec3 colour; void main() { gl_FragColor = vec4(colour, 1.0); }' });
    const curve = new THREE.CatmullRomCurve3(path.centres);
    const out = new THREE.Mesh(new THREE.TubeBufferGeometry(curve, 4 * path.centres.length, 1e-9, 8), material);
    out.frustumCulled = false;
    return out;
  }
  const ball = new THREE.SphereBufferGeometry(1, 20, 14);
  /// A dot of a radius [pixels].
  function dot(radius, colour, order) {
    const out = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ color: colour, depthTest: false }));
    out.renderOrder = order;
    dots.push({ mesh: out, radius });
    group.add(out);
    return out;
  }
  function build() {
    list.forEach((path, order) => { path.order = order; });
    for (const path of list) {
      const length = path.centres.slice(1).reduce((sum, c, i) => sum + c.distanceTo(path.centres[i]), 0);
      const level = 10 * (list.length - path.order);  // what is drawn after what
      if (length > 1e-6) {
        path.line = line(path);
        path.line.renderOrder = level;
        group.add(path.line);
      }
      const end = path.start + (path.centres.length - 1) / path.bake.fps;
      for (let k = Math.ceil((path.start - origin) / interval - 1e-6); origin + k * interval <= end + 1e-6; ++k)
        dot(2.6 * width(path), path.colour, level + 1).position.copy(place(path, origin + k * interval));
      path.marker = [dot(3 * width(path) + 4, 0x1d2126, 1000 + level), dot(3 * width(path) + 2, path.colour, 1001 + level)];
    }
    return group;
  }
  /// Widths for a camera and a picture of so many pixels.
  function face(camera, height) {
    const unit = 2 * Math.tan(camera.fov * Math.PI / 360) / height;  // size of a pixel at a distance of 1
    for (const path of list) if (path.line) path.line.material.uniforms.unit.value = unit;
    for (const { mesh, radius } of dots) mesh.scale.setScalar(radius * unit * camera.position.distanceTo(mesh.position));
  }
  function show(time) {
    for (const path of list) for (const mark of path.marker ?? []) mark.position.copy(place(path, time));
  }
  /// A direction to look from, a little above the side: across the way that is longest.
  function side() {
    const ways = list.map((path) => path.centres[path.centres.length - 1].clone().sub(path.centres[0]).setY(0));
    const way = ways.reduce((a, b) => (b.length() > a.length() ? b : a)).normalize();
    const across = new THREE.Vector3(-way.z, 0, way.x);
    if (across.lengthSq() < 0.5) across.set(0.55, 0, 0.82);
    return across.multiplyScalar(across.z < 0 ? -1 : 1).addScaledVector(way, 0.12).setY(0.15);
  }
  /// Rows of colours and names; the bake that plays stands out.
  function legend(host, playing) {
    host.replaceChildren();
    for (const path of list) {
      const row = document.createElement('div'), colour = document.createElement('i');
      colour.style.background = '#' + path.colour.toString(16).padStart(6, '0');
      row.append(colour, path.name);
      if (bakes.length > 1 && path.bake === playing) row.className = 'playing';
      host.append(row);
    }
    const note = document.createElement('span');
    note.textContent = 'a dot every ' + interval.toFixed(4) + ' s';
    host.append(note);
  }
  return { list, group, build, show, face, place, side, legend };
}
