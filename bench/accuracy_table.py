#!/usr/bin/env python3
"""Time against accuracy for one pair of points: Taut, GeographicLib, and meshes of the same surface, in one run.

    accuracy_table.py BUILD [--plot FILE.svg] [--pairs N] [--large-pairs N]
    accuracy_table.py BUILD --program

BUILD: a build folder of the preset `bench`. Prints a Markdown table: per surface and method the time to prepare (cells and
table; mesh; factorization), the median time a pair, and the median relative error. Meshes are Taut's own, with vertices exactly on
the surface, and their pairs are vertices, so that nothing but the mesh itself is to blame; their truth is `taut path --tol 1e-13`.
Exact polyhedral distances at 500,000 triangles take minutes each: they come last, and of fewer pairs (--large-pairs, 0 leaves them
out).
"""

import argparse
import csv
import io
import math
import pathlib
import statistics
import subprocess
import tempfile
import time

FORMULAS = {
    "ellipsoid": ("x^2+y^2+4z^2=1", {"5k": 0.07, "50k": 0.0225, "500k": 0.0071}),
    "torus": ("(x^2+y^2+z^2+1-0.16)^2=4*(x^2+y^2)", {"5k": 0.094, "50k": 0.03, "500k": 0.0094}),
    "tanglecube": ("x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8=0", {"5k": 0.27, "50k": 0.09, "500k": 0.028}),
}
COLD_PAIRS = {  # far apart
    "ellipsoid": ("1,0,0", "-0.5,0.5,0.35"), "torus": ("1.4,0,0", "-1,0,0.4"), "tanglecube": ("1.6,1.6,1.6", "-1.6,-1.6,-1.6"),
}
COLOURS = {"taut path": "#c0392b", "taut correction": "#e59866", "GeographicLib": "#2e86c1",
           "polyhedral": "#27ae60", "heat": "#7d3c98"}


def output(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=True).stdout


class Mesh:
    """A surface's mesh of one size, and the pairs of its vertices that the opponents are asked about."""

    def __init__(self, build, surface, size, pairs_file, count, folder):
        formula, cells = FORMULAS[surface]
        self.build, self.surface = build, surface
        self.file = folder / f"{surface}_{size}.obj"
        begin = time.monotonic()
        output(build / "taut", "mesh", formula, "--cell", cells[size], "--out", self.file, "--quiet")
        self.meshing = time.monotonic() - begin
        with self.file.open() as lines:
            self.triangles = sum(line.startswith("f ") for line in lines)
        lines = output(build / "bench/opponent_heat", self.file, pairs_file, count).splitlines()
        self.factorizing = float(lines[0])
        fields = [[float(x) for x in line.split(",")] for line in lines[1:]]
        self.fields = [f for f in fields if f[:3] != f[3:6]]
        self.ends = self.file.with_suffix(".csv")
        self.ends.write_text("".join(",".join(repr(x) for x in f[:6]) + "\n" for f in self.fields))
        self.truth = [float(line.split(",")[0]) for line in
                      output(build / "taut", "path", formula, "--pairs", self.ends, "--tol", "1e-13", "--quiet").splitlines()]

    def row(self, method, prepare, lengths, seconds):
        error = statistics.median(abs(length / truth - 1) for length, truth in zip(lengths, self.truth))
        return (self.surface, method, f"{self.triangles:,}", prepare, 1e6 * statistics.median(seconds), error)

    def heat(self):
        return self.row("heat", self.meshing + self.factorizing, [f[6] for f in self.fields], [f[7] for f in self.fields])

    def polyhedral(self, count):
        lines = self.ends.read_text().splitlines(keepends=True)
        self.ends.write_text("".join(lines[:count]))
        try:
            lines = output(self.build / "bench/opponent_polyhedral", self.file, self.ends)
        except subprocess.CalledProcessError:  # killed: some 20 GiB are not enough for every pair at 500,000 triangles
            return (self.surface, "polyhedral", f"{self.triangles:,}", self.meshing, math.nan, math.nan)
        exact = list(csv.DictReader(io.StringIO(lines)))
        return self.row("polyhedral", self.meshing, [float(e["length"]) for e in exact], [float(e["seconds"]) for e in exact])


