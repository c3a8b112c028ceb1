"""The page around the charts of any benchmark: one HTML file, readable on a screen, on paper and without a network."""
import html
from dataclasses import dataclass, field

from report_charts import COLOURS, DARK, FAINT, GRID, INK, ON_DARK, PAPER


def text(value):
    return html.escape(str(value))


@dataclass
class Column:
    """`show` makes the text of a cell; sorting uses the value itself. `note` appears when the pointer rests on the heading."""
    key: str
    heading: str
    unit: str = ""
    show: callable = str
    note: str = ""
    number: bool = True


@dataclass
class Section:
    """One benchmark on the page."""
    title: str
    anchor: str
    parts: list = field(default_factory=list)  # HTML


def paragraph(*sentences):
    return f"<p>{' '.join(sentences)}</p>"


def heading(words):
    return f"<h3>{text(words)}</h3>"


def figure(svg, label, caption):
    return f'<figure><div role="img" aria-label="{text(label)}">{svg}</div><figcaption>{caption}</figcaption></figure>'


def notice(words, bad=False):
    return f'<p class="notice{" bad" if bad else ""}">{words}</p>'


def facts(pairs):
    return '<dl class="facts">' + "".join(f"<dt>{text(k)}</dt><dd>{text(v)}</dd>" for k, v in pairs) + "</dl>"


def table(columns, rows, sortable=False, strong=lambda row: False):
    """`rows` are dictionaries; a missing key is an empty cell. `strong` picks the rows that a reader looks for."""
    head = []
    for c in columns:
        unit = f'<span class="unit">{text(c.unit)}</span>' if c.unit else ""
        # No <button>: Chromium leaves buttons out of the headings that it repeats on every printed page.
        words = f'<span class="sort" role="button" tabindex="0">{text(c.heading)}</span>' if sortable else text(c.heading)
        note = f' title="{text(c.note)}"' if c.note else ""
        head.append(f'<th scope="col"{"" if c.number else " class=words"}{note}>{words}{unit}</th>')
    body = []
    for row in rows:
        cells = []
        for c in columns:
            value = row.get(c.key)
            kind = "" if c.number else " class=words"
            order = f' data-v="{text(value)}"' if sortable and c.number and value is not None else ""
            cells.append(f"<td{kind}{order}>{'' if value is None else c.show(value)}</td>")
        body.append(f"<tr{' class=strong' if strong(row) else ''}>{''.join(cells)}</tr>")
    kind = "sortable" if sortable else ""
    return f'<div class="scroll"><table class="{kind}"><thead><tr>{"".join(head)}</tr></thead><tbody>{"".join(body)}</tbody></table></div>'


def machine_facts(machine):
    pairs = [("Processor", f'{machine.get("cpu", "unknown")}, {machine.get("threads", "?")} threads')]
    for backend in machine.get("backends", []):
        bits = "bit-exact" if backend.get("bit_exact") else "not in the bit-exact set"
        pairs.append((backend["name"], f'{backend.get("device", "")}; {backend.get("version", "")}; {bits}'))
    pairs.append(("Compiler", machine.get("compiler", "unknown")))
    known = {"cpu", "threads", "backends", "compiler"}
    return facts(pairs + [(k.capitalize(), v) for k, v in machine.items() if k not in known and not isinstance(v, (dict, list))])


def colours(palette, ink, faint, grid, paper, on, panel, bad):
    names = {"on": on, "ink": ink, "faint": faint, "grid": grid, "paper": paper, "panel": panel, "bad": bad}
    names.update({f"c{i}": c for i, c in enumerate(palette)})
    return "".join(f"--{k}:{v};" for k, v in names.items())


def page(title, lead, sections):
    contents = ""
    if len(sections) > 1:
        contents = "<nav>" + " · ".join(f'<a href="#{s.anchor}">{text(s.title)}</a>' for s in sections) + "</nav>"
    body = "".join(f'<section id="{s.anchor}"><h2>{text(s.title)}</h2>{"".join(s.parts)}</section>' for s in sections)
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{text(title)}</title>'
            f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{style()}</style></head>\n'
            f"<body><header><h1>{text(title)}</h1><p>{text(lead)}</p>{contents}</header>\n{body}\n<script>{SORT}</script></body></html>\n")


