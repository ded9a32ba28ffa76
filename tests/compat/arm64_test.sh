#!/usr/bin/env bash
# The libraries of the compatibility layer, and C programs, built for 64-bit ARM and run under QEMU, with
# the `thimble exec` of this machine: the exported names are equal, structs are returned by value, and memory
# shared between the two processors has the same layout. Only with THIMBLE_LONG.
#   arm64_test.sh THIMBLE SOURCE_DIR WORK_DIR EIGEN_INCLUDE_DIR VERSION_INCLUDE_DIR
skip() {
  echo "SKIPPED: the compatibility layer was NOT tested on 64-bit ARM: $1" >&2
  exit 77
}
[ -n "${THIMBLE_LONG:-}" ] || skip "THIMBLE_LONG=1 is not set"
for tool in aarch64-linux-gnu-g++ aarch64-linux-gnu-gcc aarch64-linux-gnu-nm qemu-aarch64; do
  command -v $tool >/dev/null || skip "$tool is missing (as root: apt-get install g++-aarch64-linux-gnu qemu-user)"
done
source "$(dirname "$0")/../program/expect.sh" "$1" "$2" "$3"
eigen=$4 version_folder=$5
export TMPDIR=$work
compat=$source_dir/app/compat
headers=$compat/include/thimble/compat
mkdir lib clients

# library NAME API [FLAG...]: libNAME.so from the sources of an API and of the core, as app/compat/CMakeLists.txt makes it.
library() {
  local name=$1 api=$2 source objects=()
  mkdir -p "$api"
  for source in "$compat/$api"/*.cpp "$compat"/core/*.cpp; do
    objects+=("$api/$(basename "$source").o")
    aarch64-linux-gnu-g++ -std=c++20 -O1 -fPIC -Wno-psabi \
      -I"$version_folder" -I"$source_dir/app" -I"$headers" -I"$source_dir/driver/include" -I"$source_dir/driver/src" \
      -isystem "$eigen" -c "$source" -o "${objects[-1]}" || return
  done
  {
    echo '{ global:'
    sed -nE 's/^([A-Za-z].*)/\1;/p' "$compat/$api/symbols.txt"
    echo 'local: *; };'
  } >"$api.map"
  aarch64-linux-gnu-g++ -shared "${objects[@]}" -static-libstdc++ -static-libgcc -pthread \
    -Wl,--version-script="$api.map" -Wl,--no-undefined -o "lib/lib$name.so"
}
expect 0 '' library HD hd
expect 0 '' library HL hl
expect 0 '' library hdPhantom hdphantom
expect 0 '' library drd dhd
ln -s libdrd.so lib/libdhd.so
ln -s libdrd.so lib/libdhd.so.3
ln -s libdrd.so lib/libdrd.so.3
client() {  # client SOURCE LIBRARY...
  local name
  name=$(basename "$1" .c)
  aarch64-linux-gnu-gcc -O1 -D_GNU_SOURCE -I"$headers" "$1" -Llib "${@:2}" -ldl -lm -o "clients/$name"
}
for name in hd_abi calibration hello_sphere two_callbacks wrong_calls; do
  expect 0 '' client "$source_dir/tests/compat/clients/$name.c" -lHD
done
expect 0 '' client "$source_dir/tests/compat/clients/chai_sphere.c"
expect 0 '' client "$source_dir/tests/compat/clients/hl.c" -lHD -lHL
for name in abi hello_force sphere; do
  mkdir -p dhd_clients
  expect 0 '' client "$source_dir/tests/compat/dhd/clients/$name.c" -ldrd
  mv "clients/$name" "dhd_clients/$name"
done

for pair in hd=HD hl=HL hdphantom=hdPhantom dhd=drd; do
  expect_own 0 '^same$' bash -c "diff <(grep -E '^[A-Za-z]' '$compat/${pair%%=*}/symbols.txt' | LC_ALL=C sort) \
    <(aarch64-linux-gnu-nm -D --defined-only lib/lib${pair#*=}.so | awk '{ sub(/@.*/, \"\", \$3); print \$3 }' | LC_ALL=C sort -u) &&
    echo same"
done

# The emulated program searches its own libraries first; the emulator uses those of this machine.
arm() {
  local options=()
  while [ "$1" != -- ]; do options+=("$1") && shift; done
  shift
  "$thimble" exec "${options[@]}" qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH="$work/lib" "$@"
}
printf '0 0 0 0.03\n1 0 0 0.012\n2 0.003 0 0.012\n3 0.003 0 0.03\n' >press.txt
expect_own 0 'errors by value: right' arm --arm vintage_phantom --arm falcon -- clients/wrong_calls
expect_own 0 'vintage_phantom by Thimble' arm --hand press.txt -- clients/hello_sphere
expect_own 0 'calibrated after 1, 200 x 200 x 200 mm, 5 N, 3 in' arm -- clients/calibration
expect_own 0 ' 0 out of order, 0 torn' arm -- clients/two_callbacks
expect_own 0 '2500 turns, [1-9]' arm --hand press.txt -- clients/chai_sphere 2.5
expect_own 0 'sphere: PASSED' arm --hand press.txt -- dhd_clients/sphere 2.5
expect_own 0 'ABI of HDAPI: 0 failures' arm --clock virtual -- clients/hd_abi
expect_own 0 'HL beside HDAPI: 0 failures' arm --clock virtual -- clients/hl
expect_own 0 'ABI of DHD: 0 failures' arm --clock virtual -- dhd_clients/abi
expect_own 0 'hello force: PASSED' arm -- dhd_clients/hello_force
expect 0 'qemu-aarch64 .*hdPhantom.* [0-9]{4} ' arm --hand press.txt -- clients/chai_sphere 2.5
finish
