#!/usr/bin/env python3
"""Every scan and mesh of some folders at full resolution, as Markdown tables.

    scan_table.py --taut build/release/taut --work FOLDER [--shapes] FILE ...

One row a file: `taut fit` to a model, `taut info` on it, a first path between two random samples, a batch of further
pairs, a field, a mesh. Columns: points; seconds of the fit; how far the surface stands off the samples (rms, most);
components and Euler number as `taut info` counts them and as the triangles of the file say; seconds of the first path
(the model read, cells, march, correction); milliseconds of a further pair (a batch, its cells included, by the pair);
seconds of the field from one sample and of the display mesh; the most memory the fit took. Seconds are of the
processor, all threads together, by the operating system. With --shapes the fit and the counts alone.

Every command is stopped after --limit seconds of the clock, and the table says so.
"""

import argparse
import json
import os
import pathlib
import random
import re
import resource
import struct
import subprocess
import sys


def run(command, limit):
    """Exit code, standard output, standard error, seconds of the processor, megabytes at most."""

    def bounded():
        resource.setrlimit(resource.RLIMIT_CPU, (2 * limit, 2 * limit))

    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=bounded)
    try:
        out, err = child.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        child.kill()
        child.communicate()
        return None, "", f"none in {limit} s", float(limit)
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    return child.returncode, out, err, end.ru_utime - begin.ru_utime + end.ru_stime - begin.ru_stime


# --- the triangles of a file -----------------------------------------------------------------------------------------


def read_obj(path):
    points, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return points, faces


def read_off(path):
    words = path.read_text().split()
    n, m = int(words[1]), int(words[2])
    numbers = words[4:]
    points = [tuple(map(float, numbers[3 * i : 3 * i + 3])) for i in range(n)]
    faces, at = [], 3 * n
    for _ in range(m):
        count = int(numbers[at])
        faces.append([int(word) for word in numbers[at + 1 : at + 1 + count]])
        at += 1 + count
    return points, faces


