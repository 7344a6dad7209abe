// The surface of a liquid: what it mirrors of a plain sky, by Fresnel's law for water (Schlick's approximation), the glint
// of the sun, and its own colour, through which is seen what lies in it. Where the scalar `foam` is above zero, bubbles lie
// on it, as many as it says; they stay where they are, for the page has no velocities.
/// colour: of the water where it is looked through. sky: of the page behind it.
function makeWaterMaterial(colour, sky) {
  'use strict';
  const uniforms = THREE.UniformsUtils.merge([THREE.UniformsLib.lights, THREE.UniformsLib.fog,
    { colour: { value: new THREE.Color(colour) }, horizon: { value: new THREE.Color(sky) } }]);
  const material = new THREE.ShaderMaterial({
    uniforms, lights: true, fog: true, transparent: true, side: THREE.DoubleSide,
    vertexShader: `
      #include <fog_pars_vertex>
      attribute float foam;
      varying vec3 seen, out_of_it, place;
      varying float covered;
      void main() {
        covered = foam;
        place = (modelMatrix * vec4(position, 1.0)).xyz;
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        seen = mvPosition.xyz;
        out_of_it = normalMatrix * normal;
        gl_Position = projectionMatrix * mvPosition;
        #include <fog_vertex>
      }`,
    fragmentShader: `
      #include <common>
      #include <lights_pars_begin>
      #include <fog_pars_fragment>
      uniform vec3 colour, horizon;
      varying vec3 seen, out_of_it, place;
      varying float covered;
      float any(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }
      // How far a place is from the wall between two bubbles, of one bubble in each square: 0 on it.
      float bubbles(vec2 p) {
        vec2 square = floor(p), at = p - square;
        float nearest = 8.0, second = 8.0;
        for (int k = -1; k <= 1; ++k)
          for (int i = -1; i <= 1; ++i) {
            vec2 cell = vec2(float(i), float(k)), middle = cell + vec2(any(square + cell), any(square + cell + 57.0)) - at;
            float d = length(middle);
            if (d < nearest) { second = nearest; nearest = d; } else second = min(second, d);
          }
        return second - nearest;
      }
      // Thin foam is a net of walls, thick foam is closed.
      float foam_at(vec2 p, float share) {
        // Bubbles of three sizes, so that nothing lines up; their walls are soft.
        float net = min(bubbles(p / 0.07), min(0.7 * bubbles(p / 0.031 + 3.7) + 0.12, 0.5 * bubbles(p / 0.012 + 9.1) + 0.3));
        return share <= 0.004 ? 0.0 : 0.85 * smoothstep(-0.22, 0.22, 0.95 * share - net) * smoothstep(0.0, 0.15, share);
      }
      void main() {
        vec3 V = normalize(-seen), N = normalize(out_of_it), up = normalize((viewMatrix * vec4(0.0, 1.0, 0.0, 0.0)).xyz);
        float side = dot(N, V) < 0.0 ? -1.0 : 1.0;
        N *= side;
        float facing = clamp(dot(N, V), 0.0, 1.0), mirrored = 0.02 + 0.98 * pow(1.0 - facing, 5.0);
        vec3 R = reflect(-V, N);
        float high = clamp(dot(R, up), -1.0, 1.0);
        vec3 above = mix(horizon, vec3(0.30, 0.48, 0.72), smoothstep(0.0, 0.9, high));
        above = mix(0.35 * colour, above, smoothstep(-0.25, 0.05, high));
        vec3 own = colour * (0.55 + 0.45 * clamp(dot(N, up), 0.0, 1.0)), glint = vec3(0.0);
        #if NUM_DIR_LIGHTS > 0
          vec3 L = directionalLights[0].direction;
          own += 0.35 * colour * clamp(dot(N, L), 0.0, 1.0);
          glint = directionalLights[0].color * (1.2 * pow(max(dot(R, L), 0.0), 260.0) + 0.08 * pow(max(dot(R, L), 0.0), 16.0));
        #endif
        float white = foam_at(place.xz, covered);
        vec3 surface = mix(mix(own, above, mirrored) + glint, vec3(0.93, 0.95, 0.96) * (0.72 + 0.28 * clamp(dot(N, up), 0.0, 1.0)), white);
        gl_FragColor = vec4(surface, mix(mix(0.66, 1.0, clamp(mirrored + dot(glint, vec3(0.3)), 0.0, 1.0)), 0.96, white));
        #include <fog_fragment>
      }`,
  });
  material.color = uniforms.colour.value;
  return material;
}

// Ground that is wet: a film above the surface of a water, which lies a little below the ground where that is dry, drawn
// before the water. The scalar `wet` says how dark.
function makeWetGround(geometry) {
  'use strict';
  const uniforms = THREE.UniformsUtils.merge([THREE.UniformsLib.fog, { lift: { value: 0.004 } }]);
  const material = new THREE.ShaderMaterial({
    uniforms, fog: true, transparent: true, depthWrite: false, side: THREE.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4,
    vertexShader: `
      #include <fog_pars_vertex>
      attribute float wet;
      uniform float lift;
      varying float dark;
      void main() {
        dark = wet;
        vec4 mvPosition = modelViewMatrix * vec4(position + vec3(0.0, lift, 0.0), 1.0);
        gl_Position = projectionMatrix * mvPosition;
        #include <fog_vertex>
      }`,
    fragmentShader: `
      #include <common>
      #include <fog_pars_fragment>
      varying float dark;
      void main() {
        if (dark < 0.01) discard;
        gl_FragColor = vec4(0.05, 0.045, 0.04, 0.5 * smoothstep(0.0, 0.6, dark));
        #include <fog_fragment>
      }`,
  });
  const film = new THREE.Mesh(geometry, material);
  film.frustumCulled = false;
  film.renderOrder = -1;
  return film;
}
