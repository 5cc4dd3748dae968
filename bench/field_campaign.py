#!/usr/bin/env python3
"""Fields on fits and scans, each checked against itself and against single paths, as a Markdown table.

    field_campaign.py --taut build/release/taut [--sources 3] [--targets 150] [--paths 12] [--seed 1] MODEL ...

MODEL is a point cloud or mesh; it is fitted once, and the ends are random vertices of `taut mesh`. Each of the sources
is asked for its distance to the other sources, to the targets and a neighbour of each in the mesh, and to points of the
path from the first source to the farthest target. What must hold, whatever the surface:

    nan        no target without a distance (`inf`, another component, counts apart)
    swapped    d(p, q) = d(q, p): largest difference, relative
    triangle   d(p, x) <= d(p, q) + d(q, x): largest excess, relative to the right side
    lipschitz  |d(p, x) - d(p, y)| <= length of the path from x to y, x and y neighbours: largest excess, relative to
               d(p, x)
    rise       along the path from the first source: least rise of the distance from one of its points to the next, in
               steps (1 = as the path's own length)
    path       field against `taut path`, relative: most below and above; above is a field that missed a way
"""

import argparse
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time


def run(command, fine=(0, 1)):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode not in fine:
        raise RuntimeError(f"{' '.join(str(c) for c in command)}: {done.returncode}: {done.stderr.strip()[-300:]}")
    return done.stdout


def read_off(path):
    words = path.read_text().split()
    count, faces = int(words[1]), int(words[2])
    numbers = words[4:]
    wide = 6 if words[0] == "NOFF" else 3  # normals stand beside the points
    points = [tuple(map(float, numbers[wide * i:wide * i + 3])) for i in range(count)]
    rest = numbers[wide * count:]
    neighbours = {}
    for i in range(faces):
        a, b, c = (int(w) for w in rest[4 * i + 1:4 * i + 4])
        for u, v in ((a, b), (b, c), (c, a)):
            neighbours.setdefault(u, set()).add(v)
            neighbours.setdefault(v, set()).add(u)
    return points, neighbours


def text_of(point):
    return ",".join(repr(c) for c in point)


def write_points(path, points):
    path.write_text("".join(text_of(p) + "\n" for p in points))


class Model:
    def __init__(self, options, name, folder):
        self.taut = options.taut
        self.folder = folder
        self.file = folder / "model.taut"
        run([self.taut, "fit", name, "--out", self.file, "-q"])
        mesh = folder / "mesh.off"
        run([self.taut, "mesh", self.file, "--out", mesh, "-q"])
        self.points, self.neighbours = read_off(mesh)

    def distances(self, source, targets):
        file = self.folder / "targets.csv"
        write_points(file, targets)
        out = run([self.taut, "field", self.file, "--from=" + text_of(source), "--at", file, "-q", "--threads", 1])
        return [float(line.split(",")[0]) for line in out.splitlines()]

    def lengths(self, pairs):
        file = self.folder / "pairs.csv"
        file.write_text("".join(f"{text_of(p)},{text_of(q)}\n" for p, q in pairs))
        out = run([self.taut, "path", self.file, "--pairs", file, "-q", "--tol", "1e-7"], fine=(0, 1, 4, 5))
        rows = [line.split(",") for line in out.splitlines()]
        return [float(row[0]) if row[-1] == "ok" else math.nan for row in rows]

    def path(self, source, target, count):
        file = self.folder / "path.csv"
        run([self.taut, "path", self.file, "--from=" + text_of(source), "--to=" + text_of(target), "--samples-along",
             count, "--out", file, "-q"])
        rows = [line for line in file.read_text().splitlines() if line and line[0] in "-.0123456789"]
        return [tuple(map(float, row.split(",")[:3])) for row in rows]


def largest(values):
    return max((v for v in values if math.isfinite(v)), default=math.nan)


def check(options, name, folder):
    model = Model(options, name, folder)
    pick = random.Random(options.seed)
    connected = [i for i in range(len(model.points)) if model.neighbours.get(i)]
    sources = [model.points[i] for i in pick.sample(connected, options.sources)]
    ends = pick.sample(connected, options.targets)
    beside = [pick.choice(sorted(model.neighbours[i])) for i in ends]
    x = [model.points[i] for i in ends]
    y = [model.points[i] for i in beside]
    start = time.time()
    first = model.distances(sources[0], sources + x + y)
    far = max(range(len(x)), key=lambda i: first[len(sources) + i] if math.isfinite(first[len(sources) + i]) else -1)
    way = model.path(sources[0], x[far], 21)
    table = [model.distances(s, sources + x + y) for s in sources]
    seconds = (time.time() - start) / (len(sources) + 1)
    along = model.distances(sources[0], way)
    n, m = len(sources), len(x)
    flat = [d for row in table for d in row] + along
    swapped = largest(abs(table[i][j] - table[j][i]) / max(table[i][j], 1e-300) for i in range(n) for j in range(i))
    triangle = largest((table[i][n + t] - table[i][j] - table[j][n + t]) / (table[i][j] + table[j][n + t])
                       for i in range(n) for j in range(n) for t in range(2 * m) if i != j)
    edge = model.lengths(list(zip(x, y)))
    lipschitz = largest((abs(row[n + t] - row[n + m + t]) - edge[t]) / max(row[n + t], 1e-300)
                        for row in table for t in range(m))
    steps = [(b - a) * (len(along) - 1) / along[-1] for a, b in zip(along, along[1:])]
    asked = pick.sample(range(m), options.paths)
    singles = model.lengths([(sources[0], x[t]) for t in asked])
    off = [table[0][n + t] / d - 1 for t, d in zip(asked, singles) if d > 0 and math.isfinite(table[0][n + t])]
    return (f"| {pathlib.Path(name).name} | {sum(math.isnan(d) for d in flat)} of {len(flat)} "
            f"| {sum(math.isinf(d) for d in flat)} | {swapped:.1e} | {triangle:.1e} | {lipschitz:.1e} "
            f"| {min(steps):.4f} | {min(off, default=math.nan):.1e}, {max(off, default=math.nan):.1e} "
            f"| {seconds:.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--taut", type=pathlib.Path, required=True)
    parser.add_argument("--sources", type=int, default=3)
    parser.add_argument("--targets", type=int, default=150)
    parser.add_argument("--paths", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("models", nargs="+")
    options = parser.parse_args()
    print("| model | nan | inf | swapped | triangle | lipschitz | least rise | field to path | s a source |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in options.models:
        with tempfile.TemporaryDirectory() as folder:
            try:
                print(check(options, name, pathlib.Path(folder)), flush=True)
            except (RuntimeError, ValueError) as error:
                print(f"| {pathlib.Path(name).name} | {error} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
