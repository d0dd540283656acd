#!/usr/bin/env bash
# Runs what README.md and docs/guide.md show: every line "$ command" in a block, in order and in one folder each, and compares what
# it prints to stdout with what stands below it. ".." there, on a line of its own or inside, stands for anything; a command with
# nothing below it may print anything, but must end well; "  # .." behind it says what it is good for. The folder holds data/ and the
# frameworks of tests/readme/files, which stand for the reader's own. tests/readme/run.sh PROGRAM; closes with "N passed, N failed".
set -u
[ $# -eq 1 ] || { echo "usage: tests/readme/run.sh PROGRAM" >&2; exit 2; }
program=$(realpath "$1")
cd "$(dirname "$0")/../.." || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
# One golden case each; exit code 5 says that not all is proved. Explained searches (--objective, --balance), of which the page
# shows nothing, are only run, for two seconds.
cases() { # PAGE
  echo "\$ cp tests/readme/files/* {TMP} && ln -s \"$PWD/data\" {TMP}"
  awk '
  function finish() { if (shown && !lines) print " ..."; if (shown) print "? 0"; shown = lines = gap = 0 }
  /^```/ { inside = !inside; finish(); next }
  !inside { next }
  /^\$ / {
    finish()
    shown = 1
    command = substr($0, 3)
    explained = sub(/ +# .*/, "", command)
    timed = explained && command ~ /--objective|--balance/
    if (timed) command = command " --time-limit 2"
    print "$ cd {TMP} && { " command " 2>messages || [ $? -eq 5 ] || { cat messages; false; }; }"
    next
  }
  !shown || timed { next }
  /^$/ { gap++; next }
  {
    for (; gap > 0; gap--) print ""
    lines++
    if ($0 == "..") $0 = " ..."
    gsub(/ \.\. /, "...")
    print
  }' "$1"
}
cases README.md >"$work/readme.case"
cases docs/guide.md >"$work/guide.case"
tests/golden/run.sh "$program" "$work/readme.case" "$work/guide.case"
