# Makes the table of the hard cases out of hard_cases.list and HARD_CASE lines (../support/hard_case.h).
# Faults go to the file `faults`, one a line.
function fault(text) { print text > faults; ++bad }
function short(x, digits,   text) {
  text = sprintf("%." digits "g", x + 0)
  sub(/e([+]0*|-0+)/, text ~ /e-/ ? "e-" : "e", text)
  sub(/^-/, "−", text)
  sub(/e-/, "e−", text)
  return text
}
function with_unit(x, unit) { return unit == "1" ? x : x " " unit }
# How many times better than it has to be; where zero is on either side there is no such number.
function margin(sign, measured, limit,   times) {
  if (sign == "=") return "equal"
  if (limit <= 0 || measured <= 0) return sign ~ /≤|</ && limit > 0 ? "all" : "–"
  times = sign ~ /≤|</ ? limit / measured : measured / limit
  return times > 1000 ? "> 1000 ×" : sprintf("%.3g ×", times)
}
function holds(sign, measured, limit) {
  if (measured !~ /^-?[0-9.]+(e[-+]?[0-9]+)?$/) return measured == "inf" && sign ~ />|≥/
  measured += 0
  limit += 0
  if (sign == "≤") return measured <= limit
  if (sign == "≥") return measured >= limit
  if (sign == "<") return measured < limit
  if (sign == ">") return measured > limit
  if (sign == "=") return measured == limit
  return 0
}
BEGIN { FS = "|" }
FNR == 1 { ++file }
file == 1 && /^#/ { next }
file == 1 && /^=/ { heading[cases + 1] = substr($0, 2); next }
file == 1 {
  ++cases
  awaited[cases] = sub(/[?]$/, "", $1)
  number[cases] = $1
  title[$1] = $2
  wanted[$1] = $3
  suite[$1] = $4
  next
}
$1 == "HARD_CASE" {
  if (NF != 9) { fault("a line that is not understood: " $0); next }
  n = $2
  if (!(n in title)) { fault("case " n " is not in hard_cases.list (" $8 ")"); next }
  if (index($8, suite[n] ".") != 1) fault("case " n " has the suite " suite[n] ", not that of " $8)
  space = index($4, " ")
  sign = space ? substr($4, 1, space - 1) : $4
  what = space ? substr($4, space + 1) : ""
  unit = $7
  sub(/^um$/, "µm", unit)
  sub(/^deg$/, "°", unit)
  sub(/<=/, "≤", sign)
  sub(/>=/, "≥", sign)
  sub(/==/, "=", sign)
  is_guard = $3 ~ /^guard: /
  words = $3
  sub(/^guard: /, "", words)
  if (!holds(sign, $5, $6))
    fault("case " n ", " words ": " $5 " is not " sign " " $6 " " $7 " (" $8 " in " $9 ")")
  label = $9
  sub(/.*\//, "", label)
  sub(/_test\.cpp$/, "", label)
  # Near its limit a figure is told by more digits, so that it is seen on which side it is.
  near = ($5 - $6) * ($5 - $6) < 1e-4 * $6 * $6
  # What is nothing but rounding differs from machine to machine.
  nothing = $5 != 0 && $5 * $5 < 1e-18 * $6 * $6
  row = "| | " (is_guard ? "*must fail:* " : "") words (what == "" ? "" : ": " what) \
        " | " with_unit($5 == "inf" ? "∞" : nothing ? "≈ 0" : short($5, near ? 4 : 3), unit) " | " sign " " with_unit(short($6, 4), unit) \
        " | " margin(sign, $5 == "inf" ? 1e300 : nothing ? 0 : $5 + 0, $6 + 0) \
        " | [" label "](../" substr($9, 7) " \"" $8 "\") |"
  if (is_guard) { guards[n] = guards[n] row "\n"; ++guard_count }
  else rows[n] = rows[n] row "\n"
  ++figures
}
END {
  for (i = 1; i <= cases; ++i) {
    n = number[i]
    if (rows[n] != "") continue
    ++missing
    if (!awaited[i]) fault("case " n " has no figure: " title[n])
  }
  print "# The hard cases"
  print ""
  print "Made by `tests/acceptance/hard_cases.sh` from a run of the tests; do not edit. All on the virtual clock, with fixed seeds,"
  print "through the product's own code; but walls in one dimension (1, 2, 5 to 7, parts of 11 and 12) are a spring and damper on the"
  print "simulated arm's exact map of one axis (tests/support/wall_rig.h), and the sums of 3, 4 and 37 are the test's own."
  print "*Margin* is how many times better than needed the figure is (*all*: nothing of the limit is used). *Must fail* marks"
  print "guards: what is known to go wrong does go wrong, so the test would see it. Figures are those of the short form that"
  print "every run makes; where more is asked, the row says what `THIMBLE_LONG=1` does."
  print ""
  print cases - missing " of " cases " cases, " figures " figures, of them " guard_count + 0 " guards."
  for (i = 1; i <= cases; ++i) {
    n = number[i]
    if (i in heading) {
      print "\n## " heading[i] "\n"
      print "| # | Case, and what was measured | Measured | Must be | Margin | Test |"
      print "|---|---|---|---|---|---|"
    }
    print "| **" n "** | **" title[n] "** — " wanted[n] " | | | | |"
    if (rows[n] == "") print "| | " (awaited[i] ? "not there yet" : "MISSING") " | | | | |"
    printf "%s%s", rows[n], guards[n]
  }
}
