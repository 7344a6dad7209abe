// Points of a bake that come and go, as droplets: discs that face the camera, lit as balls, as large as their widths and
// no smaller than they can be seen (commands/preview_points.h says how they are packed).
/// unpack(base64): the bytes. s: the system, whose positions are unpacked already.
function makePoints(s, colour, unpack) {
  'use strict';
  const own = s.points, counts = new Uint32Array(unpack(own.counts).buffer), widths = new Uint16Array(unpack(own.widths).buffer);
  const most = Math.max(s.vertices, 1), starts = [];
  counts.reduce((sum, count, frame) => { starts[frame] = sum; return sum + count; }, 0);
  own.starts = starts;
  const geometry = new THREE.BufferGeometry();
  const place = new THREE.BufferAttribute(new Float32Array(3 * most), 3), width = new THREE.BufferAttribute(new Float32Array(most), 1);
  geometry.setAttribute('position', place);
  geometry.setAttribute('width', width);
  const uniforms = { colour: { value: new THREE.Color(colour) }, height: { value: 700 } };
  const material = new THREE.ShaderMaterial({
    uniforms, transparent: true,
    vertexShader: `
      attribute float width;
      uniform float height;  // of the picture, in pixels
      varying float shown;   // of what is smaller than a pixel
      void main() {
        vec4 seen = viewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * seen;
        float size = 0.5 * height * projectionMatrix[1][1] * width / (projectionMatrix[2][3] != 0.0 ? max(-seen.z, 1e-6) : 1.0);
        gl_PointSize = max(size, 1.6);
        shown = clamp(size / 1.6, 0.25, 1.0);
      }`,
    fragmentShader: `
      uniform vec3 colour;
      varying float shown;
      void main() {
        vec2 at = vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
        float r2 = dot(at, at);
        if (r2 > 1.0) discard;
        vec3 normal = vec3(at, sqrt(1.0 - r2));
        float sky = 0.82 + 0.18 * normal.y, glint = pow(max(dot(normal, normalize(vec3(0.35, 0.75, 0.6))), 0.0), 40.0);
        gl_FragColor = vec4(mix(colour, vec3(1.0), 0.7) * sky + glint, 0.8 * shown);  // a drop is mostly sky
      }`,
  });
  const group = new THREE.Points(geometry, material), box = new THREE.Box3();
  group.frustumCulled = false;
  group.onBeforeRender = (renderer) => { uniforms.height.value = renderer.getContext().drawingBufferHeight; };

  function show(frame) {
    const count = counts[frame], from = starts[frame], p = s.positions, low = s.low, step = s.step;
    box.makeEmpty();
    for (let i = 0; i < count; ++i)
      for (let k = 0; k < 3; ++k) {
        const x = low[k] + p[3 * (from + i) + k] * step[k];
        place.array[3 * i + k] = x;
        box.min.setComponent(k, Math.min(box.min.getComponent(k), x));
        box.max.setComponent(k, Math.max(box.max.getComponent(k), x));
      }
    for (let i = 0; i < count; ++i) width.array[i] = own.widest * widths[from + i] / 65535;
    place.needsUpdate = width.needsUpdate = true;
    geometry.setDrawRange(0, count);
  }
  return { group, material, show, box };
}
