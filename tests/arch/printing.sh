#!/usr/bin/env bash
# Fails if a source prints directly: all texts of the program go through scene::write_text, print_format and Console,
# which remove terminal control sequences (names come from untrusted files). First it plants a print of
# each kind in a copy and checks that each is found.
#   tests/arch/printing.sh SOURCE_DIR
set -euo pipefail
source=$1

# prints FOLDER: file:line of each direct print in its sources.
prints() {
  (
    cd "$1"
    # An opened file (std::fprintf(file_, ...)) is not a terminal.
    grep -rnE '\b(printf|vprintf|puts|putchar|perror|psignal)\(|\bfprintf\((stdout|stderr)|\b(fputs|fputc|fwrite|putc|vfprintf)\(.*\bstd(out|err)\b|\bstd::(cout|cerr|clog)\b|\bfmt::print\(|\bwrite\((1|2|STDOUT_FILENO|STDERR_FILENO),|\bdprintf\(' \
      app driver render device_sim --include='*.h' --include='*.cpp' |
      grep -vE '^app/examples/|^app/scene/src/log/(console|printed_text)\.(h|cpp):|gnu::format\(printf|//.*printf' |
      # In the process of another program: the error text of its library, which `thimble exec` has cleaned.
      grep -vE '^app/compat/(hd/hd_device|hl/hl)\.cpp:|^app/compat/include/' || true
  )
}

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
mkdir -p "$copy"/{app/cli,driver,render,device_sim}
planted=('std::printf("%s", name);' 'std::puts(name);' 'std::fprintf(stderr, "%s", name);' 'std::fputs(name, stdout);'
  'std::fwrite(name, 1, 2, stderr);' 'std::cout << name;' 'std::cerr << name;' 'fmt::print("{}", name);'
  'perror(name);' 'write(2, name, 3);' 'std::putchar(name[0]);' 'dprintf(2, "%s", name);')
printf '%s\n' "${planted[@]}" >"$copy/app/cli/planted.cpp"
found=$(prints "$copy" | wc -l)
if [ "$found" -ne "${#planted[@]}" ]; then
  echo "FAILED: $found of ${#planted[@]} planted prints were found:"
  prints "$copy"
  exit 1
fi

found=$(prints "$source")
if [ -n "$found" ]; then
  echo "Print with scene::print_format, session::print, the loggers or scene::console (app/scene/src/log):"
  echo "$found"
  exit 1
fi
