#!/usr/bin/env bash
# Installs and lists the optional parts of Thimble (app/optional_parts.list). BY: the command that installs them, as in
# that list, or the key of a part. THIMBLE_WITHOUT in the environment: keys of parts that may be absent and are not installed.
#   app/optional_parts.sh keys BY...            prints the keys of the parts
#   app/optional_parts.sh packages BY...        prints the Debian packages of the parts
#   app/optional_parts.sh install BY...         installs them; exits with 1 and names the part if one cannot be installed
#   app/optional_parts.sh state                 prints the state of all parts on this system; a build folder that was
#                                               configured with another state is configured again
#   app/optional_parts.sh table FOLDER BY...    prints which parts the build in FOLDER has, and reasons for missing ones
#   app/optional_parts.sh missing FOLDER BY...  prints the keys of the parts whose packages are missing
set -euo pipefail
cd "$(dirname "$0")/.."
source app/debian_packages.sh

# parts [BY...]: prints lines "key|by|packages|part" of the list, without padding; all if no BY is given.
parts() {
  sed -E '/^#/d; s/ *\| */|/g; s/ +$//' app/optional_parts.list |
    awk -F'|' -v by=" $* " 'by ~ /^ *$/ || index(by, " " $2 " ") || index(by, " " $1 " ")'
}

# wanted_parts BY...: the same without THIMBLE_WITHOUT.
wanted_parts() {
  parts "$@" | awk -F'|' -v without=" ${THIMBLE_WITHOUT:-} " '!index(without, " " $1 " ")'
}

# packages_of: prints the packages of the parts in its input, one per line.
packages_of() {
  cut -d '|' -f 3 | tr ' ' '\n' | grep . || true
}

# install_parts BY...
install_parts() {
  local missing part_missing packages part status=0
  # shellcheck disable=SC2046
  mapfile -t missing < <(missing_packages $(wanted_parts "$@" | packages_of))
  [ ${#missing[@]} -gt 0 ] || return 0
  echo "Installing Debian packages: ${missing[*]}"
  # One call for all is fastest. If one package is unavailable, the other parts are still installed.
  ! install_packages "${missing[@]}" || return 0
  while IFS='|' read -r _ _ packages part; do
    # shellcheck disable=SC2086
    mapfile -t part_missing < <(missing_packages $packages)
    [ ${#part_missing[@]} = 0 ] || install_packages "${part_missing[@]}" </dev/null || {
      echo "NOTE: $part: these Debian packages could not be installed: ${part_missing[*]}" >&2
      status=1
    }
  done < <(wanted_parts "$@")
  return $status
}

state() {
  # shellcheck disable=SC2046
  installed_packages $(parts | packages_of)
  # Downloaded but not installed.
  [ ! -f build/meshes/elephant.off ] || echo "build/meshes"
  tests/usb/kernel.sh 2>/dev/null || true
}

# rows FOLDER BY...: prints lines "state|key|by|part|reason" of a build.
rows() {
  awk -F'|' -v by=" ${*:2} " 'index(by, " " $3 " ")' "$1/optional_parts.txt"
}

for key in ${THIMBLE_WITHOUT:-}; do
  grep -qxF "$key" <(parts | cut -d '|' -f 1) || {
    echo "Unknown optional part '$key'. app/optional_parts.list has the keys." >&2
    exit 2
  }
done
command=${1:-}
[ $# = 0 ] || shift
case $command in
  keys) parts "$@" | cut -d '|' -f 1 ;;
  packages) wanted_parts "$@" | packages_of ;;
  install) install_parts "$@" ;;
  state) state ;;
  table)
    echo "Optional parts of $1:"
    rows "$@" | while IFS='|' read -r state key _ part reason; do
      printf '  %-7s  %-10s  %s%s\n' "$state" "$key" "$part" "${reason:+: $reason}"
    done
    ;;
  missing)
    rows "$@" | awk -F'|' -v without=" ${THIMBLE_WITHOUT:-} " '$1 == "missing" && !index(without, " " $2 " ") { print $2 }'
    ;;
  *)
    sed -n '2,11s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
