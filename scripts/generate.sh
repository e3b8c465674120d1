#!/usr/bin/env bash
# Writes what follows from the tables of options into launch/, config/ and docs/.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"
configure "$build"
compile "$build" option_table
/usr/bin/python3 "$project/scripts/generate_option_texts.py" "$build/test/option_table"
