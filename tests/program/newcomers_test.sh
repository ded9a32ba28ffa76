#!/usr/bin/env bash
# Five newcomers (newcomers/*.sh) follow README and guide, each in an empty folder with only the
# installation: side by side with this build installed into a folder; with THIMBLE_LONG and as root one by
# one in a bare Debian 12 with the packages. Their times are printed and never checked.
#   newcomers_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
bare=$work/bare
source "$here/bare_system.sh"
leave() {
  remove_bare
  rm -rf "$work"
}
trap leave EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
cd "$work"
newcomers=(student researcher developer maker teacher)
[ "$(ls "$here"/newcomers/*.sh | wc -l)" = $((${#newcomers[@]} + 1)) ] || fail "a newcomer is not asked"

if [ -n "${THIMBLE_LONG:-}" ] && can_make_bare; then
  cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work" >log 2>&1 || fail "$(tail -n 40 log)"
  make_bare
  cp "$work"/*.deb "$bare/root/"
  cp -r "$here/newcomers" "$bare/root/"
  inside 'apt-get update -q'
  inside 'cd /root && apt-get install -y -q ./thimble_*.deb ./thimble-{viewer,studies,compat,mesh-formats,bodies}_*.deb \
    $(for deb in thimble_*.deb thimble-viewer_*.deb; do dpkg-deb -f $deb Recommends; done | tr -d , | tr " " "\n" | grep -v ^thimble) ffmpeg'
  inside 'cd /root && apt-get install -y -q --no-install-recommends ./libthimble-dev_*.deb g++ cmake make hdf5-tools'
  if ls "$bare"/root/python3-thimble_*.deb >/dev/null 2>&1; then
    inside 'cd /root && apt-get install -y -q --no-install-recommends ./python3-thimble_*.deb python3-pandas python3-h5py python3-matplotlib'
  fi
  for newcomer in "${newcomers[@]}"; do
    SECONDS=0
    inside "mkdir -p /root/$newcomer && cd /root/$newcomer &&
      DOCUMENTS=/usr/share/doc/thimble THIMBLE_LONG=1 bash /root/newcomers/$newcomer.sh"
    echo "$newcomer: $SECONDS s in a bare Debian 12"
    cat log
  done
  exit 0
fi
[ -z "${THIMBLE_LONG:-}" ] ||
  echo "NOT TESTED: the newcomers in a bare Debian 12; that takes root and debootstrap."

cmake --install "$build" --prefix "$work/usr" >log 2>&1 || fail "$(cat log)"
export PATH=$work/usr/bin:$PATH DOCUMENTS=$work/usr/share/doc/thimble
export PYTHONPATH=$work/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1
PKG_CONFIG_PATH=$(dirname "$(find "$work/usr" -name thimble.pc)")
export PKG_CONFIG_PATH CMAKE_PREFIX_PATH=$work/usr
ln -s /usr/bin/python3 "$work/usr/bin/python3"  # the script that the package is for
follow() {  # NEWCOMER, in a separate folder and home
  local begin=$EPOCHREALTIME status=0
  mkdir -p "$work/$1/home"
  (cd "$work/$1" && HOME=$PWD/home XDG_STATE_HOME=$PWD/home/state XDG_CONFIG_HOME=$PWD/home/config \
    XDG_CACHE_HOME=$PWD/home/cache bash "$here/newcomers/$1.sh") >"$1.said" 2>&1 || status=$?
  awk -v name="$1" -v from="$begin" -v to="$EPOCHREALTIME" 'BEGIN { printf "%s: %.1f s\n", name, to - from }' >"$1.time"
  return $status
}
declare -A running
for newcomer in "${newcomers[@]}"; do
  follow "$newcomer" &
  running[$newcomer]=$!
done
failed=0
for newcomer in "${newcomers[@]}"; do
  wait "${running[$newcomer]}" || failed=1
  cat "$newcomer.time" "$newcomer.said"
done
exit $failed
