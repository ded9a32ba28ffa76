# Writes the page of physical values from PHYSICS lines (../support/physics.h). Writes errors to the file
# `faults`, one per line.
function fault(text) { print text > faults; ++bad }
function number(x, text) {
  text = sprintf("%.5g", x + 0)
  sub(/e([+]0*|-0+)/, text ~ /e-/ ? "e-" : "e", text)
  return text
}
BEGIN { FS = "|" }
$1 == "PHYSICS" {
  if (NF != 11) { fault("a malformed line: " $0); next }
  if (!($8 + 0 <= $9 + 0) || $8 !~ /^[0-9.]+(e[-+]?[0-9]+)?$/)
    fault($2 ", " $3 ": error " $8 " is not within " $9 " (" $10 " in " $11 ")")
  if (!($2 in seen)) { seen[$2] = 1; order[++components] = $2 }
  label = $11
  sub(/.*\//, "", label)
  sub(/_test\.cpp$/, "", label)
  # An error far below its bound is rounding, which differs between machines.
  error = $8 + 0 < 1e-3 * $9 ? "< " number($9 / 1000) : number($8)
  measured = $8 + 0 < 1e-3 * $9 ? number($6) : number($7)
  rows[$2] = rows[$2] "| " $3 " | `" $4 "` | " number($6) " | " measured " | " $5 " | " error " | " \
    number($9) " | [" label "](../" substr($11, 7) " \"" $10 "\") |\n"
  ++values
}
END {
  if (!values) fault("no test has reported a physical value")
  print "# Physical values"
  print ""
  print "Written by `tests/acceptance/physics.sh` from a run of the tests; do not edit. The physical models of the guide, compared with"
  print "closed forms: simulated time, the product's own code, SI units. *Error* is a fraction of the value of the closed form; if"
  print "that is 0, the absolute error in the given unit. *Bound* is the error at which the test fails. An error below a thousandth of its bound"
  print "is printed as such."
  print ""
  print values + 0 " values of " components + 0 " components."
  for (i = 1; i <= components; ++i) {
    name = order[i]
    print "\n## " toupper(substr(name, 1, 1)) substr(name, 2) "\n"
    print "| Quantity | Closed form | Value of the closed form | Measured | Unit | Error | Bound | Test |"
    print "|---|---|---|---|---|---|---|---|"
    printf "%s", rows[name]
  }
}
