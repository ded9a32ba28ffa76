#!/bin/busybox sh
# The first and only process of the virtual machine. Plugs each simulated arm into this kernel by
# `thimble plug --attach` and drives it with usb_check as an unprivileged user. Prints PASS, FAIL and
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

# Arms with one or two motors are those of an arm file on the board of the Polhem.
is_short() { [ $1 = five_bar ] || [ $1 = hapkit ]; }
plugged_as() { is_short $1 && echo "polhem --arm /data/app/arms/$1.yaml" || echo $1; }

plug() {  # plug ARM TRACE [OPTION...]
  rm -f $control
  plugs=$1 trace=$2
  shift 2
  thimble plug $(plugged_as $plugs) --attach --control $control --trace "$trace" "$@" >/tmp/plug.log 2>&1 &
  plugged=$!
  for i in $(seq 200); do [ -p $control ] && break; usleep 10000; done
  chmod 666 $control
  as tester "usb_check find $plugs" >/tmp/found.log || cat /tmp/found.log /tmp/plug.log
  udevadm settle --timeout=20
}
unplug() {
  kill -INT $plugged
  wait $plugged
  status=$?
  [ $status = 0 ] || echo "FAIL plug: exited with $status: $(cat /tmp/plug.log)"
  for i in $(seq 200); do
    grep -q "^hs  0000 004" /sys/devices/platform/vhci_hcd.0/status && break
    usleep 10000
  done
  udevadm settle --timeout=20
}

# Programs written for other arms, each with its own sphere below the vertical path of the hand. The forces
# in their logs equal those of the board's motors. The short form tests the first.
programs() {
  arm=$1
  while read -r program axes centre; do
    plug $arm /tmp/board.trace
    name=$(usb_check name $arm)
    as tester "cd /tmp && HOME=/tmp thimble exec --device $name --arm /data/app/arms/$arm.yaml --yes --unchecked \
      --homed --no-real-time --record program.h5 $program 2 program.log $centre </dev/null &&
      thimble export program.h5 --csv program.csv" >/tmp/program.out 2>&1 ||
      echo "FAIL $arm with $program: $(tr '\n' ' ' </tmp/program.out)"
    unplug
    {
      usb_check program $arm /tmp/program.log $axes /tmp/program.csv /tmp/program.trace
      usb_check compare $arm /tmp/program.trace /tmp/board.trace
    } | grep -v ^FIGURE | sed "s/^\([A-Z]* $arm\)/\1 with $program/"
    rm -f /tmp/program.*
    [ $ticks -ge 10000 ] || break
  done <<EOF
hello_sphere zxy 0 180 25
chai_sphere xyz 0.025 0 0.180
dhd_client_sphere xyz 0.025 0 0.180
EOF
}

# Moves the hand along an axis of the base, in steps that no limit of speed notices.
move() { # x|y FROM TO (mm from the start of the hand)
  for mm in $(seq $2 $3); do
    metres=$(printf '0.%03d' $mm)
    [ $1 = x ] && echo "hand $metres 0 0" >$control || echo "hand 0 $metres 0" >$control
    usleep 10000
  done
}
# Waits until a new line of the board's trace fulfils a condition of awk. The last line may be incomplete.
board_has() { # CONDITION
  for i in $(seq 100); do
    tail -n 2 /tmp/touch.trace | head -n 1 | awk "NF == 22 && ($1) { found = 1 } END { exit !found }" && return 0
    usleep 100000
  done
  return 1
}
# The program touches a scene with an arm of one or two motors. The line is pulled in contact: the force ends, and
# the fault is named. No force returns when the arm is plugged in again.
pull_in_scene() { # ARM SCENE AXIS FREE PRESSED (mm)
  arm=$1
  plug $arm /tmp/touch.trace --hand rest
  name=$(usb_check name $arm)
  move $3 0 $4
  as tester "cd /tmp && HOME=/tmp exec thimble run $2 --arm /data/app/arms/$arm.yaml --device $name --yes --homed \
    --no-real-time --duration 3 --record touch.h5" </dev/null >/tmp/run.log 2>&1 &
  running=$!
  board_has '$10 > 100' || echo "FAIL $arm in a scene: no messages: $(tr '\n' ' ' </tmp/run.log)"
  move $3 $(($4 + 1)) $5
  board_has '$14 != 0' || echo "FAIL $arm in a scene: no force: $(tr '\n' ' ' </tmp/run.log)"
  echo "unplug for=300" >$control
  wait $running
  unplug
  as tester "cd /tmp && thimble export touch.h5 --csv touch.csv" >/tmp/export.log 2>&1 || cat /tmp/export.log
  # This awk has no square root, so a force is the largest of its components.
  awk -F, -v arm=$arm -v named="$(grep -c 'disconnected' /tmp/run.log)" '
    function size(f) { return f < 0 ? -f : f }
    NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
    {
      force = 0
      for (axis = 0; axis < 3; axis++) {
        one = size($column["f_sent_W." substr("xyz", axis + 1, 1) " [N]"])
        if (one > force) force = one
      }
      if ($column["fault"] != 0) faulty++
      if (!faulty && $column["in_contact"] == 1 && force > 0.1) touched++
      if (faulty && force > left) left = force
    }
    END {
      good = touched > 20 && faulty > 100 && left == 0 && named > 0
      printf "%s %s pulled in a scene: %d ticks of touch, then %d ticks with a fault and at most %g N, " \
             "\"disconnected\" in %d lines\n", good ? "PASS" : "FAIL", arm, touched, faulty, left, named
    }' /tmp/touch.csv || echo "FAIL $arm in a scene: no recording of it: $(tr '\n' ' ' </tmp/run.log)"
  grep -q disconnected /tmp/run.log || echo "NOTE $arm: $(tr '\n' ' ' </tmp/run.log)"
  rm -f /tmp/touch.*
}

