# Compares both ends of an arm: the log of a program at this end (THIS), and the recording of `thimble exec` as a
# table (THAT). Positions must agree within 1 nm, velocities within 100 nm/s, forces within force_step.
#   awk -f both_ends.awk -v force_step=1e-9 -v opening=5000 THIS THAT
# THIS has lines "px py pz vx vy vz fx fy fz" (m, m/s, N, in the world; - if a tick had no new value). Each of its
# positions and velocities must be in THAT, in the same order. Each force that was requested from THAT after the first
# `opening` ticks, in which the soft start changes it, must be one that THIS sent.
# Values are rounded to whole steps, so that zero has no sign.
function steps(value, step) { return sprintf("%d", int(value / step + (value < 0 ? -0.5 : 0.5))) }
function three(x, y, z, step) { return steps(x, step) " " steps(y, step) " " steps(z, step) }
function place(x, y, z, u, v, w) { return three(x, y, z, 1e-9) " " three(u, v, w, 1e-7) }
function push(x, y, z) { return three(x, y, z, force_step) }
NR == FNR {
  if ($1 != "-") at[++lines] = place($1, $2, $3, $4, $5, $6)
  if (sqrt($7 * $7 + $8 * $8 + $9 * $9) > 0.05) sent[push($7, $8, $9)] = 1
  next
}
FNR == 1 {
  FS = ","
  $0 = $0
  for (i = 1; i <= NF; ++i) {
    if ($i ~ /^p_WT.x/) p = i
    if ($i ~ /^v_WT.x/) v = i
    if ($i ~ /^f_wanted_W.x/) f = i
  }
  next
}
{
  here = place($p, $(p + 1), $(p + 2), $v, $(v + 1), $(v + 2))
  if (!(here in first)) first[here] = FNR
  last[here] = FNR
  if (FNR <= opening + 1) next
  if (sqrt($f * $f + $(f + 1) * $(f + 1) + $(f + 2) * $(f + 2)) < 0.05) next
  if (push($f, $(f + 1), $(f + 2)) in sent) {
    ++same
    distinct[push($f, $(f + 1), $(f + 2))] = 1
  } else {
    ++foreign
  }
}
END {
  for (i = 1; i <= lines; ++i) {
    if (!(at[i] in first)) { ++unknown; continue }
    if (last[at[i]] < before) ++backwards
    if (first[at[i]] > before) before = first[at[i]]
  }
  for (force in distinct) ++kinds
  printf "%d ticks here, %d not there, %d out of order; %d ticks there with a force from here, %d different, %d from elsewhere\n",
    lines, unknown, backwards, same, kinds, foreign
}
