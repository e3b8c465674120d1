#!/usr/bin/env bash
# Runs scripts/run.sh and scripts/test.sh on other Debian and Ubuntu releases, each in a chroot made by
# debootstrap. Needs root, 5 GB and half an hour per release.
# Usage: scripts/test_releases.sh [RELEASE ...]     (default: bullseye bookworm trixie; also: focal)
# Environment:
#   SPRING_PENDULUM_RELEASES  folder of the chroots, kept for the next run
#                             (default: ~/.cache/spring_pendulum_releases)
#   RELEASE_MIRROR            where packages come from (default: the one debootstrap knows)
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

releases=${SPRING_PENDULUM_RELEASES:-${XDG_CACHE_HOME:-$HOME/.cache}/spring_pendulum_releases}
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
    components=main
    if [ "$release" = focal ]; then components=main,universe; fi
    debootstrap --variant=minbase --components="$components" "$release" "$root" \
      ${RELEASE_MIRROR:+"$RELEASE_MIRROR"} > "$root.log" 2>&1 ||
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
