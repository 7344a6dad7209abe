// The moving air of a bake: a stroke for each place where it was sampled (run/wind_file.h), from pale to dark the way it
// blows, as long as the air goes in a fifteenth of a second and at most to the next place.
/// wind: { every, reach, places, velocities }.
function makeWind(wind) {
  'use strict';
  const count = wind.places.length, places = new Float32Array(6 * count), colours = new Float32Array(6 * count);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
  lines.frustumCulled = false;
  const tail = new THREE.Color(0xd5dbe4), head = new THREE.Color(0x2b5f9e);
  for (let i = 0; i < count; ++i) {
    tail.toArray(colours, 6 * i);
    head.toArray(colours, 6 * i + 3);
  }
  function show(index) {
    const at = Math.min(index / wind.every, wind.velocities.length - 1), first = Math.floor(at);
    const a = wind.velocities[first], b = wind.velocities[Math.min(first + 1, wind.velocities.length - 1)], share = at - first;
    for (let i = 0; i < count; ++i) {
      const v = [0, 1, 2].map((k) => (a[3 * i + k] + share * (b[3 * i + k] - a[3 * i + k])) / 1500);
      const length = Math.hypot(...v), shorter = length > 0.9 * wind.reach ? 0.9 * wind.reach / length : 1;
      for (let k = 0; k < 3; ++k) {
        places[6 * i + k] = wind.places[i][k] / 1000;
        places[6 * i + 3 + k] = places[6 * i + k] + shorter * v[k];
      }
    }
    geometry.attributes.position.needsUpdate = true;
  }
  return { lines, show };
}
