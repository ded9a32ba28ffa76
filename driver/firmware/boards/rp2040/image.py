#!/usr/bin/env python3
"""Writes the checksum of the RP2040's second stage into a binary image, and the image as UF2 for its USB drive.

    image.py IMAGE.bin IMAGE.uf2

The ROM runs the second stage only with the CRC-32 of its first 252 bytes in the last 4 (RP2040 datasheet, 2.8.1.3.1;
polynomial 0x04c11db7, initial value 0xffffffff, not reflected, no final XOR). UF2: microsoft/uf2, README.md.
"""

import struct
import sys


def crc32(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte << 24
        for _ in range(8):
            crc = (crc << 1 ^ (0x04C11DB7 if crc & 0x80000000 else 0)) & 0xFFFFFFFF
    return crc


def uf2(image, address, family):
    blocks = (len(image) + 255) // 256
    for number in range(blocks):
        part = image[256 * number:256 * number + 256].ljust(256, b"\0")
        head = struct.pack("<8I", 0x0A324655, 0x9E5D5157, 0x2000, address + 256 * number, 256, number, blocks, family)
        yield head + part.ljust(476, b"\0") + struct.pack("<I", 0x0AB16F30)


if len(sys.argv) != 3:
    sys.exit(__doc__)
with open(sys.argv[1], "r+b") as file:
    image = bytearray(file.read())
    image[252:256] = struct.pack("<I", crc32(image[:252]))
    file.seek(0)
    file.write(image)
with open(sys.argv[2], "wb") as file:
    file.write(b"".join(uf2(bytes(image), 0x10000000, 0xE48BFF56)))
