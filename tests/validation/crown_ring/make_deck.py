#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A CalculiX deck of the ring of crowns of cases/verify/stent_ring.yaml: one strut from tip to tip, by its symmetries a
twelfth of the ring. Units: mm, N, MPa. `make_deck.py OUT.inp`, `ccx -i OUT`, `read_results.py OUT.dat`."""
import math
import sys

CROWNS, DIAMETER, THICKNESS, WIDTH, LENGTH, CROWN_RADIUS = 6, 2.0, 0.1, 0.1, 1.075, 0.15
YOUNG, POISSON, YIELD = 193e3, 0.3, 172.0
HARDENING = (485 * 1.4 - YIELD) / math.log(1.4)
BALLOON_FROM, BALLOON_TO = 0.9, 1.55   # radius
ALONG, ACROSS, THROUGH = 56, 4, 3      # elements

middle = (DIAMETER - THICKNESS) / 2
half_pitch = math.pi * middle / CROWNS
height = (LENGTH - WIDTH) / 2 - CROWN_RADIUS   # of the centres of the crowns' arcs

# The centreline on the unrolled tube: arc about (0, height), straight, arc about (half_pitch, -height).
dx, dy = half_pitch, -2 * height
distance = math.hypot(dx, dy)
straight = math.sqrt(distance**2 - 4 * CROWN_RADIUS**2)
turn = math.acos(2 * CROWN_RADIUS / distance)                # from the centres' line to the radius of the tangent's point
radius_angle = math.atan2(dy, dx) + turn                     # of that radius
arc = CROWN_RADIUS * (math.pi / 2 - radius_angle)
total = 2 * arc + straight


def centreline(s):
    """Place and unit normal (to the outside of the first crown)."""
    if s < arc:
        a = math.pi / 2 - s / CROWN_RADIUS
        return CROWN_RADIUS * math.cos(a), height + CROWN_RADIUS * math.sin(a), math.cos(a), math.sin(a)
    n = math.cos(radius_angle), math.sin(radius_angle)
    if s <= arc + straight:
        t = s - arc
        return CROWN_RADIUS * n[0] + t * n[1], height + CROWN_RADIUS * n[1] - t * n[0], n[0], n[1]
    x, y, nx, ny = centreline(total - s)   # turned by half about the strut's middle
    return half_pitch - x, -y, nx, ny


def node_of(i, j, k):   # of a grid of half elements
    x, y, nx, ny = centreline(total * i / (2 * ALONG))
    w = WIDTH * (j / (2 * ACROSS) - 0.5)
    r = middle + THICKNESS * (k / (2 * THROUGH) - 0.5)
    a = (x + w * nx) / middle
    return r * math.cos(a), r * math.sin(a), y + w * ny


def main(path):
    lines, number, nodes = ['*NODE, NSET=ALL'], {}, []

    def node(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(number) + 1
            nodes.append(node_of(i, j, k))
        return number[i, j, k]

    elements, faces = [], []
    corner = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    edge = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
            (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    for i in range(ALONG):
        for j in range(ACROSS):
            for k in range(THROUGH):
                elements.append([node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in corner + edge])
                if k == 0:
                    faces.append(len(elements))
    count = len(nodes)
    lines += [f'{n + 1}, {x:.9g}, {y:.9g}, {z:.9g}' for n, (x, y, z) in enumerate(nodes)]
    # The balloon: one layer of bricks, all of whose nodes are led.
    around, along, out = 24, 14, []
    low, high, bottom, top = -0.25, math.pi / CROWNS + 0.25, -0.75, 0.75
    lines.append('*NODE, NSET=BALLOON')

    def tool(i, j, k):
        return count + 1 + i + (around + 1) * (j + (along + 1) * k)
    for k in range(2):
        for j in range(along + 1):
            for i in range(around + 1):
                a, r = low + (high - low) * i / around, BALLOON_FROM - 0.05 * (1 - k)
                lines.append(f'{tool(i, j, k)}, {r * math.cos(a):.9g}, {r * math.sin(a):.9g}, {bottom + (top - bottom) * j / along:.9g}')
    lines.append('*ELEMENT, TYPE=C3D20R, ELSET=METAL')
    for n, e in enumerate(elements):
        lines += [', '.join(map(str, [n + 1] + e[:10])) + ',', ', '.join(map(str, e[10:]))]
    lines.append('*ELEMENT, TYPE=C3D8, ELSET=TOOL')
    n = len(elements)
    for j in range(along):
        for i in range(around):
            n += 1
            out.append(n)
            q = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            lines.append(', '.join(map(str, [n] + [tool(a, b, 0) for a, b in q] + [tool(a, b, 1) for a, b in q])))
    side = [number[key] for key in number if key[0] in (0, 2 * ALONG)]
    outer = [number[key] for key in number if key[2] == 2 * THROUGH]
    for name, which in (('SIDE', side), ('OUTER', outer), ('MIDDLE', [number[ALONG, ACROSS, THROUGH * 2]])):
        lines.append(f'*NSET, NSET={name}')
        lines += [f'{v},' for v in which]
    lines.append('*SURFACE, NAME=INNER')
    lines += [f'{e}, S1' for e in faces]
    lines.append('*SURFACE, NAME=BALLOON')
    lines += [f'{e}, S2' for e in out]
    lines += ['*TRANSFORM, NSET=BALLOON, TYPE=C', '0, 0, 0, 0, 0, 1', '*TRANSFORM, NSET=SIDE, TYPE=C', '0, 0, 0, 0, 0, 1',
              '*MATERIAL, NAME=STEEL', '*ELASTIC', f'{YOUNG}, {POISSON}', '*PLASTIC',
              f'{YIELD}, 0', f'{YIELD + 2 * HARDENING}, 2', '*MATERIAL, NAME=RIGID', '*ELASTIC', '1, 0',
              '*SOLID SECTION, ELSET=METAL, MATERIAL=STEEL', '*SOLID SECTION, ELSET=TOOL, MATERIAL=RIGID',
              '*SURFACE INTERACTION, NAME=TOUCH', '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR', '2e6, 1',
              '*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE', 'INNER, BALLOON',
              '*BOUNDARY', 'SIDE, 2, 2', 'MIDDLE, 3, 3', 'BALLOON, 2, 3']
    opening = ['*BOUNDARY', f'BALLOON, 1, 1, {BALLOON_TO - BALLOON_FROM}']
    letting_go = ['*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE', 'INNER, BALLOON']   # a balloon that shrinks chatters; a ring let go is the same ring
    for what, first in ((opening, 0.01), (letting_go, 0.1)):
        lines += ['*STEP, NLGEOM, INC=2000', '*STATIC', f'{first}, 1, 1e-6, {3 * first}', *what,
                  '*NODE PRINT, NSET=OUTER, FREQUENCY=100000', 'U', '*NODE PRINT, NSET=ALL, FREQUENCY=100000', 'U', '*NODE PRINT, NSET=BALLOON, TOTALS=ONLY, FREQUENCY=20', 'RF',
                  '*EL PRINT, ELSET=METAL, FREQUENCY=100000', 'PEEQ', '*EL PRINT, ELSET=METAL, FREQUENCY=100000', 'EVOL',
                  '*NODE FILE, FREQUENCY=100000', 'U', '*EL FILE, FREQUENCY=100000', 'S, PEEQ', '*END STEP']
    open(path, 'w').write('\n'.join(lines) + '\n')


if __name__ == '__main__':
    main(sys.argv[1])
