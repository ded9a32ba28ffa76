#!/usr/bin/env bash
# Installs Debian packages that only some tests take, if it can; those tests are skipped otherwise,
# with a loud line. Quick when there is nothing to do.
#   tests/optional_packages.sh WHAT PACKAGE...    WHAT: what will not be tested without them
set -euo pipefail
what=$1
shift
missing=()
for package in "$@"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
    missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0
if [ "$(id -u)" = 0 ]; then
  as_root=()
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root=(sudo)
else
  as_root=(false)
fi
echo "Installing Debian packages for $what: ${missing[*]}"
"${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends "${missing[@]}" && exit 0
echo "NOTE: $what will be SKIPPED; it needs: ${missing[*]}" >&2
exit 1
