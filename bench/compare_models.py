#!/usr/bin/env python3
"""Taut against exact polyhedral geodesics on the meshes of a folder, as a Markdown table.

    compare_models.py --taut build/release/taut --opponent build/bench/bench/opponent_polyhedral FOLDER [NAME ...]

For each mesh (.obj .off .ply .stl; those named, or all) three pairs of its vertices are joined: by `taut path` on the surface
fitted to the vertices, and by the opponent on the mesh itself. Columns: lengths, their relative difference, how far Taut's path
stands off the mesh (largest and mean distance of its points to the triangles, relative
to the length: what fit and mesh differ by), and seconds (wall clock of the whole `taut path`; the opponent's pair alone,
its mesh already read). Nothing is fetched from anywhere.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

SUFFIXES = {".obj", ".off", ".ply", ".stl"}
PAIRS = [(0.05, 0.55), (0.2, 0.8), (0.35, 0.95)]  # places in the file, as fractions of its number of points


def run(command, timeout):
    """Exit code, standard output, standard error, seconds."""
    begin = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)
        return done.returncode, done.stdout, done.stderr, time.monotonic() - begin
    except subprocess.TimeoutExpired:
        return -1, "", f"no answer in {timeout} s", time.monotonic() - begin


def compare(taut, opponent, mesh, arguments, timeout):
    """One table row a pair."""
    code, out, err, _ = run([opponent, mesh, "--count"], timeout)
    if code != 0:
        return [f"| {mesh.stem} | - | {err.strip()} | | | | | |"]
    count = int(out)
    rows = []
    for begin, end in PAIRS:
        i, j = int(begin * count), int(end * count)
        code, out, err, seconds = run([taut, "path", mesh, "--from", f"@{i}", "--to", f"@{j}", "--json", *arguments], timeout)
        try:
            path = json.loads(out)
        except json.JSONDecodeError:
            rows.append(f"| {mesh.stem} | {i}, {j} | exit {code}: {err.strip().splitlines()[-1] if err else ''} | | | | | |")
            continue
        with tempfile.TemporaryDirectory() as folder:
            pairs = pathlib.Path(folder) / "pairs.csv"
            points = pathlib.Path(folder) / "points.csv"
            pairs.write_text(f"@{i},@{j}\n")
            points.write_text("".join(",".join(map(repr, p)) + "\n" for p in path["points"]))
            _, measured, problem, _ = run([opponent, mesh, pairs], timeout)
            _, distances, _, _ = run([opponent, mesh, "--distances", points], timeout)
        if len(measured.splitlines()) < 2:
            rows.append(f"| {mesh.stem} | {i}, {j} | {path['length']:.6g} | {problem.strip()} | | | | |")
            continue
        length, _, _, opponent_seconds = map(float, measured.splitlines()[1].split(","))
        largest, mean = map(float, distances.split(","))
        mark = "" if path.get("converged") else " (not converged)"
        rows.append(
            f"| {mesh.stem} | {i}, {j} | {path['length']:.6g}{mark} | {length:.6g} | {path['length'] / length - 1:+.1e} "
            f"| {largest / length:.1e}, {mean / length:.1e} | {seconds:.2f} | {opponent_seconds:.2f} |")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--taut", required=True, help="the taut program")
    parser.add_argument("--opponent", required=True, help="opponent_polyhedral, built with -DTAUT_BUILD_BENCH=ON")
    parser.add_argument("--timeout", type=float, default=300, help="seconds a program may take (default 300)")
    parser.add_argument("--option", action="append", default=[], help="passed on to `taut path`, repeatable: --option=--cell=0.1")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("names", nargs="*", help="file names or stems in the folder; default: every mesh")
    arguments = parser.parse_args()
    meshes = sorted(p for p in arguments.folder.iterdir() if p.suffix.lower() in SUFFIXES)
    if arguments.names:
        meshes = [p for p in meshes if p.name in arguments.names or p.stem in arguments.names]
    if not meshes:
        sys.exit(f"{arguments.folder}: no meshes")
    print("| model | samples | Taut | polyhedral | difference | path off mesh (max, mean) | Taut s | polyhedral s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for mesh in meshes:
        for row in compare(arguments.taut, arguments.opponent, mesh, arguments.option, arguments.timeout):
            print(row, flush=True)


if __name__ == "__main__":
    main()
