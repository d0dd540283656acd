#!/usr/bin/env bash
# Prints every option that the help of a command lists and no command shown in README.md or docs/*.md types. Such an option has no
# user yet: docs/guide.md should say what it is good for, or it should go. tests/readme/options.sh PROGRAM
set -u
[ $# -eq 1 ] || { echo "usage: tests/readme/options.sh PROGRAM" >&2; exit 2; }
program=$1
cd "$(dirname "$0")/../.." || exit 2
typed=$(sed -n '/^[$] thread/{s/ # .*//; p}' README.md docs/*.md)
for command in $("$program" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
  "$program" "$command" --help | sed -nE 's/^ +(-[a-zA-Z])?,? *(--[a-z-]+).*/\2 \1/p'
done | sort -u | while read -r option letter; do
  grep -qE -- " ($option|${letter:-$option})([ =]|$)" <<<"$typed" || echo "$option"
done
