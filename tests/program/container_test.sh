#!/usr/bin/env bash
# Builds the image of app/install/Containerfile with buildah, on a bare Debian 12 instead of a downloaded
# one, and touches in it with the program and with Python. Only in the long form and as root: it builds
# Thimble again, half an hour.
#   container_test.sh SOURCE_FOLDER
set -euo pipefail
source=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
bare=$work/bare
source "$here/bare_system.sh"
# The user's images are neither read nor changed; no engine privileges are needed.
export BUILDAH_ISOLATION=chroot STORAGE_DRIVER=vfs
buildah() { command buildah --root "$work/storage" --runroot "$work/running" "$@"; }
leave() {
  buildah rm --all >/dev/null 2>&1 || true
  remove_bare
  rm -rf "$work"
}
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
trap leave EXIT
[ -n "${THIMBLE_LONG:-}" ] || { echo "NOT TESTED: the container image; its test takes THIMBLE_LONG." && exit 77; }
type -P buildah >/dev/null && can_make_bare || {
  echo "NOT TESTED: the container image; install buildah and debootstrap, and be root."
  exit 77
}
cd "$work"
make_bare
umount "$bare/proc"
base=$(buildah from scratch)
tar -C "$bare" -cf bare.tar .
{ buildah add "$base" bare.tar / && buildah commit "$base" docker.io/library/debian:bookworm && buildah rm "$base"; } >log 2>&1 ||
  fail "no base image: $(tail -n 5 log)"
rm -rf bare.tar "$bare"
mkdir source
tar -C "$source" --exclude=./build --exclude=./.git -c . | tar -C source -x
buildah bud --pull-never -f source/app/install/Containerfile -t thimble source >log 2>&1 ||
  fail "buildah bud: $(tail -n 30 log)"
image=$(buildah from --pull-never thimble)
inside_image() { buildah run "$image" -- "$@" </dev/null >log 2>&1 || fail "in the image: $*: $(tail -n 10 log)"; }
inside_image thimble --version
inside_image thimble run elephant --duration 1
grep -qE "^Force +[0-9.]*[1-9]" log || fail "elephant: $(cat log)"
inside_image python3 -c '
import thimble
run = thimble.run("box", seconds=1)
assert run.force.shape[0] > 900, run.force.shape'
echo "PASS: the image of app/install/Containerfile touches by program and by Python"
