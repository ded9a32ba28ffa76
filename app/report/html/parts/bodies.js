// Poses of the moving objects: `t` and, for each object, x y z and a quaternion w x y z.
const bodies = {t: numbers('bodies.t') || new Float64Array(0), poses: numbers('bodies.poses') || new Float32Array(0)};
// Returns a function that moves the objects to their poses at a time.
function makeBodies(objects) {
  const turn = (poses, at) => new THREE.Quaternion(poses[at + 4], poses[at + 5], poses[at + 6], poses[at + 3]);
  return t => {
    const {t: times, poses} = bodies;
    if (!about.bodies || times.length === 0) return;
    const i = placeOf(times, t);
    const j = Math.min(i + 1, times.length - 1);
    const share = j > i ? Math.max(0, Math.min(1, (t - times[i]) / (times[j] - times[i]))) : 0;
    const count = about.bodies.objects.length;
    about.bodies.objects.forEach((number, k) => {
      const [a, b] = [7 * (i * count + k), 7 * (j * count + k)];
      const mesh = objects[number].mesh;
      mesh.position.fromArray(poses, a).lerp(new THREE.Vector3().fromArray(poses, b), share);
      mesh.quaternion.copy(turn(poses, a)).slerp(turn(poses, b), share);
    });
  };
}

// Dents, oldest first, and their times.
function dentsOf(get) {
  const times = get('dents.t');
  if (!times) return [];
  const [object, firstPoint, firstTriangle, pointsOf, trianglesOf, points, normals, corners, sources] =
      ['object', 'first_point', 'first_triangle', 'points_of', 'triangles_of', 'points', 'normals', 'corners', 'sources']
          .map(name => get('dents.' + name));
  return Array.from(times, (t, i) => {
    const ofPoints = all => all.subarray(3 * firstPoint[i], 3 * (firstPoint[i] + pointsOf[i]));
    const [from, to] = [firstTriangle[i], firstTriangle[i] + trianglesOf[i]];
    return {t, object: object[i], points: ofPoints(points), normals: ofPoints(normals),
            corners: corners.subarray(3 * from, 3 * to), sources: sources.subarray(from, to)};
  });
}
const dents = {all: dentsOf(numbers)};
dents.times = dents.all.map(dent => dent.t);

// Returns a function that draws the dent at a time, instead of the triangles that it replaces.
function makeDents(objects) {
  const patch = new THREE.Mesh(new THREE.BufferGeometry(), undefined);
  let shown = null;
  let away = null;  // the hidden triangles: [positions, numbers, previous corners]

  function putBack() {
    if (!away) return;
    away.numbers.forEach((triangle, k) => away.places.array.set(away.were[k], 9 * triangle));
    away.places.needsUpdate = true;
    patch.parent.remove(patch);
    away = null;
  }
  return (t, on) => {
    const dent = on && dents.all.length > 0 && t >= dents.times[0] ? dents.all[placeOf(dents.times, t)] : null;
    if (dent === shown) return;
    shown = dent;
    putBack();
    if (!dent || dent.sources.length === 0) return;
    const {mesh, first} = objects[dent.object];
    const places = first.attributes.position;
    const replaced = [...new Set(dent.sources)];
    away = {places, numbers: replaced, were: replaced.map(one => places.array.slice(9 * one, 9 * one + 9))};
    // A triangle without area is not drawn.
    for (const one of replaced) {
      for (let k = 3; k < 9; ++k) places.array[9 * one + k] = places.array[9 * one + k % 3];
    }
    places.needsUpdate = true;
    patch.geometry.dispose();
    patch.geometry = new THREE.BufferGeometry();
    patch.geometry.setAttribute('position', new THREE.BufferAttribute(dent.points.slice(), 3));
    patch.geometry.setAttribute('normal', new THREE.BufferAttribute(dent.normals.slice(), 3, true));
    patch.geometry.setIndex(new THREE.BufferAttribute(dent.corners.slice(), 1));
    patch.material = mesh.material;
    mesh.add(patch);
  };
}

// Permanent deformation of objects, step by step, oldest first: the changed vertices and triangles.
function shapesOf(get) {
  const times = get('shapes.t');
  if (!times) return [];
  const [object, verticesOf, trianglesOf, vertices, places, triangles, corners] =
      ['object', 'vertices_of', 'triangles_of', 'vertices', 'places', 'triangles', 'corners']
          .map(name => get('shapes.' + name));
  let [v, n] = [0, 0];
  return Array.from(times, (t, i) => {
    const [toV, toN] = [v + verticesOf[i], n + trianglesOf[i]];
    const step = {t, object: object[i], vertices: vertices.subarray(v, toV), places: places.subarray(3 * v, 3 * toV),
                  triangles: triangles.subarray(n, toN), corners: corners.subarray(3 * n, 3 * toN)};
    [v, n] = [toV, toN];
    return step;
  });
}
// `base`: mesh of each object before all steps, if it differs from the initial one.
const shapes = {all: shapesOf(numbers), base: new Map()};
shapes.before = number => {
  const base = shapes.base.get(number);
  if (base) return {vertices: base.vertices.slice(), corners: base.corners.slice()};
  return {vertices: numbers('object' + number + '.vertices').slice(), corners: Uint32Array.from(numbers('object' + number + '.corners'))};
};
shapes.apply = (mesh, step) => {
  const filled = (array, length) => {
    if (length <= array.length) return array;
    const more = new array.constructor(length);
    more.set(array);
    return more;
  };
  const highest = all => all.reduce((most, one) => Math.max(most, one), -1);
  mesh.vertices = filled(mesh.vertices, 3 * highest(step.vertices) + 3);
  mesh.corners = filled(mesh.corners, 3 * highest(step.triangles) + 3);
  step.vertices.forEach((v, i) => mesh.vertices.set(step.places.subarray(3 * i, 3 * i + 3), 3 * v));
  step.triangles.forEach((n, i) => mesh.corners.set(step.corners.subarray(3 * i, 3 * i + 3), 3 * n));
};
// Merges a step into the base.
shapes.fold = step => {
  const mesh = shapes.before(step.object);
  shapes.apply(mesh, step);
  shapes.base.set(step.object, mesh);
};

// Returns a function that gives each permanently deformed object its mesh at a time.
function makeShapes(objects) {
  const meshes = new Map();  // object: its drawn mesh, and the number of steps in it
  return t => {
    for (const number of new Set([...shapes.base.keys(), ...shapes.all.map(step => step.object)])) {
      const steps = shapes.all.filter(step => step.object === number);
      const upTo = steps.findIndex(step => step.t > t + 1e-9);
      const newest = (upTo < 0 ? steps[steps.length - 1] : steps[upTo - 1]) || null;
      let mesh = meshes.get(number);
      if (mesh ? mesh.newest === newest : !newest && !shapes.base.has(number)) continue;
      let next = mesh && mesh.newest ? steps.indexOf(mesh.newest) + 1 : 0;
      // Back in time: starts again from the base.
      if (!mesh || next === 0 || newest === null || steps.indexOf(newest) < next - 1) {
        next = 0;
        mesh = shapes.before(number);
        meshes.set(number, mesh);
      }
      for (; newest && steps[next - 1] !== newest; ++next) shapes.apply(mesh, steps[next]);
      mesh.newest = newest;
      const geometry = meshGeometry(mesh.vertices, mesh.corners, about.objects[number].crease);
      objects[number].first.dispose();
      objects[number].first = geometry;
    }
  };
}
