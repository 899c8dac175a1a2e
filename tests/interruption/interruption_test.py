#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A run that is ended at any moment and goes on says, bit for bit, what one that was left alone says.

usage: interruption_test.py PROGRAM KILLER [--kills N] [--seed S] [--scheme sph|cells|contact] [--folder DIR]
       KILLER     the library of library/kill_at_call.cpp
       --kills N  kills by the call that changes a file, and as many by the clock; 0: every call that changes one
exit code: 0 the same; 1 not
"""
import argparse
import filecmp
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TUBE = """{"unit": "mm", "blend_width_k": 0.1,
 "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.5], [7, 0, 0, 1.5], [14, 0, 0, 1.5], [22, 0, 0, 1.5]]}],
 "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.5},
          "distal": {"point": [20, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.5}}}"""
DECK = """version: 1
case: {name: tube}
geometry: {network: tube.json, lesion: {branch: tube, position: "10 mm", length: "5 mm", diameter_stenosis_percent: 40}}
blood: {density: "1060 kg/m^3", viscosity: "3.5 mPa s"}
aorta: {pressure: "93 mmHg"}
openings:
  inlet: {type: pressure, pressure: "93 mmHg"}
  distal: {type: resistance, resistance: "2e10 Pa s/m^3"}
"""
GEOMETRIC = 'stent: {design: paper}\ndeployment: {mode: geometric, diameter: "3 mm"}\n'
RING = """stent:
  pattern: {rings: 1, crowns: 6, length: "1.2 mm", diameter: "2 mm", crimped_diameter: "1.8 mm", nominal_diameter: "3.3 mm", strut_width: "0.12 mm",
            strut_thickness: "0.12 mm", crown_radius: "0.15 mm", gap: "0.2 mm", connectors: 3}
wall: {spacing: "0.25 mm", plaque: none}
deployment: {mode: balloon, diameter: "3 mm", crimped_diameter: "1.7 mm", ramp: "1.8 ms", steps: 300, slowing: 2, region: 1.2, frames: 4}
"""
CELLS = 'numerics: {spacing: "0.4 mm", duration: "1 s"}\n'
SCHEMES = {"sph": GEOMETRIC + 'numerics: {scheme: sph, spacing: "0.4 mm", duration: "8 ms"}\noutput: {interval: "3 ms", checkpoint_interval: "1 ms"}\n',
           "cells": GEOMETRIC + CELLS,
           "contact": RING + CELLS + 'output: {checkpoint_interval: "0.2 ms"}\n'}
FINISHED = {"sph": 0, "cells": 0, "contact": 6}   # so few steps open a stent too fast to be trusted
# What depends on the clock, on the machine or on how a run came about is no result; nor is the page, which repeats such things.
NO_RESULTS = {"timing.json", "log.txt", "report.html"}


class Trial:
    """One folder of results and the program run on it, again and again."""

    def __init__(self, options, deck, out):
        self.options, self.deck, self.out = options, deck, out
        self.began = time.monotonic()

    def start(self, **environment):
        command = [self.options.program, "run", str(self.deck), "-o", str(self.out), "--threads", "1"]
        return subprocess.Popen(command, env=os.environ | environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def finish(self, process):
        """Exit code; what it said is kept for a complaint."""
        self.said = process.communicate(timeout=900)[1]
        return process.returncode

    def run(self, **environment):
        return self.finish(self.start(**environment))

    def stage(self):
        """What the run has come to, for the reader of the test's output."""
        done = [stage for stage in ("before", "deploy", "after") if (self.out / stage / "timing.json").exists()]
        return ["before", "deploy", "after", "end"][len(done)]


def results(out):
    """Files of results, relative to the folder."""
    files = (path.relative_to(out) for path in out.rglob("*") if path.is_file())
    return {path for path in files if path.name not in NO_RESULTS and path.parent.name != "checkpoint"}


def differences(out, reference):
    ours, theirs = results(out), results(reference)
    sentences = [f"{path} is missing" for path in sorted(theirs - ours)] + [f"{path} is too much" for path in sorted(ours - theirs)]
    return sentences + [f"{path} differs" for path in sorted(ours & theirs) if not filecmp.cmp(out / path, reference / path, shallow=False)]


