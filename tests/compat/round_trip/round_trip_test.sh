#!/usr/bin/env bash
# A simulated arm, the library or service of the compatibility layer, and behind it Thimble's own driver for that vendor's
# interface. Both ends must agree: on positions and velocities in one direction, on forces in the other.
#   round_trip_test.sh THIMBLE SOURCE_DIR WORK_DIR LINK_CLIENT
source "$(dirname "$0")/../../program/expect.sh" "$1" "$2" "$3"
client=$4
here=$source_dir/tests/compat/round_trip
unset THIMBLE_DHD_LIBRARY THIMBLE_HD_LIBRARY

# A hand that never rests, for longer than the test takes.
awk 'BEGIN { for (i = 0; i <= 4000; ++i) { t = i / 10
  printf "%.2f %.5f %.5f %.5f\n", t, 0.012 * sin(0.2 * t), 0.015 * cos(0.15 * t), 0.01 * sin(0.1 * t + 1) } }' >hand.txt

good='^[0-9]{3,} ticks here, 0 not there, 0 out of order; [0-9]{3,} ticks there with a force from here, [0-9]{3,} different, 0 from elsewhere$'
for kind in dhd:omega3 hd:touch; do
  name=${kind%:*}
  expect 0 'link_client .*(DHD|DRD|HDAPI).* [1-9]' "$thimble" exec --clock virtual --hand hand.txt \
    --record $name.h5 "$client" $name "$source_dir/app/arms/${kind#*:}.yaml" $name.txt 10000
  # A Touch is calibrated first, in a separate run.
  [ ! -e $name-2.h5 ] || mv $name-2.h5 $name.h5
  expect 0 '' "$thimble" export $name.h5 --csv $name.csv
  expect 0 "$good" awk -f "$here/both_ends.awk" -v force_step=1e-9 -v opening=5000 $name.txt $name.csv
  awk -f "$here/both_ends.awk" -v force_step=1e-9 -v opening=5000 $name.txt $name.csv
done
# Thimble's drivers call the functions in an order that the interfaces allow.
for kind in dhd:omega3 hd:touch; do
  "$thimble" exec --clock virtual "$client" ${kind%:*} "$source_dir/app/arms/${kind#*:}.yaml" again.txt 1000 >report.txt 2>&1
  expect 1 '^0$' grep -c '^Wrong' report.txt
done
finish
