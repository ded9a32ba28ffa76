# Writes the table of the hard cases from hard_cases.list and HARD_CASE lines (../support/hard_case.h).
# Writes errors to the file `faults`, one per line.
function fault(text) { print text > faults; ++bad }
function short(x, digits,   text) {
  text = sprintf("%." digits "g", x + 0)
  sub(/e([+]0*|-0+)/, text ~ /e-/ ? "e-" : "e", text)
  sub(/^-/, "−", text)
  sub(/e-/, "e−", text)
  return text
}
function with_unit(x, unit) { return unit == "1" ? x : x " " unit }
# Returns the factor by which a figure is better than required; undefined if figure or limit is zero.
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
  if (NF != 9) { fault("a malformed line: " $0); next }
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
  # Near its limit a figure has more digits, so that the side of the limit is visible.
  near = ($5 - $6) * ($5 - $6) < 1e-4 * $6 * $6
  # A figure that is only rounding error differs between machines.
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
  print "Written by `tests/acceptance/hard_cases.sh` from a run of the tests; do not edit. All cases run in virtual time with fixed seeds,"
  print "through the product's own code. Exceptions: walls in one dimension (1, 2, 5 to 7, parts of 11 and 12) are a spring and damper on the"
  print "simulated arm's exact map of one axis (tests/support/wall_rig.h), and the tests of 3, 4 and 37 use their own equations."
  print "*Margin* is the factor by which the figure is better than required (*all*: it is 0 or less). *Must fail* marks"
  print "guards: a known defect is measured, so the test would detect it. Figures are those of the short form that"
  print "every run uses; rows whose criterion asks for more state what `THIMBLE_LONG=1` does."
  print ""
  print cases - missing " of " cases " cases, " figures " figures, of them " guard_count + 0 " guards."
  for (i = 1; i <= cases; ++i) {
    n = number[i]
    if (i in heading) {
      print "\n## " heading[i] "\n"
      print "| # | Case and measured quantity | Measured | Required | Margin | Test |"
      print "|---|---|---|---|---|---|"
    }
    print "| **" n "** | **" title[n] "** — " wanted[n] " | | | | |"
    if (rows[n] == "") print "| | " (awaited[i] ? "not measured yet" : "MISSING") " | | | | |"
    printf "%s%s", rows[n], guards[n]
  }
}