def plot(rows, file):
    """Error against time, both logarithmic, a panel a surface."""
    width, height, left, top = 300, 260, 60, 40
    surfaces = list(FORMULAS)
    x_of = lambda us: left + (math.log10(us) - 0) / 7 * (width - left - 20)
    y_of = lambda e: top + (-math.log10(max(e, 1e-16))) / 16 * (height - top - 40)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * len(surfaces)}" height="{height + 30}" '
           'font-family="sans-serif" font-size="10">', '<rect width="100%" height="100%" fill="white"/>']
    for panel, surface in enumerate(surfaces):
        out.append(f'<g transform="translate({panel * width},0)"><text x="{left}" y="20" font-size="12">{surface}</text>')
        for power in range(0, 8):
            x = x_of(10**power)
            out.append(f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{height - 40}" stroke="#eee"/>')
            label = {0: "1 us", 3: "1 ms", 6: "1 s"}.get(power, "")
            out.append(f'<text x="{x:.1f}" y="{height - 26}" text-anchor="middle">{label}</text>')
        for power in range(0, 17, 4):
            y = y_of(10.0**-power)
            out.append(f'<line x1="{left}" y1="{y:.1f}" x2="{width - 20}" y2="{y:.1f}" stroke="#eee"/>')
            out.append(f'<text x="{left - 6}" y="{y + 3:.1f}" text-anchor="end">1e-{power}</text>')
        for name, colour in COLOURS.items():
            points = [(x_of(us), y_of(error)) for s, method, _, _, us, error in rows if s == surface and method.startswith(name) and not math.isnan(us)]
            if not points:
                continue
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
            out.append(f'<polyline points="{path}" fill="none" stroke="{colour}"/>')
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>' for x, y in points]
        out.append("</g>")
    for i, (name, colour) in enumerate(COLOURS.items()):
        x = left + i * 150
        out.append(f'<circle cx="{x}" cy="{height + 8}" r="4" fill="{colour}"/><text x="{x + 10}" y="{height + 12}">{name}</text>')
    out.append("</svg>")
    file.write_text("\n".join(out) + "\n")


def program_table(build, folder):
    """The program as a whole: one pair from the command line, and a batch of 4,000 on one core."""
    print("\n| surface | one pair from the command line, ms of wall time | batch, pairs a second on one core |\n|---|---|---|")
    for surface, (formula, _) in FORMULAS.items():
        start, end = COLD_PAIRS[surface]
        times = []
        for _ in range(30):
            begin = time.monotonic()
            output(build / "taut", "path", formula, f"--from={start}", f"--to={end}", "--json")
            times.append(time.monotonic() - begin)
        batch = folder / "batch.csv"
        lines = (folder / f"{surface}.csv").read_text().splitlines()
        batch.write_text("".join(",".join(line.split(",")[:6]) + "\n" for line in lines) * 10)
        begin = time.monotonic()
        answers = output(build / "taut", "path", formula, "--pairs", batch, "--threads", "1", "--quiet").splitlines()
        print(f"| {surface} | {1e3 * statistics.median(times):.1f} | {len(answers) / (time.monotonic() - begin):,.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--plot", type=pathlib.Path)
    parser.add_argument("--pairs", type=int, default=10, help="pairs for the opponents on meshes")
    parser.add_argument("--large-pairs", type=int, default=1, help="pairs for exact polyhedral distances at 500,000 triangles")
    parser.add_argument("--program", action="store_true", help="the time of the program as a whole instead")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        table = csv.DictReader(io.StringIO(output(arguments.build / "bench/bench_path", "--pairs", folder)))
        for row in table:
            rows.append((row["surface"], row["method"], row["setting"], float(row["prepare_s"]), float(row["us"]),
                         float(row["median_error"])))
        if arguments.program:
            program_table(arguments.build, folder)
            return
        meshes = [Mesh(arguments.build, surface, size, folder / f"{surface}.csv", arguments.pairs, folder)
                  for surface in FORMULAS for size in FORMULAS[surface][1]]
        rows += [mesh.heat() for mesh in meshes]
        for mesh in sorted(meshes, key=lambda m: m.triangles):
            pairs = arguments.large_pairs if mesh.triangles > 200_000 else arguments.pairs
            if pairs > 0:
                rows.append(mesh.polyhedral(pairs))
    # By surface and method; the mesh methods' rows by size, as they come.
    place = lambda row: (list(FORMULAS).index(row[0]), row[1] in ("heat", "polyhedral"), row[1] == "polyhedral")
    print("| surface | method | setting or triangles | to prepare, s | a pair, us | median error |\n|---|---|---|---|---|---|")
    for surface, method, setting, prepare, us, error in sorted(rows, key=place):
        answer = "out of memory | -" if math.isnan(us) else f"{us:.3g} | {error:.1e}"
        print(f"| {surface} | {method} | {setting} | {prepare:.2g} | {answer} |")
    if arguments.plot:
        plot(rows, arguments.plot)


if __name__ == "__main__":
    main()
