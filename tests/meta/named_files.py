#!/usr/bin/env python3
"""A file that a comment or a document names exists. Usage: named_files.py SOURCE_FOLDER | --self-test

Names are whole paths, or ends of paths as readers write them (law.h, model/mesh.h), of what git tracks. STEM, NAME and other
capitals stand for any name. Prints a line for each name of nothing.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

NAME = re.compile(r"(?<![\w./*<$%-])((?:[\w.-]+/)*[\w-]+\.(?:cpp|h|cl|py|sh|cmake|md|mutation))\b(?![\w/*])")
COMMENT = re.compile(r"(?://|(?:^|\s)#(?!\s*include))(.*)")
READ = re.compile(r"\.(?:md|cpp|h|cl|py|sh|cmake)$|CMakeLists\.txt$|^dev$")
# What the build writes, and examples of names.
MADE = {"laws.cl", "twin_laws.h", "material/host_laws.h", "integrators.cl", "twin_integrators.h", "integrators/host_integrators.h", "file.cpp"}


def broken(root):
    files = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=True).stdout.split("\n")
    ends = {"/".join(parts[k:]) for parts in (f.split("/") for f in files) for k in range(len(parts))}
    found = []
    for file in files:
        if not READ.search(file) or file.startswith("tests/meta/house_rules_test") or file == "tests/meta/named_files.py":
            continue
        for number, line in enumerate((Path(root) / file).read_text(errors="replace").split("\n"), 1):
            comment = line if file.endswith(".md") else "".join(m.group(1) for m in [COMMENT.search(line)] if m)
            for name in NAME.findall(comment):
                stem = name.split("/")[-1].split(".")[0]
                name = re.sub(r"^(\.\./)+", "", name)
                if name not in ends and name not in MADE and not re.search(r"STEM|NAME|^NN", stem):
                    found.append(f"{file}:{number}: names {name}, which is not there")
    return found


def self_test():
    with tempfile.TemporaryDirectory() as tree:
        write = lambda name, text: (Path(tree) / name).write_text(text)
        (Path(tree) / "host").mkdir()
        write("host/there.h", "// See there.h, host/there.h, law_STEM.h and gone.h\nint x;  // old/there.h\n")
        write("a.md", "[x](../host/there.h) and `host/gone.cpp`, not *.h or x.json\n")
        subprocess.run("git init -q . && git add -A", shell=True, cwd=tree, check=True)
        want = ["a.md:1: names host/gone.cpp", "host/there.h:1: names gone.h", "host/there.h:2: names old/there.h"]
        found = [line.split(",")[0] for line in broken(tree)]
        assert found == want, found


if sys.argv[1] == "--self-test":
    self_test()
else:
    lines = broken(sys.argv[1])
    print("\n".join(lines))
    sys.exit(1 if lines else 0)
