#!/usr/bin/env bash
# Tests the comparison of pictures of pages and windows: equal pictures pass, a picture with one missing part fails.
source "$(dirname "$0")/expect.sh" "$@"
here=$source_dir/tests/program
live=$source_dir/tests/data/shots/page_live.png
near() { /usr/bin/python3 "$here/picture_near.py" "$@"; }
without() { /usr/bin/python3 "$here/picture_without.py" "$live" "$@"; }

without 0 0 0 0 whole.png
expect_own 0 '^the same: 0\.00 ' near "$live" whole.png
# The panel of knobs, the plots, the touched body.
without 116 4 44 58 no_panel.png
expect_own 1 '^another picture' near "$live" no_panel.png
without 0 74 160 46 no_plots.png
expect_own 1 '^another picture' near "$live" no_plots.png
without 30 2 60 56 no_body.png
expect_own 1 '^another picture' near "$live" no_body.png
without 1 1 1 1 dot.png # fonts of other versions do not make another picture
expect_own 0 '^the same' near "$live" dot.png
finish
