#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the scaling series: plotScaling.py FIGURES.json PLOT.svg

FIGURES.json is what osd_shading_moving_perf writes with --json. Needs nothing but Python's standard library.
"""
import json
import math
import sys

WIDTH, HEIGHT = 720, 420
LEFT, RIGHT, TOP, BOTTOM = 64, 196, 44, 52
# Colours that differ in lightness too.
SERIES = [
    ("openSubdiv", "OpenSubdiv: P, du, dv", "#b2182b", ""),
    ("shaded", "shaded: P, N_B", "#2166ac", ""),
    ("shadedTwoThreads", "shaded, two threads", "#67a9cf", "6 3"),
    ("limitNormals", "P, N_L", "#1b7837", "2 3"),
]


class LogScale:
    """Maps powers of ten from [low, high] to [start, end]."""

    def __init__(self, low, high, start, end):
        self.low, self.high = math.log10(low), math.log10(high)
        self.start, self.end = start, end

    def __call__(self, value):
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)


def points_of(series, key):
    return [(f["values"], 1e9 * f[key] / f["values"]) for f in series if f[key] > 0]


def bounds(values, steps):
    """The steps of the decades just outside the values."""
    ticks = [s * 10.0**e for e in range(-3, 12) for s in steps]
    return max(t for t in ticks if t <= min(values)), min(t for t in ticks if t >= max(values))


def number(value):
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:g}{letter}"
    return f"{value:g}"


def draw(series):
    lines = [(name, colour, dash, points_of(series, key)) for key, name, colour, dash in SERIES]
    lines = [line for line in lines if line[3]]
    x_low, x_high = bounds([x for line in lines for x, _ in line[3]], (1, 3))
    y_low, y_high = bounds([y for line in lines for _, y in line[3]], (1, 2, 5))
    x = LogScale(x_low, x_high, LEFT, WIDTH - RIGHT)
    y = LogScale(y_low, y_high, HEIGHT - BOTTOM, TOP)

    svg = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}"'
        ' font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<text x="{LEFT}" y="24" font-size="14">Nanoseconds per vertex of a frame</text>',
        f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 12}" text-anchor="middle">'
        "vertices at level 4 (logarithmic scales)</text>",
    ]
    for step in (s * 10.0**e for e in range(-3, 12) for s in (1, 2, 5)):
        if y_low <= step <= y_high:
            at = y(step)
            svg.append(f'<path d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
            svg.append(f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{step:g}</text>')
    for step in (s * 10.0**e for e in range(0, 12) for s in (1, 3)):
        if x_low <= step <= x_high:
            at = x(step)
            svg.append(f'<path d="M{at:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>')
            svg.append(f'<text x="{at:.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{number(step)}</text>')

    # The names stand where their lines end, in the same order, far enough apart to be read.
    last = math.inf
    for name, colour, dash, points in sorted(lines, key=lambda line: line[3][-1][1]):
        path = "L".join(f"{x(a):.1f} {y(b):.1f}" for a, b in points)
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        svg.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2"{dashes}/>')
        svg += [f'<circle cx="{x(a):.1f}" cy="{y(b):.1f}" r="3" fill="{colour}"/>' for a, b in points]
        end = points[-1]
        label = min(y(end[1]) + 4, last - 16)
        last = label
        svg.append(f'<text x="{WIDTH - RIGHT + 10}" y="{label:.1f}" fill="{colour}">{name}, {end[1]:.2g} ns</text>')
    svg.append("</svg>")
    return "\n".join(svg) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        series = json.load(file)["scalingSeries"]
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(draw(series))


if __name__ == "__main__":
    main()
