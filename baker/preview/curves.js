// Curves of a bake, as hair: ribbons that face the camera, a few pieces for each segment of a strand, all made by the
// vertex shader. A frame's packed numbers go to the graphics card as they are (commands/preview_curves.h says how they are
// packed), four vertices of a strand as one instance:
//
//    a --- b === c --- d     the piece between b and c is drawn, along a Catmull-Rom curve through all four
//
// Light on a fibre depends on its tangent: diffuse and two highlights as in Kajiya and Kay, "Rendering fur with three
// dimensional textures" (1989), the highlights shifted towards the tip and the root, the second in the hair's own colour, as
// Marschner et al., "Light scattering from human hair fibers" (2003), measured it. Light fades with the way that it goes
// through hair: by the depth of the shadow map, exponentially.
/// unpack(base64): the bytes. s: the system, whose positions and bounds are unpacked already.
function makeCurves(s, colour, unpack) {
  'use strict';
  const own = s.curves, count = s.vertices, counts = new Uint32Array(unpack(own.counts).buffer), ids = new Uint32Array(unpack(own.ids).buffer);
  const widths = own.widths ? new Float32Array(unpack(own.widths).buffer) : null;
  const texels = 2048;  // along a side of the sun's shadow map
  const share = counts.length / Math.max(own.strands, 1), usual = 8e-5;  // m, of what has no width of its own
  const wider = Math.min(Math.sqrt(1 / Math.max(share, 1e-6)), 4);  // fewer strands cover more each

  /// A number from 0 to 1 that looks as if it had nothing to do with the id.
  function random(id) {
    let h = Math.imul(id ^ 0x5bd1e995, 0x85ebca6b);
    h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
    return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
  }
  // One vertex more at both ends, for the neighbours that the first and the last do not have.
  const places = new Uint16Array(4 * (count + 2)), traits = new Float32Array(2 * (count + 2));
  const roots = new Uint32Array(counts.length);
  for (let k = 0, v = 0; k < counts.length; ++k) {
    roots[k] = v;
    for (let j = 0; j < counts[k]; ++j, ++v) {
      places[4 * (v + 1) + 3] = Math.round(65535 * j / (counts[k] - 1));  // 0 at the root, 65535 at the tip and nowhere else
      traits.set([wider * (widths ? widths[v] : usual), random(ids[k])], 2 * (v + 1));
    }
  }

  const geometry = new THREE.InstancedBufferGeometry(), corners = [], triangles = [];
  const pieces = Math.min(Math.ceil(32 * counts.length / Math.max(count, 1)), 6) || 1;  // about 32 for a strand
  for (let k = 0; k <= pieces; ++k) corners.push(k / pieces, -1, 0, k / pieces, 1, 0);
  for (let k = 0; k < pieces; ++k) triangles.push(2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 2, 2 * k + 1, 2 * k + 3);
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(triangles);
  const moving = new THREE.InstancedInterleavedBuffer(places, 4), fixed = new THREE.InstancedInterleavedBuffer(traits, 2);
  moving.setUsage(THREE.DynamicDrawUsage);
  ['a', 'b', 'c', 'd'].forEach((name, k) => geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(moving, 4, 4 * k)));
  geometry.setAttribute('trait', new THREE.InterleavedBufferAttribute(fixed, 4, 2));  // of b and of c
  geometry.maxInstancedCount = Math.max(count - 1, 0);

  const to_place = `
    attribute vec4 a, b, c, d, trait;
    uniform vec3 low, grid;
    uniform float height;  // of the picture, in pixels
    vec3 centre, tangent;  // of the ribbon, in the world
    float along;           // 0 at the root, 1 at the tip
    vec3 place(vec4 v) { return low + v.xyz * grid; }
    vec4 corner() {
      if (b.w > 65534.5) return vec4(2.0, 2.0, 2.0, 1.0);  // from a tip to the next root there is nothing
      vec3 B = place(b), C = place(c);
      vec3 A = b.w < 0.5 ? 2.0 * B - C : place(a), D = c.w > 65534.5 ? 2.0 * C - B : place(d);
      float t = position.x;
      vec3 p1 = 0.5 * (C - A), p2 = A - 2.5 * B + 2.0 * C - 0.5 * D, p3 = 0.5 * (D - A) + 1.5 * (B - C);
      centre = B + t * (p1 + t * (p2 + t * p3));
      tangent = p1 + t * (2.0 * p2 + 3.0 * t * p3);
      along = mix(b.w, c.w, t) / 65535.0;
      vec4 seen = viewMatrix * vec4(centre, 1.0);
      bool perspective = projectionMatrix[2][3] != 0.0;
      float pixel = 2.0 / (projectionMatrix[1][1] * height) * (perspective ? max(-seen.z, 0.0) : 1.0);
      vec3 aside = cross((viewMatrix * vec4(tangent, 0.0)).xyz, perspective ? -seen.xyz : vec3(0.0, 0.0, 1.0));
      float wide = max(mix(trait.x, trait.z, t), 1.1 * pixel);
      seen.xyz += 0.5 * position.y * wide * aside / max(length(aside), 1e-12);
      return projectionMatrix * seen;
    }`;
  const uniforms = THREE.UniformsUtils.merge([THREE.UniformsLib.lights, THREE.UniformsLib.fog, {
    low: { value: new THREE.Vector3() }, grid: { value: new THREE.Vector3() }, height: { value: 700 },
    middle: { value: new THREE.Vector3() }, colour: { value: new THREE.Color(colour) }, depth: { value: 1 }, fade: { value: 1 } }]);
  const material = new THREE.ShaderMaterial({
    uniforms, lights: true, fog: true, side: THREE.DoubleSide,
    vertexShader: to_place + `
      #include <fog_pars_vertex>
      #include <packing>
      varying float lit;
      #if defined(USE_SHADOWMAP) && NUM_DIR_LIGHT_SHADOWS > 0
        uniform mat4 directionalShadowMatrix[NUM_DIR_LIGHT_SHADOWS];
        uniform sampler2D directionalShadowMap[NUM_DIR_LIGHT_SHADOWS];
        uniform float depth, fade;  // of the shadow map [m]; light that goes through so much hair is 1/e [m]
        /// The mean over texels about the place.
        float through(vec3 at) {
          float sum = 0.0;
          for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
              float first = unpackRGBAToDepth(texture2D(directionalShadowMap[0], at.xy + vec2(float(i), float(j)) * ${1.3 / texels}));
              float hair = max(at.z - first, 0.0) * depth / fade;
              sum += 0.7 * exp(-hair) + 0.3 * exp(-0.2 * hair);  // what is scattered on goes farther
            }
          return sum / 9.0;
        }
      #endif
      uniform vec3 middle;
      varying vec3 way, outward, seen;
      varying vec4 strand;  // along, across, chance, chance of a piece of it
      void main() {
        gl_Position = corner();
        way = (viewMatrix * vec4(tangent, 0.0)).xyz;
        outward = (viewMatrix * vec4(centre - middle, 0.0)).xyz;
        vec4 mvPosition = viewMatrix * vec4(centre, 1.0);
        seen = mvPosition.xyz;
        strand = vec4(along, position.y, trait.y, sin(37.0 * trait.y + 9.0 * along));
        #if defined(USE_SHADOWMAP) && NUM_DIR_LIGHT_SHADOWS > 0
          vec4 at = directionalShadowMatrix[0] * vec4(centre, 1.0);
          lit = through(at.xyz / at.w);
        #else
          lit = 1.0;
        #endif
        #include <fog_vertex>
      }`,
    fragmentShader: `
      #include <common>
      #include <lights_pars_begin>
      #include <fog_pars_fragment>
      uniform vec3 colour;
      varying vec3 way, outward, seen;
      varying vec4 strand;
      varying float lit;  // of the sun's light, what comes through
      /// A highlight about the cone of directions in which a fibre with this tangent mirrors.
      float highlight(vec3 T, vec3 H, float sharp) {
        float across = dot(T, H);
        return smoothstep(-1.0, 0.0, across) * pow(max(1.0 - across * across, 0.0), 0.5 * sharp);
      }
      void main() {
        vec3 T = normalize(way), V = normalize(-seen);
        vec3 N = V - T * dot(T, V), O = outward - T * dot(T, outward);  // of the ribbon, and of the hair as a whole
        N /= max(length(N), 1e-6);
        O /= max(length(O), 1e-6);
        // Each strand is a little lighter or darker, and a little more red or yellow, than the others.
        float chance = strand.z;
        vec3 own = colour * (0.8 + 0.6 * chance) * (1.0 + 0.10 * (fract(7.31 * chance) - 0.5) * vec3(1.0, 0.1, -0.8));
        own *= mix(0.55, 1.25, smoothstep(0.0, 0.8, strand.x));
        float deep = mix(0.45, 1.0, smoothstep(0.0, 0.35, strand.x));  // little of the sky is seen from among the roots
        vec3 sum = vec3(0.0);
        #if NUM_HEMI_LIGHTS > 0
          sum += own * deep * mix(hemisphereLights[0].groundColor, hemisphereLights[0].skyColor, 0.5 + 0.5 * dot(O, hemisphereLights[0].direction));
        #endif
        float shift = 0.06 * (chance - 0.5) + 0.02 * strand.w;
        vec3 glint = own / max(max(own.r, max(own.g, own.b)), 1e-3);
        #if NUM_DIR_LIGHTS > 0
        for (int i = 0; i < NUM_DIR_LIGHTS; ++i) {
          vec3 L = directionalLights[i].direction;
          float across = dot(T, L), come = i == 0 ? lit : deep;
          float facing = clamp(0.35 + 0.65 * dot(O, L), 0.0, 1.0);  // hair is a body, too: its far side is dark
          vec3 H = normalize(L + V);
          float first = highlight(normalize(T + (shift - 0.09) * N), H, 90.0), second = highlight(normalize(T + (shift + 0.14) * N), H, 22.0);
          vec3 light = own * 1.15 * sqrt(max(1.0 - across * across, 0.0)) * facing;
          light += (0.26 * first + (0.35 + 0.3 * strand.w * strand.w) * second * glint * sqrt(max(own.r, 0.02))) * facing;
          sum += directionalLights[i].color * come * light;
        }
        #endif
        sum *= 1.0 - 0.35 * strand.y * strand.y;  // round, where it is wide enough to be seen
        gl_FragColor = vec4(sum, 1.0);
        #include <fog_fragment>
      }`,
  });
  const shade = new THREE.ShaderMaterial({
    uniforms: { low: uniforms.low, grid: uniforms.grid, height: { value: texels } }, side: THREE.DoubleSide,
    vertexShader: to_place + 'void main() { gl_Position = corner(); }',
    fragmentShader: '#include <packing>\nvoid main() { gl_FragColor = packDepthToRGBA(gl_FragCoord.z); }',
  });

  const group = new THREE.Mesh(geometry, material);
  group.customDepthMaterial = shade;
  group.castShadow = group.receiveShadow = true;
  group.frustumCulled = false;
  group.onBeforeRender = (renderer, scene) => {
    uniforms.height.value = renderer.getContext().drawingBufferHeight;
    scene.traverseVisible((o) => {
      if (o.isDirectionalLight && o.castShadow) uniforms.depth.value = o.shadow.camera.far - o.shadow.camera.near;
    });
  };
  const box = new THREE.Box3();

  function show(frame) {
    const from = 3 * frame * count, packed = s.positions, bounds = own.bounds.subarray(6 * frame, 6 * frame + 6);
    for (let i = from, to = 4, end = from + 3 * count; i < end; i += 3, to += 4)
      places[to] = packed[i], places[to + 1] = packed[i + 1], places[to + 2] = packed[i + 2];
    moving.needsUpdate = true;
    uniforms.low.value.fromArray(bounds, 0);
    uniforms.grid.value.fromArray(bounds, 3);
    box.min.copy(uniforms.low.value);
    box.max.copy(uniforms.grid.value).multiplyScalar(65535).add(box.min);
    // What they grow on is about the middle of the roots.
    const middle = uniforms.middle.value.set(0, 0, 0);
    for (const root of roots)
      for (let k = 0; k < 3; ++k) middle.setComponent(k, middle.getComponent(k) + packed[from + 3 * root + k] / roots.length);
    middle.multiply(uniforms.grid.value).add(uniforms.low.value);
    uniforms.fade.value = 0.06 * box.min.distanceTo(box.max) + 1e-4;
  }
  return { group, material, show, box };
}
