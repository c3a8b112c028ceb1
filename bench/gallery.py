#!/usr/bin/env python3
"""The pictures of docs/gallery.md and docs/tutorial, by the commands and scenes that stand there: python3 bench/gallery.py PLIANT [--only NAME,...]

A picture of the gallery is the last one of its command. One of the tutorial shows the first and the last moment of its page's scene.
They are saved with 128 colours so that they stay small.
"""
import argparse
import json
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
GALLERY = re.compile(r"!\[\]\(images/gallery/(\w+)\.png\)\n```sh\n(.*?)\n```", re.S)
TUTORIAL = {"organ": (), "press": ("--color", "mises", "--range", "0,2000"), "cut": (), "tear": ()}


def commands():
    """By name the command of each picture of the gallery."""
    return dict(GALLERY.findall((ROOT / "docs/gallery.md").read_text()))


def scene_of_page(name):
    pages = "".join(page.read_text() for page in sorted((ROOT / "docs/tutorial").glob("*.md")))
    scene = json.loads(re.search(rf"as `{name}\.json`:\n\n```json\n(.*?)```", pages, re.S)[1])
    for body in scene["bodies"]:
        for key in ("surface", "mesh"):
            if key in body:
                body[key] = str(ROOT / body[key])
    return scene


def save(image, file):
    file.parent.mkdir(parents=True, exist_ok=True)
    image.convert("RGB").quantize(128, kmeans=4).save(file, optimize=True)
    print(f"{file.relative_to(ROOT)}: {file.stat().st_size // 1024} KB")


def of_gallery(pliant, name, command):
    with tempfile.TemporaryDirectory() as folder:
        words = shlex.split(command)
        words[0], words[words.index("--out") + 1] = str(pliant), folder
        subprocess.run([*words, "--quiet", "--samples", "48"], check=True, cwd=ROOT)
        save(Image.open(sorted(Path(folder).glob("*.png"))[-1]), ROOT / f"docs/images/gallery/{name}.png")


def of_tutorial(pliant, name):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{name}.json"
        file.write_text(json.dumps(scene_of_page(name)))
        subprocess.run([pliant, "run", file, "--quiet", "--out", Path(folder) / "out", "--every", "10s", "--format", "png", "--size", "400x300",
                        "--samples", "48", *TUTORIAL[name]], check=True)
        first, *_, last = sorted((Path(folder) / "out").glob("*.png"))
        sheet = Image.new("RGB", (800, 300))
        sheet.paste(Image.open(first), (0, 0))
        sheet.paste(Image.open(last), (400, 0))
        save(sheet, ROOT / f"docs/images/tutorial_{name}.png")


def main():
    known = commands()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pliant", type=Path, help="the pliant command")
    parser.add_argument("--only", default=",".join([*known, *TUTORIAL]), help="names, separated by commas")
    options = parser.parse_args()
    for name in options.only.split(","):
        if name not in known and name not in TUTORIAL:
            sys.exit(f'gallery.py: --only names "{name}"; there are {", ".join([*known, *TUTORIAL])}')
        if name in known:
            of_gallery(options.pliant.resolve(), name, known[name])
        else:
            of_tutorial(options.pliant.resolve(), name)


if __name__ == "__main__":
    main()
