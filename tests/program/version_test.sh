#!/usr/bin/env bash
# The version has one source, CMake's project(). The program prints it, and the documents that
# repeat it agree: the changelog's newest section, the citation and the examples.
source "$(dirname "$0")/expect.sh" "$@"

version=$(sed -n 's/^project(thimble VERSION \([0-9.]*\) .*/\1/p' "$source_dir/CMakeLists.txt")
expect 0 '^[0-9]+\.[0-9]+\.[0-9]+$' echo "$version"
dots=${version//./\\.}
expect 0 "^thimble $dots \\(" "$thimble" --version
expect 0 "^version: $dots\$" cat "$source_dir/CITATION.cff"
expect 0 "^## $dots( |\$)" sh -c "grep -m 1 '^## ' '$source_dir/CHANGELOG.md'"
expect 0 "find_package\\(thimble $(sed -E 's/\.[0-9]+$//; s/\./\\./' <<<"$version") " cat "$source_dir/app/examples/CMakeLists.txt"
expect 0 "^Version: $dots\$" cat "$(dirname "$thimble")/install/thimble.pc"
python=$(dirname "$thimble")/python
if [ -d "$python/thimble" ] && /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
  export PYTHONPATH=$python PYTHONDONTWRITEBYTECODE=1
  expect 0 "^$dots\$" /usr/bin/python3 -c 'import thimble; print(thimble.__version__)'
else
  echo "NOT TESTED: the version of the Python package; the package was not built, or numpy is missing."
fi
if command -v dpkg-deb >/dev/null; then
  expect 0 "CPACK_PACKAGE_VERSION \"$dots\"" cat "$(dirname "$thimble")/../CPackConfig.cmake"
fi
finish
