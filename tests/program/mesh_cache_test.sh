#!/usr/bin/env bash
# thimble run --mesh-cache: the same results with and without, damaged files, folders that cannot be written; thimble mesh cache.
source "$(dirname "$0")/expect.sh" "$@"

export XDG_CACHE_HOME=$work/home
unset THIMBLE_MESH_CACHE
# A ring of 10^6 triangles, the fewest that are stored.
awk 'BEGIN {
  u = 1000; v = 500; tau = 8 * atan2(1, 1)
  print "OFF\n" u * v, 2 * u * v, 0
  for (i = 0; i < u; ++i) for (j = 0; j < v; ++j) {
    a = tau * i / u; b = tau * j / v; ring = 0.03 + 0.012 * cos(b)
    printf "%.7f %.7f %.7f\n", ring * cos(a), ring * sin(a), 0.012 * sin(b)
  }
  for (i = 0; i < u; ++i) for (j = 0; j < v; ++j) {
    a = i * v + j; b = (i + 1) % u * v + j; c = (i + 1) % u * v + (j + 1) % v; d = i * v + (j + 1) % v
    print 3, a, b, c "\n" 3, a, c, d
  }
}' >ring.off
cat >ring.yaml <<'END'
name: ring
arm: vintage_phantom
duration: 0.3
objects:
  - {name: ring, mesh: ring.off, scale: 1, position: [0, 0, -0.02], stiffness: 500, damping: 1}
hand:
  path:
    - {t: 0, at: [0.03, 0, 0.005]}
    - {t: 0.15, at: [0.03, 0, -0.011]}
    - {t: 0.3, at: [0.033, 0.004, -0.011]}
END

# run_of NAME OPTION...: a run; its ticks are in NAME.csv.
run_of() {
  local name=$1
  shift
  expect 0 '' "$thimble" run ring.yaml --record "$name.h5" --force "$@"
  expect 0 '' "$thimble" export "$name.h5" --csv "$name.csv"
}
# same NAME: the results of NAME are those of the first run.
same() {
  checks=$((checks + 1))
  cmp -s first.csv "$1.csv" || fail_check "the results of $1 differ"
}
# files COUNT FOLDER: a cache has COUNT files, and nothing else.
files() {
  checks=$((checks + 1))
  [ "$(find "$2" -type f -name '*.prepared' | wc -l) $(find "$2" -type f | wc -l)" = "$1 $1" ] ||
    fail_check "$2: $(ls "$2")"
}

run_of first
checks=$((checks + 1))
[ ! -e home ] || fail_check "a cache although none was asked for"
run_of written --mesh-cache
same written
files 2 home/thimble/prepared
expect 0 '0600|rw-------' ls -l home/thimble/prepared
run_of read --mesh-cache --log read.log
same read
expect 0 'ring\.off.*\.prepared' cat read.log
files 2 home/thimble/prepared
expect_words 0 'ring.off 1000000 mesh' "$thimble" mesh cache
expect_words 0 'home/thimble/prepared 2' "$thimble" mesh cache

# Damage: one line, the same results, and a new file.
for file in home/thimble/prepared/*; do
  cp "$file" kept
  truncate -s -1000 "$file"
  run_of damaged --mesh-cache
  same damaged
  checks=$((checks + 1))
  cmp -s "$file" kept || fail_check "$file was not written again"
done
truncate -s 10 "$file"
expect_words 0 'damaged version' "$thimble" mesh cache
checks=$((checks + 1))
[ "$("$thimble" run ring.yaml --mesh-cache 2>&1 >/dev/null | wc -l)" = 1 ] || fail_check "not one line on a damaged file"
# Another mesh is not that of the cache.
sed -i 's/^0.0420000 0.0000000 0.0000000$/0.0420001 0.0000000 0.0000000/' ring.off
expect 0 '' "$thimble" run ring.yaml --mesh-cache
files 4 home/thimble/prepared
expect_words 0 '4 removed' "$thimble" mesh cache --clear
files 0 home/thimble/prepared
expect_words 0 'prepared 0' "$thimble" mesh cache

# The environment.
THIMBLE_MESH_CACHE=$work/own expect 0 '' "$thimble" run ring.yaml
files 2 own
THIMBLE_MESH_CACHE=1 expect 0 '' "$thimble" run ring.yaml
files 2 home/thimble/prepared
THIMBLE_MESH_CACHE=$work/ring.yaml expect_words 1 'ring.yaml read THIMBLE_MESH_CACHE' "$thimble" mesh cache --clear
THIMBLE_MESH_CACHE=relative expect_words 0 'THIMBLE_MESH_CACHE=relative 1' "$thimble" run ring.yaml
checks=$((checks + 1))
[ ! -e relative ] || fail_check "a cache in a relative folder"
# Folders that cannot be written, and a full disk, stop no run.
THIMBLE_MESH_CACHE=/dev/null/none expect_words 0 '/dev/null/none' "$thimble" run ring.yaml
checks=$((checks + 1))
(ulimit -f 1000; trap '' XFSZ; THIMBLE_MESH_CACHE=$work/full "$thimble" run ring.yaml >/dev/null 2>said) ||
  fail_check "a full disk: $(cat said)"
files 0 full
# Small meshes are not stored.
THIMBLE_MESH_CACHE=$work/small expect 0 '' "$thimble" run box
checks=$((checks + 1))
[ ! -e small ] || fail_check "a small mesh was stored"
expect_error 2 '"more"' "$thimble" mesh cache more
finish
