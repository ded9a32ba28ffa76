// Playback: plays, pauses and seeks, and updates stage, plots and strip.
(() => {
  // `fresh`: the user has not moved in time yet; `following`: shows the newest tick of a live run.
  const player = {t: 0, arm: 0, speed: 1, playing: false, fresh: true, following: Boolean(about.live)};
  const byId = id => document.getElementById(id);
  let stage, plots, strip, live, steer;
  const contactsOf = arms.map(() => null);
  // Returns the intervals of contact; gaps shorter than 20 ms are closed, as in the report.
  player.contacts = () => {
    if (contactsOf[player.arm]) return contactsOf[player.arm];
    const arm = arms[player.arm];
    const found = [];
    for (let i = 0; i < arm.t.length; ++i) {
      if (!arm.touching[i]) continue;
      const end = arm.t[Math.min(i + 1, arm.t.length - 1)];
      const last = found[found.length - 1];
      if (last && arm.t[i] - last[1] <= 0.02) last[1] = end;
      else found.push([arm.t[i], end]);
    }
    return contactsOf[player.arm] = found;
  };
  player.window = () => (plots ? plots.window : [span.begin, span.end]);
  // Width of the plots' window in a live run, s; zooming changes it.
  let shownLast = 10;
  let sliding = false;
  player.windowChanged = ([from, to]) => {
    if (about.live && !sliding) shownLast = Math.max(0.01, to - from);
    if (strip) strip.paint();
  };

  function show() {
    stage.show(player.t);
    stage.draw();
    plots.cursor(player.t);
    strip.paint();
    showReadout(player);
    byId('clock').textContent = player.t.toFixed(3) + ' / ' + span.end.toFixed(3) + ' s';
  }
  player.seek = t => {
    player.t = Math.max(span.begin, Math.min(span.end, t));
    player.fresh = false;
    if (player.following) follow(false);
    show();
  };
  function showPlay() {
    byId('play').textContent = player.playing ? 'Pause' : player.following ? 'Hold' : 'Play';
    byId('now').disabled = player.following || (live && live.state === 'ended');
    if (live) showLive(live, player.following);
  }
  player.play = on => {
    if (on && (player.fresh || player.t >= span.end)) player.seek(span.begin);
    player.playing = on;
    showPlay();
    before = null;
  };
  // In a live run: follows the newest tick, or stays at the current time.
  function follow(on) {
    player.following = on;
    if (on) {
      player.playing = false;
      player.t = span.end;
      slow = 0;
    }
    showPlay();
  }
  player.now = () => follow(true);

  // Steps by rows of the page. A row is a tick, unless the run was longer than the page shows.
  player.step = rows => {
    const times = arms[player.arm].t;
    if (times.length === 0) return;
    player.play(false);
    player.seek(times[Math.max(0, Math.min(times.length - 1, placeOf(times, player.t) + rows))]);
  };

  let before = null;
  let slow = 0;  // time at which the slow parts were drawn last
  let grown = false;
  // Shows the new ticks of a live run: the scene at once, plots and lists a few times a second.
  function showGrown(now) {
    grown = false;
    stage.grow();
    if (player.following) player.t = span.end;
    player.t = Math.max(span.begin, player.t);
    if (now - slow > 200 || live.state === 'ended') {
      slow = now;
      contactsOf.fill(null);
      showScale();
      if (live.marks || live.figures) showSide(player);
      live.marks = live.figures = false;
      sliding = true;
      if (player.following) plots.setWindow(span.end - shownLast, span.end);
      sliding = false;
      strip.forget();
    }
    if (live.state === 'ended' && player.following) follow(false);
    showLive(live, player.following);
    show();
  }
  function frame(now) {
    if (grown) showGrown(now);
    if (player.playing) {
      const t = player.t + (before === null ? 0 : Math.min(0.25, (now - before) * 1e-3) * player.speed);
      before = now;
      player.seek(t);
      if (player.t < span.end) return requestAnimationFrame(frame);
      player.play(false);
      if (about.live) follow(true);
    } else {
      stage.draw();
    }
    requestAnimationFrame(frame);
  }

  function addChoice(name, words, on) {
    const label = document.createElement('label');
    const check = document.createElement('input');
    check.type = 'checkbox';
    check.checked = on;
    check.dataset.shown = name;
    label.append(check, ' ' + words);
    check.addEventListener('change', () => {
      stage.shown[name] = check.checked;
      show();
    });
    byId('stage-choices').append(label);
  }

  function showScale() {
    const bar = byId('scale-bar').getContext('2d');
    for (let x = 0; x < 160; ++x) {
      const colour = forceColour(Math.max(1e-3, x / 160 * forceScale));
      bar.fillStyle = 'rgb(' + colour.map(one => Math.round(255 * one)).join(',') + ')';
      bar.fillRect(x, 0, 1, 8);
    }
    byId('scale-least').textContent = '0';
    byId('scale-most').textContent = +forceScale.toPrecision(3) + ' N';
  }

  // Gives the timeline the horizontal extent of the plots.
  function align() {
    const extent = plots.extent();
    if (!extent) return;
    const box = byId('player').getBoundingClientRect();
    byId('strip').style.marginLeft = extent[0] - box.left + 'px';
    byId('strip').style.marginRight = box.right - extent[1] + 'px';
  }

  let begun = false;
  function begin() {
    begun = true;
    showMapScales(byId('scales'));
    byId('title').textContent = about.title;
    byId('subtitle').textContent = about.subtitle;
    byId('subtitle').title = about.subtitle;
    byId('program').textContent = 'Computed by ' + about.program + '.';
    for (const speed of [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 4]) {
      const option = textIn(byId('speed'), 'option', speed + ' \u00d7');
      option.value = speed;
      option.selected = speed === 1;
    }
    if (arms.length > 1) {
      byId('arm-choice').hidden = false;
      arms.forEach((arm, i) => { textIn(byId('arm'), 'option', arm.name || arm.arm).value = i; });
    }
    showScale();
    showObjects();
    showSide(player);
    stage = makeStage(byId('stage'));
    stage.resize();
    if (stage.shown) {
      addChoice('ahead', 'future path', true);
      if (arms.some(arm => arm.barTimes && arm.barTimes.length > 0)) addChoice('arm', 'arm', false);
      if (about.objects.some(object => object.left)) addChoice('left', 'final shape', false);
      textIn(byId('stage-choices'), 'span', 'grid ' + +(1e3 * stage.cell).toPrecision(2) + ' mm');
    }
    sliding = true;
    plots = makePlots(byId('plots'), player);
    strip = makeStrip(byId('strip'), player);
    plots.layOut();
    sliding = false;
    align();
    theme.onChange(() => {
      stage.recolour();
      plots.recolour();
      strip.forget();
      showScale();
      show();
    });

    byId('play').addEventListener('click', () => {
      if (player.following) player.seek(player.t);
      else player.play(!player.playing);
    });
    byId('now').addEventListener('click', player.now);
    byId('speed').addEventListener('change', event => { player.speed = Number(event.target.value); });
    byId('arm').addEventListener('change', event => {
      player.arm = Number(event.target.value);
      strip.forget();
      showSide(player);
      plots.refresh();
      show();
    });
    // The stage takes the height that plots and panels leave.
    new ResizeObserver(() => {
      stage.resize();
      stage.draw();
    }).observe(byId('stage'));
    window.addEventListener('resize', () => {
      for (const graph of plots.graphs) if (!graph.box.hidden) graph.dygraph.resize();
      align();
      show();
    });
    window.addEventListener('keydown', event => {
      if (event.ctrlKey || event.altKey || event.metaKey || /SELECT|INPUT/.test(event.target.tagName)) return;
      const steps = {ArrowLeft: -1, ArrowRight: 1, PageUp: -100, PageDown: 100};
      if (event.key === ' ' && event.target.tagName !== 'BUTTON') player.play(!player.playing);
      else if (steps[event.key]) player.step(steps[event.key] * (event.shiftKey ? 10 : 1));
      else if (event.key === 'Home') player.seek(span.begin);
      else if (event.key === 'End' && about.live) player.now();
      else if (event.key === 'End') player.seek(span.end);
      else return;
      event.preventDefault();
    });
    if (about.live) {
      byId('now').hidden = false;
      player.fresh = false;
      follow(true);
      grown = true;
    } else {
      // Starts at the largest force.
      const arm = arms[0];
      let peak = 0;
      for (let i = 1; i < arm.t.length; ++i) if (arm.force[i] > arm.force[peak]) peak = i;
      player.seek(arm.t.length ? arm.t[peak] : 0);
      player.fresh = true;  // the first playback starts at the beginning
    }
    requestAnimationFrame(frame);
  }
  if (about.live) {
    steer = makeSteer();
    live = makeLive(() => {
      showLive(live, player.following);
      steer.show(live);
      // The extent of the scene is known with the first tick.
      if (!begun && arms[0].t.length > 0) begin();
      grown = begun;
    });
    showLive(live, true);
    steer.show(live);
  } else {
    begin();
  }

  // Interface for scripts that control the page.
  window.thimblePage = {
    get duration() { return span.end; },
    get begun() { return begun; },
    now: player.now,
    seek: player.seek,
    play: player.play,
    speed: speed => { player.speed = speed; },
    zoom: (from, to) => plots.setWindow(from, to),
    // Left and right ends on the screen: of the time axis of the plots, and of the timeline.
    extents: () => {
      const box = byId('strip').getBoundingClientRect();
      return {plots: plots.extent(), strip: [box.left, box.right]};
    },
    state: () => {
      const arm = arms[player.arm];
      const i = placeOf(arm.t, player.t);
      return {following: player.following, begin: span.begin, live: live || null, rows: arm.t.length, t: player.t, tick: arm.tick[i], force: arm.force[i], depth: arm.depth[i],
              playing: player.playing, drawn: stage.drawn, window: plots.window.slice(),
              plotted: plots.graphs.map(graph => graph.box.hidden ? 0 : graph.dygraph.numRows())};
    }
  };
})();
