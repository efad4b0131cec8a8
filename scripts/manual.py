#!/usr/bin/env python3
"""Make the references in docs/, the man pages and completion/ from the program's description of itself.

    scripts/manual.py [--check] [PROGRAM]        default: build/release/vcor

`vcor help --json` gives the commands, keys, columns, statuses and exit codes; the parsers of the Python package,
which has to be importable (build/venv/bin/python), give the options of its commands. The prose around them is in
scripts/manual/*.md, where a line {{name}} stands for a part that is made here. With --check
nothing is written, and the exit code is 1 if a page is not what it should be.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import completion

ROOT = Path(__file__).resolve().parents[1]
# Page of Markdown, page of man and what it is about
PAGES = [
    ("commands", "vcor.1", "coefficient of restitution of viscoelastic impacts"),
    ("input", "vcor-input.5", "case files of vcor"),
    ("output", "vcor-output.5", "result files of vcor"),
]
MADE = "Made by scripts/manual.py from scripts/manual/{}.md and vcor help --json"
MARKDOWN_WIDTH = 120
# mandoc complains about more than 80
MAN_WIDTH = 78


# ------------------------------------------------------------------------------ parts of a page


def escaped(text):
    """Plain text as Markdown: only what is between backquotes is taken as it is."""
    parts = text.split("`")
    parts[::2] = [re.sub(r"([*<|])", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def code(words):
    """Words to be typed as they are."""
    return ", ".join(f"`{word}`" for word in words)


def item(term, text):
    return f"- `{term}`: {escaped(text)}"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def synopsis(document, man):
    usage = [line for command in document["commands"] for line in command["usage"]]
    return "\n\n".join(f"`{line}`" for line in [*usage, "vcor --version"])


def commands(document, man):
    blocks = []
    for command in document["commands"]:
        blocks.append(f"### `vcor {command['name']}`")
        blocks.extend(f"`{line}`" for line in command["usage"])
        before = {}
        for entry in command["page"]:
            if "option" in entry and "term" in before:
                blocks.append("Options:")
            before = entry
            term = " ".join(filter(None, [entry.get("option"), entry.get("value")]))
            term = term or entry.get("term")
            blocks.append(item(term, entry["text"]) if term else escaped(entry["text"]))
        blocks.append("```sh\n" + "\n".join(command["examples"]) + "\n```")
    return "\n\n".join(blocks)


def package_options(name):
    """Arguments of a command of the Python package: what is typed, and what it means."""
    from vcor._command import parser_of

    parser = parser_of(name)
    usage = (parser.usage or "").replace("%(prog)s", parser.prog).splitlines()
    rows, words = [], []
    for action in parser._actions:
        if action.dest in ("help", "version"):
            continue
        value = action.metavar or ("|".join(action.choices) if action.choices else action.dest.upper())
        takes_value = action.nargs != 0
        term = " ".join([*action.option_strings[:1], *([value] if takes_value else [])])
        meaning = (action.help or "") % {"default": action.default}
        if action.choices and action.metavar is None and len(value) > 30:
            term = term.replace(value, action.dest.upper())
            meaning += f"; one of {', '.join(map(str, action.choices))}"
        rows.append((term, meaning))
        if not action.option_strings:
            many = " ..." if action.nargs in ("+", "*") else ""
            words.append(f"{value}{many}")
    return [line.strip() for line in usage] or [f"{parser.prog} {' '.join(words)} [options]"], parser.description, rows


def package_commands(document, man):
    """Commands of the Python package with their options."""
    blocks = []
    for one in document["package_commands"]:
        usage, words, rows = package_options(one["name"])
        blocks.append(f"### `vcor {one['name']}`")
        blocks.extend(f"`{line}`" for line in usage)
        blocks.append(escaped(words))
        blocks.append("\n".join(item(term, f"{meaning}") for term, meaning in rows))
    return "\n\n".join(blocks)


def exit_codes(document, man):
    return "\n".join(
        item(str(c["code"]), f"{c['name']}: {c['meaning']}.") for c in document["exit_codes"]
    )


def value_of(key):
    """Values that a key may have."""
    if not key["choices"]:
        return f"{key['value']} {key['range']}".strip()
    return ("one of " if len(key["choices"]) > 1 else "") + code(key["choices"])


def default_of(key):
    if key["required"]:
        return f"required, or `{key['instead']}`" if "instead" in key else "required"
    if "default" not in key:
        return ""
    return f"`'{key['default']}'`" if key["type"] == "text" else f"`{key['default']}`"


def key_item(key):
    """A key as an item: what it means, what it takes, what it is by default."""
    meaning, mark, rest = key["meaning"].partition(";")
    unit = f" [{key['unit']}]" if key["unit"] else ""
    default = default_of(key)
    if default.startswith("`"):
        default = f"default {default}"
    words = "; ".join(filter(None, [meaning + unit + mark + rest, value_of(key), default])) + "."
    words += "".join(f" `{c['word']}`: {c['meaning']}." for c in key["meanings"])
    if key["models"]:
        words += f" Models: {code(key['models'])}."
    return item(key["name"], words)


def groups(document, man):
    blocks = []
    for group in document["groups"]:
        blocks.append(f"## &{group['name']}")
        words = "Required" if group["required"] else "Optional"
        words += ", may be repeated." if group["repeated"] else "."
        blocks.append(escaped(f"{group['meaning']}. {words}"))
        models = any(key["models"] for key in group["keys"])
        if man:
            blocks.append("\n".join(map(key_item, group["keys"])))
            continue
        rows = [
            [f"`{key['name']}`", escaped(key["meaning"]), escaped(key["unit"]),
             escaped(value_of(key)), default_of(key) or "-"]
            + ([code(key["models"]) or "all"] if models else [])
            for key in group["keys"]
        ]  # fmt: skip
        head = ["key", "meaning", "unit", "value", "default"] + (["models"] if models else [])
        blocks.append(table(head, rows))
        for key in group["keys"]:
            if key["meanings"]:
                blocks.append(f"The values of `{key['name']}`:")
                blocks.append("\n".join(f"- `{c['word']}`: {escaped(c['meaning'])}" for c in key["meanings"]))
        if models:
            selector = next(key for key in group["keys"] if key["name"] == group["selector"])
            blocks.append(f"The keys of each `{group['selector']}`, besides those of all:")
            names = {
                model: [key["name"] for key in group["keys"] if model in key["models"]]
                for model in selector["choices"]
            }
            blocks.append("\n".join(f"- `{model}`: {code(names[model])}" for model in names))
    return "\n\n".join(blocks)


def columns(list_of_columns, man):
    if man:
        return "\n".join(
            item(c["name"], c["meaning"] + (f" [{c['unit']}]" if c["unit"] else ""))
            for c in list_of_columns
        )
    rows = [
        [f"`{c['name']}`", escaped(c["symbol"]), escaped(c["unit"]), escaped(c["meaning"])]
        for c in list_of_columns
    ]
    return table(["column", "symbol", "unit", "meaning"], rows)


def statuses(document, man):
    if man:
        return "\n".join(
            item(s["name"], s["meaning"] + (f". Advice: {s['advice']}." if s["advice"] else "."))
            for s in document["statuses"]
        )
    rows = [
        [f"`{s['name']}`", escaped(s["meaning"]), escaped(s["advice"])]
        for s in document["statuses"]
    ]
    return table(["status", "meaning", "what to do"], rows)


PARTS = {
    "synopsis": synopsis,
    "commands": commands,
    "package_commands": package_commands,
    "exit_codes": exit_codes,
    "groups": groups,
    "summary": lambda document, man: columns(document["summary"], man),
    "history": lambda document, man: columns(document["history"], man),
    "bounces": lambda document, man: columns(document["bounces"], man),
    "statuses": statuses,
}


# --------------------------------------------------------------------------- Markdown and roff


def wrapped(text, width, indent=""):
    """Lines that end at a blank, but not within backquotes or bold words."""
    kept = re.sub(r"`[^`]*`|\\fB.*?\\fR", lambda m: m[0].replace(" ", "\0"), text)
    lines = textwrap.wrap(
        kept, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
    return [line.replace("\0", " ") for line in lines]


def filled(document, name, man):
    """A template with its parts, as Markdown."""
    text = (ROOT / "scripts" / "manual" / f"{name}.md").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda m: PARTS[m[1]](document, man), text)


def markdown(document, name):
    """A page of docs/."""
    lines = [f"<!-- {MADE.format(name)} -->", ""]
    fenced = False
    for line in filled(document, name, man=False).splitlines():
        fenced ^= line.startswith("```")
        if len(line) <= MARKDOWN_WIDTH or fenced or line.startswith("|"):
            lines.append(line)
        else:
            indent = "  " if line.startswith("- ") else ""
            lines += wrapped(line, MARKDOWN_WIDTH, indent)
    # items that follow each other are one list
    return re.sub(r"(?m)^(- .*(?:\n  .*)*)\n\n(?=- )", r"\1\n", "\n".join(lines) + "\n")


def blocks_of(page):
    """The parts of a page between blank lines; lines of code are one part."""
    for part in re.split(r"(?ms)(^```\w*\n.*?^```$)", page):
        yield from [part] if part.startswith("```") else (b.strip("\n") for b in part.split("\n\n"))


def roff(text):
    """A plain text: a minus sign is none of the typographer's dashes, and so on."""
    for old, new in [("\\", "\\e"), ("-", "\\-"), ("'", "\\(aq"), ("^", "\\(ha"), ("~", "\\(ti")]:
        text = text.replace(old, new)
    return text


