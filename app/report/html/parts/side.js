// Panel next to the scene: figures, events, objects.
const kWords = {
  ticks: 'Ticks', rate: 'Rate', period_p99_9: 'Period, 99.9 %', period_max: 'Period, longest',
  touch_downs: 'Contacts', lost_contacts: 'Lost contacts', force_max: 'Force, maximum',
  force_rms: 'Force in contact, RMS', depth_max: 'Depth, maximum', energy_to_hand: 'Energy to the hand',
  reports_missing: 'Reports missing', fault_ticks: 'Ticks in fault', ticks_missed: 'Ticks missed', current_at_exit: 'Current at the end',
  page_misses: 'Ticks missing a page', pages_damaged: 'Pages damaged', tick_time_p50: 'Computing, median',
  tick_time_p99_9: 'Computing, 99.9 %', forces_differing: 'Forces that differ from the recording'
};

function textIn(parent, tag, text, className) {
  const element = document.createElement(tag);
  element.textContent = text;
  if (className) element.className = className;
  parent.append(element);
  return element;
}

function showSide(player) {
  const arm = arms[player.arm];
  const table = document.getElementById('figures');
  table.textContent = '';
  for (const figure of arm.figures) {
    const row = document.createElement('tr');
    const rounded = Math.abs(figure.value) >= 1e5 || Number.isInteger(figure.value)
                        ? String(Math.round(figure.value)) : String(+figure.value.toPrecision(4));
    textIn(row, 'td', kWords[figure.name] || figure.name);
    textIn(row, 'td', rounded + (figure.unit ? ' ' + figure.unit : ''));
    textIn(row, 'td', figure.goal ? (figure.met ? '\u2713 ' : '\u2717 ') + figure.goal.replace('>=', '\u2265')
                          .replace('<=', '\u2264').replace('==', '=') : '', 'goal');
    if (!figure.met) row.className = 'unmet';
    table.append(row);
  }
  const list = document.getElementById('marks');
  list.textContent = '';
  document.getElementById('no-marks').hidden =
      arm.marks.some(mark => mark.kind === 'fault' || mark.kind === 'gate' || mark.kind === 'warning');
  // In a live run the newest events come first.
  for (const mark of about.live ? arm.marks.slice().reverse() : arm.marks.slice(0, 500)) {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = mark.kind;
    textIn(button, 'time', mark.begin.toFixed(3) + ' s');
    textIn(button, 'span', mark.words);
    button.addEventListener('click', () => player.seek(mark.begin));
    const item = document.createElement('li');
    item.append(button);
    list.append(item);
  }
  if (arm.marks.length > 500) textIn(list, 'li', 'and ' + (arm.marks.length - 500) + ' more');
}

function showObjects() {
  const list = document.getElementById('objects');
  about.objects.forEach((object, i) => {
    const item = document.createElement('li');
    const spot = document.createElement('i');
    spot.style.background = objectColour(i);
    item.append(spot, object.name + ' ');
    let words = object.kind === 'field' ? 'field, not drawn'
                : object.kind === 'paged' ? 'paged from disk, not drawn'
                : object.kind === 'shape' ? 'exact shape' : object.triangles + ' triangles';
    if (object.drawn < object.triangles) words += ', drawn with ' + object.drawn;
    if (object.moves) words += ', moves';
    textIn(item, 'span', words);
    list.append(item);
  });
}

// Shows the values at one time, over the scene.
function showReadout(player) {
  const arm = arms[player.arm];
  const box = document.getElementById('readout');
  if (arm.t.length === 0) return;
  const i = placeOf(arm.t, player.t);
  const object = arm.object[i] >= 0 && arm.touching[i] ? about.objects[arm.object[i]] : null;
  const values = [['time', arm.t[i].toFixed(3) + ' s'], ['force', arm.force[i].toFixed(2) + ' N'],
                  ['depth', (1e3 * arm.depth[i]).toFixed(2) + ' mm'],
                  ['touches', object ? object.name : 'nothing']];
  if (box.children.length !== 2 * values.length) {
    box.textContent = '';
    for (const [name] of values) {
      textIn(box, 'dt', name);
      textIn(box, 'dd', '');
    }
  }
  values.forEach(([, value], k) => { box.children[2 * k + 1].textContent = value; });
}
