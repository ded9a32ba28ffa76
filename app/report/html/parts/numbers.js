// Description of the run (`about`), and its numbers: typed arrays over one block of bytes, by name.
const about = JSON.parse(document.getElementById('about').textContent);
const kTypes = {
  f64: Float64Array, f32: Float32Array, u32: Uint32Array, u16: Uint16Array, i16: Int16Array,
  u8: Uint8Array
};
// Returns a function that returns arrays by name. `arrays` has their positions, from `offset` of a buffer on.
function arraysOf(arrays, buffer, offset) {
  return name => {
    const array = arrays[name];
    return array ? new kTypes[array.type](buffer, offset + array.offset, array.count) : null;
  };
}
const numbers = (() => {
  const raw = atob(document.getElementById('numbers').textContent);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return arraysOf(about.arrays, inflate(bytes, about.numbers_bytes).buffer, 0);
})();

// Returns the last index of an increasing array whose value is not above `t`; 0 if there is none.
function placeOf(times, t) {
  let low = 0;
  let high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return low;
}

function lengthAt(array, i) {
  return Math.hypot(array[3 * i], array[3 * i + 1], array[3 * i + 2]);
}

// Returns the smallest 1, 2 or 5 times a power of ten that is not below a value.
function roundUp(value) {
  if (!(value > 0)) return 1;
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  for (const factor of [1, 2, 5]) if (factor * power >= value * 0.9999) return factor * power;
  return 10 * power;
}

// Columns of an arm's ticks, with the number of values per tick.
const kColumns = {
  t: 1, tick: 1, tip: 3, proxy: 3, sent: 3, asked: 1, depth: 1, period: 1, work: 1, speed: 1,
  object: 1, touching: 1
};
// Ticks of one arm, column by column.
function armOf(number) {
  const arm = Object.assign({}, about.arms[number]);
  const column = name => numbers('arm' + number + '.' + name);
  for (const name of Object.keys(kColumns)) arm[name] = column(name);
  arm.barTimes = column('bar_t');
  arm.bars = column('bars');
  arm.force = new Float32Array(arm.t.length);
  arm.maxForce = 0;
  for (let i = 0; i < arm.t.length; ++i) {
    arm.force[i] = lengthAt(arm.sent, i);
    if (arm.force[i] > arm.maxForce) arm.maxForce = arm.force[i];
  }
  return arm;
}
const arms = about.arms.map((_, number) => armOf(number));
// Time range of the page, s; both ends move in a live run.
const span = {begin: 0, end: Math.max(0.001, ...arms.map(arm => (arm.t.length ? arm.t[arm.t.length - 1] : 0)))};
let forceScale = roundUp(Math.max(...arms.map(arm => arm.maxForce)));

// Colour of a force: grey for none, then light to dark; distinguishable for colour-blind people. On dark ground the
// largest force is brighter, because it would not be seen there.
const kForceStops = [[0.98, 0.82, 0.30], [0.95, 0.56, 0.17], [0.84, 0.25, 0.05]];
const kForceStopsLight = [...kForceStops, [0.38, 0.03, 0.12]];
const kForceStopsDark = [...kForceStops, [0.82, 0.10, 0.44]];
function forceColour(force) {
  if (!(force > 1e-4)) return [0.60, 0.64, 0.69];
  const stops = theme.dark ? kForceStopsDark : kForceStopsLight;
  const at = Math.min(0.9999, force / forceScale) * (stops.length - 1);
  const i = Math.floor(at);
  return stops[i].map((one, k) => one + (stops[i + 1][k] - one) * (at - i));
}

const kObjectColours = ['#8fb3d1', '#e0b88a', '#96c3ac', '#c7a5c4', '#b9bfc7', '#d9cf9a'];
function objectColour(i) {
  return kObjectColours[i % kObjectColours.length];
}
