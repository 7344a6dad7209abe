// Instances of a bake: one InstancedMesh for each prototype, whose matrices are computed anew from the packed numbers in
// every frame that is shown (commands/preview_instances.h says how they are packed). Each instance has a shade of its own,
// by its id, so that one can be followed by eye.
/// unpack(base64): the bytes. s: the system, whose positions are unpacked already.
function makeInstances(s, colour, unpack) {
  'use strict';
  const own = s.instances, count = s.vertices;
  const ids = new Uint32Array(unpack(own.ids).buffer), of = new Uint16Array(unpack(own.of).buffer);
  const scale = new Float32Array(unpack(own.scale).buffer), turns = new Int16Array(unpack(own.turns).buffer);
  const sizes = own.sizes ? unpack(own.sizes) : null;

  /// A number from 0 to 1 that looks as if it had nothing to do with the id.
  function random(id, salt) {
    let h = (id ^ Math.imul(salt, 0x9e3779b1)) >>> 0;
    h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
    h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
    return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
  }
  function shade(id, to, at) {
    const c = new THREE.Color(colour), hsl = c.getHSL({});
    c.setHSL((hsl.h + 1 + 0.09 * (random(id, 1) - 0.5)) % 1, Math.min(1, hsl.s * (0.75 + 0.5 * random(id, 2))),
      Math.min(0.9, hsl.l * (0.9 + 0.6 * random(id, 3))));
    c.toArray(to, at);
  }

  const group = new THREE.Group(), radii = [], slots = [];  // slots: of each instance its matrix, and where in it
  const material = new THREE.MeshStandardMaterial({ color: 0xffffff, roughness: 0.75, metalness: 0, side: THREE.DoubleSide, vertexColors: true });
  own.prototypes.forEach((prototype, p) => {
    const members = [];
    for (let i = 0; i < count; ++i) if (of[i] === p) members.push(i);
    const geometry = new THREE.BufferGeometry(), colours = new Float32Array(3 * members.length);
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(unpack(prototype.points).buffer), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(unpack(prototype.triangles).buffer), 1));
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
    radii[p] = geometry.boundingSphere.radius + geometry.boundingSphere.center.length();
    members.forEach((i, k) => shade(ids[i], colours, 3 * k));
    geometry.setAttribute('color', new THREE.InstancedBufferAttribute(colours, 3));
    if (members.length === 0) return;
    const mesh = new THREE.InstancedMesh(geometry, material, members.length);
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    members.forEach((i, k) => { slots[i] = [mesh.instanceMatrix.array, 16 * k]; });
    group.add(mesh);
  });
  const box = new THREE.Box3();

  /// Column by column: what the rotation makes of the axes, times their scales; then the origin.
  function show(frame) {
    const p = s.positions, low = s.low, step = s.step;
    box.makeEmpty();
    for (let i = 0; i < count; ++i) {
      const at = frame * count + i, place = 3 * at, turn = 4 * at;
      let x = turns[turn], y = turns[turn + 1], z = turns[turn + 2], w = turns[turn + 3];
      const length = Math.hypot(x, y, z, w) || 1, size = sizes ? sizes[at] / 255 : 1;
      x /= length, y /= length, z /= length, w /= length;
      const sx = size * scale[3 * i], sy = size * scale[3 * i + 1], sz = size * scale[3 * i + 2];
      const px = low[0] + p[place] * step[0], py = low[1] + p[place + 1] * step[1], pz = low[2] + p[place + 2] * step[2];
      const [m, o] = slots[i];
      m[o] = sx * (1 - 2 * (y * y + z * z)), m[o + 1] = 2 * sx * (x * y + z * w), m[o + 2] = 2 * sx * (x * z - y * w);
      m[o + 4] = 2 * sy * (x * y - z * w), m[o + 5] = sy * (1 - 2 * (x * x + z * z)), m[o + 6] = 2 * sy * (y * z + x * w);
      m[o + 8] = 2 * sz * (x * z + y * w), m[o + 9] = 2 * sz * (y * z - x * w), m[o + 10] = sz * (1 - 2 * (x * x + y * y));
      m[o + 12] = px, m[o + 13] = py, m[o + 14] = pz, m[o + 15] = 1;
      const largest = Math.max(sx, sy, sz);
      if (largest <= 0) continue;  // it is not there
      const r = largest * radii[of[i]];
      box.min.x = Math.min(box.min.x, px - r), box.max.x = Math.max(box.max.x, px + r);
      box.min.y = Math.min(box.min.y, py - r), box.max.y = Math.max(box.max.y, py + r);
      box.min.z = Math.min(box.min.z, pz - r), box.max.z = Math.max(box.max.z, pz + r);
    }
    for (const mesh of group.children) mesh.instanceMatrix.needsUpdate = true;
  }
  /// Where a prototype's x axis of length 1 ends, from the instance's origin; of the frame that is shown.
  const axis = (i) => { const [m, o] = slots[i]; return [m[o], m[o + 1], m[o + 2]]; };
  return { group, material, show, box, axis };
}
