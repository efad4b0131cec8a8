"""What an SVG file of gnuplot holds."""

import re
from html import unescape


def texts(path):
    """All texts of a figure, subscripts in their line."""
    found = re.findall(r"<text[^>]*>(.*?)</text>", path.read_text(encoding="utf-8"), re.DOTALL)
    return [unescape(re.sub(r"<[^>]*>", "", text)).replace("\u00a0", " ") for text in found]


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
