"""Where a mutation acts: a pattern of tokens in the functions of a name.

White space and comments do not count, so what formats, moves or explains code leaves mutations alone. Only what a function is
called, and the tokens of the pattern themselves, tie a mutation to the source.
"""
import re
from pathlib import Path

TOKEN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/)
    |(?P<text>R"(?P<raw>[a-z_]*)\(.*?\)(?P=raw)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')
    |(?P<number>\.?\d(?:'?[\w.]|(?<=[eEpP])[+-])*)
    |(?P<word>[A-Za-z_]\w*)
    |(?P<sign><<=|>>=|->\*|\.\.\.|<=>|::|->|\+\+|--|<<|[-+*/%&|^=!<>]=|&&|\|\||\#\#|.)""",
    re.X | re.S)
SPECIFIERS = {"const", "noexcept", "override", "final", "mutable"}
SCOPES = {"namespace", "struct", "class", "union", "enum", "extern"}


class Token:
    __slots__ = ("text", "start", "end", "directive")

    def __init__(self, text, start, end, directive):
        self.text, self.start, self.end, self.directive = text, start, end, directive


def tokens(source):
    """All but white space and comments; `directive` marks those of a preprocessor line."""
    directives = [m.span() for m in re.finditer(r"^[ \t]*#(?:\\\n|[^\n])*", source, re.M)]
    found, line = [], 0
    for m in TOKEN.finditer(source):
        if m.lastgroup == "skip":
            continue
        while line < len(directives) and directives[line][1] <= m.start():
            line += 1
        inside = line < len(directives) and directives[line][0] <= m.start()
        found.append(Token(m.group(), m.start(), m.end(), inside))
    return found


def matching(code, at):
    """Index of the bracket that closes the one at `at`."""
    open_, close = code[at].text, {"(": ")", "{": "}", "[": "]"}[code[at].text]
    depth = 0
    for k in range(at, len(code)):
        depth += (code[k].text == open_) - (code[k].text == close)
        if depth == 0:
            return k
    return len(code) - 1


def name_of(head):
    """The name of the function that a statement up to its '{' begins, or None."""
    if not head or (head[0].text in SCOPES and not any(t.text == "(" for t in head)):
        return None
    depth = 0
    for k, token in enumerate(head):
        if token.text == "(" and depth == 0:
            before = head[k - 1].text if k else ""
            if before == "__attribute__":
                depth += 1
                continue
            if re.fullmatch(r"[A-Za-z_]\w*", before):
                return before
            return "operator" if any(t.text == "operator" for t in head[:k]) else None
        if token.text in ("(", "["):
            depth += 1
        elif token.text in (")", "]"):
            depth -= 1
        elif token.text == "=" and depth == 0 and (k == 0 or head[k - 1].text != "operator"):
            return None
    return None


def starts_member(head):
    """Whether a '{' after these tokens gives a member its value, in front of the body of a constructor."""
    last = head[-1].text if head else ""
    if not re.fullmatch(r"[A-Za-z_]\w*", last) or last in SPECIFIERS:
        return False
    depth = 0
    for k, token in enumerate(head):
        depth += (token.text == "(") - (token.text == ")")
        if token.text == ":" and depth == 0 and k and (head[k - 1].text == ")" or head[k - 1].text in SPECIFIERS):
            return True
    return False


def functions(source):
    """[(name, start, end)] of the definitions in a C++ or OpenCL source, from the first token of their statement to the last brace."""
    code = [t for t in tokens(source) if not t.directive]
    found, head, k = [], [], 0
    while k < len(code):
        text = code[k].text
        if text == "{":
            name = name_of(head)
            if name is None:
                head = []  # a scope, whose inside is read on
            else:
                end = matching(code, k)
                if starts_member(head):
                    head += code[k : end + 1]
                    k = end + 1
                    continue
                found.append((name, head[0].start, code[end].end))
                head, k = [], end
        elif text in (";", "}") or (text == ":" and head and head[-1].text in ("public", "private", "protected")):
            head = []
        else:
            head.append(code[k])
        k += 1
    return found


def places(source, where, pattern):
    """[(start, end)] of a pattern in the functions called `where`, or anywhere where that is empty."""
    wanted = [t.text for t in tokens(pattern)]
    if not wanted:
        return []
    ranges = [(s, e) for name, s, e in functions(source) if name == where] if where else [(0, len(source))]
    code, found = tokens(source), set()
    for start, end in ranges:
        inside = [t for t in code if start <= t.start and t.end <= end]
        for k in range(len(inside) - len(wanted) + 1):
            if all(inside[k + j].text == wanted[j] for j in range(len(wanted))):
                found.add((inside[k].start, inside[k + len(wanted) - 1].end))
    return sorted(found)


def find(tree, changed, file, where, pattern):
    """(path in the tree, start, end) of a pattern that stands exactly once. `changed`: {path: (before, now)} of what the mutation
    has already changed. The file is where a function was when the mutation was written: one that has moved is looked for in the
    other files of its floor. Throws LookupError."""
    def count(name):
        path = Path(tree) / name
        return places(changed[name][1] if name in changed else path.read_text(), where, pattern) if path.is_file() else []

    own = count(file)
    if len(own) == 1:
        return file, *own[0]
    what = f"{where}() in {file}" if where else file
    if own or not where:
        raise LookupError(f"{what} holds the pattern {len(own)} times, expected once: {pattern.strip()}")
    floor = Path(tree) / file.split("/")[0]
    others = sorted(str(path.relative_to(tree)) for path in floor.rglob(f"*{Path(file).suffix}"))
    moved = [(name, *place) for name in others if name != file and where in (Path(tree) / name).read_text() for place in count(name)]
    if len(moved) != 1:
        raise LookupError(f"{what} holds the pattern no more, other files of {floor.name} {len(moved)} times: {pattern.strip()}")
    return moved[0]
