// Objects that move: returns what puts them where they are at a time.
function makeBodies(objects) {
  const times = numbers('bodies.t');
  const poses = numbers('bodies.poses');
  if (!about.bodies || times.length === 0) return () => {};
  const turn = at => new THREE.Quaternion(poses[at + 4], poses[at + 5], poses[at + 6], poses[at + 3]);
  return t => {
    const i = placeOf(times, t);
    const j = Math.min(i + 1, times.length - 1);
    const share = j > i ? Math.max(0, Math.min(1, (t - times[i]) / (times[j] - times[i]))) : 0;
    const count = about.bodies.objects.length;
    about.bodies.objects.forEach((number, k) => {
      const [a, b] = [7 * (i * count + k), 7 * (j * count + k)];
      const mesh = objects[number].mesh;
      mesh.position.fromArray(poses, a).lerp(new THREE.Vector3().fromArray(poses, b), share);
      mesh.quaternion.copy(turn(a)).slerp(turn(b), share);
    });
  };
}

// Objects that dent: returns what draws the dent of a time, in place of the triangles it stands for.
function makeDents(objects) {
  const times = numbers('dents.t');
  if (!about.dents || times.length === 0) return () => {};
  const [object, firstPoint, firstTriangle, pointsOf, trianglesOf, points, normals, corners, sources] =
      ['object', 'first_point', 'first_triangle', 'points_of', 'triangles_of', 'points', 'normals', 'corners', 'sources']
          .map(name => numbers('dents.' + name));
  const patch = new THREE.Mesh(new THREE.BufferGeometry(), undefined);
  let shown = -1;
  let away = null;  // the triangles that are not drawn: [positions, numbers, what they were]

  function putBack() {
    if (!away) return;
    away.numbers.forEach((triangle, k) => away.places.array.set(away.were[k], 9 * triangle));
    away.places.needsUpdate = true;
    patch.parent.remove(patch);
    away = null;
  }
  return (t, on) => {
    const i = on && t >= times[0] ? placeOf(times, t) : -1;
    if (i === shown) return;
    shown = i;
    putBack();
    if (i < 0 || trianglesOf[i] === 0) return;
    const {mesh, first} = objects[object[i]];
    const places = first.attributes.position;
    const from = firstTriangle[i];
    const replaced = [...new Set(sources.subarray(from, from + trianglesOf[i]))];
    away = {places, numbers: replaced, were: replaced.map(one => places.array.slice(9 * one, 9 * one + 9))};
    // A triangle without area is not drawn.
    for (const one of replaced) {
      for (let k = 3; k < 9; ++k) places.array[9 * one + k] = places.array[9 * one + k % 3];
    }
    places.needsUpdate = true;
    patch.geometry.dispose();
    patch.geometry = new THREE.BufferGeometry();
    const own = all => all.slice(3 * firstPoint[i], 3 * (firstPoint[i] + pointsOf[i]));
    patch.geometry.setAttribute('position', new THREE.BufferAttribute(own(points), 3));
    patch.geometry.setAttribute('normal', new THREE.BufferAttribute(own(normals), 3, true));
    patch.geometry.setIndex(new THREE.BufferAttribute(corners.slice(3 * from, 3 * (from + trianglesOf[i])), 1));
    patch.material = mesh.material;
    mesh.add(patch);
  };
}
