"""Writes a picture with one part removed, to test that picture_near.py detects the difference.

  picture_without.py PICTURE.png LEFT TOP WIDTH HEIGHT OUT.png

The part gets the colour of its upper left corner. The formats are those of picture_near.py.
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
