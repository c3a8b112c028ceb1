#!/usr/bin/env python3
"""Effective Young's modulus of lattice shape matching, measured with the pliant command on square bars.

usage: calibrate.py PLIANT [--json FILE] [--only scaling|sections|limits] [--backend B] [--jobs N]

Each bar (N x N cells across, clamped at x = 0, dead load on the end face) settles with damping near the critical one. From its
displacements follow three moduli E, each given as c = E b / (rho d^2 alpha), with d the spacing, H the step, D the damping rate
[1/s] and b = H^2 / (1 + D H / 2):
  pull   strain of the middle third under an axial load
  tip    end deflection under a transverse load, by Timoshenko's beam with nu = 0
  curve  change of curvature over the middle half of the same bar: neither the clamp nor shear is in it
Sets: scaling (alpha, step, spacing), sections (cells across, width), limits (large strain, single precision).
"""
import argparse
import concurrent.futures
import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

WIDTHS = (1, 2, 3, 4, 5)
DENSITY = 1000.0
AREA_FACTOR = 5 / 6  # Timoshenko's, of a rectangle


def expected(width):
    """The bulk limit: the variance of a window of 2 w + 1 nodes, in spacings squared."""
    return width * (width + 1) / 3


class Bar:
    def __init__(self, width, across, mode, alpha=1.0, dt=1 / 60, spacing=0.01, load=1e-4, slender=8, backend="cpu:double"):
        self.width, self.across, self.mode, self.alpha, self.dt, self.spacing = width, across, mode, alpha, dt, spacing
        self.load, self.backend = load, backend
        # The middle third of a pulled bar must lie clear of the regions that reach its ends.
        self.along = slender * across if mode == "bend" else max(4 * across, 6 * (2 * width + 1))
        self.length, self.side = self.along * spacing, across * spacing
        speed = math.sqrt(alpha * expected(width)) * spacing / dt
        slowest = math.pi / 2 / self.length
        if mode == "bend":
            slowest = 3.516 * self.side / math.sqrt(12) / self.length**2
        self.omega = slowest * speed
        self.damping = 2 * self.omega
        self.b = dt**2 / (1 + self.damping * dt / 2)
        self.unit = DENSITY * spacing**2 * alpha / self.b  # modulus at c = 1 [Pa]
        self.young = self.unit * expected(width)
        area, inertia = self.side**2, self.side**4 / 12
        self.flexibility = self.length**3 / (3 * inertia) + self.length / (AREA_FACTOR * 0.5 * area)  # end deflection E / F
        # `load` is the strain of the pulled bar, or the end deflection of the bent one over its length, at c = expected.
        self.force = load * self.young * (area if mode == "pull" else self.length / self.flexibility)

    def name(self):
        return (f"{self.mode} w {self.width} across {self.across} alpha {self.alpha:g} dt {self.dt:.6g} spacing {self.spacing:g} "
                f"load {self.load:g} {self.backend}")

    def write(self, folder):
        size = (self.length, self.side, self.side)
        corners = [[size[c] * (n >> c & 1) for c in range(3)] for n in range(8)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        lines = ["v " + " ".join(f"{x:.17g}" for x in p) for p in corners]
        for a, b, c, d in faces:
            lines += [f"f {a + 1} {b + 1} {c + 1}", f"f {a + 1} {c + 1} {d + 1}"]
        (folder / "bar.obj").write_text("\n".join(lines) + "\n")
        half = self.spacing / 2
        force = [self.force, 0, 0] if self.mode == "pull" else [0, self.force, 0]
        scene = {
            "format": "pliant-scene/1", "gravity": [0, 0, 0], "dt": self.dt,
            "bodies": [{
                "name": "bar", "surface": "bar.obj", "lattice": {"spacing": self.spacing},
                "model": {"type": "flsm", "width": self.width, "alpha": self.alpha},
                "material": {"young": self.young, "poisson": 0, "density": DENSITY, "damping": self.damping},
                "fixed": [{"box": [[-half, -1, -1], [half, 9, 9]]}],
                "forces": [{"box": [[self.length - half, -1, -1], [self.length + half, 9, 9]], "force": force}]}]}
        (folder / "bar.json").write_text(json.dumps(scene))

    def sections(self, points, moved):
        """Mean displacement of each cross-section, by cells from the clamp."""
        component = 0 if self.mode == "pull" else 1
        sums, counts = [0.0] * (self.along + 1), [0] * (self.along + 1)
        for p, u in zip(points, moved):
            at = round((p[0] - u[0]) / self.spacing)
            sums[at] += u[component]
            counts[at] += 1
        if counts != [(self.across + 1)**2] * (self.along + 1):
            raise RuntimeError(f"{self.name()}: the lattice is not {self.along} x {self.across} x {self.across} cells")
        return [s / n for s, n in zip(sums, counts)]

    def moduli(self, u):
        if self.mode == "pull":
            low, high = round(self.along / 3), round(2 * self.along / 3)
            strain = (u[high] - u[low]) / ((high - low) * self.spacing)
            return {"pull": self.force / self.side**2 / strain, "strain": strain, "ends": u[-1] / strain / self.spacing - self.along}
        quarter, sixth = round(self.along / 4), round(self.along / 6)
        a, b, c, d = (u[quarter + i * sixth] for i in range(4))
        third = (a - 3 * b + 3 * c - d) / (sixth * self.spacing)**3  # -u''' = F / (E I)
        inertia = self.side**4 / 12
        return {"tip": self.force * self.flexibility / u[-1], "curve": self.force / inertia / third, "deflection": u[-1] / self.length}


def read_frame(file):
    """Points and displacements of a .vtu file as pliant writes it."""
    data = file.read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[:start].decode()

    def array(name):
        tag = head[head.index(f'Name="{name}"'):]
        at = start + int(tag[tag.index('offset="') + 8:].split('"')[0])
        size, = struct.unpack_from("<Q", data, at)
        flat = struct.unpack_from(f"<{size // 4}f", data, at + 8)
        return list(zip(*[iter(flat)] * 3))

    return array("Points"), array("displacement")


def measure(pliant, bar):
    steps = math.ceil(30 / (bar.omega * bar.dt))  # a bar half as stiff as expected, and so overdamped, is at rest by then too
    every = math.ceil(steps / 10)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bar.write(folder)
        done = subprocess.run([pliant, "run", str(folder / "bar.json"), "--backend", bar.backend, "--steps", str(10 * every), "--quiet",
                               "--out", str(folder / "out"), "--every", str(every), "--format", "vtu"],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{bar.name()}: {done.stderr.strip()}")
        frames = sorted((folder / "out").glob("bar_0*.vtu"))[-2:]
        before, after = (bar.sections(*read_frame(f)) for f in frames)
    row = {"width": bar.width, "across": bar.across, "along": bar.along, "mode": bar.mode, "alpha": bar.alpha, "dt": bar.dt,
           "spacing": bar.spacing, "damping": bar.damping, "load": bar.load, "backend": bar.backend, "steps": 10 * every,
           "unrest": abs(after[-1] / before[-1] - 1)}
    for key, value in bar.moduli(after).items():
        row[key] = value / bar.unit if key in ("pull", "tip", "curve") else value
    if row["unrest"] > 2e-3:
        print(f"{bar.name()}: not at rest, the end still moved by {row['unrest']:.1e} of its way", file=sys.stderr)
    return row


def scaling_bars():
    """One bar of each width; alpha, step and spacing all vary."""
    for width in WIDTHS:
        for mode in ("pull", "bend"):
            for alpha in (0.1, 0.3, 0.5, 0.8, 1.0):
                for dt in (1 / 60, 1 / 1000):
                    for spacing in (0.01, 0.0025):
                        yield Bar(width, 4, mode, alpha, dt, spacing)


def section_bars():
    for width in WIDTHS:
        for across in (4, 8, 12):
            for mode in ("pull", "bend"):
                yield Bar(width, across, mode)


def limit_bars():
    for width in WIDTHS:
        for strain in (-0.2, 0.1, 0.5, 1.0):  # pushed far beyond Euler's load, a slender bar buckles
            yield Bar(width, 4, "pull", load=strain)
        for deflection in (0.1, 0.3):
            yield Bar(width, 4, "bend", load=deflection)
        yield Bar(width, 4, "pull", load=0.01, backend="cpu")
        yield Bar(width, 4, "bend", load=0.01, backend="cpu")


SETS = {"scaling": scaling_bars, "sections": section_bars, "limits": limit_bars}


def spread(values):
    return f"{min(values):.4f} to {max(values):.4f}"


def show_scaling(rows):
    print("\nc over alpha 0.1 to 1, steps 1/60 s and 1/1000 s, spacings 10 and 2.5 mm; bars of 4 x 4 cells")
    print("| w | w(w+1)/3 | pull | tip | curve |\n|---|---|---|---|---|")
    for w in WIDTHS:
        of = {k: [r[k] for r in rows if r["width"] == w and k in r] for k in ("pull", "tip", "curve")}
        print(f"| {w} | {expected(w):.4f} | " + " | ".join(spread(of[k]) for k in of) + " |")


def show_sections(rows):
    sizes = sorted({r["across"] for r in rows})
    print("\nc by cells across (alpha 1)")
    print("| w | w(w+1)/3 | " + " | ".join(f"{k} {n}" for k in ("pull", "tip", "curve") for n in sizes) + " | spread |")
    print("|---" * (3 + 3 * len(sizes)) + "|")
    for w in WIDTHS:
        values = [next(r[k] for r in rows if r["width"] == w and r["across"] == n and k in r)
                  for k in ("pull", "tip", "curve") for n in sizes]
        print(f"| {w} | {expected(w):.4f} | " + " | ".join(f"{v:.3f}" for v in values) + f" | {max(values) / min(values):.2f} |")


def show_limits(rows):
    print("\nc at large loads and in single precision (4 x 4 cells)")
    print("| w | mode | backend | load | strain or deflection / L | c (pull or tip) | over w(w+1)/3 |\n|---|---|---|---|---|---|---|")
    for r in rows:
        c = r.get("pull", r.get("tip"))
        print(f"| {r['width']} | {r['mode']} | {r['backend']} | {r['load']:g} | {r.get('strain', r.get('deflection')):.4g} | {c:.4f} | "
              f"{c / expected(r['width']):.4f} |")


SHOW = {"scaling": show_scaling, "sections": show_sections, "limits": show_limits}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pliant", help="path of the pliant command")
    parser.add_argument("--json", type=Path, help="write every measurement to this file")
    parser.add_argument("--only", choices=SETS, help="one set instead of all")
    parser.add_argument("--backend", help="measure the sets scaling and sections on this backend (default: cpu:double)")
    parser.add_argument("--jobs", type=int, default=1, help="bars measured at the same time")
    arguments = parser.parse_args()
    results = {}
    for name in [arguments.only] if arguments.only else SETS:
        bars = list(SETS[name]())
        for bar in bars:
            if arguments.backend and name != "limits":
                bar.backend = arguments.backend
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            results[name] = list(pool.map(lambda bar: measure(arguments.pliant, bar), bars))
        print(f"\n{name}: {len(bars)} bars, largest motion left {max(r['unrest'] for r in results[name]):.1e}")
        SHOW[name](results[name])
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, OSError) as e:
        print(f"calibrate: {e}", file=sys.stderr)
        sys.exit(2)
