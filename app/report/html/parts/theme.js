'use strict';

// Light or dark. All colours are variables of page.css, so that style and canvases agree.
const theme = (() => {
  const root = document.documentElement;
  const button = document.getElementById('theme');
  const system = matchMedia('(prefers-color-scheme: dark)');
  const listeners = [];
  const colours = new Map();  // values that were read already
  let chosen = null;
  try { chosen = localStorage.getItem('thimble-theme'); } catch { /* a page without storage */ }
  const one = {};

  function show(name) {
    root.dataset.theme = name;
    one.dark = name === 'dark';
    colours.clear();
    button.title = one.dark ? 'Light colours' : 'Dark colours';
    button.setAttribute('aria-label', button.title);
    for (const listener of listeners) listener();
  }
  // Returns the value of a variable of page.css, without its two hyphens.
  one.colour = name => {
    if (!colours.has(name)) colours.set(name, getComputedStyle(root).getPropertyValue('--' + name).trim());
    return colours.get(name);
  };
  one.onChange = listener => listeners.push(listener);
  // Chooses the theme for this and later visits.
  one.choose = name => {
    chosen = name;
    try { localStorage.setItem('thimble-theme', name); } catch { /* a page without storage */ }
    show(name);
  };
  button.addEventListener('click', () => one.choose(one.dark ? 'light' : 'dark'));
  system.addEventListener('change', () => { if (!chosen) show(system.matches ? 'dark' : 'light'); });
  show(root.dataset.theme);
  return one;
})();
