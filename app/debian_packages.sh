# shellcheck shell=bash
# Sourced by scripts that install Debian packages.

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