# The limits of a real arm come from an installed arm file: here in the tester's folder.
mkdir -p /tmp/.config/thimble
# The pose in which a program opens an arm is taken for its home pose, and the hand moves about 0.2 m above the middle of the
# workspace. In a larger workspace no wall of it adds to the force of the program, whenever the program starts.
sed -i 's/^  min: \[-0.1, -0.1, -0.1\]/  min: [-0.3, -0.3, -0.3]/; s/^  max: \[0.1, 0.1, 0.1\]/  max: [0.3, 0.3, 0.3]/' \
  /data/app/arms/woodenhaptics.yaml
cp -r /data/app/arms /tmp/.config/thimble/arm_files

for arm in $arms; do
  image=
  [ $arm = falcon ] && image=/etc/falcon.bin
  usb_check vector $arm

  # The kind of a Teensy is unknown, so the installed rule ignores it; doctor prints the rule that gives
  # its owner access.
  if [ $arm = polhem-64 ]; then
    plug $arm /tmp/device.trace
    as tester "usb_check denied $arm" | sed "s/closed to strangers/closed until its owner adds a rule/"
    as tester "HOME=/tmp thimble doctor" >/tmp/doctor.log 2>&1
    mkdir -p /etc/udev/rules.d
    sed -n "s/.*echo '\(SUBSYSTEM[^']*\)'.*/\1/p" /tmp/doctor.log >/etc/udev/rules.d/71-my-arm.rules
    [ -s /etc/udev/rules.d/71-my-arm.rules ] ||
      echo "FAIL $arm with thimble doctor: no rule in $(cat /tmp/doctor.log)"
    udevadm control --reload
    unplug
  fi

  plug $arm /tmp/device.trace
  cat /tmp/found.log
  usb_check kernel $arm
  as stranger "usb_check denied $arm $image"
  as tester "usb_check listen $arm"
  as tester "usb_check wrong $arm"
  as tester "usb_check touch $arm $ticks /tmp/driver.trace $image"
  unplug
  sed -n 's/^Unplugged\. /NOTE '$arm': /p' /tmp/plug.log
  usb_check compare $arm /tmp/driver.trace /tmp/device.trace

  # The program itself, with the listed name; then another program after it.
  [ $arm != five_bar ] || pull_in_scene five_bar /data/app/scenes/disc.yaml y 16 28
  [ $arm != hapkit ] || pull_in_scene hapkit /data/tests/data/scenes/stop_on_a_line.yaml x 0 16
  plug $arm /tmp/run.trace
  name=$(usb_check name $arm)
  if ! is_short $arm; then
    program="thimble run /data/tests/data/scenes/two_boxes.yaml --arm /data/app/arms/${arm%-64}.yaml"
    [ -z "$image" ] || program="$program --firmware $image"
    if as tester "thimble devices && HOME=/tmp $program --device $name --yes --homed --no-real-time --duration 0.5" \
      >/tmp/run.log 2>&1 && grep -qE "^$name .*(ready|unknown kind)" /tmp/run.log; then
      echo "PASS $arm as $name with thimble devices and thimble run"
    else
      echo "FAIL $arm as $name with thimble devices and thimble run: $(tr '\n' ' ' </tmp/run.log)"
    fi
  fi
  usleep 300000
  as tester "usb_check fresh $arm $image"
  unplug

  [ $arm != woodenhaptics ] || programs $arm

  # The padded board differs from the other only in its reports.
  [ $arm = polhem-64 ] && [ $ticks -lt 10000 ] && { echo "NOTE $arm done after $(uptime) s"; continue; }

  plug $arm /tmp/replug.trace
  as tester "usb_check replug $arm $control $image"
  unplug

  # A driver that is killed in contact: only the arm's watchdog remains. Its time is from
  # the last message to the end of the motor currents, in the arm's own frames.
  plug $arm /tmp/killed.trace
  as tester "exec usb_check hang $arm $image" >/tmp/hang.log &
  for i in $(seq 1500); do grep -q touching /tmp/hang.log && break; usleep 10000; done
  usleep 50000
  killall -9 usb_check
  usleep 800000
  unplug
  watchdog=500
  early=1
  # The Falcon's board dates a message by its last frame. A plug that was delayed by some frames
  # (up to six were seen) makes that too early, never too late.
  [ $arm = falcon ] && watchdog=100 && early=10
  awk -v arm=$arm -v stated=$watchdog -v early=$early '
    !/^#/ && NF == 22 {
      forced = $14 != 0 || $15 != 0 || $16 != 0
      if ($10 != messages) { messages = $10; said = $1; contact = forced; frames += forced; on = 1 }
      if (on && $20 == 0) { on = 0; off = $1; current = forced }
    }
    END {
      after = off - said
      good = !on && frames > 20 && contact && !current && after >= stated - early && after <= stated + 2
      printf "%s %s with a killed driver: motors off %d frames after the last message (stated: %d), " \
             "%d messages with force before\n", good ? "PASS" : "FAIL", arm, after, stated, frames
      printf "FIGURE %s.watchdog %d frames\n", arm, after
    }' /tmp/killed.trace
  echo "NOTE $arm done after $(uptime) s"
