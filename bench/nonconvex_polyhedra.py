#!/usr/bin/env python3
"""Shortest paths on non-convex polyhedra against exact polyhedral distances.

    nonconvex_polyhedra.py TAUT OPPONENT [--pairs N] [--only NAME]

TAUT is the program, OPPONENT the program opponent_polyhedral (CGAL). Ten polyhedra are made of boxes with whole
coordinates by union and difference, four of them sheared; as formulas of max and min of planes, and as meshes of the
unit squares between inside and outside. N random pairs (100) of points of each, the same for both. Prints a line a
shape: pairs, refused, how many are longer or shorter by more than 1e-9 of their length, and the worst
difference of the rest.
"""

import argparse
import csv
import os
import pathlib
import random
import subprocess
import tempfile


def box(ax, bx, ay, by, az, bz):
    return ("box", (ax, bx, ay, by, az, bz))


def union(*parts):
    return ("union", parts)


def minus(a, b):
    return ("minus", (a, b))


IDENTITY = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
SHEAR = ((1, 0.3, 0), (0, 1, 0.25), (0.2, 0, 1))
TURN = ((0.8, -0.6, 0), (0.6, 0.8, 0), (0, 0, 1))

SHAPES = {
    "L": (union(box(0, 3, 0, 1, 0, 1), box(0, 1, 0, 3, 0, 1)), IDENTITY),
    "stairs": (union(box(0, 3, 0, 2, 0, 1), box(1, 3, 0, 2, 0, 2), box(2, 3, 0, 2, 0, 3)), IDENTITY),
    "U": (minus(box(0, 4, 0, 2, 0, 3), box(1, 3, -1, 3, 1, 4)), IDENTITY),
    "tower": (union(box(0, 5, 0, 5, 0, 1), box(1, 3, 2, 4, 0, 4)), IDENTITY),
    "cross": (union(box(0, 5, 2, 3, 0, 1), box(2, 3, 0, 5, 0, 1), box(2, 3, 2, 3, 0, 3)), IDENTITY),
    "bored": (minus(box(0, 4, 0, 4, 0, 2), box(1, 3, 1, 2, -1, 3)), IDENTITY),
    "pit": (minus(box(0, 4, 0, 4, 0, 3), box(1, 3, 1, 3, 1, 4)), SHEAR),
    "sheared L": (union(box(0, 4, 0, 1, 0, 2), box(0, 1, 0, 3, 0, 1)), SHEAR),
    "sheared T": (union(box(0, 5, 0, 1, 2, 3), box(2, 3, 0, 1, 0, 3)), SHEAR),
    "turned towers": (union(box(0, 6, 0, 3, 0, 1), box(1, 2, 1, 2, 0, 3), box(4, 5, 0, 2, 0, 2)), TURN),
}


def inside(shape, x):
    kind, of = shape
    if kind == "box":
        return all(of[2 * i] < x[i] < of[2 * i + 1] for i in range(3))
    if kind == "union":
        return any(inside(part, x) for part in of)
    return inside(of[0], x) and not inside(of[1], x)


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    rows = (e * i - f * h, c * h - b * i, b * f - c * e), (f * g - d * i, a * i - c * g, c * d - a * f), (
        d * h - e * g, b * g - a * h, a * e - b * d)
    return [[value / det for value in row] for row in rows]


def times(m, x):
    return [sum(m[i][k] * x[k] for k in range(3)) for i in range(3)]


def formula(shape, names):
    kind, of = shape
    if kind == "box":
        sides = [f"{of[2 * i]}-{names[i]},{names[i]}-{of[2 * i + 1]}" for i in range(3)]
        return "max(" + ",".join(sides) + ")"
    if kind == "union":
        return "min(" + ",".join(formula(part, names) for part in of) + ")"
    return f"max({formula(of[0], names)},-{formula(of[1], names)})"


def squares(shape):
    """The unit squares between inside and outside, their corners counterclockwise from outside."""
    found = []
    reach = range(-1, 8)
    for i in reach:
        for j in reach:
            for k in reach:
                cell = [i, j, k]
                if not inside(shape, [c + 0.5 for c in cell]):
                    continue
                for axis in range(3):
                    for side in (0, 1):
                        other = [c + 0.5 for c in cell]
                        other[axis] += 1 if side else -1
                        if inside(shape, other):
                            continue
                        u, v = (axis + 1) % 3, (axis + 2) % 3
                        corners = []
                        for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                            corner = list(cell)
                            corner[axis] += side
                            corner[u] += du
                            corner[v] += dv
                            corners.append(tuple(corner))
                        found.append(corners if side else corners[::-1])
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("taut")
    parser.add_argument("opponent")
    parser.add_argument("--pairs", type=int, default=100)
    parser.add_argument("--only")
    arguments = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp())
    print("| shape | pairs | refused | longer | shorter | worst difference of the rest | ms a pair |")
    print("|---|---|---|---|---|---|---|")
    for name, (shape, matrix) in SHAPES.items():
        if arguments.only and arguments.only != name:
            continue
        generator = random.Random(name)
        back = inverse(matrix)
        names = []
        for row in back:
            terms = [f"{value:.17g}*{letter}" for value, letter in zip(row, "xyz") if abs(value) > 1e-15]
            names.append("(" + "+".join(terms).replace("+-", "-") + ")")
        if matrix is IDENTITY:
            names = list("xyz")
        faces = squares(shape)
        vertices = sorted({corner for face in faces for corner in face})
        number = {corner: index + 1 for index, corner in enumerate(vertices)}
        mesh = folder / "mesh.obj"
        with mesh.open("w") as out:
            for corner in vertices:
                out.write("v " + " ".join(f"{value:.17g}" for value in times(matrix, corner)) + "\n")
            for face in faces:
                ids = [number[corner] for corner in face]
                out.write(f"f {ids[0]} {ids[1]} {ids[2]}\nf {ids[0]} {ids[2]} {ids[3]}\n")

        def point():
            face = generator.choice(faces)
            u, v = generator.uniform(0.01, 0.99), generator.uniform(0.01, 0.99)
            x = [face[0][i] + u * (face[1][i] - face[0][i]) + v * (face[3][i] - face[0][i]) for i in range(3)]
            return times(matrix, x)

        pairs = folder / "pairs.csv"
        with pairs.open("w") as out:
            for _ in range(arguments.pairs):
                out.write(",".join(f"{value:.17g}" for value in point() + point()) + "\n")
        told = subprocess.run([arguments.opponent, str(mesh), str(pairs)], capture_output=True, text=True, check=True)
        exact = [float(row[0]) for row in csv.reader(told.stdout.splitlines()) if row and row[0][0].isdigit()]
        before = os.times().children_user
        ran = subprocess.run([arguments.taut, "path", formula(shape, names), "--pairs", str(pairs), "--threads", "1"],
                             capture_output=True, text=True)
        seconds = os.times().children_user - before
        refused = longer = shorter = 0
        worst = 0.0
        for row, truth in zip(csv.reader(ran.stdout.splitlines()), exact, strict=True):
            if row[-1] != "ok":
                refused += 1
                continue
            off = (float(row[0]) - truth) / truth
            if off > 1e-9:
                longer += 1
            elif off < -1e-9:
                shorter += 1
            else:
                worst = max(worst, abs(off))
            if abs(off) > 1e-9:
                print("  ", name, row[0], truth, pairs.read_text().splitlines()[exact.index(truth)])
        print(f"| {name} | {len(exact)} | {refused} | {longer} | {shorter} | {worst:.1e} "
              f"| {1e3 * seconds / len(exact):.2f} |", flush=True)


if __name__ == "__main__":
    main()
