// The scene in three dimensions. Without WebGL a message is shown instead, and the rest of the page works.
function makeStage(box) {
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true});
  } catch (error) {
    const note = document.getElementById('stage-note');
    note.textContent = 'This browser does not support WebGL, so the scene is not shown; plots and figures are below.';
    note.hidden = false;
    return {show() {}, draw() {}, resize() {}, recolour() {}, grow() {}, drawn: 0};
  }
  const kOpening = 0.6;
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  renderer.domElement.className = 'view';
  box.insertBefore(renderer.domElement, box.firstChild);
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(kOpening * 180 / Math.PI, 1, 0.001, 10);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa3ad, 0.72));
  const lamp = new THREE.DirectionalLight(0xffffff, 0.36);
  scene.add(lamp, lamp.target);

  // Objects, with their initial and final meshes.
  const bounds = new THREE.Box3();
  const objects = about.objects.map((object, i) => {
    const prefix = 'object' + i + '.';
    const of = which => meshGeometry(numbers(which + 'vertices'), numbers(which + 'corners'),
                                     object.crease);
    const first = of(prefix);
    const left = object.left ? of(prefix + 'left.') : null;
    const values = object.map ? numbers(prefix + 'map') : null;
    const drawn = values ? mappedGeometry(first, values, object.map.parts, i) : first;
    const mesh = new THREE.Mesh(drawn, new THREE.MeshPhongMaterial({
      color: values ? '#ffffff' : objectColour(i),
      vertexColors: values ? THREE.VertexColors : THREE.NoColors, specular: 0x222222, shininess: 25, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
    scene.add(mesh);
    drawn.computeBoundingBox();
    if (!object.endless && drawn.attributes.position.count > 0) bounds.union(drawn.boundingBox);
    return {mesh, first: drawn, left};
  });
  for (const arm of arms) {
    const p = new THREE.Vector3();
    for (let i = 0; i < arm.t.length; i += 20) {
      if (arm.touching[i] || bounds.isEmpty()) bounds.expandByPoint(p.fromArray(arm.tip, 3 * i));
    }
  }
  for (const arm of arms) {
    if (!bounds.isEmpty() || !arm.workspace) continue;
    for (const corner of arm.workspace) bounds.expandByPoint(new THREE.Vector3().fromArray(corner));
  }
  if (bounds.isEmpty()) bounds.expandByPoint(new THREE.Vector3());
  const size = Math.max(1e-3, bounds.getSize(new THREE.Vector3()).length());

  // A grid of 10 mm, or this times a power of ten, below the scene.
  const cell = Math.pow(10, Math.round(Math.log10(size / 15)));
  const cells = 2 * Math.ceil(0.55 * size / cell);
  const middle = bounds.getCenter(new THREE.Vector3());
  let grid = null;
  function makeGrid() {
    if (grid) {
      scene.remove(grid);
      grid.geometry.dispose();
    }
    grid = new THREE.GridHelper(cells * cell, cells, theme.colour('grid-middle'), theme.colour('grid'));
    grid.rotation.x = Math.PI / 2;
    grid.position.set(Math.round(middle.x / cell) * cell, Math.round(middle.y / cell) * cell,
                      bounds.min.z - 0.002 * size);
    scene.add(grid);
  }
  makeGrid();

  // Drawn parts of each arm.
  const ball = new THREE.SphereBufferGeometry(1, 24, 16);
  const rod = new THREE.CylinderBufferGeometry(1, 1, 1, 12);
  const materials = new Map();  // by the name of their colour in page.css
  const plain = name => {
    if (!materials.has(name)) materials.set(name, new THREE.MeshPhongMaterial({color: theme.colour(name), shininess: 40}));
    return materials.get(name);
  };
  // Draws a part of an arm faintly where objects hide it.
  const hidden = name => {
    const material = plain(name).clone();
    Object.assign(material, {transparent: true, opacity: 0.45, depthTest: false, depthWrite: false});
    materials.set(name + ' hidden', material);
    return material;
  };
  const sides = arms.map(arm => {
    const path = makePath(arm, size / 700, size / 330);
    const tip = new THREE.Mesh(ball, plain('tip'));
    const proxy = new THREE.Mesh(ball, plain('proxy'));
    const shaft = new THREE.Mesh(rod, plain('force'));
    const head = new THREE.Mesh(new THREE.ConeBufferGeometry(1, 1, 20), plain('force'));
    tip.scale.setScalar(size / 110);
    proxy.scale.setScalar(size / 130);
    // A tip that is a ball, around the proxy.
    const around = new THREE.Mesh(ball, plain('tip-ball'));
    around.material.transparent = true;
    around.material.opacity = 0.4;
    around.material.depthWrite = false;
    around.scale.setScalar(about.tip_radius || 1);
    around.visible = false;
    const bars = [];
    for (const count of arm.lines || []) {
      for (let i = 0; i + 1 < count; ++i) bars.push(new THREE.Mesh(rod, plain('bar')));
    }
    for (const [part, colour] of [[tip, 'tip'], [proxy, 'proxy'], [shaft, 'force'], [head, 'force']]) {
      part.add(new THREE.Mesh(part.geometry, hidden(colour)));
    }
    scene.add(path.group, tip, proxy, around, shaft, head, ...bars);
    return {path, tip, proxy, around, shaft, head, bars};
  });

  // Returns the sum of all forces: the initial view is from the touched side.
  function touchedSide() {
    const sum = new THREE.Vector3();
    for (const arm of arms) {
      for (let i = 0; i < arm.t.length; i += 5) {
        sum.x += arm.sent[3 * i];
        sum.y += arm.sent[3 * i + 1];
        sum.z += arm.sent[3 * i + 2];
      }
    }
    return sum;
  }

  const up = new THREE.Vector3(0, 1, 0);
  const put = (mesh, a, b, thick) => {
    const along = b.clone().sub(a);
    const length = along.length();
    mesh.visible = length > 1e-9;
    if (!mesh.visible) return;
    mesh.position.copy(a).addScaledVector(along, 0.5);
    mesh.quaternion.setFromUnitVectors(up, along.normalize());
    mesh.scale.set(thick, length, thick);
  };
  const stage = {shown: {ahead: true, arm: false, left: false}, drawn: 0, dirty: true};
  const point = (array, i) => new THREE.Vector3(array[3 * i], array[3 * i + 1], array[3 * i + 2]);

  function showArm(arm, side, t) {
    const i = placeOf(arm.t, t);
    side.tip.visible = arm.t.length > 0;
    if (!side.tip.visible) return;
    const tip = point(arm.tip, i);
    const proxy = point(arm.proxy, i);
    side.tip.position.copy(tip);
    side.proxy.position.copy(proxy);
    side.proxy.visible = arm.touching[i] > 0;
    side.around.visible = about.tip_radius > 0;
    side.around.position.copy(side.proxy.visible ? proxy : tip);
    const force = point(arm.sent, i).multiplyScalar(0.3 * size / forceScale);
    const felt = force.length();
    const pointed = felt > 1e-6 * size;
    side.shaft.visible = side.head.visible = pointed;
    if (pointed) {
      const end = proxy.clone().add(force);
      const neck = proxy.clone().addScaledVector(force, Math.max(0, 1 - 0.05 * size / felt));
      put(side.shaft, proxy, neck, size / 260);
      put(side.head, neck, end, size / 90);
    }
    side.path.show(t, stage.shown.ahead);
    for (const bar of side.bars) bar.visible = false;
    if (!stage.shown.arm || !arm.barTimes || arm.barTimes.length === 0) return;
    const all = arm.lines.reduce((sum, one) => sum + one, 0);
    let at = all * placeOf(arm.barTimes, t);
    let bar = 0;
    for (const count of arm.lines) {
      for (let k = 0; k + 1 < count; ++k, ++at) {
        put(side.bars[bar++], point(arm.bars, at), point(arm.bars, at + 1), size / 100);
      }
      ++at;
    }
  }

  const showBodies = makeBodies(objects);
  const showDents = makeDents(objects);
  const showShapes = makeShapes(objects);
  const eye = makeEye(renderer.domElement, () => { stage.dirty = true; });
  // Adds the new ticks of a live run to the paths.
  stage.grow = () => sides.forEach(side => side.path.grow());
  stage.show = t => {
    showShapes(t);
    objects.forEach(object => {
      object.mesh.geometry = stage.shown.left && object.left ? object.left : object.first;
    });
    arms.forEach((arm, i) => showArm(arm, sides[i], t));
    showBodies(t);
    showDents(t, !stage.shown.left);
    stage.dirty = true;
  };
  stage.draw = () => {
    if (!stage.dirty) return;
    stage.dirty = false;
    eye.place(camera);
    lamp.position.copy(camera.position).add(new THREE.Vector3(0, 0, eye.distance));
    lamp.target.position.copy(eye.target);
    renderer.render(scene, camera);
    ++stage.drawn;
  };
  stage.resize = () => {
    renderer.setSize(box.clientWidth, box.clientHeight, false);
    camera.aspect = box.clientWidth / Math.max(1, box.clientHeight);
    if (!eye.home) eye.frame(bounds, camera, touchedSide());
    stage.dirty = true;
  };
  stage.recolour = () => {
    makeGrid();
    for (const [name, material] of materials) material.color.set(theme.colour(name.split(' ')[0]));
    for (const side of sides) side.path.recolour();
    stage.dirty = true;
  };
  stage.cell = cell;
  stage.eye = eye;
  return stage;
}
