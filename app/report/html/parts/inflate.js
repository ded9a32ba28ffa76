// Decompresses data in the zlib format (RFC 1950), which holds deflate blocks (RFC 1951); `size`: of the result.
function inflate(bytes, size) {
  const out = new Uint8Array(size);
  let [at, to, bits, held] = [2, 0, 0, 0];  // the header has two bytes
  const fill = count => {
    while (held < count) {
      bits |= (at < bytes.length ? bytes[at] : 0) << held;
      ++at;
      held += 8;
    }
  };
  const take = count => {
    fill(count);
    const value = bits & ((1 << count) - 1);
    bits >>>= count;
    held -= count;
    return value;
  };
  // Table of a Huffman code, indexed by the next bits: a symbol and the length of its code (RFC 1951, 3.2.2).
  const tableOf = lengths => {
    const counts = new Uint16Array(16);
    for (const length of lengths) if (length > 0) ++counts[length];
    const next = new Uint16Array(17);
    for (let length = 1; length < 16; ++length) next[length + 1] = (next[length] + counts[length]) << 1;
    const table = new Uint16Array(1 << Math.max(1, ...lengths));
    lengths.forEach((length, symbol) => {
      if (length === 0) return;
      let [code, reversed] = [next[length]++, 0];
      for (let k = 0; k < length; ++k, code >>= 1) reversed = reversed << 1 | code & 1;
      for (let i = reversed; i < table.length; i += 1 << length) table[i] = symbol << 4 | length;
    });
    return table;
  };
  const symbolOf = table => {
    fill(15);
    const entry = table[bits & (table.length - 1)];
    bits >>>= entry & 15;
    held -= entry & 15;
    return entry >> 4;
  };
  // Lengths and distances (3.2.5): the first of each symbol, and its number of extra bits.
  const extraOf = (first, extra) => extra.map(bitCount => {
    const own = [first, bitCount];
    first += 1 << bitCount;
    return own;
  });
  const lengthsOf = extraOf(3, [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5]).concat([[258, 0]]);
  const distancesOf = extraOf(1, [0, 0, 0, 0, ...Array.from({length: 26}, (_, i) => 1 + (i >> 1))]);

  // Reads the codes of a block with its own codes (3.2.7).
  const readCodes = () => {
    const [literals, distances, codes] = [take(5) + 257, take(5) + 1, take(4) + 4];
    const lengths = new Array(19).fill(0);
    for (const place of [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15].slice(0, codes)) lengths[place] = take(3);
    const table = tableOf(lengths);
    const all = [];
    while (all.length < literals + distances) {
      const symbol = symbolOf(table);
      if (symbol < 16) all.push(symbol);
      else if (symbol === 16) for (let again = 3 + take(2), last = all[all.length - 1]; again > 0; --again) all.push(last);
      else for (let zeros = symbol === 17 ? 3 + take(3) : 11 + take(7); zeros > 0; --zeros) all.push(0);
    }
    return [tableOf(all.slice(0, literals)), tableOf(all.slice(literals, literals + distances))];
  };
  const fixedCodes = () => [tableOf(Array.from({length: 288}, (_, i) => (i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8))), tableOf(new Array(30).fill(5))];

  for (let last = false; !last;) {
    if (at > bytes.length + 4) throw new Error('The numbers of this page are damaged.');
    last = take(1) === 1;
    const kind = take(2);
    if (kind === 0) {
      take(held & 7);
      for (let count = take(16), skipped = take(16); count > 0; --count) out[to++] = take(8);
      continue;
    }
    const [literals, distances] = kind === 1 ? fixedCodes() : readCodes();
    for (let symbol = symbolOf(literals); symbol !== 256; symbol = symbolOf(literals)) {
      if (symbol < 256) {
        out[to++] = symbol;
      } else {
        const [length, extra] = lengthsOf[symbol - 257];
        const end = to + length + take(extra);
        const [distance, more] = distancesOf[symbolOf(distances)];
        let from = to - distance - take(more);
        while (to < end) out[to++] = out[from++];
      }
      if (to > size) throw new Error('The numbers of this page are damaged.');
    }
  }
  if (to !== size) throw new Error('The numbers of this page are damaged.');
  return out;
}
