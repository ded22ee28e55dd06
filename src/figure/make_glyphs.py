#!/usr/bin/env python3
"""make_glyphs.py FONT.ttf > glyphs.inc: outlines of the characters that figures may hold, as rows of a C table.

A row is {character, advance, path}: units of 1/2048 em, y up from the baseline; the path has SVG's relative commands m, l, h,
v and q (quadratic curves), every contour closed. Contours keep TrueType's sense: filled by the non-zero rule.
"""
import struct
import sys

CHARACTERS = (
    [(0x20, 0x7E), (0xA0, 0x17F), (0x192, 0x192), (0x391, 0x3C9), (0x3D1, 0x3D1), (0x3D5, 0x3D5), (0x401, 0x401)]
    + [(0x410, 0x44F), (0x451, 0x451), (0x2010, 0x2015), (0x2018, 0x201E), (0x2020, 0x2022), (0x2026, 0x2026)]
    + [(0x2030, 0x2030), (0x2032, 0x2033), (0x2070, 0x2071), (0x2074, 0x208E), (0x20AC, 0x20AC), (0x2103, 0x2103)]
    + [(0x210F, 0x210F), (0x2113, 0x2113), (0x2126, 0x2126), (0x212B, 0x212B), (0x2190, 0x2195), (0x2202, 0x2202)]
    + [(0x2206, 0x2207), (0x220F, 0x220F), (0x2211, 0x2213), (0x2215, 0x2215), (0x2218, 0x221A), (0x221D, 0x221E)]
    + [(0x2225, 0x2225), (0x222B, 0x222B), (0x223C, 0x223C), (0x2248, 0x2248), (0x2260, 0x2261), (0x2264, 0x2265)]
    + [(0x2299, 0x2299), (0x22A5, 0x22A5), (0x22C5, 0x22C5), (0xFFFD, 0xFFFD)]
)


class Font:
    def __init__(self, path):
        self.data = open(path, "rb").read()
        self.table = {}
        for i in range(struct.unpack_from(">H", self.data, 4)[0]):
            tag, _, offset, _ = struct.unpack_from(">4sLLL", self.data, 12 + 16 * i)
            self.table[tag.decode()] = offset
        head = self.table["head"]
        assert struct.unpack_from(">H", self.data, head + 18)[0] == 2048, "units of 1/2048 em are meant"
        self.long = struct.unpack_from(">h", self.data, head + 50)[0]
        self.metrics = struct.unpack_from(">H", self.data, self.table["hhea"] + 34)[0]
        self.map = self.characters()

    def characters(self):
        cmap = self.table["cmap"]
        for i in range(struct.unpack_from(">H", self.data, cmap + 2)[0]):
            at = cmap + struct.unpack_from(">L", self.data, cmap + 8 + 8 * i)[0]
            if struct.unpack_from(">H", self.data, at)[0] == 12:
                n = struct.unpack_from(">L", self.data, at + 12)[0]
                found = {}
                for g in range(n):
                    first, last, glyph = struct.unpack_from(">LLL", self.data, at + 16 + 12 * g)
                    found.update((c, glyph + c - first) for c in range(first, last + 1))
                return found
        sys.exit("the font has no character map of format 12")

    def advance(self, glyph):
        return struct.unpack_from(">H", self.data, self.table["hmtx"] + 4 * min(glyph, self.metrics - 1))[0]

    def contours(self, glyph):
        """Lists of (x, y, on the curve)."""
        loca, size = self.table["loca"], 4 if self.long else 2
        start, end = struct.unpack_from(">LL" if self.long else ">HH", self.data, loca + size * glyph)
        if start == end:
            return []
        at = self.table["glyf"] + (start if self.long else 2 * start)
        n = struct.unpack_from(">h", self.data, at)[0]
        return self.simple(at + 10, n) if n >= 0 else self.composite(at + 10)

    def composite(self, at):
        out, more = [], True
        while more:
            flags, glyph = struct.unpack_from(">HH", self.data, at)
            assert flags & 2, "parts are placed by offsets"
            dx, dy = struct.unpack_from(">hh" if flags & 1 else ">bb", self.data, at + 4)
            at += 8 if flags & 1 else 6
            a, b, c, d = 1, 0, 0, 1
            if flags & 8:
                a = d = struct.unpack_from(">h", self.data, at)[0] / 16384
                at += 2
            elif flags & 0x40:
                a, d = (v / 16384 for v in struct.unpack_from(">hh", self.data, at))
                at += 4
            elif flags & 0x80:
                a, b, c, d = (v / 16384 for v in struct.unpack_from(">hhhh", self.data, at))
                at += 8
            for contour in self.contours(glyph):
                moved = [(round(a * x + c * y) + dx, round(b * x + d * y) + dy, on) for x, y, on in contour]
                out.append(moved if a * d - b * c > 0 else moved[::-1])
            more = flags & 0x20
        return out

    def simple(self, at, n):
        ends = struct.unpack_from(">%dH" % n, self.data, at)
        at += 2 * n
        at += 2 + struct.unpack_from(">H", self.data, at)[0]
        count, flags = ends[-1] + 1 if n else 0, []
        while len(flags) < count:
            flag, at = self.data[at], at + 1
            flags.append(flag)
            if flag & 8:
                flags += [flag] * self.data[at]
                at += 1
        axes = []
        for short, same in ((2, 16), (4, 32)):
            value, values = 0, []
            for flag in flags:
                if flag & short:
                    value += self.data[at] if flag & same else -self.data[at]
                    at += 1
                elif not flag & same:
                    value += struct.unpack_from(">h", self.data, at)[0]
                    at += 2
                values.append(value)
            axes.append(values)
        points = [(x, y, flag & 1) for x, y, flag in zip(axes[0], axes[1], flags)]
        return [points[a:b + 1] for a, b in zip((0,) + tuple(e + 1 for e in ends[:-1]), ends)]


