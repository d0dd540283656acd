#!/usr/bin/env bash
# tests/targets.sh static|windows [PROGRAM [OTHER]]: the program as one file (OTHER: build/static/thread or build/windows/thread.exe,
# as `make static` and `make windows` leave it) beside the installed one (PROGRAM: build/release/thread): plans, checks, drawings,
# evaluations and pieces to print, and lines about bad input, must be the same, byte for byte.
# static: it runs where there is nothing else: in a folder of its own as the root of its file system, with the fonts for the PDF.
# windows: it runs under Wine. sheets.html stands for sheets.pdf, and the last digits of an evaluation are those of another exp():
# no more may differ.
# Builds what is missing. Closes with "N passed, N failed", or, unless CI=true, "1 skipped" and exit code 77 where the sources of the
# libraries, Wine or the right to change the root cannot be had.
set -u
cd "$(dirname "$0")/.." || exit 1
target=${1:?static or windows?} program=${2:-build/release/thread} passed=0 failed=0
case $target in
static) other=${3:-build/static/thread} ;;
windows) other=${3:-build/windows/thread.exe} ;;
*) echo "tests/targets.sh: $target is neither static nor windows" >&2 && exit 2 ;;
esac
skip() {
  echo "tests/targets.sh: $1" >&2
  [ "${CI:-}" = true ] && echo '0 passed, 1 failed' && exit 1
  echo '1 skipped'
  exit 77
}
plain_make() { env -u MAKEFLAGS -u MAKELEVEL "${MAKE:-make}" "$@" >&2; }
[ -x "$program" ] || plain_make BUILD=release || exit 1
if [ ! -e "$other" ]; then
  targets/libraries.sh --fetch "${LIBRARIES:-${XDG_CACHE_HOME:-$HOME/.cache}/thread-libraries}" || skip 'there are no sources of the libraries'
  plain_make "$target" || { echo '0 passed, 1 failed' && exit 1; }
fi
if [ "$target" = windows ]; then tools/install-packages.sh wine wine64 >&2 || skip 'there is no Wine'; fi
work=$(mktemp -d) || exit 1
leave() {
  if [ -e "$work/wine" ]; then wineserver --kill --wait; fi # Wine's own process, of this folder alone
  rm -rf "$work"
}
trap leave EXIT
program=$(realpath "$program")

# Two folders that look the same to the two programs; `other` runs the other one in its folder.
here=$work/here there=$work/there
mkdir -p "$here/out" "$there/out"
cp "$other" "$there/thread" || exit 1
if [ "$target" = static ]; then
  mkdir -p "$there/etc" "$there/usr/share"
  cp -rL /etc/fonts "$there/etc" && cp -rL /usr/share/fonts "$there/usr/share" || exit 1
  enter=(chroot "$there")
  [ "$(id -u)" = 0 ] || enter=(unshare --map-root-user chroot "$there")
  other() { timeout 300 "${enter[@]}" /thread "$@"; }
  other --version >/dev/null || skip 'the program does not run with another root'
  alike() { cat; }
  near() { cat; }
else
  mv "$there/thread" "$work/thread.exe"
  export WINEPREFIX=$work/wine WINEDEBUG=-all LC_ALL=C.UTF-8
  other() (cd "$there" && timeout 300 wine "$work/thread.exe" "$@")
  other --version >"$work/version" 2>"$work/log" || { cat "$work/log" >&2 && skip 'Wine does not run the program'; }
  # Wine starts processes of its own, whose failures it tells here, too; one of the program's shows in its exit code.
  alike() { sed -e '/^wine: /d' -e '/^thread: sheets\./d' -e 's/ sheets\.[a-z]*//'; }
  near() { python3 -c 'import re, sys; print(re.sub(r"\d+\.\d+", lambda n: "%.12g" % float(n[0]), sys.stdin.read()))'; }
