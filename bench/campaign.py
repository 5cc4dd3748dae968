#!/usr/bin/env python3
"""Random pairs on hard smooth surfaces, each answer of `taut path` checked by brute force, as a Markdown table.

    campaign.py --taut build/release/taut --judge build/bench/bench/judge_rays [--sources 5] [--targets 100]
                [--seed 1] [NAME ...]

Ends are random vertices of `taut mesh`. The judge (bench/judge_rays.cpp) follows rays from each source in all
directions and shares nothing with the search but the formula. A pair is a silent miss where rays find a way that is
shorter by more than 1e-7 and the answer has no doubt (`--unique` says true or false), and a doubted one where it has.
"Judge longer": rays found a longer way only, the judge's own misses. Nothing is fetched from anywhere.
"""

import argparse
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time

# name: formula, box in which ends are taken (of surfaces without end)
SURFACES = {
    # fillets
    "bar": ("(x/2)^14+y^14+(z/0.7)^14=1", None),
    "can": ("(x^2+y^2)^10+z^20=1", None),
    "brick": ("x^12+(y/0.5)^8+(z/0.3)^12=1", None),
    "dice": ("(x^4+y^4)^2+z^8=1", None),
    # bumps
    "horns": ("x^2+y^2+z^2=1+0.5*exp(-20*((x-1)^2+y^2+z^2))+0.5*exp(-20*((y-1)^2+x^2+z^2))", None),
    "ripples": ("x^2+y^2+z^2=1+0.15*cos(9x)*cos(9y)", None),
    "dents": ("x^2+y^2+z^2=1-0.3*exp(-30*((x-1)^2+y^2+z^2))-0.3*exp(-30*(x^2+y^2+(z-1)^2))", None),
    "beads": ("(sqrt(x^2+y^2)-1.5)^2+z^2=0.12+0.1*cos(12*atan2(y,x))", None),
    "star": ("(sqrt(x^2+y^2)-2)^2+z^2=0.4+0.15*cos(7*atan2(y,x))", None),
    # thin parts
    "sheet": ("x^4+y^4+(z/0.05)^2=1", None),
    "blade": ("x^2+(y/0.6)^2+(z/0.04)^2=1", None),
    "needle": ("(x/6)^2+(y/0.3)^2+(z/0.3)^2=1", None),
    "bowl": ("40*(sqrt(x^2+y^2+z^2)-1)^2+exp(4*z-1)=1", None),
    "spindle": ("(x^2+y^2)*(1+30*z^2)+z^2/4=1", None),
    # necks
    "neck": ("y^2+z^2=0.01+0.5*x^2*(1-x^2)", None),
    "lobes": ("exp(-6*((x-0.7)^2+y^2+z^2))+exp(-6*((x+0.7)^2+y^2+z^2))+exp(-6*(x^2+(y-1.1)^2+z^2))=0.3", None),
    "hourglass": ("x^2+y^2=(z^2+0.05)*(1.5-z^2)", "-1.2,1.2"),
    "hyperboloid": ("x^2+2*y^2=z^2+0.02", "-1.5,1.5"),
    "crossing": ("(x^2+y^2-0.04)*(y^2+z^2-0.04)=0.0005", "-1.2,1.2"),
    # flat discs
    "coin": ("(x^2+y^2)^3+(z/0.07)^2=1", None),
    "ellipse": ("x^2+4*y^2+(z/0.06)^2=1", None),
    "lens": ("smooth_intersection(sphere(0,0,-0.9,1), sphere(0,0,0.9,1), 0.05)", None),
    "pancake": ("x^2+y^2+(z/0.1)^4=1+0.3*x*y", None),
    # high genus
    "two_holes": ("(x^2*(1-x^2)-y^2)^2+0.5*z^2=0.01", None),
    "double_torus": ("(x*(x-1)^2*(x-2)+y^2)^2+z^2=0.01", None),
    "cage": ("8*x^4-8*x^2+8*y^4-8*y^2+8*z^4-8*z^2+2.5=0", None),
    "primitive": ("cos(3x)+cos(3y)+cos(3z)=0", "-1.6,1.6"),
    "diamond": ("sin(2x)*sin(2y)*sin(2z)+sin(2x)*cos(2y)*cos(2z)+cos(2x)*sin(2y)*cos(2z)+cos(2x)*cos(2y)*sin(2z)=0",
                "-1.6,1.6"),
    "rings": ("((sqrt(x^2+y^2)-1)^2+z^2-0.05)*((sqrt((x-1)^2+z^2)-1)^2+y^2-0.05)=0.002", None),
    "deco": ("((x^2+y^2-0.7)^2+(z^2-0.8)^2)*((y^2+z^2-0.7)^2+(x^2-0.8)^2)*((z^2+x^2-0.7)^2+(y^2-0.8)^2)=0.03", None),
    # bodies with smooth joins
    "ring_and_ball": ("smooth_union(torus(0,0,0,1,0.3), sphere(1,0,0,0.5), 0.1)", None),
    "bitten": ("smooth_difference(sphere(0,0,0,1), sphere(0.9,0,0,0.5), 0.08)", None),
    "grooved": ("smooth_difference(sphere(0,0,0,1), torus(0,0,0,1,0.25), 0.05)", None),
    "two_balls": ("smooth_union(sphere(-0.8,0,0,0.6), sphere(0.8,0,0,0.6), 0.3)", None),
    "trimmed_ring": ("smooth_intersection(sphere(0,0,0,1), torus(0,0,0,0.8,0.5), 0.1)", None),
    # graphs and others
    "hills": ("z=0.3*sin(4x)+0.2*cos(5y)", "-1.3,1.3"),
    "dipole": ("z=exp(-6*(x^2+y^2))-exp(-6*((x-0.8)^2+y^2))", "-1.2,1.2"),
    "steps": ("z=0.3*tanh(15*x*y)", "-1,1"),
    "coil": ("(x-0.8*cos(4z))^2+(y-0.8*sin(4z))^2=0.06", "-1.5,1.5"),
    "heart": ("(2*x^2+y^2+z^2-1)^3-(0.1*x^2+y^2)*z^3=0.005", None),
    "egg": ("x^2+y^2*(1+0.5*x)+z^2*(1-0.3*x)+0.1*(x^4+y^4+z^4)=1", None),
}
MISS = 1e-7  # relative: much more than the errors of both


