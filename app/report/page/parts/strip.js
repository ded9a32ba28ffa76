// The timeline: force over the whole run, contact, marks, the window of the plots, and where it is.
const kMarkColours = {fault: '#b3261e', warning: '#b7791f', gate: '#8e2a8b', note: '#9aa5b1'};

function makeStrip(box, player) {
  const canvas = box.querySelector('canvas');
  const strip = {};
  let ground = null;

  function paintGround(width, height) {
    const arm = arms[player.arm];
    ground = document.createElement('canvas');
    ground.width = width;
    ground.height = height;
    const pen = ground.getContext('2d');
    pen.fillStyle = '#fff';
    pen.fillRect(0, 0, width, height);
    pen.fillStyle = '#dfe9f2';
    for (const [begin, end] of player.contacts()) {
      pen.fillRect(begin / duration * width, 0, Math.max(1, (end - begin) / duration * width), height);
    }
    // A force stands until the next tick, which may be some columns on.
    const most = new Float32Array(width);
    for (let i = 0; i < arm.t.length; ++i) {
      const next = i + 1 < arm.t.length ? arm.t[i + 1] : duration;
      const last = Math.min(width - 1, Math.floor(next / duration * width));
      for (let x = Math.floor(arm.t[i] / duration * width); x <= last; ++x) {
        if (arm.force[i] > most[x]) most[x] = arm.force[i];
      }
    }
    for (let x = 0; x < width; ++x) {
      if (!(most[x] > 0)) continue;
      pen.fillStyle = 'rgb(' + forceColour(most[x]).map(one => Math.round(255 * one)).join(',') + ')';
      const high = most[x] / forceScale * (height - 6);
      pen.fillRect(x, height - high, 1, high);
    }
    for (const mark of arm.marks) {
      pen.fillStyle = kMarkColours[mark.kind];
      const x = mark.begin / duration * width;
      pen.fillRect(x, 0, mark.kind === 'fault' ? 3 : 2, mark.kind === 'fault' ? height : 7);
    }
  }
  strip.paint = () => {
    const scale = window.devicePixelRatio || 1;
    const [width, height] = [Math.max(1, Math.round(box.clientWidth * scale)), Math.round(box.clientHeight * scale)];
    if (!ground || canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
      paintGround(width, height);
    }
    const pen = canvas.getContext('2d');
    pen.drawImage(ground, 0, 0);
    const [begin, end] = player.window();
    pen.fillStyle = 'rgba(31, 41, 51, 0.16)';
    if (begin > 0) pen.fillRect(0, 0, begin / duration * width, height);
    if (end < duration) pen.fillRect(end / duration * width, 0, width, height);
    pen.fillStyle = '#0b3c5d';
    pen.fillRect(Math.min(width - 3, player.t / duration * width - 1), 0, 3, height);
    box.setAttribute('aria-valuenow', player.t.toFixed(3));
    box.setAttribute('aria-valuetext', player.t.toFixed(3) + ' s');
  };
  strip.forget = () => { ground = null; };

  const go = event => {
    const place = box.getBoundingClientRect();
    player.seek((event.clientX - place.left) / place.width * duration);
  };
  box.setAttribute('aria-valuemax', duration.toFixed(3));
  box.addEventListener('pointerdown', event => {
    box.setPointerCapture(event.pointerId);
    box.focus({preventScroll: true});
    go(event);
  });
  box.addEventListener('pointermove', event => { if (event.buttons & 1) go(event); });
  return strip;
}
