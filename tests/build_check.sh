# Functions of the scripts that test builds; sourced by core.sh and shared.sh. `work` is the script's folder for logs.
fail() {
  echo "FAILED: $1" >&2
  exit 1
}
quiet() {  # quiet LOG COMMAND...
  "${@:2}" >"$work/$1.log" 2>&1 || fail "$(printf '%s ' "${@:2}"): $(tail -n 30 "$work/$1.log")"
}
empty_folder() {  # empty_folder FOLDER: makes it the script's folder for logs
  work=$1
  rm -rf "$work"
  mkdir -p "$work"
}
