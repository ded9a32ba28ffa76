#!/usr/bin/env bash
# Boots this system's Debian kernel in QEMU and drives every simulated USB arm through it.
#   virtual_machine.sh THIMBLE USB_CHECK SOURCE_DIR WORK_DIR PROGRAMS_DIR [--long]
# PROGRAMS_DIR holds the C programs that were built for other arms (tests/compat).
# Exits with 0 if all passed, 1 if not, 77 if this machine lacks a tool. The complete logs are in
# WORK_DIR/console.log and identified.log, the figures in WORK_DIR/figures.json, every tested fault of every arm
# in WORK_DIR/faults.md.
#
# The machine counts instructions instead of time (-icount): one instruction is 4 ns, and idle time
# is skipped. So a busy computer makes the test slower and never changes its result. In the long form a second
# machine identifies arms with hidden constants (identify.sh).
set -euo pipefail
thimble=$1 check=$2 source=$3 work=$4 programs=$5
long=${THIMBLE_LONG:+--long}
[ "${6:-$long}" = --long ] && long=1 || long=

skip() {
  echo "SKIPPED: the USB arms were NOT tested through a kernel: $1" >&2
  echo "  Run tests/usb/setup.sh to install the dependencies." >&2
  exit 77
}
[ "$(uname -m)" = x86_64 ] || skip "it needs an x86_64 machine"
for tool in qemu-system-x86_64 cpio; do
  command -v $tool >/dev/null || skip "$tool is missing"
done
udevd=/lib/systemd/systemd-udevd
[ -x $udevd ] || skip "systemd-udevd is missing"
rules="50-udev-default 70-uaccess 71-seat 73-seat-late"
for rule in $rules; do
  [ -f "/lib/udev/rules.d/$rule.rules" ] || skip "udev's rule $rule is missing (Debian: udev, systemd)"
done
busybox=$(command -v busybox || true)
[ -n "$busybox" ] && ! ldd "$busybox" >/dev/null 2>&1 || skip "a static busybox is missing"
kernel=$("$source/tests/usb/kernel.sh") || skip "no readable kernel with the module vhci-hcd"

rm -rf "$work"
root=$work/root
mkdir -p "$root"/{bin,dev,etc/udev/rules.d,lib/modules,lib/systemd,lib/udev/rules.d,proc,run,sys,tmp,usr/bin,var}
cp "$source/tests/usb/init.sh" "$root/init"
cp "$source/tests/usb/identify.sh" "$root/identify.sh"
chmod +x "$root/init"
cp "$busybox" "$root/bin/busybox"

# A program and its libraries, each at its own path.
add() {
  local program=$1 place=$2
  cp -L "$program" "$root$place"
  strip "$root$place" 2>/dev/null || true
  ldd "$program" | grep -o '/[^ ]*' | while read -r library; do
    mkdir -p "$root$(dirname "$library")"
    [ -e "$root$library" ] || cp -L "$library" "$root$library"
  done
}
add "$thimble" /bin/thimble
add "$check" /bin/usb_check
# Programs written for other arms, and the libraries that `thimble exec` loads into them.
for program in clients/hello_sphere clients/chai_sphere dhd/dhd_client_sphere; do
  add "$programs/$program" "/bin/$(basename $program)"
done
mkdir -p "$root/bin/compat/lib"
cp -L "$(dirname "$thimble")"/compat/lib/*.so* "$root/bin/compat/lib/"
# systemd-udevd and udevadm are one program that checks its name.
add /bin/udevadm /bin/udevadm
add $udevd $udevd
drivers=${kernel%boot/vmlinuz-*}lib/modules/${kernel##*/vmlinuz-}/kernel/drivers
for module in usb/common/usb-common usb/core/usbcore hid/hid usb/usbip/usbip-core \
  usb/usbip/vhci-hcd hid/usbhid/usbhid hid/hid-generic; do
  cp "$drivers/$module.ko" "$root/lib/modules/"
done
# Not every kernel has gadget support; without it that part is omitted.
gadgets=woodenhaptics,polhem,polhem-64
for module in ../fs/configfs/configfs usb/gadget/udc/udc-core usb/gadget/libcomposite \
  usb/gadget/function/usb_f_hid usb/gadget/udc/dummy_hcd; do
  cp "$drivers/$module.ko" "$root/lib/modules/" 2>/dev/null && continue
  echo "SKIPPED: arms as HID gadgets: this kernel has no module $module" >&2
  gadgets=
done
for rule in $rules; do
  cp "/lib/udev/rules.d/$rule.rules" "$root/lib/udev/rules.d/"
done
cp "$source/udev/70-thimble.rules" "$root/lib/udev/rules.d/"

# Two users: one in the group of the rule, one not.
cat >"$root/etc/passwd" <<'EOF'
root:x:0:0:root:/:/bin/sh
tester:x:1000:1000::/tmp:/bin/sh
stranger:x:1001:1001::/tmp:/bin/sh
EOF
grep -E '^(tty|dialout|kmem|input|video|render|sgx|audio|lp|disk|cdrom|tape|kvm|floppy):' /etc/group |
  sed 's/:[^:]*$/:/' >"$root/etc/group"
