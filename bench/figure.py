#!/usr/bin/env python3
"""The pictures of docs/images, from the shipped scenes: python3 bench/figure.py PLIANT [--out DIR] [--only NAME,...] [--quick]

  parameters  a figure of the Hybrid Deformation Model: rows ratio 0.7 and 0.3; columns the parts of the body, stiff (lambda = mu =
              200000 Pa, alpha = 0.8) and soft (20000 Pa, 0.5), under the same force
  bunny       four moments of scenes/bunny.json
  liver       four moments of scenes/liver.json, coloured by von Mises stress
  cut         four moments of scenes/cut_liver.json: at rest, stretched, half cut, cut through
  grasp       four moments of scenes/grasp.json: at rest, cut, grasped, lifted
  hands       the first picture of README.md: the flap of scenes/grasp.json held open; a probe over the tumour of scenes/palpate.json, and its force
  parts       who computes what in scenes/bunny_hybrid.json and liver_hybrid.json
  tumour      scenes/palpate_tumour.json: a press, and the map of the forces at all places
  methods     one cut through the same tetrahedra by removal, decomposition and virtual nodes (`pliant bench cutting`), with one camera

  forces      blades that press before they cut, and forceps: a moment of scenes/incise.json, stroke.json and dissect.json each, and the forces
              over time

and some moments each of the scenes bunny_settings, cut_bunny_hybrid, cut_shell, fold, needle and skin_on_bone, by these names

Pictures are traced at twice their size and scaled down, and saved with 256 colours so that they stay small.
"""
import argparse
import csv
import io
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parent.parent
SCENES = ROOT / "scenes"
INK = (40, 43, 51)
PAPER = (255, 255, 255)
ROWS = {  # moments [s] of scenes that have a row of pictures
    "bunny_settings": (0.6, 1.2, 1.8, 2.4),
    "cut_bunny_hybrid": (0.2, 0.6, 1.2),
    "cut_shell": (0.4, 1.0, 1.7),
    "fold": (0.3, 0.6, 1.4),
    "needle": (0, 0.2, 0.8),
    "skin_on_bone": (0, 0.4, 1),
}
KNOWN = ("parameters", "bunny", "liver", "cut", "grasp", "hands", "parts", "tumour", "methods", "forces", *ROWS)


def font(size):
    try:
        import matplotlib.font_manager as manager

        return ImageFont.truetype(manager.findfont("DejaVu Sans"), size)
    except ImportError:
        return ImageFont.load_default()


def load(name):
    """A shipped scene whose mesh paths hold anywhere."""
    scene = json.loads((SCENES / f"{name}.json").read_text())
    for body in scene["bodies"]:
        for key in {"surface", "mesh"} & body.keys():
            body[key] = str((SCENES / body[key]).resolve())
    return scene


