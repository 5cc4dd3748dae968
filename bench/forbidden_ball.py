#!/usr/bin/env python3
"""The unit sphere in R^d with a forbidden cap of 41 degrees: random pairs against spherical trigonometry.

    forbidden_ball.py TAUT [--dim 4] [--pairs 50] [--seed 1]

Only pairs between whose ends the cap stands, each asked from both ends. The path lies in the great sphere through both
ends and the middle of the cap: two tangents and an arc. Prints pairs, refused, pairs off by more than 1e-10, the
largest difference of the rest, ms of CPU a question.
"""

import argparse
import csv
import math
import pathlib
import random
import resource
import subprocess
import tempfile

RADIUS = math.acos(0.75)


def dot(u, v):
    return sum(a * b for a, b in zip(u, v))


def plus(a, u, b, v):
    return [a * x + b * y for x, y in zip(u, v)]


def unit(u):
    return [x / math.sqrt(dot(u, u)) for x in u]


def angle(u, v):
    across = plus(1, u, -dot(u, v), v)
    return math.atan2(math.sqrt(dot(across, across)), dot(u, v))


def exact(p, q, c):
    """The length of the path, or None where it does not meet the cap."""
    w = unit(plus(1, q, -dot(p, q), p))
    t = math.atan2(dot(c, w), dot(c, p))
    if not 0 < t < angle(p, q) or angle(plus(math.cos(t), p, math.sin(t), w), c) >= RADIUS:
        return None
    turn = angle(unit(plus(1, p, -dot(p, c), c)), unit(plus(1, q, -dot(q, c), c)))
    length = 0
    for x in (p, q):
        length += math.acos(math.cos(angle(x, c)) / math.cos(RADIUS))
        turn -= math.acos(math.tan(RADIUS) / math.tan(angle(x, c)))
    return length + math.sin(RADIUS) * turn


def pairs_of(dim, count, seed):
    rng = random.Random(seed)
    c = [1.0] + [0.0] * (dim - 1)
    found = []
    while len(found) < 2 * count:
        # Leaning towards the cap: else it is hardly ever met in many dimensions.
        p, q = (unit(plus(1, unit([rng.gauss(0, 1) for _ in c]), 0.3, c)) for _ in range(2))
        if max(p[0], q[0]) > 0.749:
            continue
        length = exact(p, q, c)
        if length is not None:
            found += [(p + q, length), (q + p, length)]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("taut")
    parser.add_argument("--dim", type=int, default=4)
    parser.add_argument("--pairs", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    squares = "+".join(f"x{i + 1}^2" for i in range(options.dim))
    pairs = pairs_of(options.dim, options.pairs, options.seed)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "pairs.csv")
        file.write_text("".join(",".join(map(repr, row)) + "\n" for row, _ in pairs))
        command = [options.taut, "path", squares + "=1", "--dim", str(options.dim), "-q", "--header", "--threads", "1"]
        command += ["--obstacle", squares + "-2*x1+0.5", "--pairs", str(file)]
        answers = subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    refused = off = 0
    largest = 0.0
    for answer, (_, length) in zip(csv.DictReader(answers), pairs, strict=True):
        difference = abs(float(answer["length"]) / length - 1) if answer["status"] == "ok" else None
        if difference is None:
            refused += 1
        elif difference > 1e-10:
            off += 1
        else:
            largest = max(largest, difference)
    ms = 1000 * seconds / len(pairs)
    print(f"| {options.dim} | {len(pairs)} | {refused} | {off} | {largest:.1e} | {ms:.2f} |")


if __name__ == "__main__":
    main()