def path(contours):
    out, px, py = [], 0, 0
    for contour in contours:
        full = []  # with the points on the curve that TrueType leaves out
        for i, (x, y, on) in enumerate(contour):
            bx, by, before = contour[i - 1]
            if not on and not before:
                full.append(((bx + x) // 2, (by + y) // 2, 1))
            full.append((x, y, on))
        first = next(i for i, p in enumerate(full) if p[2])
        full = full[first:] + full[:first + 1]
        out.append("m%d %d" % (full[0][0] - px, full[0][1] - py))
        px, py = full[0][:2]
        control = None
        for x, y, on in full[1:]:
            if not on:
                control = (x, y)
                continue
            if control:
                out.append("q%d %d %d %d" % (control[0] - px, control[1] - py, x - px, y - py))
            elif x == px and y != py:
                out.append("v%d" % (y - py))
            elif y == py and x != px:
                out.append("h%d" % (x - px))
            elif x != px:
                out.append("l%d %d" % (x - px, y - py))
            px, py, control = x, y, None
    return "".join(out).replace(" -", "-")


def main():
    font = Font(sys.argv[1])
    print("""/* glyphs.inc: outlines of the letters of figures, made by make_glyphs.py from DejaVu Sans 2.37, one row each:
 * character, advance, path (SVG's relative commands), in units of 1/2048 em, y up from the baseline; by character.
 *
 * The outlines are under the licence of the Bitstream Vera fonts (NOTICE has its text):
 * Copyright (c) 2003 by Bitstream, Inc. All Rights Reserved. Bitstream Vera is a trademark of Bitstream, Inc.
 * DejaVu changes are in public domain. */""")
    for lo, hi in CHARACTERS:
        for c in range(lo, hi + 1):
            if c in font.map:
                glyph = font.map[c]
                print('{0x%04x, %d, "%s"},' % (c, font.advance(glyph), path(font.contours(glyph))))


main()
