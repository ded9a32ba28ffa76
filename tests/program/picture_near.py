"""Compares two small pictures: PNG files as Chromium writes them, 8 bit, RGB or RGBA.

  picture_near.py KEPT.png NEW.png

Software rendering differs slightly between versions at the edges of triangles and letters; in pictures scaled to one
eighth this difference is small. A moved or missing object makes a large difference in some places.
"""
import struct
import sys
import zlib

MEAN_MAX = 2.5  # of 255, mean over all pixels; edges of another version: below 1
OFF = 40  # of 255: a pixel that differs
OFF_SHARE_MAX = 0.01  # of all pixels


def pixels(path):
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path + " is not a PNG"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert depth == 8 and colour in (2, 6), path + " is neither RGB nor RGBA"
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    size = 3 if colour == 2 else 4
    raw = zlib.decompress(packed)
    rows, before = [], bytearray(width * size)
    for y in range(height):
        begin = y * (width * size + 1)
        how, row = raw[begin], bytearray(raw[begin + 1:begin + 1 + width * size])
        for x in range(width * size):
            left = row[x - size] if x >= size else 0
            up, corner = before[x], before[x - size] if x >= size else 0
            if how == 1:
                add = left
            elif how == 2:
                add = up
            elif how == 3:
                add = (left + up) // 2
            elif how == 4:
                add = min((left, up, corner), key=lambda one: abs(left + up - corner - one))
            else:
                add = 0
            row[x] = (row[x] + add) & 255
        rows.append([tuple(row[size * x:size * x + 3]) for x in range(width)])
        before = row
    return rows


def main():
    kept, new = (pixels(path) for path in sys.argv[1:])
    if [len(kept), len(kept[0])] != [len(new), len(new[0])]:
        print("the sizes differ")
        return 1
    apart = [max(abs(a - b) for a, b in zip(one, other)) for row, others in zip(kept, new)
             for one, other in zip(row, others)]
    mean = sum(apart) / len(apart)
    off = sum(one > OFF for one in apart) / len(apart)
    near = mean <= MEAN_MAX and off <= OFF_SHARE_MAX
    print(f"{'the same' if near else 'another picture'}: {mean:.2f} of 255 apart on the whole, {100 * off:.2f} % of it off")
    return 0 if near else 1


if __name__ == "__main__":
    sys.exit(main())
