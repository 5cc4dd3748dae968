#!/usr/bin/env python3
"""Random pairs on bodies of planes, spheres, cylinders and cones, each answer of `taut path` checked by closed forms.

    face_campaign.py --taut build/release/taut --judge build/bench/bench/judge_faces [--pairs 600] [--seed 1] [NAME ...]

The judge (bench/judge_faces.cpp) shares nothing with Taut. A pair is a silent miss where it finds a way that is shorter
by more than 1e-7 and the answer has no doubt (`--unique` says true or false), and a doubted one where it has. "Judge
longer": it found a longer way only, as where a path runs along the rim of a sphere; "not judged": none at all. The last
column is the largest relative difference of the rest.
"""

import argparse
import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import time

MISS = 1e-7  # relative: a judged way may leave the body by 1e-9


def call(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)


def campaign(name, options, folder):
    """The counts of one shape, and its largest difference."""
    formula = call(options.judge, name, "--formula").stdout.strip()
    pairs = folder / "pairs.csv"
    pairs.write_text(call(options.judge, name, "--pairs", options.pairs, options.seed).stdout)
    begin = time.monotonic()
    path = call(options.taut, "path", formula, "--pairs", pairs, "--header", "--unique", "-q", "--threads", 1)
    seconds = time.monotonic() - begin
    answers = list(csv.DictReader(path.stdout.splitlines()))
    judged = [float(line) for line in call(options.judge, name, "--judge", pairs).stdout.split()]
    count = dict.fromkeys(("pairs", "refused", "silent", "doubted", "longer", "unjudged"), 0)
    worst = 0.0
    for pair, answer, way in zip(pairs.read_text().split(), answers, judged, strict=True):
        count["pairs"] += 1
        doubt = answer["unique"] not in ("true", "false", "1", "0")
        length = float(answer["length"]) if answer["status"] == "ok" else math.nan
        excess = length / way - 1
        if math.isnan(length):
            count["refused"] += 1
        elif math.isinf(way):
            count["unjudged"] += 1
        elif excess > MISS:
            count["doubted" if doubt else "silent"] += 1
            print(f"{name}: {pair}: {length:.12g}, judge {way:.12g}, {'doubt' if doubt else 'SILENT'}",
                  file=sys.stderr, flush=True)
        elif excess < -MISS:
            count["longer"] += 1
        else:
            worst = max(worst, abs(excess))
    return count, worst, 1000 * seconds / max(1, count["pairs"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--taut", type=pathlib.Path, required=True)
    parser.add_argument("--judge", type=pathlib.Path, required=True)
    parser.add_argument("--pairs", type=int, default=600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    names = options.names or call(options.judge).stdout.split()
    print("| shape | pairs | refused | silent misses | doubted misses | judge longer | not judged | largest difference "
          "| path ms |")
    print("|---|---|---|---|---|---|---|---|---|", flush=True)
    total = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            count, worst, ms = campaign(name, options, pathlib.Path(folder))
            total = {key: total.get(key, 0) + value for key, value in count.items()}
            print(f"| {name} | " + " | ".join(str(value) for value in count.values()) + f" | {worst:.1e} | {ms:.1f} |",
                  flush=True)
    print("| all | " + " | ".join(str(value) for value in total.values()) + " | | |")


if __name__ == "__main__":
    main()