fi
cp data/jax_fdm/barrel.obj data/jax_fdm/monkey_saddle.json data/jax_fdm/liew_dome.json "$here"
cp "$here"/*.* "$there"

report() { # WHETHER WHAT: counts, and tells what failed
  if [ "$1" = yes ]; then passed=$((passed + 1)); else failed=$((failed + 1)) && echo "$2"; fi
}

same() { # CODE ARGUMENTS..: exit code and what is printed
  local a b ok=no how=alike
  if [ "$2" = eval ]; then how=near; fi
  (cd "$here" && XDG_CACHE_HOME=/none timeout 300 "$program" "${@:2}" 2>"$work/a.err" </dev/null) | $how >"$work/a.out"
  a=${PIPESTATUS[0]}
  other "${@:2}" 2>"$work/b.err" </dev/null | $how >"$work/b.out"
  b=${PIPESTATUS[0]}
  alike <"$work/a.err" >"$work/a.said"
  alike <"$work/b.err" >"$work/b.said"
  if [ "$a" = "$1" ] && [ "$b" = "$1" ] && cmp -s "$work/a.out" "$work/b.out" && cmp -s "$work/a.said" "$work/b.said"; then ok=yes; fi
  report $ok "thread ${*:2}: exit codes $a and $b, expected $1$(diff "$work/a.said" "$work/b.said" | head -n 5)$(diff "$work/a.out" "$work/b.out" | head -n 5)"
}

same 0 make dome -o dome.json
same 0 make tube --size 12 --rings 7 -o tube.json
for frame in dome.json tube.json barrel.obj monkey_saddle.json liew_dome.json; do
  plan=out/${frame%.*}.json
  same 0 plan "$frame" -o "$plan" --draw "out/${frame%.*}"
  same 0 check "$plan"
  same 0 eval "$plan" --json
  same 0 info "$frame" --json
done
same 0 plan dome.json --objective tortuosity --cords 4 --ends feet --minimize max-turning --tune nodes=4 --time-limit 0 -o out/turning.json
same 0 check out/turning.json
same 0 symmetries dome.json --tune row-work=0.05 --json
same 0 plan dome.json --objective symmetry --group 3 -o out/symmetry.json
same 0 make dome --size 3 -o small.json
same 0 plan small.json -o out/small.json
same 0 kit out/small.json --names none --stl -o out/kit
same 3 plan missing.obj -o out/none.json
printf 'v 0 0 0\nv 1 0\nl 1 2\n' | tee "$here/bad.obj" >"$there/bad.obj"
same 3 plan bad.obj -o out/none.json

# What the other one wrote: the same files, and plans that the installed program takes.
for plan in "$there"/out/*.json; do
  if "$program" check -q "$plan" >"$work/log" 2>&1; then report yes; else report no "$(cat "$work/log")"; fi
done
ok=yes
diff <(cd "$here/out" && find . -type f ! -name 'sheets.*' | sort) <(cd "$there/out" && find . -type f ! -name 'sheets.*' | sort) || ok=no
while read -r file; do
  cmp -s <(alike <"$here/out/$file") <(alike <"$there/out/$file") || { ok=no && echo "out/$file"; }
done < <(cd "$here/out" && find . -type f ! -name 'sheets.*')
report $ok 'the outputs differ'
if [ "$target" = static ]; then
  if cmp "$here/out/dome/sheets.pdf" "$there/out/dome/sheets.pdf"; then report yes; else report no 'sheets.pdf differs'; fi
  rm -rf "$there/etc" "$there/usr"
  ok=no
  other plan dome.json -q -o bare.json --draw bare && "$program" draw "$there/bare.json" -T sheets.html -q -o - | cmp - "$there/bare/sheets.html" && ok=yes
  report $ok 'without fonts the booklet is sheets.html'
else
  ok=no
  other plan dome.json -q -o 'out\Grüße.json' --draw 'new\folder' && [ -s "$there/out/Grüße.json" ] &&
    [ -s "$there/new/folder/overview.svg" ] && ok=yes
  report $ok "names in another alphabet, with the separators of Windows"
  ok=no
  other plan - -q -o - <"$here/dome.json" | cmp <(alike <"$there/out/dome.json") <(alike) && ok=yes
  report $ok 'bytes through pipes'
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
