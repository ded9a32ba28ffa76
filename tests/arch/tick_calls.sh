# Calls and instructions of a tick of a scene, counted by callgrind; sourced by other tests of this folder.
#   tick_calls SCENE_TICKS SCENE FOLDER TAG     writes FOLDER/TAG.calls: a line per caller and callee with calls and
#                                               instructions (the callee's, all below it included) per tick, and
#                                               FOLDER/TAG.ticks: instructions per tick, share of ticks in contact
# Both are the difference of two runs whose length differs by 2000 ticks, so that start-up does not count.
tick_calls() {
  local program=$1 scene=$2 folder=$3 tag=$4 ticks
  for ticks in 1000 3000; do
    valgrind --tool=callgrind --compress-strings=no --compress-pos=no \
      --callgrind-out-file="$folder/$tag.$ticks" "$program" "$scene" "$ticks" \
      >"$folder/$tag.contact.$ticks" 2>"$folder/$tag.said" ||
      { cat "$folder/$tag.said"; return 1; }
    sed -n 's/.*Collected : //p' "$folder/$tag.said" >"$folder/$tag.all.$ticks"
    awk -v OFS='\t' '
      sub(/^fn=/, "") { caller = $0; next }
      sub(/^cfn=/, "") { callee = $0; next }
      /^calls=/ { split(substr($1, 7), n, " "); pair = caller OFS callee; calls[pair] += n[1]; getline; cost[pair] += $2 }
      END { for (pair in calls) print pair, calls[pair], cost[pair] }' "$folder/$tag.$ticks" >"$folder/$tag.rows.$ticks"
  done
  awk -F'\t' -v OFS='\t' '
    NR == FNR { calls[$1 OFS $2] = $3; cost[$1 OFS $2] = $4; next }
    $3 > calls[$1 OFS $2] { print $1, $2, ($3 - calls[$1 OFS $2]) / 2000, ($4 - cost[$1 OFS $2]) / 2000 }' \
    "$folder/$tag.rows.1000" "$folder/$tag.rows.3000" >"$folder/$tag.calls"
  paste "$folder/$tag.all.1000" "$folder/$tag.all.3000" "$folder/$tag.contact.1000" "$folder/$tag.contact.3000" |
    awk '{ printf "%.0f %.3f\n", ($2 - $1) / 2000, ($4 - $3) / 2000 }' >"$folder/$tag.ticks"
}

# callees FILE CALLER: the functions that a function with CALLER in its name calls, without arguments.
callees() {
  awk -F'\t' -v caller="$2" 'index($1, caller) { print $2 }' "$1" |
    sed -E ':inner; s/<[^<>]*>//; t inner; s/\([^()]*\)( const)?$//' | sort -u
}

# instructions_of FILE CALLEE: per tick, in calls of functions with CALLEE in their name, from other functions.
instructions_of() {
  awk -F'\t' -v callee="$2" 'index($2, callee) && !index($1, callee) { sum += $4 } END { printf "%.0f\n", sum }' "$1"
}
