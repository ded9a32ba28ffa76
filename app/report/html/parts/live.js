// The page of a live run: appends the updates to its data and drops the oldest.

// Column that grows at its end; `array` is its current contents.
class Column {
  constructor(type, width, maxRows) {
    this.width = width;
    this.maxRows = maxRows;
    this.store = new type(2 * maxRows * width);
    this.clear();
  }
  clear() {
    [this.first, this.rows] = [0, 0];
    this.look();
  }
  look() {
    this.array = this.store.subarray(this.width * this.first, this.width * (this.first + this.rows));
  }
  push(numbers) {
    const rows = Math.min(this.maxRows, numbers.length / this.width);
    if (this.first + this.rows + rows > 2 * this.maxRows) {
      this.store.copyWithin(0, this.width * this.first, this.width * (this.first + this.rows));
      this.first = 0;
    }
    this.store.set(numbers.subarray(numbers.length - rows * this.width), this.width * (this.first + this.rows));
    this.rows += rows;
    this.drop(this.rows - this.maxRows);
  }
  // Drops the given number of oldest rows.
  drop(rows) {
    if (rows > 0) {
      this.first += rows;
      this.rows -= rows;
    }
    this.look();
  }
}

function makeLive(changed) {
  const live = {state: 'connecting', notice: '', lost: 0, lostHere: 0, figures: false, marks: false, updates: 0};
  const maxRows = Math.floor(about.live.rows / arms.length);
  const kPicturesMax = 4000;  // poses of bodies and arms: 30 a second, with some margin
  const columns = arms.map(arm => {
    const own = {};
    for (const [name, width] of Object.entries(kColumns)) own[name] = new Column(arm[name].constructor, width, maxRows);
    own.force = new Column(Float32Array, 1, maxRows);
    return own;
  });
  const marks = arms.map(() => new Map());
  const bars = arms.map(() => null);
  let bodyColumns = null;

  function forget() {
    for (const own of columns) for (const column of Object.values(own)) column.clear();
    for (const own of marks) own.clear();
    for (const own of bars) if (own) for (const column of Object.values(own)) column.clear();
    if (bodyColumns) for (const column of Object.values(bodyColumns)) column.clear();
    [dents.all, dents.times] = [[], []];
    shapes.all = [];
    shapes.base.clear();
  }

  function takeArm(number, part, get) {
    const arm = arms[number];
    const own = columns[number];
    const column = name => get('arm' + number + '.' + name);
    if (part.rows > 0) {
      for (const name of Object.keys(kColumns)) own[name].push(column(name));
      // Of arms after the first only the newest ticks are sent, so there are no periods.
      if (number > 0) own.period.array[own.period.array.length - 1] = NaN;
      const sent = column('sent');
      const force = Float32Array.from({length: part.rows}, (_, i) => lengthAt(sent, i));
      own.force.push(force);
      for (const one of force) if (one > arm.maxForce) arm.maxForce = one;
    }
    if (part.lines && part.lines.length > 0 && column('bars').length > 0) {
      const points = part.lines.reduce((sum, one) => sum + one, 0);
      arm.lines = arm.lines || part.lines;
      bars[number] = bars[number] || {t: new Column(Float64Array, 1, kPicturesMax), points: new Column(Float32Array, 3 * points, kPicturesMax)};
      bars[number].t.push(column('bar_t'));
      bars[number].points.push(column('bars'));
    }
    for (const [mark, words] of part.marks) {
      marks[number].set(mark, words);
      if (marks[number].size > 500) marks[number].delete(marks[number].keys().next().value);
      live.marks = true;
    }
  }

  function take(update, get) {
    if (update.base) {
      forget();
      live.lostHere += update.lost_here;
    }
    (update.arms || []).forEach((part, number) => takeArm(number, part, get));
    if (update.bodies) {
      about.bodies = about.bodies || update.bodies;
      const width = 7 * about.bodies.objects.length;
      bodyColumns = bodyColumns || {t: new Column(Float64Array, 1, kPicturesMax), poses: new Column(Float32Array, width, kPicturesMax)};
      bodyColumns.t.push(get('bodies.t'));
      bodyColumns.poses.push(get('bodies.poses'));
    }
    if (update.dents) dents.all.push(...dentsOf(get));
    if (update.shapes) shapes.all.push(...shapesOf(get));
    if (update.figures) {
      arms[0].figures = update.figures;
      live.figures = true;
    }
    if (update.state) {
      live.state = update.died ? 'the process has died' : update.paused && update.state === 'running' ? 'paused' : update.state;
      live.recording = update.recording;
      live.lost = update.lost;
      live.missed = update.missed;
      live.knobs = update.knobs;
      live.notice = update.notice;
    }
    ++live.updates;
  }

  // Drops everything older than the oldest tick, except the state at that time.
  function trim() {
    const first = columns[0].t.array[0];
    if (first === undefined) return;
    const old = times => Math.max(0, placeOf(times, first));
    for (const own of columns.slice(1)) {
      const rows = old(own.t.array);
      for (const column of Object.values(own)) column.drop(rows);
    }
    for (const own of bars) if (own) for (const [rows, column] of Object.values(own).map(one => [old(own.t.array), one])) column.drop(rows);
    if (bodyColumns) {
      const rows = old(bodyColumns.t.array);
      for (const column of Object.values(bodyColumns)) column.drop(rows);
    }
    dents.all.splice(0, old(dents.all.map(dent => dent.t)));
    dents.times = dents.all.map(dent => dent.t);
    const steps = shapes.all.findIndex(step => step.t > first);
    for (const step of shapes.all.splice(0, steps < 0 ? 0 : steps)) shapes.fold(step);
  }

  // Publishes the current columns.
  function show() {
    arms.forEach((arm, number) => {
      for (const [name, column] of Object.entries(columns[number])) arm[name] = column.array;
      arm.marks = [...marks[number].values()];
      if (bars[number]) [arm.barTimes, arm.bars] = [bars[number].t.array, bars[number].points.array];
    });
    if (bodyColumns) [bodies.t, bodies.poses] = [bodyColumns.t.array, bodyColumns.poses.array];
    const some = arms.filter(arm => arm.t.length > 0);
    if (some.length > 0) {
      span.begin = some[0].t[0];
      span.end = Math.max(span.begin + 0.001, ...some.map(arm => arm.t[arm.t.length - 1]));
    }
    forceScale = Math.max(forceScale, roundUp(Math.max(...arms.map(arm => arm.maxForce))));
  }

  const decoder = new TextDecoder();
  let leaving = false;
  function read(buffer) {
    const view = new DataView(buffer);
    for (let at = 0; at < buffer.byteLength;) {
      const [text, block] = [view.getUint32(at, true), view.getUint32(at + 4, true)];
      const update = JSON.parse(decoder.decode(new Uint8Array(buffer, at + 8, text)));
      // Another run has this name now; its ticks do not belong to the objects of this page.
      if (update.run && update.run !== about.live.run) leaving = true;
      if (leaving) return location.reload();
      take(update, arraysOf(update.arrays, buffer, at + 8 + text));
      at += 8 + text + block;
    }
    trim();
    show();
    changed();
  }

  function connect() {
    const socket = new WebSocket('ws://' + location.host + '/live' + location.search);
    socket.binaryType = 'arraybuffer';
    socket.onmessage = event => read(event.data);
    socket.onclose = event => {
      if (event.code === 1012) return location.reload();  // another run
      if (event.code === 1000) {
        live.state = 'ended';
      } else {
        // A run that has ended may be followed by another one of the same name.
        if (live.state !== 'ended') live.state = 'not connected';
        setTimeout(connect, 1000);
      }
      changed();
    };
  }
  connect();
  return live;
}

// Shows the state of the run in the header.
function showLive(live, following) {
  const box = document.getElementById('live');
  box.hidden = false;
  box.className = live.state === 'running' ? (following ? 'on' : 'held') : 'off';
  const parts = [live.state === 'running' ? (following ? 'live' : 'held; the run continues') : live.state];
  if (live.recording && live.state === 'running') parts.push('recording to ' + live.recording);
  if (live.lost > 0) parts.push(live.lost + ' ticks were overwritten before they were read');
  if (live.lostHere > 0) parts.push(live.lostHere + ' ticks did not reach this page');
  const words = parts.join(', ');
  if (box.textContent !== words) box.textContent = words;
}
