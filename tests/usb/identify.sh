# Identifies simulated arms with hidden constants through this kernel, like a user: feel check, then
# `thimble identify` with a known mass and the shipped arm file, which is wrong. Sourced by init.sh.

seconds=15  # of each motion
known=0.025 # kg

# Waits for prompt number COUNT in a log. Polls seldom: every read of the log takes time from the servo, with
# which it shares the only processor.
prompted() { # LOG COUNT
  for i in $(seq 1000); do
    [ "$(grep -c 'Press Enter to begin' "$1")" -ge "$2" ] && return 0
    [ -d /proc/$asking ] || return 1
    usleep 400000
  done
  return 1
}
press() { # LOG COUNT
  prompted "$1" "$2" && echo >&8
}

# Moves the hand from the middle of the workspace by X Y Z, m along the world axes.
lead() { # ARM X Y Z
  case $1 in
    woodenhaptics) echo "$2 $3 $4" | awk '{ print "hand", $1 - 0.025, $2, $3 - 0.205 }' ;; # it starts in its home pose
    falcon) echo "hand $3 $4 $2" ;; # its base has x to the right, y up, z to the user
    *) echo "hand $2 $3 $4" ;;
  esac >$control
}

feel_check() { # ARM OPTIONS
  arm=$1
  as tester "exec thimble feel-check --no-real-time $2" <$keys >/tmp/feel.log 2>&1 &
  asking=$!
  press /tmp/feel.log 1 || return 1
  for place in "0.025 0.025 0" "-0.025 0 0.025" "0 -0.025 -0.025" "0 0 0"; do
    lead $arm $place
    usleep 800000
  done
  step=2
  for place in "0.03 0 0" "0 0.03 0" "0 0 0.03"; do
    press /tmp/feel.log $step || return 1
    usleep 100000
    lead $arm $place
    usleep 700000
    lead $arm 0 0 0
    step=$((step + 1))
  done
  while [ $step -le 8 ]; do
    press /tmp/feel.log $step || return 1
    step=$((step + 1))
  done
  wait $asking
}

# Holds the mass from below, and releases it once the motors carry it.
hold_mass() { # ARM
  lead $1 0 0 0
  echo "hand on" >$control
  usleep 300000
  echo "mass $known" >$control
  usleep 300000
  echo >&8
  # Some arms need time to connect.
  for i in $(seq 100); do
    tail -n 1 /tmp/device.trace | awk '{ exit !(NF == 22 && $20 && ($11 || $12 || $13)) }' && break
    usleep 100000
  done
  usleep 600000
  echo "hand off" >$control
}

# One arm, drawn by SEED; NAME_cables: NAME with elastic cables.
identify() { # ARM SEED
  named=$1 arm=${1%_cables} cables=
  [ $named = $arm ] || cables=cables
  file=/data/app/arms/$arm.yaml
  options="--arm $file"
  [ $arm != falcon ] || options="$options --firmware /etc/falcon.bin"
  usb_check hide $file $2 $cables >/tmp/hidden.yaml || { cat /tmp/hidden.yaml; return; } # prints a FAIL line
  begun=$(uptime)
  plug $arm /tmp/device.trace --hand rest --arm /tmp/hidden.yaml
  options="--device $(usb_check name $arm) $options"
  keys=/tmp/keys
  rm -f $keys
  mkfifo $keys
  chmod 666 $keys
  exec 8<>$keys
  export HOME=/tmp
  lead $arm 0 0 0
  sleep 1
  if feel_check $arm "$options"; then
    echo "PASS $named of hidden constants passes its feel check"
    echo "hand off" >$control
    as tester "exec thimble identify --no-real-time $options --known-mass $known --duration $seconds \
      --places 0 --record /tmp/motion.h5 --output /tmp/identified.yaml" <$keys >/tmp/identify.log 2>&1 &
    asking=$!
    press /tmp/identify.log 1 && prompted /tmp/identify.log 2 && hold_mass $arm
    wait $asking && echo "PASS $named of hidden constants is identified" ||
      echo "FAIL $named of hidden constants is identified: $(tr '\n' ' ' </tmp/identify.log)"
    cat /tmp/identify.log
  else
    echo "FAIL $named of hidden constants passes its feel check: $(tr '\n' ' ' </tmp/feel.log)"
  fi
  exec 8>&-
  unplug
  sed -n 's/^Unplugged\. /NOTE '$named': /p' /tmp/plug.log
  as tester "thimble export /tmp/motion.h5 --csv /tmp/motion.csv"
  # The state of each tick from usb_check's trace, in the arm's base frame.
  awk -F, -v falcon=$([ $arm = falcon ] && echo 1 || echo 0) '
    !named { for (i = 1; i <= NF; ++i) { sub(/ .*/, "", $i); at[$i] = i }; named = 1; print 0; next }
    { x = $at["f_sent_W.x"]; y = $at["f_sent_W.y"]; z = $at["f_sent_W.z"]
      if (falcon) { t = x; x = y; y = z; z = t }
      print $at["fresh"], $at["counts.1"], $at["counts.2"], $at["counts.3"], x, y, z }' \
    /tmp/motion.csv >/tmp/driver.trace
  usb_check compare $arm /tmp/driver.trace /tmp/device.trace >/tmp/compare.log
  sed 's/^\(PASS\|FAIL\) '$arm'/\1 '$named' identified:/; s/^FIGURE '$arm'\./FIGURE '$named'.identify_/' /tmp/compare.log
  delay=$(sed -n "s/^FIGURE $arm.delay_median \([0-9.]*\).*/\1/p" /tmp/compare.log)
  usb_check identified $named $file /tmp/hidden.yaml /tmp/identified.yaml ${delay:-0}
  echo "FIGURE $named.identify_time $(echo "$(uptime) $begun" | awk '{ print $1 - $2 }') s"
  rm -f /tmp/motion.* /tmp/identified.yaml /tmp/*.trace
}
