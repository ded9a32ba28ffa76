// Colours are names of variables in page.css. Plots of one arm over time, all with the same window; a click moves the player to that time.
const kPlots = [
  {title: 'Force', unit: 'N', channels: [
    {name: about.replayed ? 'replayed' : 'requested', colour: 'requested', on: true, of: (arm, i) => arm.asked[i]},
    {name: about.replayed ? 'recorded' : 'sent', colour: 'force', on: true, of: (arm, i) => arm.force[i]}]},
  {title: 'Depth', unit: 'mm', channels: [
    {name: 'depth', colour: 'depth', on: true, of: (arm, i) => 1e3 * arm.depth[i]}]},
  {title: 'Tick', unit: 'ms', channels: [
    {name: 'period', colour: 'period', on: true, of: (arm, i) => 1e3 * arm.period[i]},
    {name: 'computing', colour: 'computing', on: !about.virtual && !about.replayed, of: (arm, i) => 1e3 * arm.work[i]}]},
  {title: 'Speed', unit: 'mm/s', channels: [
    {name: 'speed', colour: 'speed', on: false, of: (arm, i) => 1e3 * arm.speed[i]}]}];

// Returns the rows to draw between two times: as many as a screen shows, with every minimum and maximum. The first
// and the last row of all are included, so that the axis has its full range.
function rowsToDraw(arm, channels, begin, end) {
  const kMax = 1500;
  const rows = arm.t.length;
  const first = Math.max(0, placeOf(arm.t, begin) - 1);
  const last = Math.min(rows - 1, placeOf(arm.t, end) + 1);
  const picked = new Set([0, first, last, rows - 1]);
  const stride = Math.max(1, (last - first) / kMax);
  for (let bucket = first; bucket < last; bucket += stride) {
    const [from, to] = [Math.floor(bucket), Math.min(last, Math.floor(bucket + stride))];
    for (const channel of channels) {
      let [low, high] = [from, from];
      for (let i = from + 1; i < to; ++i) {
        const value = channel.of(arm, i);
        if (value < channel.of(arm, low)) low = i;
        if (value > channel.of(arm, high)) high = i;
      }
      picked.add(low).add(high);
    }
  }
  return [...picked].sort((a, b) => a - b);
}

