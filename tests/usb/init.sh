#!/bin/busybox sh
# The first and only process of the virtual machine: plugs each simulated arm into this kernel by
# `thimble plug --attach` and lets an unprivileged user drive it with usb_check. Says PASS, FAIL and
# FIGURE lines, then END, then switches the machine off.
/bin/busybox --install -s /bin
export PATH=/bin:/usr/bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mount -t tmpfs none /run
mount -t tmpfs none /tmp
chmod 1777 /tmp
ifconfig lo 127.0.0.1 up
setting() { sed -n "s/.*thimble\.$1=\([^ ]*\).*/\1/p" /proc/cmdline; }
ticks=$(setting ticks)
arms=$(setting arms | tr , ' ')
faulty=$(setting faulty | tr , ' ')
for module in usb-common usbcore hid usbip-core vhci-hcd usbhid hid-generic; do
  insmod /lib/modules/$module.ko || echo "FAIL module $module: not loaded"
done
/lib/systemd/systemd-udevd --daemon --resolve-names=early 2>/dev/null
uptime() { cut -d' ' -f1 /proc/uptime; }
echo "NOTE ready after $(uptime) s"

as() { su -s /bin/sh "$1" -c "$2"; }
control=/tmp/control
count=0

plug() {  # plug ARM TRACE
  rm -f $control
  thimble plug "$1" --attach --control $control --trace "$2" >/tmp/plug.log 2>&1 &
  plugged=$!
  for i in $(seq 200); do [ -p $control ] && break; usleep 10000; done
  chmod 666 $control
  as tester "usb_check find $1" >/tmp/found.log || cat /tmp/found.log /tmp/plug.log
  udevadm settle --timeout=20
}
unplug() {
  kill -INT $plugged
  wait $plugged
  status=$?
  [ $status = 0 ] || echo "FAIL plug: left with $status: $(cat /tmp/plug.log)"
  for i in $(seq 200); do
    grep -q "^hs  0000 004" /sys/devices/platform/vhci_hcd.0/status && break
    usleep 10000
  done
  udevadm settle --timeout=20
}

for arm in $arms; do
  image=
  [ $arm = falcon ] && image=/etc/falcon.bin
  plug $arm /tmp/device.trace
  cat /tmp/found.log
  as stranger "usb_check denied $arm $image"
  as tester "usb_check touch $arm $ticks /tmp/driver.trace $image"
  unplug
  sed -n 's/^Unplugged\. /NOTE '$arm': /p' /tmp/plug.log
  usb_check compare $arm /tmp/driver.trace /tmp/device.trace

  # The program itself, where the arm file and the simulated mechanics are of the same arm.
  if [ $arm = woodenhaptics ] || [ $arm = falcon ]; then
    plug $arm /tmp/run.trace
    program="thimble run /data/tests/data/scenes/two_boxes.yaml --arm /data/app/arms/$arm.yaml"
    [ -z "$image" ] || program="$program --firmware $image"
    if as tester "thimble devices && HOME=/tmp $program --device SIM0001 --yes --duration 0.5" \
      >/tmp/run.log 2>&1 && grep -q 'SIM0001.*ready' /tmp/run.log; then
      echo "PASS $arm with thimble devices and thimble run"
    else
      echo "FAIL $arm with thimble devices and thimble run: $(cat /tmp/run.log)"
    fi
    unplug
  fi

  # The padded board differs from the other in its reports only.
  [ $arm = polhem-64 ] && { echo "NOTE $arm done after $(uptime) s"; continue; }

  plug $arm /tmp/replug.trace
  as tester "usb_check replug $arm $control $image"
  unplug

  # A driver that is killed in contact: the arm's own watchdog is what is left.
  if [ $arm != falcon ]; then
    plug $arm /tmp/killed.trace
    as tester "exec usb_check hang $arm" >/tmp/hang.log &
    for i in $(seq 400); do grep -q touching /tmp/hang.log && break; usleep 10000; done
    usleep 50000
    killall -9 usb_check
    usleep 800000
    unplug
    off=$(tail -n 1 /tmp/killed.trace | awk '{ print $NF, ($14 == 0 && $15 == 0 && $16 == 0) }')
    before=$(awk '$NF == 1 && ($14 != 0 || $15 != 0 || $16 != 0) { n++ } END { print n + 0 }' /tmp/killed.trace)
    if [ "$off" = "0 1" ] && [ "$before" -gt 20 ]; then
      echo "PASS $arm with a killed driver: the watchdog switched the motors off"
    else
      echo "FAIL $arm with a killed driver: motors on, currents zero: $off; frames with force: $before"
    fi
  fi
  echo "NOTE $arm done after $(uptime) s"
done

# Every fault, both ways, one after another on the same plug: after each the arm must serve again.
# All but a stalled message: the kernel never clears that halt for hidraw, only a new plug does; so
# it comes last.
for arm in $faulty; do
  image=
  [ $arm = falcon ] && image=/etc/falcon.bin
  plug $arm /tmp/fault.trace
  for kind in short long torn stale duplicate silence "bit_errors rate=0.01" stall; do
    for way in in out; do
      set -- $kind
      as tester "usb_check fault $arm $control '$1 $way for=100 $2' $image"
    done
  done
  unplug
  echo "NOTE $arm with faults done after $(uptime) s"
done

dmesg | grep -E "Oops|BUG:|Kernel panic|blocked for more|WARNING:" && echo "FAIL kernel: see the log"
echo "NOTE memory: $(free -k | awk '/Mem/ { print $3 }') kB used"
echo "END after $(uptime) s"
poweroff -f
