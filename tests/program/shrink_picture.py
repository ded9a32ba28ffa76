"""Scales a picture down for picture_near.py: each pixel is the mean of a square of the larger picture.

  shrink_picture.py LARGE.png SMALL.png TIMES [LEFT TOP WIDTH HEIGHT]

TIMES: scale factor, a whole number. LEFT TOP WIDTH HEIGHT: part of the larger picture, pixels (default: all)
"""
import struct
import sys
import zlib

from picture_near import pixels


def main():
    large, small, times = pixels(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    if len(sys.argv) > 4:
        left, top, wide, high = map(int, sys.argv[4:])
        large = [row[left:left + wide] for row in large[top:top + high]]
    height, width = len(large) // times, len(large[0]) // times
    raw = bytearray()
    for y in range(height):
        raw.append(0)  # no filter
        for x in range(width):
            square = [large[times * y + j][times * x + i] for j in range(times) for i in range(times)]
            raw.extend(sum(one[c] for one in square) // len(square) for c in range(3))

    def part(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(small, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + part(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   part(b"IDAT", zlib.compress(bytes(raw), 9)) + part(b"IEND", b""))


main()
