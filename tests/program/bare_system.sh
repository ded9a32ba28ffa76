# A bare Debian 12 to install the packages into. Source it; it takes root, debootstrap and a mirror.
#   bare=FOLDER         its folder, set before make_bare
# fail MESSAGE... is defined by the test.

can_make_bare() { [ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null; }

make_bare() {
  local mirror
  mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 2>/dev/null | head -n 1)
  debootstrap --variant=minbase --include=ca-certificates bookworm "$bare" ${mirror:+"$mirror"} >log 2>&1 ||
    fail "no bare Debian: $(tail -n 5 log)"
  cp /etc/resolv.conf /etc/hosts "$bare/etc/" 2>/dev/null || true
  if [ -d /etc/apt/apt.conf.d ]; then cp -n /etc/apt/apt.conf.d/* "$bare/etc/apt/apt.conf.d/"; fi
  echo force-unsafe-io >"$bare/etc/dpkg/dpkg.cfg.d/unsafe-io"  # nothing there must survive a power loss
  mount -t proc proc "$bare/proc"
}

remove_bare() {
  if mountpoint -q "$bare/proc"; then umount "$bare/proc"; fi
  rm -rf "$bare"
}

# in_bare COMMAND: its output goes to the file log.
in_bare() {
  chroot "$bare" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive bash -c "$1" </dev/null >log 2>&1
}
inside() { in_bare "$1" || fail "in a bare Debian: $1: $(tail -n 20 log)"; }