def read_ply(path):
    """Binary, little-endian, with triangles: what the one mesh of this kind here is. Else no faces."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    lines = header.decode(errors="replace").splitlines()
    if "format binary_little_endian 1.0" not in lines or not any(line.startswith("element face") for line in lines):
        return [], []
    elements, sizes = {}, {"float": 4, "float32": 4, "double": 8, "uchar": 1, "int": 4, "uint": 4, "short": 2}
    name = ""
    for line in lines:
        words = line.split()
        if words[:1] == ["element"]:
            name = words[1]
            elements[name] = [int(words[2]), 0]
        elif words[:1] == ["property"] and words[1] != "list":
            elements[name][1] += sizes[words[1]]
    (n, stride), (m, _) = elements["vertex"], elements["face"]
    points = [struct.unpack_from("<3f", body, stride * i) for i in range(n)]
    faces, at = [], stride * n
    for _ in range(m):
        count = body[at]
        faces.append(list(struct.unpack_from(f"<{count}i", body, at + 1)))
        at += 1 + 4 * count
    return points, faces


def read_vtk(path):
    """Legacy text with polygons or triangle strips."""
    words = path.read_text().split()
    at = words.index("POINTS")
    n = int(words[at + 1])
    points = [tuple(map(float, words[at + 3 + 3 * i : at + 6 + 3 * i])) for i in range(n)]
    faces = []
    for kind in ("POLYGONS", "TRIANGLE_STRIPS"):
        if kind not in words:
            continue
        at = words.index(kind)
        count, at = int(words[at + 1]), at + 3
        for _ in range(count):
            size = int(words[at])
            row = [int(word) for word in words[at + 1 : at + 1 + size]]
            at += 1 + size
            faces += [row] if kind == "POLYGONS" else [row[i : i + 3] for i in range(size - 2)]
    return points, faces


READERS = {".obj": read_obj, ".off": read_off, ".ply": read_ply, ".vtk": read_vtk}


def shape_of_mesh(path):
    """(components, Euler number, boundary loops) of the triangles, vertices in the same place being one; None without
    triangles. Vertices that no triangle names do not count."""
    points, faces = READERS.get(path.suffix, lambda _: ([], []))(path)
    if not faces:
        return None
    place = {}
    first = [place.setdefault(point, i) for i, point in enumerate(points)]
    triangles = set()
    for face in faces:
        corners = [first[i] for i in face]
        for i in range(1, len(corners) - 1):
            corner = (corners[0], corners[i], corners[i + 1])
            if len(set(corner)) == 3:
                triangles.add(frozenset(corner))
    edges, above = {}, {}

    def root(tree, i):
        while tree.setdefault(i, i) != i:
            tree[i] = tree[tree[i]]
            i = tree[i]
        return i

    for triangle in triangles:
        a, b, c = sorted(triangle)
        for edge in ((a, b), (b, c), (a, c)):
            edges[edge] = edges.get(edge, 0) + 1
            above[root(above, edge[0])] = root(above, edge[1])
    vertices = {i for triangle in triangles for i in triangle}
    rims = {}
    for (a, b), count in edges.items():
        if count == 1:
            rims[root(rims, a)] = root(rims, b)
    components = len({root(above, i) for i in vertices})
    loops = len({root(rims, i) for i in list(rims)})
    return components, len(vertices) - len(edges) + len(triangles), loops


# --- a row -----------------------------------------------------------------------------------------------------------


def row_of(path, options):
    taut, limit, model = options.taut, options.limit, options.work / (path.stem + ".taut")
    code, out, err, fit_seconds = run([taut, "fit", path, "--out", model], limit)
    if code != 0:
        return f"| `{path.name}` | {(err.strip().splitlines() or ['failed'])[-1]} |"
    points = int(re.search(r"^samples\s+([\d,]+)", out, re.M).group(1).replace(",", ""))
    rms, most = re.search(r"stands (\S+) \(rms\) off the samples, (\S+) \(most\)", out).groups()
    cells = [f"`{path.name}`", f"{points:,}", f"{fit_seconds:.2f}", f"{rms}, {most}"]

    code, out, err, info_seconds = run([taut, "info", model, "--json"], limit)
    if code == 0:
        info = json.loads(out)
        open_or_closed = "closed" if info.get("closed") else "open"
        settled = "" if info.get("shape_settled") else ", not settled"
        cells.append(f"{len(info['components'])}, {info.get('euler', '')} {open_or_closed}{settled}")
    else:
        cells.append(err.strip().splitlines()[-1] if err.strip() else "failed")
    mesh = shape_of_mesh(path)
    cells.append(f"{mesh[0]}, {mesh[1]} " + ("closed" if mesh[2] == 0 else f"open, {mesh[2]} loops") if mesh else "")
    if options.shapes:
        return "| " + " | ".join(cells) + " |"

    chance = random.Random(7)
    pairs = [(chance.randrange(points), chance.randrange(points)) for _ in range(options.pairs)]
    i, j = pairs[0]
    code, out, err, seconds = run([taut, "path", model, "--from", f"@{i}", "--to", f"@{j}", "--json"], limit)
    status = json.loads(out)["status"] if out.startswith("{") else (err.strip() or "failed")
    cells.append(f"{seconds:.2f}" + ("" if status == "ok" else f" ({status})"))

    listed = options.work / "pairs.csv"
    listed.write_text("".join(f"@{i},@{j}\n" for i, j in pairs))
    code, out, err, seconds = run([taut, "path", model, "--pairs", listed], limit)
    rows = out.strip().splitlines()
    found = sum(",ok," in row or row.endswith(",ok") or row.startswith("ok,") for row in rows)
    cells.append(f"{1000 * seconds / len(pairs):.1f}, {found} of {len(pairs)} ok" if rows else err.strip()[-40:])

    picture = options.work / (path.stem + ".html")
    code, out, err, seconds = run([taut, "field", model, "--from", f"@{i}", "--out", picture], limit)
    cells.append(f"{seconds:.1f}" + ("" if code == 0 else f" (exit {code})"))
    code, out, err, seconds = run([taut, "mesh", model, "--out", options.work / (path.stem + ".ply")], limit)
    cells.append(f"{seconds:.1f}" + ("" if code == 0 else f" (exit {code})"))
    cells.append(f"{memory_of([taut, 'fit', path, '--out', model], limit):.0f}")
    return "| " + " | ".join(cells) + " |"


def memory_of(command, limit):
    """The most megabytes one run takes, in a process of its own: the maximum over children does not go down again."""
    code = (
        "import resource, subprocess, sys; subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, "
        "stderr=subprocess.DEVNULL); print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
    )
    whole = [sys.executable, "-c", code, *map(str, command)]
    done = subprocess.run(whole, capture_output=True, text=True, timeout=limit, check=False)
    return int(done.stdout) / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--taut", required=True, type=pathlib.Path)
    parser.add_argument("--work", required=True, type=pathlib.Path, help="a folder for models and pictures")
    parser.add_argument("--shapes", action="store_true", help="fits and their components and Euler numbers only")
    parser.add_argument("--pairs", type=int, default=100, help="random pairs for the column of further pairs")
    parser.add_argument("--limit", type=int, default=120, help="seconds that one command may take")
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    names = ["model", "points", "fit, s", "residual: rms, most", "components, Euler number", "the mesh's"]
    if not options.shapes:
        names += ["first path, s", "a further pair, ms", "field, s", "mesh, s", "memory of the fit, MB"]
    print("| " + " | ".join(names) + " |\n|" + "---|" * len(names), flush=True)
    for path in options.files:
        print(row_of(path, options), flush=True)
    return os.EX_OK


if __name__ == "__main__":
    sys.exit(main())
