// Requests of the page to a live run: pause, restart and knobs, as in the window. Shows their state.

// Returns the unit in which to show a value of this size, and its number per unit of the knob.
function readUnit(unit, largest) {
  if (unit === 'm' && largest < 1e-3) return ['\u00b5m', 1e6];
  if (unit === 'm' && largest < 1) return ['mm', 1e3];
  if (unit === 'N' && largest < 1) return ['mN', 1e3];
  return [unit, 1];
}

function makeSteer() {
  const byId = id => document.getElementById(id);
  const kPlaces = 1000;  // positions of a slider
  const token = new URLSearchParams(location.search).get('token');
  const steer = {};
  let answer = '';

  async function ask(words) {
    try {
      const answered = await fetch('/steer', {method: 'POST', headers: {'X-Thimble-Token': token, 'X-Thimble-Run': about.live.run}, body: words});
      answer = answered.ok ? '' : (await answered.text()).trim();
    } catch {
      answer = 'The run cannot be reached.';
    }
    byId('steer-note').textContent = answer;
  }

  // Creates the row of a knob: name, value, slider, and a button to reset it.
  function makeKnob(knob) {
    const row = document.createElement('div');
    row.className = 'knob';
    const name = textIn(row, 'label', knob.name);
    const value = textIn(row, 'output', '');
    const slider = document.createElement('input');
    slider.type = 'range';
    [slider.min, slider.max, slider.step] = [0, kPlaces, 1];
    slider.id = name.htmlFor = 'knob-' + knob.name;
    const reset = document.createElement('button');
    row.append(slider, reset);
    reset.type = 'button';
    reset.textContent = 'reset';
    reset.title = 'Reset to the value in the scene';
    byId('knobs').append(row);

    const [unit, size] = readUnit(knob.unit, Math.max(Math.abs(knob.least), Math.abs(knob.most)));
    // A range of more than two powers of ten has a logarithmic slider, as in the window.
    const wide = knob.least > 0 && knob.most > 100 * knob.least;
    const at = place => {
      const share = place / kPlaces;
      const free = wide ? knob.least * Math.pow(knob.most / knob.least, share) : knob.least + share * (knob.most - knob.least);
      return Math.max(knob.least, Math.min(knob.most, free));
    };
    const placeOfValue = one => Math.round(kPlaces * (wide ? Math.log(one / knob.least) / Math.log(knob.most / knob.least)
                                                            : (one - knob.least) / (knob.most - knob.least)));
    const showValue = one => { value.textContent = +(one * size).toPrecision(4) + (unit ? ' ' + unit : ''); };
    // One request at a time: the newest value waits for the answer to the previous request.
    let [wish, asking] = [null, false];
    async function turn(one) {
      wish = one;
      showValue(one);
      if (asking) return;
      asking = true;
      while (wish !== null) {
        const now = wish;
        wish = null;
        await ask('turn ' + knob.name + '=' + now);
      }
      asking = false;
    }
    slider.addEventListener('input', () => turn(at(Number(slider.value))));
    reset.addEventListener('click', () => turn(knob.initial));
    return {show: (one, off) => {
      [slider.disabled, reset.disabled] = [off, off];
      if (asking) return;
      showValue(one);
      slider.value = placeOfValue(one);
    }};
  }

  byId('steer').hidden = false;
  byId('knobs-title').hidden = about.live.knobs.length === 0;
  const knobs = about.live.knobs.map(makeKnob);
  const [pause, step, restart] = ['pause', 'step', 'restart'].map(name => byId('steer-' + name));
  let paused = false;
  pause.addEventListener('click', () => ask(paused ? 'resume' : 'pause'));
  step.addEventListener('click', event => ask('step ' + (event.ctrlKey ? 100 : event.shiftKey ? 10 : 1)));
  restart.addEventListener('click', () => ask('restart'));

  // Shows the state of the run.
  steer.show = live => {
    const goes = live.state === 'running' || live.state === 'paused';
    paused = live.state === 'paused';
    const words = paused ? 'Resume run' : 'Pause run';
    if (pause.textContent !== words) pause.textContent = words;
    pause.disabled = !goes;
    step.disabled = !paused || about.live.no_step !== '';
    step.title = about.live.no_step || (paused ? '1 tick; with Shift 10, with Ctrl 100' : 'Pause the run first.');
    restart.disabled = !goes || about.live.no_restart !== '';
    restart.title = about.live.no_restart || 'Restarts the run from its first tick';
    knobs.forEach((knob, i) => { if (live.knobs) knob.show(live.knobs[i], !goes); });
    const note = answer || live.notice;
    if (byId('steer-note').textContent !== note) byId('steer-note').textContent = note;
  };
  return steer;
}
