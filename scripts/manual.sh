#!/usr/bin/env bash
# Writes the pages that the program prints of itself: the references in docs/ and the pages of man/.
#
#   scripts/manual.sh [PROGRAM]     default: build/release/vcor
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
vcor=${1:-$top/build/release/vcor}

# page FILE WORD ...: what 'vcor help WORD ...' prints, and the old page stays if it fails
page() {
   local file=$top/$1
   shift
   "$vcor" help "$@" >"$file.new"
   mv "$file.new" "$file"
   printf 'manual: %s\n' "$file"
}

page docs/commands.md --markdown
page docs/input.md input --markdown
page docs/output.md output --markdown
page man/vcor.1 --man
page man/vcor-input.5 input --man
page man/vcor-output.5 output --man
