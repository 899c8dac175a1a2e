#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `ccx` found of the deck of make_deck.py: outer diameter open and at rest, recoil, plastic work of the whole ring.
`read_results.py OUT.inp OUT.dat`."""
import math
import sys

from make_deck import CROWNS, HARDENING, LENGTH, YIELD


def blocks(path):
    """(title, rows) of every table of a .dat file."""
    title, rows = None, []
    for line in open(path):
        words = line.split()
        if words and words[0].isalpha():
            if rows:
                yield title, rows
            title, rows = line.strip(), []
        elif words and title:
            rows.append([w if w == 'L' else float(w) for w in words])   # L: in cylindrical axes
    if rows:
        yield title, rows


def places(path):
    nodes, reading = {}, False
    for line in open(path):
        if line.startswith('*'):
            reading = line.startswith('*NODE, NSET=ALL')
        elif reading:
            n, *x = line.split(',')
            nodes[int(n)] = [float(v) for v in x]
    return nodes


def radius(x, y, u, v, is_cylindrical):
    if is_cylindrical:
        return math.hypot(math.hypot(x, y) + u, v)
    return math.hypot(x + u, y + v)


def main(deck, results):
    nodes = places(deck)
    diameters, lengths, works, strains, volumes = [], [], [], None, []
    for title, rows in blocks(results):
        if title.startswith('displacements') and 'OUTER' in title:
            r = [radius(*nodes[int(n)][:2], u, v, bool(local)) for n, u, v, _, *local in rows]
            diameters.append(2 * sum(r) / len(r))
        elif title.startswith('displacements'):   # of all nodes: crowns lean outwards, so that their inner edges stand out
            z = [nodes[int(row[0])][2] + row[3] for row in rows]
            lengths.append(max(z) - min(z))
        elif 'equivalent plastic strain' in title:
            strains = {}
            for e, _, a in rows:
                strains.setdefault(int(e), []).append(a)
        elif title.startswith('volume') and strains:
            work = lambda a: YIELD * a + HARDENING * a * a / 2
            volume = {int(row[0]): row[1] for row in rows if len(row) == 2}
            works.append(2 * CROWNS * 1e-3 * sum(volume[e] * sum(map(work, a)) / len(a) for e, a in strains.items()))
            volumes.append(max(max(a) for a in strains.values()))
    print(f'outer diameter open {diameters[0]:.4f} mm, at rest {diameters[-1]:.4f} mm, recoil {100 * (1 - diameters[-1] / diameters[0]):.3f} %')
    print(f'foreshortening at rest {100 * (1 - lengths[-1] / LENGTH):.2f} %')
    print(f'plastic work of the ring {works[0]:.5g} J, largest plastic strain {volumes[0]:.4f}')


if __name__ == '__main__':
    main(sys.argv[1], sys.argv[2])
