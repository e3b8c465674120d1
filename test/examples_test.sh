#!/usr/bin/env bash
# Builds and runs examples/ as a program outside this project.
# Usage: examples_test.sh FOLDER   (of spring_pendulumConfig.cmake)
set -euo pipefail
package=$1
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cmake -S "$project/examples" -B "$folder" -Dspring_pendulum_DIR="$package" > "$folder/log" 2>&1 &&
  cmake --build "$folder" >> "$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }

expect() { grep -qE "$1" <<< "$2" || { printf 'no "%s" in:\n%s\n' "$1" "$2" >&2; exit 1; }; }

expect '^10 s: .* m$' "$("$folder/simulate" "$project/data/particle.txt")"
if output=$("$folder/simulate" /nowhere.txt 2>&1); then exit 1; fi
expect '/nowhere.txt' "$output"
expect '500 frames.*, verdict: ok$' "$("$folder/judge" "$project/data/particle.txt")"
if output=$("$folder/judge" /nowhere.txt 2>&1); then exit 1; fi
own=$("$folder/own_methods")
for method in Ralston Heun Runge-Kutta-4; do expect "^$method: .* m after 10 s$" "$own"; done