def inline(text):
    """A line of Markdown as roff: what is between backquotes is bold."""
    parts = text.split("`")
    parts[::2] = [roff(re.sub(r"\\([*<|])", r"\1", part)) for part in parts[::2]]
    parts[1::2] = [f"\\fB{roff(part)}\\fR" for part in parts[1::2]]
    return "".join(parts)


def guarded(lines):
    """Lines of roff that begin with no request."""
    return [f"\\&{line}" if line.startswith(".") else line for line in lines]


def man_page(document, name, file, about):
    """A page of man, from the same Markdown. Paragraphs with links to other pages are left out."""
    title, section = file.split(".")
    lines = [
        f'.\\" {MADE.format(name)}',
        f'.TH {title.upper()} {section} "" "vcor {document["version"]}" "vcor manual"',
        ".SH NAME",
        f"{roff(title)} \\- {roff(about)}",
    ]

    def begin_paragraph(request=".PP"):
        if not lines[-1].startswith((".SH ", ".SS ")):
            lines.append(request)

    for block in blocks_of(filled(document, name, man=True)):
        if not block or block.startswith("# ") or re.search(r"\]\(\w+\.md", block):
            continue
        if block.startswith("```"):
            begin_paragraph()
            rows = [roff(row) or "\\&" for row in block.splitlines()[1:-1]]
            lines.extend([".nf", ".RS 4", *guarded(rows), ".RE", ".fi"])
        elif block.startswith("## "):
            lines.append(f".SH {inline(block[3:].upper())}")
        elif block.startswith("### "):
            lines.append(f".SS {inline(block[4:])}")
        elif block.startswith("- "):
            for entry in re.split(r"(?m)^- ", block)[1:]:
                term, words = re.match(r"`([^`]*)`: (.*)", " ".join(entry.split())).groups()
                lines.extend([".TP", f"\\fB{roff(term)}\\fR"])
                lines.extend(guarded(wrapped(inline(words), MAN_WIDTH)))
        elif re.fullmatch(r"`[^`]*`", block):
            begin_paragraph(".br")
            lines.append(inline(block))
        else:
            begin_paragraph()
            lines.extend(guarded(wrapped(inline(" ".join(block.split())), MAN_WIDTH)))
    others = [other.split(".") for _, other, _ in PAGES if other != file]
    lines += [".SH SEE ALSO", inline(", ".join(f"`{other}`({number})" for other, number in others))]
    return "\n".join(lines) + "\n"


