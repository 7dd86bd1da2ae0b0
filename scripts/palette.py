#!/usr/bin/env python3
"""scripts/palette.py FILE.png...

Rewrites pictures of the documentation with a palette of 256 colours, by median cuts: a half to a fifth of the
bytes. Reads them through oiiotool.
"""
import os
import struct
import subprocess
import sys
import tempfile
import zlib
from collections import Counter


def pixels_of(path):
    """Width, height and the colours of all pixels, row by row from above."""
    with tempfile.TemporaryDirectory() as folder:
        plain = os.path.join(folder, "plain.ppm")
        subprocess.run(["oiiotool", path, "--ch", "R,G,B", "-d", "uint8", "-o", plain], check=True)
        with open(plain, "rb") as file:
            data = file.read()
    magic, width, height, _, rest = header_of(data)
    if magic != b"P6":
        raise SystemExit(f"{path}: oiiotool made no plain picture of it")
    return width, height, list(zip(rest[0::3], rest[1::3], rest[2::3]))


def header_of(data):
    """The words of a PPM file's header, and what follows."""
    words = []
    at = 0
    while len(words) < 4:
        while data[at:at + 1].isspace():
            at += 1
        if data[at:at + 1] == b"#":
            at = data.index(b"\n", at)
            continue
        end = at
        while not data[end:end + 1].isspace():
            end += 1
        words.append(data[at:end])
        at = end
    return words[0], int(words[1]), int(words[2]), int(words[3]), data[at + 1:]


def palette_of(counts, most=256):
    """At most so many groups of colours: the group with the largest spread is cut at its median."""
    def spread(group):
        return max((max(c[i] for c in group) - min(c[i] for c in group), i) for i in range(3))

    groups = [(spread(list(counts)), list(counts))]
    while len(groups) < most:
        # What many pixels have counts for more, by the root.
        at = max(range(len(groups)),
                 key=lambda g: groups[g][0][0] * sum(counts[c] for c in groups[g][1]) ** 0.5)
        (width, axis), group = groups.pop(at)
        if width == 0:
            groups.append(((0, 0), group))
            break
        group.sort(key=lambda c: c[axis])
        half = sum(counts[c] for c in group) / 2
        passed = 0
        cut = 0
        for cut, colour in enumerate(group):
            passed += counts[colour]
            if passed >= half:
                break
        cut = min(max(cut + (cut == 0), 1), len(group) - 1)
        groups += [(spread(part), part) for part in (group[:cut], group[cut:])]
    palette = []
    index = {}
    for _, group in groups:
        weight = sum(counts[c] for c in group)
        for colour in group:
            index[colour] = len(palette)
        palette.append(tuple(round(sum(c[i] * counts[c] for c in group) / weight) for i in range(3)))
    return palette, index


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def rewrite(path):
    width, height, pixels = pixels_of(path)
    palette, index = palette_of(Counter(pixels))
    places = bytes(map(index.__getitem__, pixels))
    rows = b"".join(b"\0" + places[y * width:(y + 1) * width] for y in range(height))
    before = os.path.getsize(path)
    with open(path + ".part", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        file.write(chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)))
        file.write(chunk(b"PLTE", b"".join(bytes(c) for c in palette)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)))
        file.write(chunk(b"IEND", b""))
    os.replace(path + ".part", path)
    print(f"{path}: {before} bytes, now {os.path.getsize(path)}")


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
    for name in sys.argv[1:]:
        if not name.startswith("-"):
            rewrite(name)