def call(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    return done.stdout.splitlines(), done.stderr.strip()


def campaign(name, options, folder):
    """The row of one surface."""
    formula, box = SURFACES[name]
    mesh, claims = folder / "mesh.obj", folder / "claims.csv"
    _, err = call([options.taut, "mesh", formula, "--out", mesh, "-q", *(["--box", box] if box else [])])
    vertices = [line.split()[1:4] for line in mesh.read_text().splitlines() if line.startswith("v ")]
    if not vertices:
        return f"| {name} | {err} |"
    draw = random.Random(f"{options.seed} {name}")
    pairs = []
    for _ in range(options.sources):
        source = draw.choice(vertices)
        pairs += [source + target for target in draw.choices(vertices, k=options.targets)]
    claims.write_text("".join(",".join(pair) + "\n" for pair in pairs))
    begin = time.monotonic()
    rows, err = call([options.taut, "path", formula, "--pairs", claims, "--header", "--unique", "-q"])
    seconds = time.monotonic() - begin
    if len(rows) != len(pairs) + 1:
        return f"| {name} | {err} |"
    header = rows[0].split(",")
    answers = [dict(zip(header, row.split(","))) for row in rows[1:]]
    lengths = [answer["length"] if answer["status"] == "ok" else "nan" for answer in answers]
    # An end may be in question where there is no answer: the judge takes some length.
    known = [length for length in lengths if length != "nan"]
    claims.write_text("".join(",".join(pair) + "," + (length if length != "nan" else max(known, key=float)) + "\n"
                              for pair, length in zip(pairs, lengths)))
    begin = time.monotonic()
    lines, err = call([options.judge, formula, claims])
    judge_seconds = time.monotonic() - begin
    if err:
        return f"| {name} | {err} |"
    spent = sum("spent" in line for line in lines if line.startswith("#"))
    judged = [float(line.split(",")[1]) for line in lines if not line.startswith("#")]
    count = dict.fromkeys(("none", "doubt", "silent", "doubted", "longer", "unjudged"), 0)
    worst = 0.0
    for pair, answer, length, rays in zip(pairs, answers, map(float, lengths), judged):
        doubt = answer["unique"] not in ("true", "false", "1", "0")
        count["none"] += math.isnan(length)
        count["doubt"] += doubt
        if math.isnan(length) or pair[:3] == pair[3:]:
            continue
        if math.isnan(rays):
            count["unjudged"] += 1
            continue
        excess = length / rays - 1
        if excess > MISS:
            count["doubted" if doubt else "silent"] += 1
            print(f"{name}: {','.join(pair)}: {length:.12g}, rays {rays:.12g}, {'doubt' if doubt else 'SILENT'}",
                  file=sys.stderr, flush=True)
        elif excess < -MISS:
            count["longer"] += 1
        else:
            worst = max(worst, abs(excess))
    return (f"| {name} | {len(pairs)} | {count['none']} | {count['doubt']} | {count['silent']} | {count['doubted']} | "
            f"{count['longer']} | {count['unjudged']} | {worst:.1e} | {seconds:.1f} | {judge_seconds:.0f} | {spent} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--taut", type=pathlib.Path, required=True)
    parser.add_argument("--judge", type=pathlib.Path, required=True)
    parser.add_argument("--sources", type=int, default=5)
    parser.add_argument("--targets", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(SURFACES))
    options = parser.parse_args()
    print("| surface | pairs | no answer | in doubt | silent misses | doubted misses | judge longer | not judged | "
          "largest difference | path s | judge s | budget spent |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names or SURFACES:
            print(campaign(name, options, pathlib.Path(folder)), flush=True)


if __name__ == "__main__":
    main()
