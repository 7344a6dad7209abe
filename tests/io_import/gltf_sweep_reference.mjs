// Writes what three.js makes of glTF files: FILE.positions beside every .gltf and .glb of a folder, for gltf_sweep_test.cpp.
// Needs node, and npm's three, draco3d and meshoptimizer where node finds them from the current folder:
//   npm install three draco3d meshoptimizer && node .../gltf_sweep_reference.mjs FOLDER
// A .positions file holds corners of triangles in the world, in the order in which the scene draws them: u32 sample count,
// then for each sample i32 clip (-1: rest), f64 time [s], u32 corner count, three f32 per corner. No samples: three.js
// refused the file.
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import fs from 'node:fs';
import path from 'node:path';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class { constructor(type) { this.type = type; } };
console.warn = console.error = () => {};
const require = createRequire(path.join(process.cwd(), 'x.js'));
const load = (name) => import(pathToFileURL(require.resolve(name)).href);
const THREE = await import(pathToFileURL(path.join(path.dirname(require.resolve('three')), 'three.module.js')).href);
const { GLTFLoader } = await load('three/examples/jsm/loaders/GLTFLoader.js');
const { MeshoptDecoder } = await load('meshoptimizer');
const draco = await require('draco3d').createDecoderModule({});

/// Stands for DRACOLoader, which wants web workers.
const dracoLoader = {
  preload() {},
  dispose() {},
  decodeDracoFile(buffer, done, ids, types, space, failed) {
    try {
      const decoder = new draco.Decoder(), mesh = new draco.Mesh();
      const bytes = new Int8Array(buffer);
      const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
      if (!status.ok()) throw new Error(status.error_msg());
      const geometry = new THREE.BufferGeometry();
      const index = new Uint32Array(mesh.num_faces() * 3), face = new draco.DracoInt32Array();
      for (let f = 0; f < mesh.num_faces(); ++f) {
        decoder.GetFaceFromMesh(mesh, f, face);
        for (let k = 0; k < 3; ++k) index[3 * f + k] = face.GetValue(k);
      }
      geometry.setIndex(new THREE.BufferAttribute(index, 1));
      for (const name in ids) {
        const attribute = decoder.GetAttributeByUniqueId(mesh, ids[name]);
        const width = attribute.num_components(), count = mesh.num_points() * width;
        const integers = types[name] !== 'Float32Array';
        const values = integers ? new draco.DracoInt32Array() : new draco.DracoFloat32Array();
        if (integers) decoder.GetAttributeInt32ForAllPoints(mesh, attribute, values);
        else decoder.GetAttributeFloatForAllPoints(mesh, attribute, values);
        const array = new globalThis[types[name]](count);
        for (let i = 0; i < count; ++i) array[i] = values.GetValue(i);
        geometry.setAttribute(name, new THREE.BufferAttribute(array, width));
      }
      done(geometry);
    } catch (error) { failed(error); }
  },
};

/// The file without looks (which want a browser) and with its buffers inside, as the text and bytes of a .glb.
function prepare(file) {
  const bytes = fs.readFileSync(file);
  let json, bin = null;
  if (bytes.toString('latin1', 0, 4) === 'glTF') {
    let at = 12;
    while (at + 8 <= bytes.length) {
      const length = bytes.readUInt32LE(at), kind = bytes.readUInt32LE(at + 4), chunk = bytes.subarray(at + 8, at + 8 + length);
      if (kind === 0x4e4f534a) json = JSON.parse(chunk.toString('utf8'));
      if (kind === 0x004e4942 && bin === null) bin = chunk;
      at += 8 + length;
    }
  } else json = JSON.parse(bytes.toString('utf8').replace(/^\ufeff/, ''));
  for (const mesh of json.meshes ?? []) for (const primitive of mesh.primitives ?? []) delete primitive.material;
  for (const key of ['materials', 'textures', 'images', 'samplers']) delete json[key];
  if (!json.scenes?.length && json.nodes?.length) {
    const below = new Set(json.nodes.flatMap((node) => node.children ?? []));
    json.scenes = [{ nodes: json.nodes.map((_, n) => n).filter((n) => !below.has(n)) }];
    json.scene = 0;
  }
  json.scene ??= 0;
  for (const buffer of json.buffers ?? []) {
    if (!buffer.uri || buffer.uri.startsWith('data:')) continue;
    const data = fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(buffer.uri)));
    buffer.uri = 'data:application/octet-stream;base64,' + data.toString('base64');
  }
  const pad = (b, fill) => Buffer.concat([b, Buffer.alloc((4 - b.length % 4) % 4, fill)]);
  const head = (length, kind) => { const h = Buffer.alloc(8); h.writeUInt32LE(length, 0); h.writeUInt32LE(kind, 4); return h; };
  const text = pad(Buffer.from(JSON.stringify(json)), 32);
  const parts = [Buffer.from('glTF\x02\0\0\0\0\0\0\0', 'latin1'), head(text.length, 0x4e4f534a), text];
  if (bin !== null) parts.push(head(pad(bin, 0).length, 0x004e4942), pad(bin, 0));
  const out = Buffer.concat(parts);
  out.writeUInt32LE(out.length, 8);
  return out.buffer.slice(out.byteOffset, out.byteOffset + out.length);
}