class Maker:
    def __init__(self, pliant, out, quick):
        self.pliant, self.out, self.quick = pliant, out, quick

    def frames(self, scene, size, seconds, every=10**9, extra=()):
        """Pictures of a run at step 0, every so many steps (or so much time, in words), and at its end, scaled to `size`."""
        factor, samples = (1, 2) if self.quick else (2, 8)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.json"
            file.write_text(json.dumps(scene))
            subprocess.run(
                [self.pliant, "run", file, "--quiet", "--out", Path(folder) / "out", "--format", "png", "--seconds", str(seconds),
                 "--every", str(every), "--size", f"{factor * size[0]}x{factor * size[1]}", "--samples", str(samples), *extra],
                check=True)
            found = sorted((Path(folder) / "out").glob("*.png"))
            return [Image.open(f).convert("RGB").resize(size, Image.LANCZOS) for f in found]

    def moments(self, scene, size, times, extra=()):
        """Pictures at these times: the step is fixed first, so that they are multiples of it."""
        scene = dict(scene)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.json"
            file.write_text(json.dumps(scene))
            done = subprocess.run([self.pliant, "info", file, "--json", "-", "--quiet"], check=True, capture_output=True, text=True)
        unit = math.gcd(*(round(1000 * t) for t in times)) / 1000
        # Half of the step at rest leaves room for what the deformation does to the stable step.
        steps = int(unit / (0.5 * json.loads(done.stdout)["stable_step"]["dt"])) + 1
        scene["dt"] = unit / steps
        pictures = self.frames(scene, size, times[-1], steps, extra)
        return [pictures[round(t / unit)] for t in times]

    def save(self, name, image):
        palette = image.quantize(256, kmeans=4)
        image.quantize(palette=palette, dither=Image.FLOYDSTEINBERG).save(self.out / f"{name}.png", optimize=True)
        print(f"{self.out / name}.png: {image.width} x {image.height}, {(self.out / f'{name}.png').stat().st_size // 1024} KB")

    # --- the pictures --------------------------------------------------------------------------------------------------------

    def parameters(self):
        width, height, bar, left, top = 330, 320, 64, 92, 46
        columns = [("model", None, None), ("displacement", 200000, 0.8), ("displacement", 20000, 0.5)]
        sheet = Image.new("RGB", (left + 3 * width + bar, top + 2 * height), PAPER)
        pen = ImageDraw.Draw(sheet)
        for row, ratio in enumerate((0.7, 0.3)):
            pen.text((12, top + row * height + height // 2), f"ratio {ratio}", fill=INK, font=font(16), anchor="lm")
            for column, (color, modulus, alpha) in enumerate(columns):
                scene = load("bunny_hybrid")
                body = scene["bodies"][0]
                del body["prescribed"]
                body["material"].pop("young"), body["material"].pop("poisson")
                body["material"].update({"lambda": modulus or 20000, "mu": modulus or 20000, "damping": 20})
                body["model"].update({"ratio": ratio, "alpha": alpha or 0.5})
                body["forces"] = [{"sphere": [[-0.005, 0.145, -0.016], 0.012], "force": [1.2, 0.3, 0], "curve": "smooth", "duration": 0.4}]
                scene["view"] = {"eye": [0.12, 0.2, 0.5], "target": [0.004, 0.077, 0], "field_of_view": 22}
                extra = ["--color", color] + (["--range", "0,0.05"] if modulus else [])
                whole = width + (bar if modulus else 0)
                picture = self.frames(scene, (whole, height), 1.0 if modulus else 0.0, extra=extra)[-1]
                if column == 1:
                    picture = picture.crop((0, 0, width, height))
                sheet.paste(picture, (left + column * width, top + row * height))
        for column, title in enumerate(("who computes what", "λ = μ = 200 000 Pa, α = 0.8", "λ = μ = 20 000 Pa, α = 0.5")):
            pen.text((left + column * width + width // 2, top // 2), title, fill=INK, font=font(16), anchor="mm")
        self.save("parameters", sheet)

    def strip(self, name, scene, times, size, extra=()):
        sheet = Image.new("RGB", (2 * size[0], 2 * size[1]), PAPER)
        for i, picture in enumerate(self.moments(scene, size, times, extra)):
            pen = ImageDraw.Draw(picture)
            pen.text((14, size[1] - 14), f"{times[i]:.2f} s", fill=INK, font=font(15), anchor="ls")
            sheet.paste(picture, (i % 2 * size[0], i // 2 * size[1]))
        self.save(name, sheet)

    def bunny(self):
        scene = load("bunny")
        scene["view"] = {"eye": [0.14, 0.17, 0.5], "target": [0.0, 0.08, 0], "field_of_view": 24}
        self.strip("bunny", scene, (0, 0.2, 0.4, 0.6), (480, 360))

    def liver(self):
        scene = load("liver")
        scene["view"] = {"eye": [-0.12, 0.34, 0.4], "target": [0.012, 0.035, 0], "field_of_view": 26}
        self.strip("liver", scene, (0, 0.2, 0.4, 0.6), (480, 320), ["--color", "mises", "--range", "0,600"])

    def cut(self):
        self.strip("cut", load("cut_liver"), (0, 0.4, 0.7, 1.0), (480, 340))

    def grasp(self):
        self.strip("grasp", load("grasp"), (0, 0.3, 0.9, 1.6), (480, 340))

    def parts(self):
        sheet = Image.new("RGB", (960, 360), PAPER)
        for i, name in enumerate(("bunny_hybrid", "liver_hybrid")):
            scene = load(name)
            sheet.paste(self.frames(scene, (480, 360), 0.6, extra=["--color", "model"])[-1], (480 * i, 0))
        self.save("parts", sheet)

    def row(self, name):
        """Moments of a shipped scene beside each other, at its own step: each the first step at or after its time."""
        size, times = (320, 240), ROWS[name]
        unit = math.gcd(*(round(1000 * t) for t in times))
        pictures = self.frames(load(name), size, times[-1], f"{unit}ms")
        sheet = Image.new("RGB", (len(times) * size[0], size[1]), PAPER)
        for i, t in enumerate(times):
            picture = pictures[round(1000 * t / unit)]
            ImageDraw.Draw(picture).text((10, size[1] - 10), f"{t:.2f} s", fill=INK, font=font(13), anchor="ls")
            sheet.paste(picture, (i * size[0], 0))
        self.save(name, sheet)

    def tumour(self):
        """Left a press above the tumour; right the force of the probe [mN] at the end of each press, smooth in between."""
        scene, size, pixels = load("palpate_tumour"), (480, 340), 4000  # pixels per metre
        path = scene["tools"][0]["path"]
        presses = [path[i:i + 4] for i in range(0, len(path), 4)]  # above, pressed, held, above again
        centre, radius = scene["bodies"][0]["inclusions"][0]["sphere"]
        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "scene.json", Path(folder) / "out"
            file.write_text(json.dumps(scene))
            subprocess.run([self.pliant, "run", file, "--quiet", "--out", out, "--every", "1000s"], check=True)
            rows = list(csv.DictReader((out / "scene_tools.csv").open()))
        force = {}
        for _, _, (end, x, _, z), _ in presses:
            last = max((r for r in rows if float(r["time [s]"]) <= end), key=lambda r: float(r["time [s]"]))
            force[x, z] = 1000 * float(last["fy [N]"])
        xs, zs = (sorted({place[c] for place in force}) for c in (0, 1))
        low, high = min(force.values()), max(force.values())
        grid = Image.new("F", (len(xs), len(zs)))
        for (x, z), f in force.items():
            grid.putpixel((xs.index(x), zs.index(z)), (f - low) / (high - low))
        step = [round(pixels * (c[1] - c[0])) for c in (xs, zs)]
        cells = grid.resize((step[0] * len(xs), step[1] * len(zs)), Image.BICUBIC)
        shades = [cells.point(lambda v, a=a, b=b: v * (b - a) + a).convert("L") for a, b in ((250, 150), (240, 20), (230, 30))]
        drawn = Image.merge("RGB", shades)
        left, top = size[0] + (size[0] - drawn.width) // 2, (size[1] - drawn.height) // 2

        def at(x, z):
            return left + step[0] / 2 + pixels * (x - xs[0]), top + step[1] / 2 + pixels * (z - zs[0])

        pressed = min(presses, key=lambda p: (p[2][1] - centre[0])**2 + (p[2][3] - centre[2])**2)[2][0]
        sheet = Image.new("RGB", (2 * size[0], size[1]), PAPER)
        sheet.paste(self.frames(scene, size, pressed)[-1], (0, 0))
        sheet.paste(drawn, (left, top))
        pen = ImageDraw.Draw(sheet)
        (x0, z0), (x1, z1) = at(centre[0] - radius, centre[2] - radius), at(centre[0] + radius, centre[2] + radius)
        pen.ellipse((x0, z0, x1, z1), outline=INK, width=2)
        for (x, z), f in force.items():
            pen.text(at(x, z), f"{f:.0f}", fill=PAPER if 2 * f > low + high else INK, font=font(14), anchor="mm")
        pen.text((left, top - 8), "force [mN], 3.5 mm deep; the ring is the tumour below", fill=INK, font=font(14), anchor="ls")
        self.save("tumour", sheet)

    def methods(self):
        """`bench cutting` takes its second body from a cut_liver.json: here a cube that one of its cuts crosses, with a view."""
        names, size = ("removal", "decomposition", "virtual nodes"), (320, 240)
        middle = [0.0531, 0.06, 0.06]
        scene = load("cut_liver")
        scene["view"] = {"eye": [0.19, 0.17, 0.21], "target": middle, "field_of_view": 28}
        body = scene["bodies"][0]
        body.update({"surface": "cube.obj", "scale": 0.03, "translate": middle, "lattice": {"spacing": 0.006}})
        body["fixed"] = []
        with tempfile.TemporaryDirectory() as folder:
            corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
            faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
            (Path(folder) / "cube.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) +
                                                   "".join("f {} {} {} {}\n".format(*f) for f in faces))
            (Path(folder) / "cut_liver.json").write_text(json.dumps(scene))
            subprocess.run([self.pliant, "bench", "cutting", "--parts", "methods", "--quiet", "--scenes", folder, "--out", folder],
                           check=True, stdout=subprocess.DEVNULL)
            sheet = Image.new("RGB", (3 * size[0], size[1]), PAPER)
            for i, name in enumerate(names):
                picture = Image.open(Path(folder) / f"cutting_liver_{name.replace(' ', '_')}.png").convert("RGB")
                width = picture.height * size[0] // size[1]
                start = (picture.width - width) // 2
                picture = picture.crop((start, 0, start + width, picture.height)).resize(size, Image.LANCZOS)
                ImageDraw.Draw(picture).text((10, size[1] - 10), name, fill=INK, font=font(14), anchor="ls")
                sheet.paste(picture, (i * size[0], 0))
        self.save("methods", sheet)

    def tool_forces(self, scene):
        """Rows of the file of forces that a run of the scene writes, every 10 ms."""
        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "scene.json", Path(folder) / "out"
            file.write_text(json.dumps(scene))
            subprocess.run([self.pliant, "run", file, "--quiet", "--out", out, "--every", "10ms"], check=True)
            return list(csv.DictReader((out / "scene_tools.csv").open()))

    @staticmethod
    def chart(size, words, lines, moment, span=None):
        """Forces [N] over time, drawn in mN: `lines` are tuples of name, colour, times and forces; `span` is shaded and named."""
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        chart, axes = plt.subplots(figsize=(size[0] / 100, size[1] / 100), dpi=200)
        small = 5.4 + size[0] / 200
        if span:
            shade = "#f3e3dc"
            axes.axvspan(*span[:2], color=shade, linewidth=0, zorder=0)
            axes.text(sum(span[:2]) / 2, 0.08, span[2], fontsize=small, ha="center", transform=axes.get_xaxis_transform(),
                      bbox={"facecolor": shade, "edgecolor": "none", "pad": 1})
        axes.axvline(moment, color="#c0c4c8", linewidth=0.8, zorder=0)
        for name, colour, times, forces in lines:
            axes.plot(times, [1000 * f for f in forces], color=colour, linewidth=size[0] / 320, label=name)
        axes.set_title(words, fontsize=small + 1)
        axes.set_xlabel("time [s]", fontsize=small)
        axes.set_ylabel("force [mN]", fontsize=small)
        axes.tick_params(labelsize=small)
        axes.set_ylim(bottom=0)
        axes.spines[["top", "right"]].set_visible(False)
        if len(lines) > 1:
            axes.legend(fontsize=small, frameon=False)
        chart.tight_layout()
        drawn = io.BytesIO()
        chart.savefig(drawn)
        plt.close(chart)
        return Image.open(drawn).convert("RGB").resize(size, Image.LANCZOS)

    def hands(self):
        size, colour = (480, 240), "#d55e00"
        sheet = Image.new("RGB", (2 * size[0], 2 * size[1]), PAPER)
        scene = load("grasp")
        sheet.paste(self.moments(scene, (size[0], 2 * size[1]), (1.6,))[0], (0, 0))
        scene = load("palpate")
        scene["view"] = {"eye": [0.075, 0.11, 0.2], "target": [0.003, 0.003, 0], "field_of_view": 30}
        path, (centre, radius) = scene["tools"][0]["path"], scene["bodies"][0]["inclusions"][0]["sphere"]
        (pressed, start, *_), (end, last, *_) = path[1:]

        def when(x):
            return pressed + (end - pressed) * (x - start) / (last - start)

        moment = when(centre[0])
        sheet.paste(self.frames(scene, size, moment)[-1], (size[0], 0))
        rows = self.tool_forces(scene)
        line = ("probe", colour, [float(r["time [s]"]) for r in rows], [float(r["fy [N]"]) for r in rows])
        span = (when(centre[0] - radius), when(centre[0] + radius), "over the\ntumour")
        sheet.paste(self.chart(size, "the probe is pressed in and drawn over a tumour", [line], moment, span), size)
        self.save("hands", sheet)

    def forces(self):
        size, moments = (320, 240), {"incise": 0.9, "stroke": 0.8, "dissect": 0.9}
        sheet = Image.new("RGB", (3 * size[0], 2 * size[1]), PAPER)
        colours = {"scalpel": "#d55e00", "forceps": "#0072b2"}
        for i, (name, moment) in enumerate(moments.items()):
            scene = load(name)
            sheet.paste(self.frames(scene, size, moment)[-1], (i * size[0], 0))
            rows, lines = self.tool_forces(scene), []
            for tool, colour in colours.items():
                own = [r for r in rows if r["tool"] == tool]
                force = [math.hypot(*(float(r[f"f{c} [N]"]) for c in "xyz")) for r in own]
                if own:
                    lines.append((tool, colour, [float(r["time [s]"]) for r in own], force))
            sheet.paste(self.chart(size, name, lines, moment), (i * size[0], size[1]))
        self.save("forces", sheet)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pliant", help="the pliant command")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images")
    parser.add_argument("--only", default=",".join(KNOWN), help="names, separated by commas")
    parser.add_argument("--quick", action="store_true", help="few rays: to see that it works")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    maker = Maker(Path(options.pliant).resolve(), options.out, options.quick)
    for name in options.only.split(","):
        if name not in KNOWN:
            sys.exit(f"figure.py: --only names \"{name}\"; there are {', '.join(KNOWN)}")
        if name in ROWS:
            maker.row(name)
        else:
            getattr(maker, name)()


if __name__ == "__main__":
    main()
