#!/usr/bin/env bash
# Everything is installed into the prefix given to cmake --install, and works from there.
# Usage: install_prefix_test.sh CMAKE BUILD
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
die() { printf '%s\n' "$@" >&2; exit 1; }

prefix=$folder/prefix
"$1" -DCMAKE_INSTALL_PREFIX="$prefix" -P "$2/cmake_install.cmake" > "$folder/log" 2>&1 || die "$(cat "$folder/log")"
outside=$(grep -E '^-- (Installing|Up-to-date): ' "$folder/log" | grep -vF ": $prefix" || true)
[ -z "$outside" ] || die "outside the prefix:" "$outside"
configured=$(sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$2/CMakeCache.txt")
wrong=$(grep -rIlF "$configured" "$prefix" --include='*.sh' --include='*.pc' --include='*.cmake' || true)
[ -z "$wrong" ] || die "with the prefix of the configuration:" "$wrong"
[ -s "$prefix/share/bash-completion/completions/Exercise3" ] || die "no completion"
! command -v help2man > /dev/null || [ -s "$prefix/share/man/man1/Exercise3.1" ] || die "no manual page"
! grep -rE '\?\?|^\\fB\\-.* [a-z]+ ' "$prefix/share/man" || die "a unit or the text of an option is broken in a manual page"

program=$(find "$prefix" -name Exercise3 -path '*/spring_pendulum/*' -o -name Exercise3 -path '*/bin/*' | head -n 1)
cd "$folder"
"$program" Euler "$prefix/share/spring_pendulum/data/particle.txt" --frames 3 --output frames > /dev/null
[ -s frames/frame_0002.txt ] || die "no frames"
module=$(find "$prefix" -name '_core.*.so' -path '*/spring_pendulum/*')
if [ -n "$module" ]; then
  folder_of_python=${module%/spring_pendulum/*}
  [ ! -e "$prefix/setup.bash" ] || folder_of_python=$(set +u; source "$prefix/setup.bash" && echo "$PYTHONPATH")
  PYTHONPATH=$folder_of_python /usr/bin/python3 -c 'import sys, spring_pendulum as sp
assert sp.__file__.startswith(sys.argv[1]), sp.__file__
print(sp.simulate(sys.argv[2]))' "$prefix" "$prefix/share/spring_pendulum/data/particle.txt" > /dev/null ||
    die "the Python module does not work"
fi
[ -e "$prefix/lib/pkgconfig/spring_pendulum.pc" ] && command -v pkg-config > /dev/null || exit 0
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
pkg-config --cflags spring_pendulum | grep -qF -- "-I$prefix/include" || die "pkg-config finds no headers"
! pkg-config --libs spring_pendulum | grep -q -- '-lroscpp\( \|$\)' || die "pkg-config links roscpp"
