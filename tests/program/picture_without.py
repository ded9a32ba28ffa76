"""Writes a picture without one part of it, to see that picture_near.py tells them apart.

  picture_without.py PICTURE.png LEFT TOP WIDTH HEIGHT OUT.png

The part gets the colour of its upper left corner. PNG files as picture_near.py reads them.
"""
import struct
import sys
import zlib

import picture_near


def main():
    rows = picture_near.pixels(sys.argv[1])
    left, top, width, height = (int(one) for one in sys.argv[2:6])
    for row in rows[top:top + height]:
        row[left:left + width] = [rows[top][left]] * len(row[left:left + width])
    raw = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in rows)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(sys.argv[6], "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    sys.exit(main())
