#!/usr/bin/env python3
"""The rules of the house that a compiler does not check. Usage: house_rules.py SOURCE_FOLDER

Prints a line for each place that breaks a rule, and fails if there is any. ARCHITECTURE.md, CONTRIBUTING.md and docs/determinism.md
state the rules.
"""
import hashlib
import os
import re
import subprocess
import sys
from pathlib import Path

META = "tests/meta/"
CODE_FOLDERS = ("kernels", "host", "cpu_ref", "include", "tests", "bench", "scenes", "examples", "python")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"][^>"\n]+[>"])', re.M)


class Tree:
    """A folder of sources. It reads each file at most once."""

    def __init__(self, root):
        self.root = Path(root)
        self.texts = {}
        self.broken = []
        self.tracked = self.git("ls-files", "-z").split("\0")[:-1]
        self.code = sorted(f for folder in CODE_FOLDERS for f in self.walk(folder))

    def report(self, text):
        self.broken.append(text)

    def git(self, *arguments):
        """What git prints, or nothing where the folder is no checkout."""
        return subprocess.run(["git", *arguments], cwd=self.root, capture_output=True, text=True).stdout

    def walk(self, folder):
        for path, folders, files in os.walk(self.root / folder):
            folders[:] = [f for f in folders if f != "__pycache__"]
            yield from (os.path.relpath(os.path.join(path, f), self.root) for f in files if f.endswith((".cl", ".h", ".cpp")))

    def under(self, folder, *ends):
        return [f for f in self.code if f.startswith(folder + "/") and f.endswith(ends)]

    def exists(self, file):
        return (self.root / file).is_file()

    def text(self, file):
        """The text of a file, empty for one that is not there or not text."""
        if file not in self.texts:
            try:
                content = (self.root / file).read_bytes()
            except OSError:
                content = b""
            self.texts[file] = "" if b"\0" in content else content.decode(errors="replace")
        return self.texts[file]

    def lines(self, file):
        return self.text(file).split("\n")

    def rows(self, file):
        """The words of each row of a list; a row that begins with # is a comment."""
        return [line.split() for line in self.lines(file) if line.strip() and not line.startswith("#")]

    def includes(self, file):
        return INCLUDE.findall(self.text(file))


# --- sizes -------------------------------------------------------------------------------------------------------------------
# Exceptions: file, its own limit, why. One that is no longer needed is itself reported, so that the list only shrinks.
def check_sizes(tree):
    listed = META + "size_exceptions.txt"
    exceptions = {row[0]: int(row[1]) for row in tree.rows(listed)}
    sizes = [(150, tree.under("kernels", ".cl", ".h")), (200, tree.under("include", ".h") + tree.under("host", ".h"))]
    sizes += [(200, tree.under("cpu_ref", ".h"))]
    sizes += [(400, [f for folder in ("host", "cpu_ref", "tests", "bench", "scenes", "examples") for f in tree.under(folder, ".cpp")])]
    for limit, files in sizes:
        for file in files:
            lines = tree.text(file).count("\n")
            if file in exceptions:
                if lines <= limit:
                    tree.report(f"{file}: {lines} lines need no exception any more (limit {limit}): {listed}")
                if lines > exceptions[file]:
                    tree.report(f"{file}: {lines} lines, its exception allows {exceptions[file]}")
            elif lines > limit:
                tree.report(f"{file}: {lines} lines, allowed are {limit}: split it by topic")
    for file in exceptions:
        if not tree.exists(file):
            tree.report(f"{file}: is gone; remove its exception from {listed}")


RAW_STRING = re.compile(r'R"([a-z_]*)\(')
NO_FUNCTION = re.compile(r"(?:namespace|struct|class|enum|union|using|typedef|static_assert|extern) ")
LIMIT_OF_FUNCTION = 60


def long_functions(lines):
    """First line, length and name of the functions at the margin (clang-format puts their last brace there) that are too long."""
    start, name, is_open, raw = 0, "", False, ""
    for number, line in enumerate(lines, 1):
        if raw:
            if raw in line:
                raw = ""
            continue
        if 'R"' in line and (match := RAW_STRING.search(line)):
            end = f'){match[1]}"'
            raw = "" if end in line[match.end() :] else end
        first = line[:1]
        if is_open:
            if first == "}":
                if number - start >= LIMIT_OF_FUNCTION:
                    yield start, number - start + 1, re.sub(r".*[ &*]", "", name.split("(")[0])
                start, is_open = 0, False
            continue
        if (first.isalpha() or first in ("_", "~", "[")) and not NO_FUNCTION.match(line):
            start, name = number, line
        if start and line.endswith("{"):
            is_open = "(" in name
            start = start if is_open else 0
        elif start and line.endswith((";", "}")):
            start = 0  # a declaration, or a function of one line


# Exceptions: file, the function as its first line names it, its own limit, why.
def check_functions(tree):
    listed = META + "function_exceptions.txt"
    exceptions = {(row[0], row[1]): int(row[2]) for row in tree.rows(listed)}
    seen = set()
    for folder in ("host", "cpu_ref", "bench", "scenes", "examples", "python", "tests"):
        for file in tree.under(folder, ".cpp"):
            for line, length, name in long_functions(tree.lines(file)):
                seen.add((file, name))
                limit = exceptions.get((file, name), LIMIT_OF_FUNCTION)
                if length > limit:
                    tree.report(f"{file}:{line}: {name} has {length} lines, allowed are {limit}")
    for file, name in exceptions:
        if (file, name) not in seen:
            tree.report(f"{file} {name} needs no exception any more: {listed}")


# --- words that strangers do not know ----------------------------------------------------------------------------------------
# One regular expression a line, matched as a word and whatever its case. What git tracks is searched.
def check_words(tree):
    listed = META + "banned_words.txt"
    words = [line for line in tree.lines(listed) if line and not line.startswith("#")]
    if not words:
        return
    # Small letters in both: re.I takes six times as long.
    small = [re.sub(r"\\.|[A-Z]+", lambda m: m[0] if m[0][0] == "\\" else m[0].lower(), word) for word in words]
    any_word = re.compile("|".join(small), re.A)
    each_word = [(word, re.compile(rf"(?<!\w)(?:{pattern})(?!\w)", re.A)) for word, pattern in zip(words, small)]
    for file in tree.tracked:
        if file == listed or file.startswith(META + "house_rules_test"):
            continue
        text = tree.text(file).lower()
        if not any_word.search(text):
            continue
        for number, line in enumerate(text.split("\n"), 1):
            for word, pattern in each_word:
                if pattern.search(line):
                    tree.report(f'{file}:{number}: "{word}" is banned by {listed}')


# --- who includes whom ---------------------------------------------------------------------------------------------------------
def allow(tree, why, pattern, files):
    """Every include of these files matches the pattern."""
    for file in files:
        for name in tree.includes(file):
            if not re.search(pattern, name):
                tree.report(f"{file} includes {name}: {why}")


def forbid(tree, why, pattern, files):
    for file in files:
        for name in tree.includes(file):
            if re.search(pattern, name):
                tree.report(f"{file} includes {name}: {why}")


def check_includes(tree):
    opencl_header = r'^[<"]CL/|opencl\.hpp|cl\.h[>"]$'
    host, twins = tree.under("host", ".h", ".cpp"), tree.under("cpu_ref", ".h", ".cpp")
    # A kernel is included by its base name, whatever its folder.
    allow(tree, "kernels include kernels and layout.h only", r'^"([a-z0-9_]+\.cl|layout\.h)"$', tree.under("kernels", ".cl", ".h"))
    allow(tree, "the public API uses the standard library only", r'^(<[a-z_0-9]+>|<(std(def|int)|math)\.h>|"pliant/[a-z_/]+\.h")$',
          tree.under("include", ".h"))
    forbid(tree, "only host/backends/opencl includes OpenCL headers", opencl_header,
           [f for f in host if not f.startswith("host/backends/opencl/")] + twins)
    forbid(tree, "the twins are independent of the backends and of the kernels", r'"(host/)?backends/(opencl|twins|choice)/|\.cl[>"]$', twins)
    forbid(tree, "no Eigen in the twins", r'[<"]Eigen/', twins)
    forbid(tree, "a .cl file is text, not a header", r'\.cl[>"]$', host + tree.under("include", ".h"))
    forbid(tree, "the command asks host/backends for a backend", r'"(host/)?backends/(opencl|twins)/', tree.under("host/cli", ".h", ".cpp"))


class Room:
    def __init__(self, row):
        self.library, self.folder, names = row[0], row[1], row[2:]
        self.name = re.sub("^host/", "", self.folder)
        self.direct = [name.strip("()") for name in names]
        self.passed_on = [name for name in names if not name.startswith("(")]


ROOMS = "cmake/rooms.txt"


def read_rooms(tree):
    rooms = {room.name: room for room in (Room(row) for row in tree.rows(ROOMS))}
    for room in rooms.values():
        if not (tree.root / room.folder).is_dir():
            tree.report(f"{ROOMS}: there is no folder {room.folder}")
        for name in room.direct:
            if name not in rooms:
                tree.report(f"{ROOMS}: {room.folder} may include {name}, which has no row")
    folders = tuple(f"{room.folder}/" for room in rooms.values())
    for folder in sorted({os.path.dirname(f) for f in tree.under("host", ".h", ".cpp") if not f.startswith(folders)}):
        tree.report(f"{folder}: has no row in {ROOMS}")
    return rooms


def known(rooms, room):
    """What a room may include: itself, what its row names, and what those pass on."""
    names, waiting = {room.name}, list(room.direct)
    while waiting:
        name = waiting.pop()
        if name not in names and name in rooms:
            names.add(name)
            waiting += rooms[name].passed_on
    return names


def check_rooms(tree, rooms):
    for room in rooms.values():
        inner = known(rooms, room)
        prefixes = tuple(f"{name}/" for name in inner | {"pliant"})
        why = f"{room.folder} knows only: {' '.join(sorted(inner))}"
        within = tuple(f"{other.folder}/" for other in rooms.values() if other.folder.startswith(f"{room.folder}/"))
        for file in tree.under(room.folder, ".h", ".cpp"):
            for name in () if file.startswith(within) else tree.includes(file):
                path = name[1:-1]
                if name[0] == "<" or path in ("layout.h", "laws.h", "integrators.h") or path.startswith(prefixes):
                    continue
                if "/" not in path and not room.folder.startswith("host/"):
                    continue  # a neighbour, or a file that the build writes
                tree.report(f"{file} includes {name}: {why}")


# The tables of ARCHITECTURE.md name for each room what its row names.
def check_room_tables(tree, rooms):
    page = "ARCHITECTURE.md"
    if not tree.exists(page):
        return
    folders = {room.folder: room for room in rooms.values()}
    told = set()
    in_table = False
    for number, line in enumerate(tree.lines(page), 1):
        if not line.startswith("|"):
            in_table = False
        elif re.match(r"\| room \|.*\| may include \|$", line):
            in_table = True
        elif in_table:
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if cells[0] not in folders:
                continue
            told.add(cells[0])
            want = ", ".join(folders[cells[0]].direct)
            if cells[-1] != want:
                tree.report(f'{page}:{number}: {cells[0]} may include "{cells[-1]}", its row in {ROOMS} says "{want}"')
    for folder in folders:
        if folder not in told:
            tree.report(f"{page}: no table of rooms has a row for {folder}, which is in {ROOMS}")


# --- elements ----------------------------------------------------------------------------------------------------------------
# Who names a concrete element must change when one comes. Not counted: its own files, and files that read what others wrote. The
# number may only fall; what is left are texts for users, and the comment of a kernel that one element has. Statics has its own list.
FILES_NAMING_ELEMENTS = 3


def check_elements(tree):
    named = re.compile(r"\b(?:tet4|tet4anp|hex8|hex8full|Tet4|Tet4Anp|Hex8|Hex8Full)\b|ElementKind::|#include .elements/element_")
    own = re.compile(r"^host/(?:elements|mesh_io|statics)/|/(?:tled_)?(?:tet4|hex8)")
    naming = [f for f in tree.tracked if re.match(r"(?:host|kernels|cpu_ref|include)/.*\.(?:h|cpp|cl)$", f)
              and not own.search(f) and named.search(tree.text(f))]
    if len(naming) > FILES_NAMING_ELEMENTS:
        tree.report(f"{len(naming)} files name a concrete element, at most {FILES_NAMING_ELEMENTS} may; "
                    f"ask element_info (host/elements/element.h): {' '.join(naming)}")


# --- bits --------------------------------------------------------------------------------------------------------------------
# Whoever writes other golden hashes comes past the section that says why.
def check_bits(tree):
    hashes = "tests/golden/hashes.json"
    if tree.exists(hashes):
        digest = hashlib.sha256((tree.root / hashes).read_bytes()).hexdigest()[:16]
        if digest not in tree.text("CHANGELOG.md"):
            tree.report(f'{hashes}: its sha256 ({digest}...) is not the one under "Bits" in CHANGELOG.md: say there what changed, and why')


# --- kernels and twins -------------------------------------------------------------------------------------------------------
# On values: what rounds differently between implementations.
INEXACT = re.compile(r"\b(?:mad|dot|cross|length|normalize|distance|mix|min|max|fmin|fmax|clamp|rsqrt|native_[a-z0-9]+|half_[a-z0-9]+"
                     r"|sin|cos|tan|exp|log|pow|cbrt)\s*\(")

# A minimum with zero that keeps the sign of -0 where a compiler makes min() of it (NVIDIA's does), and loses it elsewhere.
MINIMUM_WITH_ZERO = re.compile(r"(\S+) < 0\.0f \? \1 : 0\.0f|(\S+) > 0\.0f \? 0\.0f : \2")


def check_kernels(tree):
    registry = "cpu_ref/registry.cpp"
    tests = "\n".join(tree.text(f) for f in tree.under("tests/kernels", "_test.cpp"))
    rows = set(re.findall(r"ROW\((\w+)\)", tree.text(registry)))
    tested = set(re.findall(r"\w+", tests))
    seen = {}
    for file in tree.under("kernels", ".cl"):
        stem = Path(file).stem
        if stem in seen:
            tree.report(f"{file}: {seen[stem]} has the same name, and kernels are included by their names without a folder")
        seen[stem] = file
        code = re.sub("//.*", "", tree.text(file))  # comments may name what the code must not use
        found = [f"{n}:{use}" for n, line in enumerate(code.split("\n"), 1) for use in INEXACT.findall(line)]
        if found:
            tree.report(f"{file}: forbidden on values (docs/determinism.md): {' '.join(found)}")
        if MINIMUM_WITH_ZERO.search(code):
            tree.report(f"{file}: write a minimum with zero as x <= 0.0f ? x : 0.0f (docs/determinism.md)")
        if "__kernel" not in code:
            continue
        first = next(iter(tree.includes(file)), "nothing")
        if first != '"arith.cl"':
            tree.report(f"{file}: must include arith.cl first, which turns contraction off (first is {first})")
        if not re.search(rf"__kernel\s+.*\b{stem}\b", code):
            tree.report(f"{file}: holds no kernel of its own name")
        twin = re.sub(r"^kernels/(.*)\.cl$", r"cpu_ref/\1.cpp", file)  # on the same shelf
        if not tree.exists(twin):
            tree.report(f"{file}: no twin {twin}")
        if stem not in rows:
            tree.report(f"{file}: no row in {registry}")
        if stem not in tested:
            tree.report(f"{file}: named by no test in tests/kernels")
    arith = seen.get("arith", "kernels/arith.cl")
    if "#pragma OPENCL FP_CONTRACT OFF" not in tree.text(arith):
        tree.report(f"{arith}: must turn contraction off")


# --- documents and commits -----------------------------------------------------------------------------------------------------
COLUMNS = 160
SUBJECT = 72
# Older commits cannot be changed any more.
SUBJECTS_SINCE = "2026-11-25T19:30:00+00:00"


def long_lines(tree, page):
    """The lines that are too long: not those of code, nor the tables of docs/scene.md, which a test writes (Tables.*)."""
    in_code = False
    for number, line in enumerate(tree.lines(page), 1):
        if line.lstrip().startswith("```"):
            in_code = not in_code
        elif len(line) > COLUMNS and not in_code and not (page == "docs/scene.md" and line.startswith("|")):
            yield number


# Exceptions: file, number of its long lines. It may only fall, so a number that is too high is reported as well.
def check_documents(tree):
    listed = META + "long_lines.txt"
    exceptions = {row[0]: int(row[1]) for row in tree.rows(listed)}
    pages = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"]
    pages += sorted(str(path.relative_to(tree.root)) for path in (tree.root / "docs").rglob("*.md"))
    for page in pages:
        found, allowed = list(long_lines(tree, page)), exceptions.get(page, 0)
        if len(found) > allowed:
            more = f", {listed} allows {allowed}" if allowed else ""
            tree.report(f"{page}: {len(found)} lines longer than {COLUMNS} columns{more}: {' '.join(map(str, found))}")
        elif len(found) < allowed:
            tree.report(f"{page}: {len(found)} lines longer than {COLUMNS} columns, {listed} says {allowed}: lower it")
    for page in exceptions:
        if page not in pages:
            tree.report(f"{page}: is gone; remove its exception from {listed}")


# Those since the last tag, or the last 20.
TEST_NAME = re.compile(r"^TEST(?:_P|_F)?\((\w+), ([a-z]\w*|\w*_\w*)\)", re.M)


def check_test_names(tree):
    for file in tree.under("tests", ".cpp"):
        for suite, name in TEST_NAME.findall(tree.text(file)):
            tree.report(f"{file}: the test {suite}.{name} is to be named InCapitalsLikeThis")


def check_subjects(tree):
    tag = tree.git("describe", "--tags", "--abbrev=0").strip()
    which = [f"{tag}..HEAD"] if tag else ["-20"]
    for line in tree.git("log", "--no-merges", f"--since={SUBJECTS_SINCE}", "--format=%h %s", *which).splitlines():
        commit, _, subject = line.partition(" ")
        if len(subject) > SUBJECT:
            tree.report(f"commit {commit}: its subject has {len(subject)} characters, allowed are {SUBJECT}: {subject}")


def main():
    tree = Tree(sys.argv[1])
    check_sizes(tree)
    check_functions(tree)
    check_words(tree)
    check_includes(tree)
    rooms = read_rooms(tree)
    check_rooms(tree, rooms)
    check_room_tables(tree, rooms)
    check_elements(tree)
    check_bits(tree)
    check_kernels(tree)
    check_documents(tree)
    check_test_names(tree)
    check_subjects(tree)
    if tree.broken:
        print("\n".join(tree.broken))
        print(f"{len(tree.broken)} rule(s) broken")
        sys.exit(1)


if __name__ == "__main__":
    main()
