#!/usr/bin/env bash
# Runs the commands of Exercise3 that README.md shows, word for word, in a new shell. None may warn.
# Usage: readme_test.sh FOLDER   (of Exercise3)
set -euo pipefail
programs=$1
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

ln -s "$project/data" "$folder/data"
sed -n 's/^    \(Exercise3 .*\)/\1/p' "$project/README.md" > "$folder/commands.sh"
[ "$(wc -l < "$folder/commands.sh")" -ge 3 ] || { echo "README.md shows too few commands" >&2; exit 1; }
cd "$folder"
env -i PATH="$programs:/usr/bin:/bin" bash -e commands.sh 2> warnings.txt ||
  { cat warnings.txt >&2; exit 1; }
cat warnings.txt >&2
[ ! -s warnings.txt ] && [ -s frames/frame_0499.txt ] && [ -s energy.csv ]
