#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The same state, bit by bit, for every instruction set and any number of threads.

usage: bits_test.py PROGRAM...     builds of tests/bits/program/state_hash.cpp; one that exits with 77 is left out
exit code: 0 the same; 1 not; 77 fewer than two of them run here
"""
import os
import subprocess
import sys
from pathlib import Path

STEPS = "6"
CANNOT_RUN = 77


def run(program, precision, threads):
    """What the program prints, by lines, or None where it cannot run."""
    done = subprocess.run([program, precision, STEPS], env=os.environ | {"OMP_NUM_THREADS": str(threads)},
                          capture_output=True, text=True, timeout=300)
    if done.returncode == CANNOT_RUN:
        return None
    if done.returncode != 0:
        sys.exit(f"{program} {precision}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout.splitlines()


def main(programs):
    failures, compared = 0, set()
    for precision in ("mixed", "double"):
        first = None   # (who, lines)
        for program in programs:
            for threads in (1, 2, 3, 4) if program == programs[0] else (1, 3):
                who = f"{Path(program).name} {precision}, {threads} threads"
                lines = run(program, precision, threads)
                if lines is None:
                    print(f"{Path(program).name}: not on this processor")
                    break
                compared.add(program)
                assert len(lines) == int(STEPS), f"{who}: {len(lines)} lines"
                if first is None:
                    first = (who, lines)
                    print("\n".join([who, *lines]))
                for ours, theirs in zip(lines, first[1]):
                    if ours != theirs:
                        failures += 1
                        print(f"{who}: {ours}\nunlike {first[0]}: {theirs}")
                        break
    print(f"{len(compared)} builds, {failures} differ")
    if failures:
        return 1
    return 0 if len(compared) > 1 else CANNOT_RUN


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
