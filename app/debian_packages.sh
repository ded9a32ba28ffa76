#!/usr/bin/env bash
# Prints the disk space of Debian packages. For each file it prints its own kB, the kB of those dependencies that a bare Debian
# (required packages and apt) does not have, and the sum. Indirect dependencies count as well.
#   app/debian_packages.sh PACKAGE.deb...      build/release/*.deb after `cpack -G DEB`
# The sizes are the field Installed-Size. The dependencies must be installed on this machine, as they are where the packages
# were built. Exit code 1: a dependency is missing, so the sum is too small. Scripts that install packages source this file.

# installed_packages PACKAGE...: prints a line "PACKAGE VERSION" for each that is installed.
installed_packages() {
  [ $# -gt 0 ] || return 0  # dpkg-query would list all
  # dpkg-query ends with 1 if one of them is unknown.
  { dpkg-query -W -f='${db:Status-Status} ${Package} ${Version}\n' "$@" 2>/dev/null || true; } |
    sed -n 's/^installed //p' | LC_ALL=C sort -u
}

# missing_packages PACKAGE...: prints a line for each that is not installed.
missing_packages() {
  printf '%s\n' "$@" | grep . | sort -u | grep -vxF -f <(installed_packages "$@" | cut -d ' ' -f 1) || true
}

# install_packages PACKAGE...: installs them. Returns 3 if this user may not or this system has no apt-get, 1 if apt-get
# fails.
install_packages() {
  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; } || return 3
    as_root=(sudo)
  fi
  command -v apt-get >/dev/null || return 3
  "${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "$@" || return 1
}

# print_package_sizes DEB...: prints the output of this script.
print_package_sizes() {
  local deb
  {
    dpkg-query -W -f='${db:Status-Status}\t${Package}\t${Installed-Size}\t${Priority}\t${Essential}\t${Pre-Depends}, ${Depends}\t${Provides}\n'
    for deb in "$@"; do
      dpkg-deb --show --showformat='file\t${Package}\t${Installed-Size}\t\t\t${Pre-Depends}, ${Depends}\t\n' "$deb"
    done
  } | awk -F'\t' '
    function name_of(text) { sub(/^ +/, "", text); sub(/[ (:\[].*/, "", text); return text }
    # Adds a package and its dependencies to those of the bare system (mark "bare") or of one of the files.
    function add(package, mark,    i, k, count, groups, alternatives, choices, found, one) {
      if ((package, mark) in has || (package, "bare") in has) return
      has[package, mark] = 1
      if (mark != "bare") { sum += kilobytes[package] }
      count = split(needs[package], groups, ",")
      for (i = 1; i <= count; ++i) {
        choices = split(groups[i], alternatives, "|")
        found = name_of(groups[i])
        if (found == "") continue
        for (k = 1; k <= choices; ++k) {
          one = name_of(alternatives[k])
          if (one in kilobytes || one in provider) { found = one in kilobytes ? one : provider[one]; break }
        }
        if (found in kilobytes) add(found, mark)
        else absent[found " (for " package ")"] = 1
      }
    }
    $1 != "installed" && $1 != "file" { next }
    # The content of a file counts, not an installed package of the same name.
    $1 == "file" { files[++file_count] = $2 }
    {
      kilobytes[$2] = $3; needs[$2] = $6
      if ($4 == "required" || $5 == "yes" || $2 == "apt") bare[$2] = 1
      count = split($7, virtual, ",")
      for (i = 1; i <= count; ++i) provider[name_of(virtual[i])] = $2
    }
    END {
      delete provider[""]
      for (package in bare) add(package, "bare")
      delete absent
      printf "%-24s %10s %14s %10s\n", "package", "kB", "needs kB", "sum in kB"
      for (i = 1; i <= file_count; ++i) {
        sum = 0
        add(files[i], i)
        printf "%-24s %10d %14d %10d\n", files[i], kilobytes[files[i]], sum - kilobytes[files[i]], sum
      }
      for (package in absent) { print "not counted, because it is not installed here: " package > "/dev/stderr"; bad = 1 }
      exit bad
    }'
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  [ $# -gt 0 ] || {
    echo "usage: app/debian_packages.sh PACKAGE.deb..." >&2
    exit 2
  }
  print_package_sizes "$@"
fi