function corners(scene) {
  const out = [], v = new THREE.Vector3(), instance = new THREE.Matrix4();
  scene.updateMatrixWorld(true);
  scene.traverse((object) => {
    if (!object.isMesh) return;
    if (object.isSkinnedMesh) object.skeleton.update();
    const index = object.geometry.index, position = object.geometry.attributes.position;
    if (!position) return;
    const count = index ? index.count : position.count;
    const points = [];
    for (let i = 0; i < position.count; ++i) points.push(object.getVertexPosition(i, v).clone());
    for (let copy = 0; copy < (object.isInstancedMesh ? object.count : 1); ++copy) {
      const world = object.matrixWorld.clone();
      if (object.isInstancedMesh) object.getMatrixAt(copy, instance), world.multiply(instance);
      for (let k = 0; k + 2 < count; k += 3)
        for (let c = 0; c < 3; ++c) {
          v.copy(points[index ? index.getX(k + c) : k + c] ?? new THREE.Vector3(NaN, NaN, NaN)).applyMatrix4(world);
          out.push(v.x, v.y, v.z);
        }
    }
  });
  return new Float32Array(out);
}

async function samples(file) {
  const loader = new GLTFLoader();
  loader.setDRACOLoader(dracoLoader);
  await MeshoptDecoder.ready;
  loader.setMeshoptDecoder(MeshoptDecoder);
  const gltf = await loader.parseAsync(prepare(file), '');
  if (!gltf.scene) throw new Error('no scene');
  const out = [{ clip: -1, time: 0, corners: corners(gltf.scene) }];
  const mostClips = 12;
  for (let clip = 0; clip < Math.min(gltf.animations.length, mostClips); ++clip) {
    const mixer = new THREE.AnimationMixer(gltf.scene), action = mixer.clipAction(gltf.animations[clip]);
    action.setLoop(THREE.LoopOnce);
    action.clampWhenFinished = true;
    action.play();
    for (const share of [0, 0.137, 0.3819, 0.6283, 0.8713, 1]) {
      const time = share * gltf.animations[clip].duration;
      mixer.setTime(time);
      out.push({ clip, time, corners: corners(gltf.scene) });
    }
    mixer.stopAllAction();
    mixer.uncacheRoot(gltf.scene);
  }
  return out;
}

function write(file, all) {
  const parts = [Buffer.alloc(4)];
  parts[0].writeUInt32LE(all.length, 0);
  for (const s of all) {
    const head = Buffer.alloc(16);
    head.writeInt32LE(s.clip, 0), head.writeDoubleLE(s.time, 4), head.writeUInt32LE(s.corners.length / 3, 12);
    parts.push(head, Buffer.from(s.corners.buffer, s.corners.byteOffset, s.corners.byteLength));
  }
  fs.writeFileSync(file + '.positions', Buffer.concat(parts));
}

for (const entry of fs.readdirSync(process.argv[2], { recursive: true }).sort()) {
  if (!/\.(gltf|glb)$/i.test(entry)) continue;
  const file = path.join(process.argv[2], entry);
  let all = [];
  try {
    const tooLong = new Promise((_, reject) => setTimeout(() => reject(new Error('no answer')), 60000).unref());
    all = await Promise.race([samples(file), tooLong]);
  } catch (error) {
    console.log('three.js refuses ' + entry + ': ' + String(error).slice(0, 100));
  }
  write(file, all);
}
