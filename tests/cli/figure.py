"""What an SVG file of gnuplot holds."""

import re
from html import unescape


def texts(path):
    """All texts of a figure, subscripts in their line."""
    found = re.findall(r"<text[^>]*>(.*?)</text>", path.read_text(encoding="utf-8"), re.DOTALL)
    return [unescape(re.sub(r"<[^>]*>", "", text)).replace("\u00a0", " ") for text in found]


def places(path):
    """All texts of a figure with their places: text, x, y, size of its letters, anchor."""
    group = (
        r'<g transform="translate\(([-.\d]+),([-.\d]+)\)[^>]*font-size="([.\d]+)"\s+'
        r'text-anchor="(\w+)">\s*<text[^>]*>(.*?)</text>'
    )
    found = re.findall(group, path.read_text(encoding="utf-8"), re.DOTALL)
    return [
        (unescape(re.sub(r"<[^>]*>", "", text)), float(x), float(y), float(size), anchor)
        for x, y, size, anchor, text in found
    ]


def crowded(path):
    """Labels below a horizontal axis that are nearer to each other than a blank."""
    rows = {}
    for text, x, y, size, anchor in places(path):
        if anchor == "middle" and re.fullmatch(r"-?[\d.]+(e[+-]?\d+)?", text):
            # digits are 0.556 of the size in this letter
            rows.setdefault(y, []).append((x, 0.556 * size * len(text), text))
    found = []
    for row in rows.values():
        row.sort()
        for (x, width, text), (x_next, width_next, after) in zip(row, row[1:], strict=False):
            if x_next - x - (width + width_next) / 2 < 3 and text != after:
                found.append((text, after))
    return found


def plots(path):
    """Number of lines, shapes and sets of points."""
    return len(re.findall(r'<g id="gnuplot_plot_\d+\w*" ?>', path.read_text(encoding="utf-8")))


def blocks(path):
    """The curves of a file of data: lists of pairs, by their places in it."""
    found = []
    for block in path.read_text(encoding="utf-8").split("\n\n\n"):
        lines = [line for line in block.splitlines() if line and not line.startswith("#")]
        if lines:
            found.append([tuple(float(word) for word in line.split()) for line in lines])
    return found
