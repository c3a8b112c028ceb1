#!/usr/bin/env python3
"""The rules can fail: house_rules.py reports each breach of a small tree that breaks every rule, and nothing in one that keeps them.

Usage: house_rules_test.py SOURCE_FOLDER
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

RULES = Path(sys.argv[1]) / "tests/meta/house_rules.py"

BAD = {
    "tests/meta/size_exceptions.txt": "host/io/gone.cpp 500 it was long\nhost/io/short.cpp 500 it was long\n"
                                      "host/io/longer.cpp 401 it is long\n",
    "tests/meta/function_exceptions.txt": "host/io/folded.cpp fold 70 it was long\n",
    "tests/meta/banned_words.txt": "# words\nFrobni[ck]ate\n",
    "tests/meta/long_lines.txt": "docs/listed.md 1\ndocs/shorter.md 2\ndocs/gone.md 1\n",
    "cmake/rooms.txt": "# library folder rooms\n"
                       "pliant_scene host/scene\npliant_model host/model scene\npliant_io host/io model nowhere\npliant_cli host/cli io choice\n"
                       "pliant_opencl host/backends/opencl\npliant_choice host/choice (backends/opencl)\npliant_gone host/gone\npliant_ref cpu_ref\n",
    "kernels/arith.cl": "#pragma OPENCL FP_CONTRACT ON\n",
    "tests/kernels/turn_test.cpp": "TEST(Turn, goes_round) {}\n",
    "kernels/turn.cl": '#include "texels.cl"\n__kernel void twist(float x) { x = dot(x, x) < 0.0f ? x : 0.0f; x = x < 0.0f ? x : 0.0f; }\n',
    "kernels/texels.cl": '#include "../host/scene/scene.h"\n',
    "kernels/long.cl": "// a long kernel\n" * 151,
    "kernels/contact/press.cl": '#include "contact/texels.cl"\n__kernel void press(float x) {}\n',
    "kernels/contact/texels.cl": "",
    "host/io/long.cpp": "// a long file\n" * 401,
    "host/io/longer.cpp": "// a long file\n" * 402,
    "host/io/long.h": "// a long header\n" * 201,
    "host/io/short.cpp": "#include <vector>\n",
    "host/io/endless.cpp": "namespace pliant {\nint endless(int a,\n            int b) {\n"
                           '  const char* text = R"(\nvoid inner() {\n}\n)";\n' + "  a += b;\n" * 60 + "  return a;\n}\n"
                           "int brief() { return 1; }\nstruct Kept {\n  int x = 0;\n};\n}  // namespace pliant\n",
    "host/io/words.cpp": "// Frobnicate the nodes.\n",
    "host/scene/load.cpp": '#include "model/mesh.h"\n#include <CL/cl.h>\n',
    "host/model/text.cpp": '#include "turn.cl"\n',
    "host/cli/devices.cpp": '#include "backends/opencl/devices.h"\n#include "choice/choice.h"\n#include "scene/scene.h"\n',
    "host/choice/choice.cpp": '#include "backends/opencl/devices.h"\n',
    "host/backends/strange/strange.cpp": "",
    "host/backends/opencl/devices.h": "",
    "cpu_ref/arms.cpp": '#include <Eigen/Dense>\n#include "backends/opencl/devices.h"\n#include "turn.cl"\n',
    "cpu_ref/contact/elbow.cpp": '#include <Eigen/Dense>\n#include "cpu_ref/contact/elbow.h"\n#include "model/mesh.h"\n',
    "cpu_ref/contact/elbow.h": "// a long header\n" * 201,
    "cpu_ref/registry.cpp": "",
    "cpu_ref/press.cpp": "",
    "include/pliant/api.h": "#include <fmt/format.h>\n",
    "tests/golden/hashes.json": "{}\n",
    "CHANGELOG.md": "### Bits\n\nsha256 0123456789abcdef\n",
    "ARCHITECTURE.md": "| room | holds | may include |\n|---|---|---|\n| host/scene | scenes | |\n| host/model | models | scene, io |\n"
                       "| host/io | files | model, nowhere |\n| host/cli | the command | io, choice |\n| host/choice | backends | backends/opencl |\n"
                       "| host/gone | nothing | |\n| cpu_ref | the twins | |\n",
    "README.md": "x" * 160 + "\n" + "y" * 161 + "\n```\n" + "z" * 161 + "\n```\n",
    "docs/listed.md": "y" * 161 + "\n" + "| " + "y" * 161 + "\n",
    "docs/shorter.md": "y" * 161 + "\n",
    "docs/decisions/long.md": "y" * 161,
    "docs/scene.md": "| " + "y" * 161 + " |\n",
} | {f"host/model/element_{n}.cpp": "// tet4\n" for n in range(3)}
BAD["host/model/element_included.cpp"] = '#include "elements/element_wedge6.h"\n'

EXPECTED = r"""
kernels/long\.cl: 151 lines, allowed are 150
host/io/long\.cpp: 401 lines, allowed are 400
host/io/longer\.cpp: 402 lines, its exception allows 401
host/io/endless\.cpp:2: endless has 68 lines, allowed are 60
host/io/folded\.cpp fold needs no exception
host/io/words\.cpp:1: "Frobni.*ate" is banned
host/io/long\.h: 201 lines, allowed are 200
cpu_ref/contact/elbow\.h: 201 lines, allowed are 200
host/io/short\.cpp: 1 lines need no exception
host/io/gone\.cpp: is gone
kernels/texels\.cl includes .*scene\.h
kernels/contact/press\.cl includes "contact/texels\.cl": kernels include
include/pliant/api\.h includes <fmt/format\.h>
host/scene/load\.cpp includes <CL/cl\.h>
host/scene/load\.cpp includes "model/mesh\.h": host/scene knows only
host/cli/devices\.cpp includes "backends/opencl/devices\.h": the command asks
host/cli/devices\.cpp includes "backends/opencl/devices\.h": host/cli knows only
host/model/text\.cpp includes "turn\.cl": a \.cl file is text
cpu_ref/arms\.cpp includes <Eigen/Dense>
cpu_ref/arms\.cpp includes "backends/opencl/devices\.h": the twins are independent
cpu_ref/arms\.cpp includes "turn\.cl"
cpu_ref/contact/elbow\.cpp includes <Eigen/Dense>
cpu_ref/contact/elbow\.cpp includes "model/mesh\.h": cpu_ref knows only
host/backends/strange: has no row in cmake/rooms\.txt
cmake/rooms\.txt: there is no folder host/gone
cmake/rooms\.txt: host/io may include nowhere, which has no row
ARCHITECTURE\.md:4: host/model may include "scene, io", its row in cmake/rooms\.txt says "scene"
ARCHITECTURE\.md: no table of rooms has a row for host/backends/opencl
4 files name a concrete element, at most 3 may
kernels/turn\.cl: forbidden on values .*dot
kernels/turn\.cl: write a minimum with zero as
kernels/turn\.cl: must include arith\.cl first
kernels/turn\.cl: holds no kernel of its own name
kernels/turn\.cl: no twin
kernels/turn\.cl: no row
kernels/turn\.cl: named by no test
tests/kernels/turn_test\.cpp: the test Turn\.goes_round is to be named
kernels/contact/press\.cl: no twin cpu_ref/contact/press\.cpp
kernels/.*texels\.cl: kernels/.*texels\.cl has the same name
tests/golden/hashes\.json: its sha256 \(ca3d163bab055381
kernels/arith\.cl: must turn contraction off
README\.md: 1 lines longer than 160 columns: 2$
docs/listed\.md: 2 lines longer than 160 columns, tests/meta/long_lines\.txt allows 1: 1 2
docs/shorter\.md: 1 lines longer than 160 columns, tests/meta/long_lines\.txt says 2: lower it
docs/decisions/long\.md: 1 lines longer than 160 columns: 1$
docs/gone\.md: is gone
commit [0-9a-f]+: its subject has 73 characters, allowed are 72
""".strip().split("\n")

# On shelves, too, a kernel has its twin, its test and its includes.
GOOD = {
    "cmake/rooms.txt": "pliant_program host/program\npliant_backend host/backends/interface program\npliant_ref cpu_ref backends/interface\n",
    "kernels/nodes/arith.cl": "#pragma OPENCL FP_CONTRACT OFF\n",
    "kernels/contact/press.cl": '#include "arith.cl"\n#include "sum.cl"\n__kernel void press(float x) {}\n',
    "kernels/contact/sum.cl": "// not dot(x, x)\n",
    "cpu_ref/contact/press.cpp": '#include "cpu_ref/contact/sum.h"\n#include "program/pass.h"\n#include "twin_laws.h"\n',
    "cpu_ref/registry.cpp": "ROW(press)\n",
    "tests/kernels/contact/press_test.cpp": "TEST(Press, Bits) { press(); }\n",
    "host/program/pass.h": "",
    "host/backends/interface/backend.h": '#include "program/pass.h"\n',
}


def rules(root, files, subjects):
    """Exit status and lines of the rules over a checkout of these files."""
    for name, text in files.items():
        file = Path(root) / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    for folder in ("cmake", "tests/meta", "docs"):
        (Path(root) / folder).mkdir(parents=True, exist_ok=True)
    git = ["git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
    environment = dict(os.environ, GIT_COMMITTER_DATE="2090-01-01T00:00:00+00:00")
    subprocess.run([*git, "init", "-q"], cwd=root, check=True)
    subprocess.run([*git, "add", "-A"], cwd=root, check=True)
    for subject in subjects:
        subprocess.run([*git, "commit", "-q", "--allow-empty", "--no-verify", "-m", subject], cwd=root, check=True, env=environment)
    done = subprocess.run([sys.executable, "-B", str(RULES), root], capture_output=True, text=True)
    return done.returncode, (done.stdout + done.stderr).splitlines()


def main():
    with tempfile.TemporaryDirectory() as root:
        status, lines = rules(root, BAD, ["x" * 73, "y" * 72])
    missing = [want for want in EXPECTED if not any(re.match(want, line) for line in lines)]
    # What brackets hide is known to the room itself, and a room that is included is known with what it knows.
    unwanted = [line for line in lines if re.match(r"host/choice/|host/cli/.*(choice|scene)\.h|docs/scene\.md|.*y{72}", line)]
    if status == 0 or missing or unwanted:
        print("\n".join([*lines, f"status {status}", *(f"not reported: {want}" for want in missing), *(f"wrong: {line}" for line in unwanted)]))
        sys.exit(1)
    with tempfile.TemporaryDirectory() as root:
        status, lines = rules(root, GOOD, ["one"])
    if status != 0 or lines:
        print("\n".join(["a tree that keeps every rule failed:", *lines]))
        sys.exit(1)


main()