def methods(document):
    """The table of what each method solves, and what excludes each other, as Markdown."""
    names = document["methods"]
    head = ["an impact with", "keys", *(f"`{name}`" for name in names)]
    rows = [
        [escaped(one["meaning"]), code(re.split(", (?=\\w+ =)", one["keys"])),
         *("yes" if name in one["methods"] else "no" for name in names)]
        for one in document["features"]
    ]
    rows += [
        ["the key", f"`{one['key']}`", *("read" if name in one["methods"] else "not read" for name in names)]
        for one in document["method_keys"]
    ]
    pairs = []
    for one in document["exclusions"]:
        line = item(f"{one['one']}` and `{one['other']}", one["reason"])
        pairs += wrapped(line, MARKDOWN_WIDTH, "  ")
    return table(head, rows) + "\n\nFeatures that exclude each other:\n\n" + "\n".join(pairs)


def with_methods(document, name):
    """A page written by hand in which the table of methods is made here."""
    text = (ROOT / name).read_text(encoding="utf-8")
    made = "<!-- made by scripts/manual.py -->"
    before, _, rest = text.partition(f"{made}\n")
    _, _, after = rest.partition("<!-- end -->")
    return f"{before}{made}\n{methods(document)}\n<!-- end -->{after}"


def pages(document):
    """All pages: text by path."""
    found = {"docs/which_model.md": with_methods(document, "docs/which_model.md")}
    for name, file, about in PAGES:
        found[f"docs/{name}.md"] = markdown(document, name)
        found[f"man/{file}"] = man_page(document, name, file, about)
    return found | completion.files(document)


def main():
    parser = argparse.ArgumentParser(description="make the references in docs/ and the man pages")
    parser.add_argument("program", nargs="?", default=str(ROOT / "build/release/vcor"))
    parser.add_argument("--check", action="store_true", help="compare the pages, write nothing")
    words = parser.parse_args()
    sys.path.insert(0, str(ROOT / "python/src"))
    os.environ.setdefault("VCOR_LIBRARY", str(Path(words.program).absolute().parent / "libvcor_python.so"))
    text = subprocess.run(
        [words.program, "help", "--json"], check=True, stdout=subprocess.PIPE, encoding="utf-8"
    ).stdout
    stale = []
    for name, page in pages(json.loads(text)).items():
        path = ROOT / name
        if path.exists() and path.read_text(encoding="utf-8") == page:
            continue
        stale.append(name)
        if not words.check:
            path.write_text(page, encoding="utf-8")
            print(f"manual: {name}")
    if words.check and stale:
        sys.exit(f"manual: not current: {', '.join(stale)}; run scripts/manual.py")


if __name__ == "__main__":
    main()
