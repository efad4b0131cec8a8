#!/usr/bin/env bash
# Makes the site of the documents, build/site/html/index.html: the pages of docs with a search, the notebook
# of the tutorial executed, the references of the Python package and of the Fortran library. Builds the
# library (scripts/setup.sh has what that needs) and installs Sphinx in build/site_venv. The site needs no
# network: MathJax and Bootstrap (Debian's libjs-bootstrap5) are in it. Stops at the first warning of Sphinx. Not a part of scripts/test.sh; .github/workflows/site.yml runs it.
#
#   scripts/site.sh
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
top=$PWD
venv=$top/build/site_venv
site=$top/build/site
fail() { printf 'site: error: %s\n' "$*" >&2; exit 1; }

[ $# -eq 0 ] || fail "unknown argument '$1', expected nothing"
[ -d /usr/share/javascript/bootstrap5 ] || fail "no Bootstrap here; please apt-get install libjs-bootstrap5"
cmake --preset release >/dev/null
cmake --build --preset release --target vcor_python >/dev/null

made_of=$(python3 --version; cat docs/site/requirements.txt tests/requirements.txt)
if [ "$made_of" != "$(cat "$venv/made_of" 2>/dev/null)" ]; then
   python3 -m venv --clear "$venv"
   "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-input -r docs/site/requirements.txt
   printf '%s' "$made_of" >"$venv/made_of"
fi

# The pages as they are, with links to the folders that they name
rm -rf "$site"
mkdir -p "$site"
cp -r docs "$site/docs"
cp docs/site/conf.py docs/site/python_api.md "$site/docs"
cp README.md "$site/docs/index.md"
cp examples/tutorial.ipynb "$site/docs"
sed "s|](docs/|](|g" CHANGELOG.md >"$site/docs/changes.md"
printf 'ROOT = %s\n' "$top" >"$site/docs/place"
for name in examples data include tests benchmarks scripts man src CONTRIBUTING.md README.md CHANGELOG.md CITATION.cff LICENSE; do
   ln -s "$top/$name" "$site/$name"
done
# Where the notebook finds its cases
ln -s "$top"/examples/{paper,sweeps,materials,identification} "$top"/examples/*.csv "$site/docs"

export VCOR_LIBRARY=$top/build/release/libvcor_python.so PYTHONPATH=$top/python/src
"$venv/bin/python" -m sphinx -W --keep-going -q -b html "$site/docs" "$site/html"
"$venv/bin/ford" -q -o "$site/html/fortran" docs/site/fortran.md
python3 docs/site/offline.py "$site/html"
printf 'site: %s\n' "$site/html/index.html"
