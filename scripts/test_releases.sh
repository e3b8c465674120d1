#!/usr/bin/env bash
# Runs scripts/run.sh and scripts/test.sh on other Debian releases, each in a chroot made by
# debootstrap. Needs root, 5 GB and half an hour per release. The folders are kept for the next run;
# remove them by hand.
# Usage: scripts/test_releases.sh [RELEASE ...]     (default: bullseye bookworm trixie)
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
releases=${SPRING_PENDULUM_RELEASES:-/var/tmp/spring_pendulum_releases}
[ "$(id -u)" = 0 ] || die "must run as root, for chroot"
[ $# -gt 0 ] || set -- bullseye bookworm trixie
"$project/scripts/setup.sh" releases

# Separate file systems: the /dev of the host is not visible inside.
mount_in() {
  mount -t proc proc "$1/proc"
  mkdir -p "$1/dev/pts" "$1/dev/shm"
  mount -t devpts -o newinstance,ptmxmode=0666 devpts "$1/dev/pts"
  mount -t tmpfs tmpfs "$1/dev/shm"
}

unmount_in() {
  local folder
  for folder in dev/shm dev/pts proc; do
    if mountpoint -q "$1/$folder"; then umount "$1/$folder"; fi
  done
}

# inside ROOT COMMAND
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM="${TERM:-dumb}" \
    chroot "$1" bash -c "$2"
}

failed=()
for release in "$@"; do
  root=$releases/$release
  say "$release in $root"
  if [ ! -e "$root/etc/debian_version" ]; then
    mkdir -p "$root"
    debootstrap --variant=minbase "$release" "$root" "$mirror" > "$root.log" 2>&1 ||
      { tail -n 20 "$root.log"; die "debootstrap failed"; }
  fi
  rm -rf "$root/srv/spring_pendulum"
  mkdir "$root/srv/spring_pendulum"
  (cd "$project" && git -c safe.directory="$project" ls-files -z | tar --null -T - -c) |
    tar -x -C "$root/srv/spring_pendulum"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  trap 'unmount_in "$root"' EXIT
  mount_in "$root"
  inside "$root" 'cd /srv/spring_pendulum && scripts/run.sh && scripts/test.sh' ||
    failed+=("$release")
  unmount_in "$root"
done
[ ${#failed[@]} = 0 ] || die "failed on: ${failed[*]}"
say "passed on: $*"
