"""Makes a site of FORD's pages readable without a network, and checks that every page of the site is.

offline.py SITE: SITE/fortran has FORD's pages, which fetch Bootstrap, for which Debian's copy is put beside them,
and MathJax, which goes, since no comment of the sources has a formula.
"""

import re
import shutil
import sys
from pathlib import Path

BOOTSTRAP = Path("/usr/share/javascript/bootstrap5")
FILES = {"css/bootstrap.min.css": "css", "js/bootstrap.bundle.min.js": "js"}


def main():
    """Change FORD's pages, then look at all."""
    site = Path(sys.argv[1])
    ford = site / "fortran"
    for name, folder in FILES.items():
        shutil.copy(BOOTSTRAP / name, ford / folder)
    for path in ford.rglob("*.html"):
        here = "../" * (len(path.relative_to(ford).parts) - 1) or "./"
        text = path.read_text()
        text = re.sub(r'https://[^"]*/bootstrap@[^"/]*/dist/(?=css/|js/)', here, text)
        text = re.sub(r'\s+integrity="[^"]*"\s+crossorigin="[^"]*"', "", text)
        text = re.sub(r'<!-- MathJax -->.*?<script src="[^"]*MathJax[^"]*"[^>]*></script>', "", text, flags=re.S)
        path.write_text(text)
    address = re.compile(r'<(?:script|link|img)\b[^>]*\b(?:src|href)="((?:https?:)?//[^"]*)"')
    fetched = sorted({found for path in site.rglob("*.html") for found in address.findall(path.read_text())})
    if fetched:
        sys.exit("site: error: pages fetch " + ", ".join(fetched))


if __name__ == "__main__":
    main()
