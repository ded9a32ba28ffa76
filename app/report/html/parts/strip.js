// The timeline: force over the whole run, contact, events, the window of the plots, and the current time.
const markColour = kind => theme.colour(kind === 'fault' ? 'bad' : kind);

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
    pen.fillStyle = theme.colour('strip');
    pen.fillRect(0, 0, width, height);
    pen.fillStyle = theme.colour('contact');
    const at = t => (t - span.begin) / (span.end - span.begin) * width;
    for (const [begin, end] of player.contacts()) {
      pen.fillRect(at(begin), 0, Math.max(1, at(end) - at(begin)), height);
    }
    // A force lasts until the next tick, which may be several columns later.
    const maxima = new Float32Array(width);
    for (let i = 0; i < arm.t.length; ++i) {
      const next = i + 1 < arm.t.length ? arm.t[i + 1] : span.end;
      const last = Math.min(width - 1, Math.floor(at(next)));
      for (let x = Math.max(0, Math.floor(at(arm.t[i]))); x <= last; ++x) {
        if (arm.force[i] > maxima[x]) maxima[x] = arm.force[i];
      }
    }
    for (let x = 0; x < width; ++x) {
      if (!(maxima[x] > 0)) continue;
      pen.fillStyle = 'rgb(' + forceColour(maxima[x]).map(one => Math.round(255 * one)).join(',') + ')';
      const high = maxima[x] / forceScale * (height - 6);
      pen.fillRect(x, height - high, 1, high);
    }
    for (const mark of arm.marks) {
      pen.fillStyle = markColour(mark.kind);
      const x = at(mark.begin);
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
    const at = t => (t - span.begin) / (span.end - span.begin) * width;
    pen.fillStyle = theme.colour('shade');
    if (begin > span.begin) pen.fillRect(0, 0, at(begin), height);
    if (end < span.end) pen.fillRect(at(end), 0, width, height);
    pen.fillStyle = theme.colour('ink');
    const thick = Math.max(2, Math.round(2 * scale));
    pen.fillRect(Math.max(0, Math.min(width - thick, at(player.t) - thick / 2)), 0, thick, height);
    box.setAttribute('aria-valuemin', span.begin.toFixed(3));
    box.setAttribute('aria-valuemax', span.end.toFixed(3));
    box.setAttribute('aria-valuenow', player.t.toFixed(3));
    box.setAttribute('aria-valuetext', player.t.toFixed(3) + ' s');
  };
  strip.forget = () => { ground = null; };

  const go = event => {
    const place = box.getBoundingClientRect();
    player.seek(span.begin + (event.clientX - place.left) / place.width * (span.end - span.begin));
  };
  box.addEventListener('pointerdown', event => {
    box.setPointerCapture(event.pointerId);
    box.focus({preventScroll: true});
    go(event);
  });
  box.addEventListener('pointermove', event => { if (event.buttons & 1) go(event); });
  return strip;
}
