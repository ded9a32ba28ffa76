// Camera that orbits a point. World: x towards the user, y to the right, z up.
function makeEye(canvas, changed) {
  const eye = {target: new THREE.Vector3(), yaw: 0.5, pitch: 0.42, distance: 0.3, home: null};
  const towards = () => new THREE.Vector3(Math.cos(eye.pitch) * Math.cos(eye.yaw),
                                          Math.cos(eye.pitch) * Math.sin(eye.yaw),
                                          Math.sin(eye.pitch));
  eye.place = camera => {
    camera.position.copy(eye.target).addScaledVector(towards(), eye.distance);
    camera.up.set(0, 0, 1);
    camera.lookAt(eye.target);
    camera.near = eye.distance / 100;
    camera.far = eye.distance * 100;
    camera.updateProjectionMatrix();
  };
  const kMargin = 1.06;  // of the picture around the box [chosen: no corner touches the edge]
  // Shows a whole box from the side to which `side` points, from above.
  eye.frame = (box, camera, side) => {
    const flat = Math.hypot(side.x, side.y);
    if (flat > 0.2 * Math.abs(side.z)) {
      eye.yaw = Math.max(-1.2, Math.min(1.2, Math.atan2(side.y, side.x))) + 0.25;
    }
    eye.pitch = Math.max(0.3, Math.min(0.75, Math.atan2(side.z, Math.max(flat, 1e-9))));
    box.getCenter(eye.target);
    eye.distance = box.getSize(new THREE.Vector3()).length();
    for (let round = 0; round < 6; ++round) {
      eye.place(camera);
      camera.updateMatrixWorld();
      camera.matrixWorldInverse.getInverse(camera.matrixWorld);
      let largest = 0;
      for (let corner = 0; corner < 8; ++corner) {
        const p = new THREE.Vector3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                    corner & 4 ? box.max.z : box.min.z).project(camera);
        largest = Math.max(largest, Math.abs(p.x), Math.abs(p.y));
      }
      eye.distance *= kMargin * largest;
    }
    eye.home = {target: eye.target.clone(), yaw: eye.yaw, pitch: eye.pitch, distance: eye.distance};
  };
  eye.goHome = () => {
    eye.target.copy(eye.home.target);
    Object.assign(eye, {yaw: eye.home.yaw, pitch: eye.home.pitch, distance: eye.home.distance});
    changed();
  };
  const turn = (dx, dy) => {
    eye.yaw -= dx * 0.008;
    eye.pitch = Math.max(-1.5, Math.min(1.5, eye.pitch + dy * 0.008));
  };
  const pan = (dx, dy) => {
    const forward = towards().negate();
    const right = forward.clone().cross(new THREE.Vector3(0, 0, 1)).normalize();
    const up = right.clone().cross(forward);
    const step = eye.distance / canvas.clientHeight * 0.6;
    eye.target.addScaledVector(right, -dx * step).addScaledVector(up, dy * step);
  };
  const zoom = factor => {
    eye.distance = Math.max(0.002, Math.min(20, eye.distance * factor));
  };

  const fingers = new Map();
  canvas.addEventListener('pointerdown', event => {
    fingers.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointermove', event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before.clientX;
    const dy = event.clientY - before.clientY;
    if (fingers.size === 2) {
      const other = [...fingers.values()].find(one => one.pointerId !== event.pointerId);
      const apart = one => Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY);
      zoom(apart(before) / Math.max(1, apart(event)));
      pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      pan(dx, dy);
    } else {
      turn(dx, dy);
    }
    fingers.set(event.pointerId, event);
    changed();
  });
  for (const end of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  }
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  canvas.addEventListener('dblclick', eye.goHome);
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
    changed();
  }, {passive: false});
  return eye;
}
