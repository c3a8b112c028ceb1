#!/usr/bin/env python3
"""Charts and one page from the files that `pliant bench NAME --out DIR` writes.

usage: report.py DIR    reads DIR/kernels.json, DIR/accuracy.json, ... ; writes DIR/report.html and, for each chart, DIR/NAME.svg and DIR/NAME.png
"""
import importlib
import json
import sys
from pathlib import Path

# Another benchmark is one more name here and a module report_NAME with section(result, folder) -> report_page.Section.
BENCHMARKS = ["kernels", "accuracy", "deformation", "stability", "cutting", "haptics"]


class Refused(Exception):
    pass


def load(path):
    try:
        result = json.loads(path.read_text(encoding="utf-8"))
    except OSError as e:
        raise Refused(f"{path}: cannot be read: {e.strerror}") from e
    except ValueError as e:
        raise Refused(f"{path}: is not JSON: {e}") from e
    if not isinstance(result, dict) or not isinstance(result.get("machine"), dict) or not isinstance(result.get("rows"), list):
        raise Refused(f'{path}: expected an object with "machine" and "rows", as pliant bench writes it')
    if not result["rows"]:
        raise Refused(f"{path}: has no rows, so there is nothing to draw")
    return result


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        asked = arguments in (["-h"], ["--help"])
        print(__doc__.strip(), file=sys.stdout if asked else sys.stderr)
        return 0 if asked else 2
    folder = Path(arguments[0])
    found = [name for name in BENCHMARKS if (folder / f"{name}.json").is_file()]
    if not found:
        wanted = " or ".join(f"{name}.json" for name in BENCHMARKS)
        raise Refused(f"{folder}: no {wanted} there; `pliant bench {BENCHMARKS[0]} --out {folder}` writes it")
    results = {name: load(folder / f"{name}.json") for name in found}
    try:
        import report_charts
        import report_page
    except ImportError as e:
        raise Refused(f"needs matplotlib (Debian: python3-matplotlib) in this Python, {sys.executable}: {e}") from e
    sections = []
    for name in found:
        try:
            sections.append(importlib.import_module(f"report_{name}").section(results[name], folder))
        except KeyError as e:
            raise Refused(f"{folder / name}.json: a row has no {e}; was it written by another version of pliant?") from e
    machine = results[found[0]]["machine"]
    when = f', {machine["date"]}' if "date" in machine else ""
    titles = {"kernels": "Pliant: what a step costs", "accuracy": "Pliant: speed against accuracy"}
    html = report_page.page(titles[found[0]] if len(found) == 1 and found[0] in titles else "Pliant: measurements",
                            f'{machine.get("cpu", "unknown processor")}{when}', sections)
    report_charts.write_whole(folder / "report.html", html.encode())
    print(f"report: {folder / 'report.html'}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Refused as e:
        problem = str(e)
    except OSError as e:
        problem = f"{e.filename}: {e.strerror}"
    print(f"report: {problem}", file=sys.stderr)
    sys.exit(2)
