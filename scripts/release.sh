#!/usr/bin/env bash
# Makes the files of a release in output/release: source archive, Debian package, the page, and the
# tables of the benchmarks. Refuses to release what is not committed.
# Usage: scripts/release.sh [--try]      --try: also installs the package in a bare Debian, made by
#                                        debootstrap (needs root), and runs it there
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

[ $# -eq 0 ] || [ "$*" = --try ] || die "unexpected '$*': scripts/release.sh [--try]"
"$project/scripts/setup.sh" core python lab releases
cd "$project"
[ -z "$(git status --porcelain)" ] || die "there are changes that are not committed"
version=$(sed -n 's/^project(spring_pendulum VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
grep -q "^  <version>$version</version>" package.xml || die "package.xml is not of version $version"
grep -q "^$version (" CHANGELOG.rst || die "CHANGELOG.rst has no entry with a date for $version"
release=$project/output/release
rm -rf "$release"
mkdir -p "$release"

say "source archive"
name=spring_pendulum-$version
git archive --prefix="$name/" -o "$release/$name.tar.gz" HEAD

say "Debian package"
folder=$build-release
configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_INSTALL_PREFIX=/usr \
  -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON -DSPRING_PENDULUM_TESTS=OFF
compile "$folder"
(cd "$folder" && cpack -B "$release" > cpack.log 2>&1) || { cat "$folder/cpack.log" >&2; exit 1; }
rm -rf "$release/_CPack_Packages"

scripts/lab.sh
cp output/pendulum_lab.html "$release"
tar -C benchmark/results -czf "$release/$name-benchmarks.tar.gz" .
(cd "$release" && sha256sum -- * > SHA256SUMS && cat SHA256SUMS)
[ $# -gt 0 ] || exit 0

say "trying the package in a bare $(. /etc/os-release && echo "$VERSION_CODENAME")"
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root" \
  > "$release/../debootstrap.log" 2>&1 || die "debootstrap failed: output/debootstrap.log"
cp "$release"/*.deb "$root/srv"
cp /etc/resolv.conf "$root/etc"
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
  chroot "$root" bash -ec 'cd /srv
    apt-get install -y --no-install-recommends ./*.deb > log 2>&1 ||
      { tail -n 20 log; exit 1; }
    Exercise3 --version
    Exercise3 Runge-Kutta-4 /usr/share/spring_pendulum/data/particle.txt --output frames
    python3 -c "import spring_pendulum as sp; print(sp.simulate(\"/usr/share/spring_pendulum/data/particle.txt\"))"'
say "the package works"