function makePlots(box, player) {
  const plots = {window: [span.begin, span.end], graphs: []};
  const channelBox = document.getElementById('channels');
  let setting = false;

  const colours = plot => ({colors: plot.channels.map(channel => theme.colour(channel.colour)),
                            axisLineColor: theme.colour('axis'), gridLineColor: theme.colour('grid-line')});
  plots.recolour = () => plots.graphs.forEach(graph => graph.dygraph.updateOptions(colours(graph.plot)));
  // Returns the left and the right end of the time axis on the screen.
  plots.extent = () => {
    const graph = plots.graphs.find(one => !one.box.hidden);
    if (!graph) return null;
    const area = graph.dygraph.getArea();
    const left = graph.inner.getBoundingClientRect().left + area.x;
    return [left, left + area.w];
  };
  const dataOf = graph => {
    const arm = arms[player.arm];
    const channels = graph.plot.channels;
    if (arm.t.length === 0) return [[0, ...channels.map(() => 0)]];
    return rowsToDraw(arm, channels, plots.window[0], plots.window[1])
        .map(i => [arm.t[i], ...channels.map(channel => channel.of(arm, i))]);
  };
  // Draws contact as background, and events as lines.
  const underlay = (canvas, area, dygraph) => {
    const arm = arms[player.arm];
    canvas.fillStyle = theme.colour('contact');
    for (const [begin, end] of player.contacts()) {
      const [a, b] = [dygraph.toDomXCoord(begin), dygraph.toDomXCoord(end)];
      if (b >= area.x && a <= area.x + area.w) canvas.fillRect(a, area.y, Math.max(1, b - a), area.h);
    }
    for (const mark of arm.marks) {
      const x = dygraph.toDomXCoord(mark.begin);
      if (x < area.x || x > area.x + area.w) continue;
      canvas.fillStyle = markColour(mark.kind);
      const width = mark.kind === 'fault' ? 2 : 1;
      canvas.globalAlpha = mark.kind === 'fault' ? 1 : 0.55;
      canvas.fillRect(x, area.y, width, area.h);
      canvas.globalAlpha = 1;
    }
  };
  plots.setWindow = (begin, end) => {
    plots.window = [Math.max(span.begin, begin), Math.min(span.end, end)];
    setting = true;
    for (const graph of plots.graphs) {
      if (!graph.box.hidden) graph.dygraph.updateOptions({file: dataOf(graph), dateWindow: plots.window.slice()});
    }
    setting = false;
    plots.cursor(player.t);
    player.windowChanged(plots.window);
  };
  plots.refresh = () => plots.setWindow(plots.window[0], plots.window[1]);

  for (const plot of kPlots) {
    const outer = document.createElement('div');
    outer.className = 'plot';
    const head = document.createElement('h3');
    const inner = document.createElement('div');
    inner.className = 'graph';
    const cursor = document.createElement('div');
    cursor.className = 'cursor';
    outer.append(head, inner);
    box.append(outer);
    const graph = {plot, box: outer, inner, head, cursor, hovered: null};
    graph.dygraph = new Dygraph(inner, dataOf(graph), {
      labels: ['t', ...plot.channels.map(channel => channel.name)],
      visibility: plot.channels.map(channel => channel.on),
      dateWindow: plots.window.slice(),
      ...colours(plot),
      legend: 'never',
      includeZero: true,
      strokeWidth: 1.3,
      highlightCircleSize: 2,
      axes: {y: {axisLabelWidth: 44, pixelsPerLabel: 20},
             x: {axisLabelFormatter: t => +t.toFixed(4) + ' s'}},
      underlayCallback: underlay,
      clickCallback: (event, t) => player.seek(t),
      highlightCallback: (event, t) => { graph.hovered = t; plots.showValues(graph); },
      unhighlightCallback: () => { graph.hovered = null; plots.showValues(graph); },
      zoomCallback: (begin, end) => plots.setWindow(begin, end),
      drawCallback: dygraph => {
        const [begin, end] = dygraph.xAxisRange();
        const moved = Math.abs(begin - plots.window[0]) + Math.abs(end - plots.window[1]);
        if (!setting && plots.graphs.length === kPlots.length && moved > 1e-6) plots.setWindow(begin, end);
      }});
    inner.append(cursor);
    plots.graphs.push(graph);
    plot.channels.forEach((channel, k) => {
      const label = document.createElement('label');
      const check = document.createElement('input');
      check.type = 'checkbox';
      check.checked = channel.on;
      check.dataset.channel = channel.name;
      const line = document.createElement('i');
      line.style.background = 'var(--' + channel.colour + ')';
      const name = plot.channels.length > 1 ? plot.title + ' ' + channel.name : plot.title;
      label.append(check, line, name);
      channelBox.append(label);
      check.addEventListener('change', () => {
        channel.on = check.checked;
        graph.dygraph.setVisibility(k, channel.on);
        plots.layOut();
      });
    });
  }

  plots.layOut = () => {
    setting = true;
    const shown = plots.graphs.filter(graph => {
      graph.box.hidden = !graph.plot.channels.some(channel => channel.on);
      return !graph.box.hidden;
    });
    shown.forEach((graph, k) => {
      const last = k + 1 === shown.length;  // only the last plot has a time axis
      graph.box.classList.toggle('last', last);
      graph.dygraph.updateOptions({axes: {x: {drawAxis: last}}}, true);
      graph.dygraph.resize();
    });
    setting = false;
    plots.refresh();
  };
  // Shows the values under the mouse, or at the player's time.
  plots.showValues = graph => {
    const arm = arms[player.arm];
    if (arm.t.length === 0) return;
    const i = placeOf(arm.t, graph.hovered === null ? player.t : graph.hovered);
    const values = graph.plot.channels.filter(channel => channel.on)
        .map(channel => channel.name + ' <b>' + channel.of(arm, i).toPrecision(4) + '</b> ' + graph.plot.unit);
    graph.head.innerHTML = graph.plot.title + ' at ' + arm.t[i].toFixed(3) + ' s: ' + values.join(', ');
  };
  plots.cursor = t => {
    for (const graph of plots.graphs) {
      if (graph.box.hidden) continue;
      const inside = t >= plots.window[0] - 1e-9 && t <= plots.window[1] + 1e-9;
      graph.cursor.hidden = !inside;
      if (inside) graph.cursor.style.left = graph.dygraph.toDomXCoord(t) + 'px';
      if (graph.hovered === null) plots.showValues(graph);
    }
  };
  return plots;
}