cat >>"$root/etc/group" <<'EOF'
root:x:0:
plugdev:x:46:tester
tester:x:1000:
stranger:x:1001:
EOF
echo 'passwd: files' >"$root/etc/nsswitch.conf"
mkdir -p "$root/data/app" "$root/data/tests/data"
cp -r "$source/app/arms" "$root/data/app/"
cp -r "$source/tests/data/scenes" "$source/tests/data/meshes" "$root/data/tests/data/"
mkdir -p "$root/data/app/scenes"
cp "$source/app/scenes/disc.yaml" "$root/data/app/scenes/"
# Any bytes: the simulated Falcon runs any firmware.
head -c 1500 /bin/sh >"$root/etc/falcon.bin"
# Not compressed: unpacking would take 6 s of the machine's time.
(cd "$root" && find . | cpio -o -H newc --quiet) >"$work/initrd.cpio"

# One machine: its log is WORK_DIR/NAME.log. One instruction takes 2^SHIFT ns.
boot() { # NAME SHIFT LIMIT_S SETTING...
  local log=$work/$1.log shift=$2 limit=$3 status=0 begin
  begin=$(date +%s)
  shift 3
  timeout "$limit" qemu-system-x86_64 -accel tcg -icount shift="$shift",sleep=off -smp 1 -m 512 \
    -kernel "$kernel" -initrd "$work/initrd.cpio" -nographic -no-reboot -nodefaults -serial stdio \
    -append "console=ttyS0 quiet panic=-1 mitigations=off nokaslr $(printf 'thimble.%s ' "$@")" \
    </dev/null 2>"$work/qemu.log" >"$log" || status=$?
  sed -i 's/\r//g' "$log"
  echo "The virtual machine ran for $(($(date +%s) - begin)) s."
  if [ $status != 0 ] && grep -qiE "could not load|failed to|not supported|Could not" "$work/qemu.log"; then
    cat "$work/qemu.log" >&2
    skip "QEMU does not start here"
  fi
  grep -aE '^(PASS|FAIL|FIGURE|NOTE|END)' "$log" || true
  grep -aq '^END' "$log" && return
  echo "FAIL: the machine did not finish (status $status). The end of its log:" >&2
  tail -n 30 "$log" >&2
  exit 1
}

# The short form omits the Polhem, whose reports are as long on its other board, and takes a fifth of the ticks.
ticks=2000 faulty=woodenhaptics arms=woodenhaptics,polhem-64,falcon,five_bar,hapkit limit=2400 identified=
if [ -n "$long" ]; then
  ticks=10000 arms=woodenhaptics,polhem,polhem-64,falcon,five_bar,hapkit limit=3000 identified=woodenhaptics,polhem,falcon,woodenhaptics_cables
  faulty=$arms
else
  gadgets=${gadgets%%,*}
fi
arms=${THIMBLE_USB_ARMS-$arms} faulty=${THIMBLE_USB_FAULTY-$faulty}
gadgets=${THIMBLE_USB_GADGETS-$gadgets} identified=${THIMBLE_USB_IDENTIFIED-$identified}
logs=
if [ -n "$arms$faulty$gadgets" ]; then
  boot console 2 $limit ticks=$ticks arms="$arms" faulty="$faulty" gadgets="$gadgets"
  logs=$work/console.log
fi
# A tick of identification computes more than a touch, and so does the board, all on one processor. At
# 4 ns per instruction a third of the messages come a frame late, and the fit reports motion that the
# model does not explain. At 1 ns, still slow for a computer, none does.
# An arm behind cables takes half an hour of processor time, most of it after its motions.
if [ -n "$identified" ]; then
  boot identified 0 $((3 * limit)) ticks=$ticks identify="$identified"
  logs="$logs $work/identified.log"
fi
[ -n "$logs" ] || skip "no arm is selected"
{ grep -ahE '^FIGURE' $logs || true; } | awk '
  BEGIN { print "[" }
  { printf "%s  {\"name\": \"usb.%s\", \"value\": %s, \"unit\": \"%s\"}", (NR > 1 ? ",\n" : ""), $2, $3, $4 }
  END { print "\n]" }' >"$work/figures.json"
{
  echo "| arm | fault | promised | measured: zero force after (ticks) | largest force (N) | fault's name | counted by the driver | longest tick (us) |"
  echo "|---|---|---|---|---|---|---|---|"
  sed -n 's/^CELL //p' $logs |
    awk -F'|' '{ print "| " $1 " | " $2 " | " $5 " | " $4 " | " $6 " | " $3 " | " $7 " | " $8 " |" }'
} >"$work/faults.md"
failed=$(cat $logs | grep -ac '^FAIL' || true)
passed=$(cat $logs | grep -ac '^PASS' || true)
grep -ah '^FAIL' $logs || true  # again: the log of a test is often cut to its last lines
echo "$passed passed, $failed failed; complete log: $logs"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