def style():
    light = colours(COLOURS, INK, FAINT, GRID, PAPER, ON_DARK, "#f5f6f7", "#b3261e")
    dark = colours(DARK, "#e4e7ea", "#9aa3ab", "#343b42", "#16191c", "#000000", "#1f2428", "#ff8a80")
    return STYLE.replace("LIGHT", light).replace("DARK", dark)


STYLE = """
:root{LIGHT color-scheme:light dark}
@media screen and (prefers-color-scheme:dark){:root{DARK}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:60rem;padding:2rem 1.25rem 4rem;background:var(--paper);color:var(--ink);
 font:15px/1.55 system-ui,"Segoe UI","DejaVu Sans",sans-serif}
h1{font-size:1.75rem;line-height:1.2;margin:0 0 .3rem}
header p{margin:0;color:var(--faint)}
nav{margin-top:.7rem}
a{color:var(--c0)}
h2{font-size:1.3rem;margin:2.2rem 0 .6rem;padding-top:.9rem;border-top:1px solid var(--grid)}
h3{font-size:1.02rem;margin:1.9rem 0 .4rem}
p,ul{max-width:46rem;margin:.5rem 0}
code{font:.92em ui-monospace,"DejaVu Sans Mono",monospace}
figure{margin:1.2rem 0 1.8rem}
figure svg{display:block;width:100%;height:auto;max-width:54rem}
figcaption{max-width:46rem;color:var(--faint);font-size:.88rem;margin-top:.5rem}
.notice{border-left:3px solid var(--c0);padding:.35rem .8rem;background:var(--panel)}
.notice.bad{border-color:var(--bad)}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1.2rem;margin:.6rem 0;font-size:.92rem}
.facts dt{color:var(--faint)}
.facts dd{margin:0}
.scroll{overflow-x:auto;margin:.8rem 0}
table{border-collapse:collapse;font-size:.84rem;font-variant-numeric:tabular-nums}
th,td{padding:.22rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--grid)}
th{vertical-align:bottom;border-bottom:1.5px solid var(--faint);font-weight:600;line-height:1.25}
th:first-child,td:first-child{padding-left:0}
.words{text-align:left}
.unit{display:block;font-weight:400;color:var(--faint)}
tr.strong td{font-weight:600}
td code{font-size:.95em}
.differs{color:var(--bad);font-weight:600}
.sort{cursor:pointer}
.sort:focus-visible{outline:2px solid var(--c0)}
th[aria-sort=ascending] .sort::after{content:" \\2191"}
th[aria-sort=descending] .sort::after{content:" \\2193"}
@page{size:A4;margin:14mm 12mm}
@media print{
 body{max-width:none;padding:0;font-size:9.5pt}
 h2{margin-top:1.2rem}
 h2,h3,h2+p,h3+p{break-after:avoid}
 figure,.facts,.notice,tr{break-inside:avoid}
 figure{margin:.7rem 0 1rem}
 figure svg{max-width:150mm}
 figcaption,.facts{font-size:8.5pt}
 .scroll{overflow:visible}
 thead{display:table-header-group}
 table{font-size:7.3pt}
 th,td{padding:.12rem .38rem}
 a{color:inherit;text-decoration:none}
}
"""

SORT = """
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
  heads.forEach((head, i) => {
    const sort = () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      heads.forEach(h => h.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const value = row => { const c = row.cells[i]; return "v" in c.dataset ? Number(c.dataset.v) : c.textContent; };
      const order = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
      body.append(...[...body.rows].sort((a, b) => (up ? 1 : -1) * order(value(a), value(b))));
    };
    const words = head.querySelector(".sort");
    words.addEventListener("click", sort);
    words.addEventListener("keydown", e => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); sort(); } });
  });
}
"""
