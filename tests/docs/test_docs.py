"""The pages of docs/tutorial and docs/gallery.md, run as they stand there: test_docs.py tutorial|gallery. Needs PLIANT, PLIANT_SOURCE.

TUTORIAL_EMBED is the program of page 5, which the build has compiled of TUTORIAL_SOURCE. Blocks of Python are left out without the module.
"""
import os
import re
import shlex
import stat
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(os.environ["PLIANT_SOURCE"])
PLIANT = os.environ["PLIANT"]
BLOCK = re.compile(r"(?:as `([\w.]+)`:\n\n)?```(\w*)\n(.*?)```", re.S)
# What the blocks of a page print, in order: they run, and they do what the page says.
EXPECTED = {
    "1_first_organ": [("sh", r"2008 nodes"), ("sh", r"largest displacement 0\.017"), ("python", r"the kidney sags by 1[78]\.\d mm")],
    "2_press_it": [("sh", r"tool probe: force \[[^]]*\] N"), ("python", r"at 14 mm: 0\.\d+ N"), ("python", r"pressed hardest at \[")],
    "3_cut_it": [("sh", r"edges cut, 1 piece"), ("python", r"[2-9] pieces, \d{3,} triangles on the cut"), ("python", r"pieces, 1 before")],
    "4_tear_it": [("sh", r"faces broken by tears, [2-9] pieces"), ("python", r"torn at 0\.\d+ s, after 1\.\d+ N")],
    "5_embed_it": [("sh", r"upload 10512 triangles"), ("sh", r"the hand pulls with [0-9.]+ N"), ("python", r"[0-9.]+ N at [0-9.]+ s")],
}


def skip(reason):
    print("skipped: " + reason)
    sys.exit(77)


def need_pictures():
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([PLIANT, "run", SOURCE / "scenes/cube_tet.json", "--steps", "1", "--out", folder, "--format", "png", "--size", "32x32"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0 and "Embree" in done.stdout:
        skip("this build has no Embree, which pictures need")
    assert done.returncode == 0, done.stdout


def script(file, text):
    file.write_text("#!/bin/bash\n" + text)
    file.chmod(file.stat().st_mode | stat.S_IXUSR)


def tools(folder):
    """A folder for PATH. Pictures are small; the compiler gives out what the build has made of the same text."""
    folder.mkdir()
    script(folder / "pliant", f'[[ "$*" == *png* ]] && set -- "$@" --size 96x64 --samples 1\nexec {shlex.quote(PLIANT)} "$@"\n')
    script(folder / "pkg-config", "")
    embed, text = (shlex.quote(os.environ.get(name, "")) for name in ("TUTORIAL_EMBED", "TUTORIAL_SOURCE"))
    script(folder / "c++", f'diff -B main.cpp {text} && cp {embed} trainer\n')
    return folder


def has_module():
    return subprocess.run([sys.executable, "-c", "import pliant"], stderr=subprocess.DEVNULL).returncode == 0


def run(call, text, folder, environment):
    done = subprocess.run(call, input=text, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    assert done.returncode == 0, f"{text}\n{done.stdout}"
    return done.stdout


def page_in(page, folder, environment, module):
    said = {"sh": "", "python": ""}
    for name, language, text in BLOCK.findall(page.read_text()):
        if name:
            (folder / name).write_text(text)
        elif language == "sh" and "trainer" in text and "TUTORIAL_EMBED" not in os.environ:
            said["sh"] = None
        elif language == "sh" and "export PATH" not in text:
            said["sh"] += run(["bash", "-e"], text, folder, environment)
        elif language == "python" and module:
            said["python"] += run([sys.executable, "-"], text, folder, environment)
        else:
            assert "export PATH" in text or not module, f"{page.name}: no test for a block of {language!r}"
    for language, pattern in EXPECTED[page.stem]:
        left_out = said[language] is None or (language == "python" and not module)
        assert left_out or re.search(pattern, said[language]), f"{page.name}: {pattern} in\n{said[language]}"
    links = re.findall(r"\]\((?!http)([^)#]+)", page.read_text())
    assert links and all((page.parent / link).exists() for link in links), [link for link in links if not (page.parent / link).exists()]


def tutorial():
    need_pictures()
    pages = sorted((SOURCE / "docs/tutorial").glob("*.md"))
    assert {p.stem for p in pages} == set(EXPECTED)
    module = has_module()
    if not module:
        print("left out: the Python module is not there")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scenes").symlink_to(SOURCE / "scenes")
        environment = dict(os.environ, PATH=f"{tools(folder / 'tools')}:{os.environ['PATH']}")
        for page in pages:
            page_in(page, folder, environment, module)


def gallery():
    """The commands run (two steps of each), name what is there, and have their pictures."""
    text = (SOURCE / "docs/gallery.md").read_text()
    entries = re.findall(r"\*\*(.+?)\*\*.*\n!\[\]\((images/gallery/(\w+)\.png)\)\n```sh\n(.*?)\n```", text)
    assert len(entries) == text.count("```sh") > 20 and len({name for _, _, name, _ in entries}) == len(entries)
    need_pictures()
    for title, picture, name, command in entries:
        words = shlex.split(command)
        assert words[:3] == ["pliant", "run", f"scenes/{name}.json"], title
        size = words[words.index("--size") + 1]
        width, height = struct.unpack(">II", (SOURCE / "docs" / picture).read_bytes()[16:24])
        assert f"{width}x{height}" == size, f"{picture} is {width}x{height}"
        elsewhere = re.search(r'"surface": "(/[^"]+)"', (SOURCE / words[2]).read_text())
        if elsewhere and not Path(elsewhere[1]).exists():
            print(f"left out: {words[2]} needs {elsewhere[1]} (Debian: glmark2-data)")
            continue
        with tempfile.TemporaryDirectory() as folder:
            words[0], words[words.index("--out") + 1], words[words.index("--size") + 1] = PLIANT, folder, "64x48"
            if "--seconds" in words:
                at = words.index("--seconds")
                assert 0 < float(words[at + 1]) <= 3
                del words[at:at + 2]
            run([*words, "--steps", "2", "--samples", "1"], None, SOURCE, dict(os.environ))
            assert len(list(Path(folder).glob("*.png"))) == 2, title


if __name__ == "__main__":
    {"tutorial": tutorial, "gallery": gallery}[sys.argv[1]]()
    print("ok")
