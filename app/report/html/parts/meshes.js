// Returns a mesh with separate normals at every corner: the mean over the triangles at the vertex whose normals
// differ by less than the crease angle.
function meshGeometry(vertices, corners, crease) {
  const triangles = corners.length / 3;
  const flat = new Float32Array(3 * triangles);
  const unit = new Float32Array(3 * triangles);
  for (let t = 0; t < triangles; ++t) {
    const [a, b, c] = [3 * corners[3 * t], 3 * corners[3 * t + 1], 3 * corners[3 * t + 2]];
    const ux = vertices[b] - vertices[a], uy = vertices[b + 1] - vertices[a + 1],
          uz = vertices[b + 2] - vertices[a + 2];
    const vx = vertices[c] - vertices[a], vy = vertices[c + 1] - vertices[a + 1],
          vz = vertices[c + 2] - vertices[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(n[0], n[1], n[2]) || 1;
    for (let k = 0; k < 3; ++k) {
      flat[3 * t + k] = n[k];
      unit[3 * t + k] = n[k] / length;
    }
  }
  // Triangles at each vertex.
  const first = new Uint32Array(vertices.length / 3 + 1);
  for (const v of corners) ++first[v + 1];
  for (let v = 1; v < first.length; ++v) first[v] += first[v - 1];
  const next = first.slice();
  const meeting = new Uint32Array(corners.length);
  for (let i = 0; i < corners.length; ++i) meeting[next[corners[i]]++] = (i / 3) | 0;
  const minCosine = Math.cos(crease);
  const places = new Float32Array(3 * corners.length);
  const normals = new Float32Array(3 * corners.length);
  for (let i = 0; i < corners.length; ++i) {
    const v = corners[i];
    const own = 3 * ((i / 3) | 0);
    let x = 0, y = 0, z = 0;
    for (let m = first[v]; m < first[v + 1]; ++m) {
      const other = 3 * meeting[m];
      const dot = unit[own] * unit[other] + unit[own + 1] * unit[other + 1] +
                  unit[own + 2] * unit[other + 2];
      if (dot < minCosine) continue;
      x += flat[other];
      y += flat[other + 1];
      z += flat[other + 2];
    }
    const length = Math.hypot(x, y, z) || 1;
    normals.set([x / length, y / length, z / length], 3 * i);
    places.set([vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]], 3 * i);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  return geometry;
}

// Returns the path of an arm's tip from row `begin` to `end` as a tube coloured by force; in contact, the path of
// the proxy. `times` has the tick of each ring of the tube.
function pathTube(arm, begin, end, step, radius) {
  const kSides = 6;
  const rows = [];
  const forces = [];
  let maxForce = 0;
  const at = i => new THREE.Vector3(arm.proxy[3 * i], arm.proxy[3 * i + 1], arm.proxy[3 * i + 2]);
  let last = null;
  for (let i = begin; i < end; ++i) {
    maxForce = Math.max(maxForce, arm.touching[i] ? arm.force[i] : 0);
    const p = at(i);
    if (last && p.distanceTo(last) < step && i + 1 < end) continue;
    last = p;
    rows.push(i);
    forces.push(maxForce);
    maxForce = 0;
  }
  const places = new Float32Array(3 * kSides * rows.length);
  const normals = new Float32Array(3 * kSides * rows.length);
  const colours = new Float32Array(3 * kSides * rows.length);
  const corners = [];
  let side = new THREE.Vector3(0, 0, 1);
  for (let r = 0; r < rows.length; ++r) {
    const along = at(rows[Math.min(r + 1, rows.length - 1)]).sub(at(rows[Math.max(r - 1, 0)]));
    if (along.lengthSq() < 1e-20) along.set(1, 0, 0);
    along.normalize();
    side = side.clone().addScaledVector(along, -side.dot(along));
    if (side.lengthSq() < 1e-6) side.set(along.y, along.z, along.x).cross(along);
    side.normalize();
    const up = along.clone().cross(side);
    const p = at(rows[r]);
    const colour = forceColour(forces[r]);
    for (let s = 0; s < kSides; ++s) {
      const angle = 2 * Math.PI * s / kSides;
      const n = side.clone().multiplyScalar(Math.cos(angle)).addScaledVector(up, Math.sin(angle));
      const k = 3 * (kSides * r + s);
      normals.set([n.x, n.y, n.z], k);
      places.set([p.x + radius * n.x, p.y + radius * n.y, p.z + radius * n.z], k);
      colours.set(colour, k);
      if (r + 1 === rows.length) continue;
      const a = kSides * r + s, b = kSides * r + (s + 1) % kSides;
      corners.push(a, b, a + kSides, b, b + kSides, a + kSides);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  geometry.setIndex(corners);
  return {geometry, times: rows.map(i => arm.t[i]), perRing: 6 * kSides};
}

// The path of an arm, in pieces of a tube. In a live run the last piece grows, and the oldest are dropped with their
// ticks. The past is drawn solid, the future thin.
function makePath(arm, step, radius) {
  const kPiece = 1000;  // ticks, in a live run; a finished run has one piece
  const solid = new THREE.MeshPhongMaterial({vertexColors: THREE.VertexColors, shininess: 10});
  const thin = new THREE.MeshPhongMaterial(
      {vertexColors: THREE.VertexColors, shininess: 10, transparent: true, opacity: 0.3, depthWrite: false});
  const path = {group: new THREE.Group()};
  const pieces = [];
  let scale = forceScale;
  const rowOf = t => (arm.t.length > 0 && t >= arm.t[0] ? placeOf(arm.t, t) : 0);

  function remove(piece) {
    path.group.remove(piece.past, piece.ahead);
    piece.past.geometry.dispose();
    piece.ahead.geometry.dispose();
  }
  function add(begin, end, closed) {
    const tube = pathTube(arm, begin, end, step, radius);
    const piece = {tube, begin: arm.t[begin], end: arm.t[end - 1], closed};
    piece.past = new THREE.Mesh(tube.geometry, solid);
    piece.ahead = new THREE.Mesh(tube.geometry.clone(), thin);
    path.group.add(piece.past, piece.ahead);
    pieces.push(piece);
  }
  path.grow = () => {
    while (pieces.length > 0 && (scale !== forceScale || arm.t.length === 0 || pieces[0].end < arm.t[0])) remove(pieces.shift());
    scale = forceScale;
    if (pieces.length > 0 && !pieces[pieces.length - 1].closed) remove(pieces.pop());
    let begin = pieces.length > 0 ? rowOf(pieces[pieces.length - 1].end) : 0;
    while (begin + 1 < arm.t.length) {
      const end = about.live ? Math.min(arm.t.length, begin + kPiece) : arm.t.length;
      add(begin, end, end - begin === kPiece);
      begin = end - 1;
    }
  };
  path.recolour = () => {
    while (pieces.length > 0) remove(pieces.pop());
    path.grow();
  };
  path.show = (t, showAhead) => {
    for (const piece of pieces) {
      const rings = t < piece.begin ? 0 : t >= piece.end ? Infinity : placeOf(piece.tube.times, t);
      piece.past.visible = rings > 0;
      piece.past.geometry.setDrawRange(0, rings * piece.tube.perRing);
      piece.ahead.visible = showAhead && rings < Infinity;
      if (piece.ahead.visible) piece.ahead.geometry.setDrawRange(rings * piece.tube.perRing, Infinity);
    }
  };
  path.grow();
  return path;
}
