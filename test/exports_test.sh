#!/usr/bin/env bash
# The shared library exports what the public headers declare, and nothing else.
# Usage: exports_test.sh LIBRARY
set -euo pipefail
die() { printf '%s\n' "$@" >&2; exit 1; }

symbols=$(nm -DC --defined-only "$1" | cut -d' ' -f3-)
[ -n "$symbols" ] || die "no symbols"
foreign=$(grep -vE '^((vtable|typeinfo|typeinfo name) for )?spring_pendulum::' <<< "$symbols" || true)
[ -z "$foreign" ] || die "foreign symbols:" "$foreign"
internal=$(grep -E 'Stepper|Kernel|OutputFolder|CheckedIntegrator|parseCommandLine' <<< "$symbols" || true)
[ -z "$internal" ] || die "internal symbols:" "$internal"
for name in 'makeIntegrator(' 'registerMethod(' 'Chain::Chain(' 'State::State(' 'readParticleFile('; do
  grep -qF "spring_pendulum::$name" <<< "$symbols" || die "not exported: $name"
done
readelf -d "$1" | grep -qE 'SONAME.*libspring_pendulum\.so\.[0-9]+\.[0-9]+\]' || die "no SONAME with a version"
