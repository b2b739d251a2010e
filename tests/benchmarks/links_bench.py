# SPDX-License-Identifier: GPL-3.0-or-later
"""How hierarchical radiosity's links grow with the size of the problem, at the same error throughout.

A furnished room whose walls, furniture and lamp are cut into ever more quads, from 10³ on: each is an element that
a matrix would have a row for. The figure is the slope of log links over log quads, by least squares; a matrix's is 2.
Leaves a drawing, links.svg, in the build's bench folder or where --svg says.
"""

import json
import math
import subprocess
from pathlib import Path

import numpy as np
from figures import arguments, figure
from room import room, write_glb

EMISSION = 10  # of the lamp; all else follows
TOLERANCE = 0.02  # W/m²: three hundredths of the mean radiosity
WIDTH, HEIGHT, MARGIN = 480, 360, 56  # of the drawing, pixels


def solve(program, folder, fineness, threads):
    """Quads, and what solving said it cost."""
    dark, lamp = room(fineness)
    write_glb(folder / "links.glb", [(dark, 0), (lamp, EMISSION)])
    command = [
        str(program),
        "radiosity",
        "links.glb",
        "--quiet",
        "--stats",
        "links.json",
        "--set",
        f"threads={threads}",
        "--set",
        f"radiosity.tolerance={TOLERANCE}",
    ]
    subprocess.run(command, cwd=folder, check=True)
    return len(dark) + len(lamp), json.loads((folder / "links.json").read_text(encoding="utf-8"))


def slope(x, y):
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def drawing(points, growth):
    """Links over quads, both by powers of ten, with the lines of n and n² through the first point."""
    low_x, high_x = 10**2.7, 10**6.3
    low_y = 10 ** math.floor(math.log10(points[0][1]))
    high_y = low_y * (high_x / low_x) ** (4.5 / 3.6)

    def place(x, y):
        across = math.log(x / low_x) / math.log(high_x / low_x)
        up = math.log(y / low_y) / math.log(high_y / low_y)
        return MARGIN + across * (WIDTH - MARGIN - 12), HEIGHT - MARGIN - up * (HEIGHT - MARGIN - 12)

    def line(ends, style):
        (x1, y1), (x2, y2) = (place(*end) for end in ends)
        return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {style}/>'

    def text(x, y, content, anchor="middle", turned=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {turned}>{content}</text>'

    def power(exponent):
        return f'10<tspan dy="-5" font-size="9">{exponent}</tspan>'

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
    ]
    grid, dashed = 'stroke="#ddd"', 'stroke="#999" stroke-dasharray="5 4"'
    for exponent in range(3, 7):
        parts.append(line([(10.0**exponent, low_y), (10.0**exponent, high_y)], grid))
        parts.append(text(place(10.0**exponent, low_y)[0], HEIGHT - MARGIN + 18, power(exponent)))
    for exponent in range(round(math.log10(low_y)), math.floor(math.log10(high_y)) + 1):
        parts.append(line([(low_x, 10.0**exponent), (high_x, 10.0**exponent)], grid))
        parts.append(text(MARGIN - 6, place(low_x, 10.0**exponent)[1] + 4, power(exponent), "end"))
    first_x, first_y = points[0]
    for exponent, name in ((1, "n"), (2, "n²")):
        end = min(high_x, first_x * (high_y / first_y) ** (1 / exponent))
        top = (end, first_y * (end / first_x) ** exponent)
        parts.append(line([(first_x, first_y), top], dashed))
        x, y = place(*top)
        parts.append(text(x - 8, y + 14, name, "end"))
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in (place(*point) for point in points))
    parts.append(f'<polyline points="{path}" fill="none" stroke="#0b6" stroke-width="2"/>')
    parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="#0b6"/>' for x, y in (place(*p) for p in points)]
    parts.append(text((WIDTH + MARGIN) / 2, HEIGHT - 14, "quads of the scene"))
    middle = (HEIGHT - MARGIN) / 2
    parts.append(text(16, middle, f"links (slope {growth:.2f})", turned=f'transform="rotate(-90 16 {middle:.0f})"'))
    return "\n".join([*parts, "</svg>", ""])


def main():
    parser = arguments(__doc__)
    parser.add_argument("--fineness", type=int, nargs="+", default=[1, 2, 4, 8, 16, 32], help="quads along each side")
    parser.add_argument("--svg", type=Path, metavar="FILE", help="the drawing")
    options = parser.parse_args()
    folder = options.build.resolve() / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    points = []
    for fineness in options.fineness:
        quads, stats = solve(options.build.resolve() / "bin" / "triptych", folder, fineness, options.threads)
        points.append((quads, stats["links"]))
        figure(f"radiosity.links.{quads}", stats["links"], "links")
        figure(f"radiosity.links.{quads}.elements", stats["elements"], "elements")
        figure(f"radiosity.links.{quads}.residual", stats["residual"], "W/m²", goal=TOLERANCE)
        figure(f"radiosity.links.{quads}.seconds", stats["seconds"]["solve"], "s")
    growth = slope(*zip(*points, strict=True))
    figure("radiosity.links.slope", growth, "of log links over log quads", goal=1.1)
    (options.svg or folder / "links.svg").write_text(drawing(points, growth), encoding="utf-8")


if __name__ == "__main__":
    main()
