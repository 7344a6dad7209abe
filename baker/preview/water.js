// The surface of a liquid: what it mirrors of a plain sky, by Fresnel's law for water (Schlick's approximation), the glint
// of the sun, and its own colour, through which is seen what lies in it.
/// colour: of the water where it is looked through. sky: of the page behind it.
function makeWaterMaterial(colour, sky) {
  'use strict';
  const uniforms = THREE.UniformsUtils.merge([THREE.UniformsLib.lights, THREE.UniformsLib.fog,
    { colour: { value: new THREE.Color(colour) }, horizon: { value: new THREE.Color(sky) } }]);
  const material = new THREE.ShaderMaterial({
    uniforms, lights: true, fog: true, transparent: true, side: THREE.DoubleSide,
    vertexShader: `
      #include <fog_pars_vertex>
      varying vec3 seen, out_of_it;
      void main() {
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
      varying vec3 seen, out_of_it;
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
        gl_FragColor = vec4(mix(own, above, mirrored) + glint, mix(0.66, 1.0, clamp(mirrored + dot(glint, vec3(0.3)), 0.0, 1.0)));
        #include <fog_fragment>
      }`,
  });
  material.color = uniforms.colour.value;
  return material;
}