def interrupt_by(trial, sig, at):
    """Ends the run `at` seconds after its start by a signal, or by the stop file. Returns its exit code."""
    process = trial.start()
    time.sleep(at)
    if sig == "stop file":
        (trial.out / "stop").touch()
    else:
        process.send_signal(sig)
    return trial.finish(process)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("killer")
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scheme", choices=SCHEMES, default="sph")
    parser.add_argument("--folder", type=Path)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    folder = options.folder or Path(tempfile.mkdtemp(prefix="patency_interruption_"))
    folder.mkdir(parents=True, exist_ok=True)
    deck = folder / "case.yaml"
    (folder / "tube.json").write_text(TUBE)
    deck.write_text(DECK + SCHEMES[options.scheme])

    reference = Trial(options, deck, folder / "reference")
    list_of_calls = folder / "calls.txt"
    finished = FINISHED[options.scheme]
    assert reference.run(LD_PRELOAD=options.killer, PATENCY_CALLS_INTO=str(list_of_calls)) == finished, reference.said
    length = time.monotonic() - reference.began
    calls = list_of_calls.read_text().splitlines()
    print(f"left alone: {length:.1f} s, {len(calls)} calls that change files", flush=True)
    assert len(calls) > 100, "the library that kills does not see the calls"

    wrong = []
    resumed = []   # steps that deployments did, over all of theirs

    def conclude(trial, what):
        code = trial.run()
        complaints = [f"exit code {code}: {trial.said.strip().splitlines()[-1:]}"] if code != finished else differences(trial.out, reference.out)
        print(f"{what}: {'; '.join(complaints) or 'the same'}", flush=True)
        if options.scheme == "contact" and not complaints:
            time_of = json.loads((trial.out / "deploy/timing.json").read_text())["deploy"]
            if time_of["resumed"]:
                resumed.append(time_of["steps"] / json.loads((trial.out / "deploy/summary.json").read_text())["deploy"]["steps"])
        wrong.extend(complaints)

    # Before a call that changes a file: where a stage's results are there and its times are not, and some others, or all.
    at_calls = {n + 1 for n, call in enumerate(calls, 1) if call.startswith("rename") and call.endswith("/summary.json") and n < len(calls)}
    at_calls |= set(range(1, len(calls) + 1) if options.kills == 0 else chance.sample(range(1, len(calls) + 1), options.kills))
    for n in sorted(at_calls):
        trial = Trial(options, deck, folder / f"call_{n}")
        code = trial.run(LD_PRELOAD=options.killer, PATENCY_KILL_AT=str(n))
        assert code == -signal.SIGKILL, f"not killed at call {n}: exit code {code}, {trial.said}"
        conclude(trial, f"killed before call {n} ({calls[n - 1]}), in {trial.stage()}")

    # By the clock, again and again on one folder until its stages have ended, then on another.
    kills = 0
    while kills < options.kills:
        trial = Trial(options, deck, folder / f"clock_{kills}")
        where = []
        while kills < options.kills and trial.stage() != "end":
            process = trial.start()
            try:
                process.wait(chance.uniform(0.05, 0.45) * length)
                break   # it was faster
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                kills += 1
                where.append(trial.stage())
        conclude(trial, f"killed {len(where)} times, in {', '.join(where)}")

    # As a person or a batch system does it: the exit code says so, and a flow of moving particles leaves a checkpoint.
    for name, sig, expected in (("SIGINT", signal.SIGINT, 130), ("SIGTERM", signal.SIGTERM, 143), ("the stop file", "stop file", 130)):
        trial = Trial(options, deck, folder / f"ended_by_{name.replace(' ', '_')}")
        code = interrupt_by(trial, sig, 0.25 * length)
        if code != expected:
            wrong.append(f"{name}: exit code {code}, not {expected}")
        if options.scheme == "sph" and not (trial.out / "before/checkpoint/flow.h5").exists():
            wrong.append(f"{name}: no checkpoint")
        conclude(trial, f"ended by {name} with exit code {code}, in {trial.stage()}")

    if options.scheme == "contact":
        print("deployments that went on:", ", ".join(f"{share:.0%} of the steps" for share in resumed))
        if not any(0 < share < 1 for share in resumed):
            wrong.append("no deployment went on from a checkpoint")
    print("\n".join(wrong) if wrong else "all the same")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