done

# An arm that accepts every message without effect: one that only answers must be detected.
for arm in $arms; do
  [ $arm != woodenhaptics ] && [ $arm != falcon ] || continue
  case " $faulty " in *" $arm "*) continue ;; esac
  plug $arm /tmp/fault.trace
  as tester "usb_check fault $arm $control 'lost out for=100'"
  unplug
done

# Every fault, in both directions, one after another on the same plug: after each the arm must work again.
# The stalled message is last: the kernel never clears that halt for hidraw, only a new plug does.
# The short form takes the faults whose effects go beyond the arm's own checks.
kinds="short|long|torn|stale|duplicate|silence|lost|bit_errors rate=0.01|stall"
[ $ticks -lt 10000 ] && kinds="torn|lost|bit_errors rate=0.01|stall"
for arm in $faulty; do
  image=
  [ $arm = falcon ] && image=/etc/falcon.bin
  plug $arm /tmp/fault.trace
  echo "$kinds" | tr '|' '\n' | while read -r kind options; do
    for way in in out; do
      as tester "usb_check fault $arm $control '$kind $way for=100 $options' $image" </dev/null
    done
  done
  unplug
  # The arm's side counts too: each kind must have hit packets, otherwise the checks above prove nothing.
  for kind in $(echo "$kinds" | tr '|' '\n' | cut -d' ' -f1); do
    hits=$(sed -n "s/^Fault $kind affected \([0-9]*\) packets.*/\1/p" /tmp/plug.log)
    [ "${hits:-0}" -gt 0 ] || echo "FAIL $arm with faults: no packet was hit by '$kind'"
  done
  echo "NOTE $arm with faults done after $(uptime) s"
done

. /identify.sh
seed=1
for hidden in $(setting identify | tr , ' '); do
  identify $hidden $seed
  seed=$((seed + 1))
  echo "NOTE $hidden identified after $(uptime) s"
done

# The second way: the kernel's own HID gadget on its own virtual bus, without USB/IP.
for arm in $(setting gadgets | tr , ' '); do
  for module in configfs udc-core libcomposite usb_f_hid dummy_hcd; do
    [ -d /sys/module/$(echo $module | tr - _) ] || insmod /lib/modules/$module.ko 2>/dev/null ||
      echo "FAIL module $module: not loaded"
  done
  [ -d /sys/kernel/config/usb_gadget ] || mount -t configfs none /sys/kernel/config
  gadget=/sys/kernel/config/usb_gadget/$arm
  mkdir -p $gadget/strings/0x409 $gadget/configs/c.1 $gadget/functions/hid.0
  product=0x0006 vendor=0x1234 length=8 serial=0123456789
  [ $arm = polhem ] && length=14
  [ $arm = polhem-64 ] && product=0x0486 vendor=0x16c0 length=64 serial=1234560
  echo $vendor >$gadget/idVendor
  echo $product >$gadget/idProduct
  echo $serial >$gadget/strings/0x409/serialnumber
  echo $length >$gadget/functions/hid.0/report_length
  usb_check descriptor $arm >$gadget/functions/hid.0/report_desc
  ln -s $gadget/functions/hid.0 $gadget/configs/c.1/
  echo dummy_udc.0 >$gadget/UDC
  udevadm settle --timeout=20
  usb_check gadget $arm /dev/hidg0 &
  behind=$!
  {
    as tester "usb_check find $arm"
    as stranger "usb_check denied $arm"
    as tester "usb_check touch $arm 2000 /tmp/gadget.trace"
  } | sed "s/^\([A-Z]* $arm\)/\1 as a gadget/"
  kill -9 $behind
  wait $behind 2>/dev/null
  echo "" >$gadget/UDC
  rm $gadget/configs/c.1/hid.0
  rmdir $gadget/functions/hid.0 $gadget/configs/c.1 $gadget/strings/0x409 $gadget
  udevadm settle --timeout=20
  echo "NOTE $arm as a gadget done after $(uptime) s"
done

dmesg | grep -E "Oops|BUG:|Kernel panic|blocked for more|WARNING:" && echo "FAIL kernel: see the log"
echo "NOTE memory: $(free -k | awk '/Mem/ { print $3 }') kB used"
echo "END after $(uptime) s"
poweroff -f
