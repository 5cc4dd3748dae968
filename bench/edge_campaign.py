#!/usr/bin/env python3
"""Random pairs on shapes with edges, each asked from both ends.

    edge_campaign.py TAUT [--pairs N] [--threads T]

Points are where random chords leave the body. A way that is missed from one end is found by the other one; a way
missed from both is not (bench/nonconvex_polyhedra.py has independent values). Prints a line a shape: pairs, refused
from either end, pairs that differ by more than 1e-9 of their length, the largest difference of the rest, ms of CPU a
question.
"""

import argparse
import csv
import math
import os
import pathlib
import random
import subprocess
import tempfile

SHAPES = [
    "max(x^2+y^2-4,abs(z)-1)",
    "max(x^2+y^2-1,abs(z)-3)",
    "max(abs(x)-3,abs(y)-1.2,abs(z)-1.2)",
    "max(abs(x)-15,abs(y)-6,abs(z)-6)",
    "max(abs(x),abs(y),abs(z))-1",
    "abs(x)+abs(y)+abs(z)-1",
    "max(max(abs(x)-1,abs(y)-1),max(abs(z)-1,0.5-x^2-y^2))",
    "min(max(abs(x)-3,abs(y)-0.5,abs(z)-0.5),max(abs(x)-0.5,abs(y)-3,abs(z)-0.8))",
    "min(max(abs(x)-2,abs(y)-2,abs(z)-0.3),max(abs(x)-0.5,abs(y)-0.5,abs(z-1)-1))",
    "sqrt(max(abs(x)-1.8,0)^2+max(abs(y)-0.8,0)^2+max(abs(z)-0.8,0)^2)-0.2",
    "sqrt(max(abs(x)-0.5,0)^2+max(abs(y)-0.5,0)^2+max(abs(z)-1.5,0)^2)-0.5",
    "max(x^2+y^2+z^2-1,0.5-z)",
    "max(x^2+y^2+z^2-1,(x-1)^2+y^2+z^2-1)",
    "max(x^2+y^2,x^2+z^2,y^2+z^2)-2",
    "max(x^2+z^2,y^2+z^2)-1",
    "max(sqrt(x^2+y^2)+z-1,-z)",
    "max(sqrt(x^2+y^2)+abs(z)-1,x-0.4)",
    "min(x^2+y^2+(z-1.2)^2-0.5,max(x^2+y^2-1,abs(z)-1))",
    "min((x+0.6)^2+y^2+z^2-1,(x-0.6)^2+y^2+z^2-1)",
    "max(x^2+y^2+z^2-1,z-0.5,x-0.7)",
    "max(x^2+y^2+z^2-4,1-x^2-y^2)",
    "max(x^2/4+y^2+z^2-1,abs(x)-1.2)",
    "max((sqrt(x^2+y^2)-2)^2+z^2-0.5,abs(z)-0.4)",
    "max(max(abs(x)-2,abs(y)-1,abs(z)-1),1.2-(x-1)^2-(y-1)^2)",
    "max(abs(x)+abs(y)-1.5,abs(z)-1,x-1)",
    "max(0.5*x+z-1,-0.5*x+z-1,0.5*y+z-1,-0.5*y+z-1,-z)",
    "max(x^2+y^2-1,abs(z+0.3*x)-1)",
    "min(max(abs(x)-2,abs(y)-1,abs(z)-0.5),max(x^2+y^2-0.5,abs(z)-1.5))",
    "max(abs(x)^3+abs(y)^3+abs(z)^3-1,z-0.8)",
    "max(x^2+y^2+z^2-1,-(x^2+y^2+(z-1)^2-0.3))",
]


def body(formula):
    text = formula.replace("^", "**")
    names = {"max": max, "min": min, "abs": abs, "sqrt": lambda v: math.sqrt(max(v, 0.0))}
    code = compile(text, "shape", "eval")
    return lambda p: eval(code, {"__builtins__": {}}, {**names, "x": p[0], "y": p[1], "z": p[2]})


def random_point(function, generator, reach):
    while True:
        a = [generator.uniform(-reach, reach) for _ in range(3)]
        b = [generator.uniform(-reach, reach) for _ in range(3)]
        if function(a) < 0 < function(b):
            for _ in range(60):
                middle = [(u + v) / 2 for u, v in zip(a, b)]
                a, b = (middle, b) if function(middle) < 0 else (a, middle)
            return a


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("taut")
    parser.add_argument("--pairs", type=int, default=667)
    parser.add_argument("--threads", default="1")
    arguments = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp())
    print("| shape | pairs | refused | differ | largest difference of the rest | ms a question |")
    print("|---|---|---|---|---|---|")
    total = [0, 0, 0]
    for formula in SHAPES:
        generator = random.Random(formula)
        function = body(formula)
        reach = 16 if "15" in formula and "abs(x)-15" in formula else 3.2
        points = [random_point(function, generator, reach) for _ in range(2 * arguments.pairs)]
        pairs = list(zip(points[0::2], points[1::2]))
        lengths = []
        before = os.times().children_user
        for turn in (lambda p, q: p + q, lambda p, q: q + p):
            path = folder / "pairs.csv"
            path.write_text("".join(",".join(f"{v:.17g}" for v in turn(p, q)) + "\n" for p, q in pairs))
            ran = subprocess.run([arguments.taut, "path", formula, "--pairs", str(path), "--threads",
                                  arguments.threads], capture_output=True, text=True)
            rows = list(csv.reader(ran.stdout.splitlines()))
            lengths.append([float(row[0]) if row[-1] == "ok" else math.nan for row in rows])
        seconds = os.times().children_user - before
        refused = differ = 0
        worst = 0.0
        for there, back, pair in zip(*lengths, pairs, strict=True):
            if math.isnan(there) or math.isnan(back):
                refused += 1
                continue
            off = abs(there - back) / max(there, back)
            if off > 1e-9:
                differ += 1
                print("  ", formula, pair, there, back)
            else:
                worst = max(worst, off)
        total = [total[0] + len(pairs), total[1] + refused, total[2] + differ]
        print(f"| `{formula}` | {len(pairs)} | {refused} | {differ} | {worst:.1e} "
              f"| {500 * seconds / len(pairs):.2f} |", flush=True)
    print("all:", *total)


if __name__ == "__main__":
    main()
