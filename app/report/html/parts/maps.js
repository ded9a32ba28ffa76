// Colour of a value of a map, from 0 to 1: a tint of the object's colour, light to dark, as in the viewer.
function mapColour(i, share) {
  const own = parseInt(objectColour(i).slice(1), 16);
  return [16, 8, 0].map(shift => {
    const one = ((own >> shift) & 255) / 255;
    const light = one + 0.55 * (1 - one), dark = 0.35 * one;
    return share < 0.5 ? light + 2 * share * (one - light) : one + (2 * share - 1) * (dark - one);
  });
}

// Returns a mesh of separate corners (meshGeometry), with each side of a triangle divided into `parts`, and with the
// colours of the values of its points: (i, k) at a + i / parts (b - a) + k / parts (c - a), by i, then by k.
function mappedGeometry(geometry, values, parts, object) {
  const triangles = geometry.attributes.position.count / 3;
  const points = (parts + 1) * (parts + 2) / 2;
  const place = (i, k) => i * (2 * parts + 3 - i) / 2 + k;
  const corners = [];
  for (let t = 0; t < triangles; ++t) {
    for (let i = 0; i < parts; ++i) {
      for (let k = 0; i + k < parts; ++k) {
        const [a, b, c] = [place(i, k), place(i + 1, k), place(i, k + 1)].map(one => t * points + one);
        corners.push(a, b, c);
        if (i + k + 1 < parts) corners.push(b, t * points + place(i + 1, k + 1), c);
      }
    }
  }
  const mapped = new THREE.BufferGeometry();
  for (const name of ['position', 'normal']) {
    const from = geometry.attributes[name].array;
    const to = new Float32Array(3 * triangles * points);
    let at = 0;
    for (let t = 0; t < triangles; ++t) {
      for (let i = 0; i <= parts; ++i) {
        for (let k = 0; i + k <= parts; ++k) {
          for (let d = 9 * t; d < 9 * t + 3; ++d) {
            to[at++] = from[d] + i / parts * (from[d + 3] - from[d]) + k / parts * (from[d + 6] - from[d]);
          }
        }
      }
    }
    mapped.setAttribute(name, new THREE.BufferAttribute(to, 3));
  }
  const tints = Array.from({length: 256}, (_, value) => mapColour(object, value / 255));
  const colours = new Float32Array(3 * values.length);
  values.forEach((value, i) => colours.set(tints[value], 3 * i));
  mapped.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  mapped.setIndex(corners);
  return mapped;
}

// Adds the range of the map of each object to the scene's legend.
function showMapScales(box) {
  about.objects.forEach((object, i) => {
    if (!object.map) return;
    const text = words => {
      const span = document.createElement('span');
      span.textContent = words;
      return span;
    };
    const bar = document.createElement('canvas');
    bar.width = 160;
    bar.height = 8;
    const pen = bar.getContext('2d');
    for (let x = 0; x < 160; ++x) {
      pen.fillStyle = 'rgb(' + mapColour(i, x / 159).map(one => Math.round(255 * one)).join(',') + ')';
      pen.fillRect(x, 0, 1, 8);
    }
    const {quantity, unit, min, max} = object.map;
    const scale = document.createElement('div');
    scale.className = 'scale';
    scale.append(text(object.name + ': ' + quantity), bar, text(+min.toPrecision(4)),
                 text(+max.toPrecision(4) + (unit ? ' ' + unit : '')));
    box.append(scale);
  });
}
