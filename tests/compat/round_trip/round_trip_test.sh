#!/usr/bin/env bash
# Both ways round: a simulated arm, behind it the library or service that stands in for a vendor's, behind that our own back
# end for that vendor's. What one end says, the other knows: positions and velocities this way, forces that way.
#   round_trip_test.sh THIMBLE SOURCE_DIR WORK_DIR LINK_CLIENT
source "$(dirname "$0")/../../program/expect.sh" "$1" "$2" "$3"
client=$4
here=$source_dir/tests/compat/round_trip
unset THIMBLE_DHD_LIBRARY THIMBLE_HD_LIBRARY

# A hand that never rests, for longer than any of it takes.
awk 'BEGIN { for (i = 0; i <= 4000; ++i) { t = i / 10
  printf "%.2f %.5f %.5f %.5f\n", t, 0.012 * sin(0.2 * t), 0.015 * cos(0.15 * t), 0.01 * sin(0.1 * t + 1) } }' >hand.txt

good='^[0-9]{3,} ticks here, 0 not there, 0 out of order; [0-9]{3,} ticks there with a force from here, [0-9]{3,} different, 0 from elsewhere$'
for kind in dhd:omega3 hd:touch; do
  name=${kind%:*}
  expect 0 'link_client .*(DHD|HDAPI).* [1-9]' "$thimble" exec --clock virtual --hand hand.txt \
    --record $name.h5 "$client" $name "$source_dir/app/arms/${kind#*:}.yaml" $name.txt 10000
  # A Touch is calibrated first, which is a run of its own.
  [ ! -e $name-2.h5 ] || mv $name-2.h5 $name.h5
  expect 0 '' "$thimble" export $name.h5 --csv $name.csv
  expect 0 "$good" awk -f "$here/both_ends.awk" -v force_step=1e-9 -v opening=5000 $name.txt $name.csv
  awk -f "$here/both_ends.awk" -v force_step=1e-9 -v opening=5000 $name.txt $name.csv
done
# Whatever our back ends call, they call in an order that the interfaces allow.
for kind in dhd:omega3 hd:touch; do
  "$thimble" exec --clock virtual "$client" ${kind%:*} "$source_dir/app/arms/${kind#*:}.yaml" again.txt 1000 >report.txt 2>&1
  expect 1 '^0$' grep -c '^Wrong' report.txt
done
finish
