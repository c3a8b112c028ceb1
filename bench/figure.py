#!/usr/bin/env python3
"""The pictures of docs/images, from the shipped scenes: python3 bench/figure.py PLIANT [--out DIR] [--only NAME,...] [--quick]

  parameters  a figure of the Hybrid Deformation Model: rows ratio 0.7 and 0.3; columns the parts of the body, stiff (lambda = mu =
              200000 Pa, alpha = 0.8) and soft (20000 Pa, 0.5), under the same force
  bunny       four moments of scenes/bunny.json
  liver       four moments of scenes/liver.json, coloured by von Mises stress
  cut         four moments of scenes/cut_liver.json: at rest, stretched, half cut, cut through
  parts       who computes what in scenes/bunny_hybrid.json and liver_hybrid.json

Pictures are traced at twice their size and scaled down, and saved with 256 colours so that they stay small.
"""
import argparse
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
        if "surface" in body:
            body["surface"] = str((SCENES / body["surface"]).resolve())
    return scene


class Maker:
    def __init__(self, pliant, out, quick):
        self.pliant, self.out, self.quick = pliant, out, quick

    def frames(self, scene, size, seconds, every=10**9, extra=()):
        """Pictures of a run at step 0, every so many steps, and at its end, scaled to `size`."""
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

    def parts(self):
        sheet = Image.new("RGB", (960, 360), PAPER)
        for i, name in enumerate(("bunny_hybrid", "liver_hybrid")):
            scene = load(name)
            sheet.paste(self.frames(scene, (480, 360), 0.6, extra=["--color", "model"])[-1], (480 * i, 0))
        self.save("parts", sheet)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pliant", help="the pliant command")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images")
    parser.add_argument("--only", default="parameters,bunny,liver,cut,parts", help="names, separated by commas")
    parser.add_argument("--quick", action="store_true", help="few rays: to see that it works")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    maker = Maker(Path(options.pliant).resolve(), options.out, options.quick)
    known = ("parameters", "bunny", "liver", "cut", "parts")
    for name in options.only.split(","):
        if name not in known:
            sys.exit(f"figure.py: --only names \"{name}\"; there are {', '.join(known)}")
        getattr(maker, name)()


if __name__ == "__main__":
    main()
