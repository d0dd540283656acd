#!/usr/bin/env bash
# tests/targets.sh static [PROGRAM [OTHER]]: the program as one file (OTHER: build/static/thread, as `make static` leaves it) beside
# the installed one (PROGRAM: build/release/thread): plans, checks, drawings and evaluations of five frameworks, and lines about bad
# input, must be the same, byte for byte. It runs where there is nothing else: in a folder of its own as the root of its file system,
# with the fonts for the PDF. Builds what is missing. Closes with "N passed, N failed", or, unless CI=true, "1 skipped" and exit
# code 77 where the sources of the libraries or the right to change the root cannot be had.
set -u
cd "$(dirname "$0")/.." || exit 1
target=${1:?static} program=${2:-build/release/thread} other=${3:-build/$1/thread} passed=0 failed=0
[ "$target" = static ] || { echo "tests/targets.sh: $target is not static" >&2 && exit 2; }
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
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
program=$(realpath "$program")

# Two folders that look the same to the two programs; to the other one it is the whole file system.
here=$work/here there=$work/there
mkdir -p "$here/out" "$there/out" "$there/etc" "$there/usr/share"
cp "$other" "$there/thread" || exit 1
cp -rL /etc/fonts "$there/etc" && cp -rL /usr/share/fonts "$there/usr/share" || exit 1
enter=(chroot "$there")
[ "$(id -u)" = 0 ] || enter=(unshare --map-root-user chroot "$there")
"${enter[@]}" /thread --version >/dev/null || skip 'the program does not run with another root'
cp data/jax_fdm/barrel.obj data/jax_fdm/monkey_saddle.json data/jax_fdm/liew_dome.json "$here"
cp "$here"/* "$there" 2>/dev/null

same() { # CODE ARGUMENTS..: exit code and what is printed
  local a b
  (cd "$here" && XDG_CACHE_HOME=/none timeout 300 "$program" "${@:2}" >"$work/a.out" 2>"$work/a.err" </dev/null)
  a=$?
  timeout 300 "${enter[@]}" /thread "${@:2}" >"$work/b.out" 2>"$work/b.err" </dev/null
  b=$?
  if [ $a = "$1" ] && [ $b = "$1" ] && cmp -s "$work/a.out" "$work/b.out" && cmp -s "$work/a.err" "$work/b.err"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "thread ${*:2}: exit codes $a and $b, expected $1"
    diff "$work/a.err" "$work/b.err" | head -n 5
  fi
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
same 5 plan dome.json --objective tortuosity --cords 4 --ends feet --minimize max-turning --nodes 4 --time-limit 0 -o out/turning.json
same 0 check out/turning.json
same 0 symmetries dome.json --row-work 0.05 --json
same 0 plan dome.json --objective symmetry --group 3 -o out/symmetry.json
same 3 plan missing.obj -o out/none.json
printf 'v 0 0 0\nv 1 0\nl 1 2\n' | tee "$here/bad.obj" >"$there/bad.obj"
same 3 plan bad.obj -o out/none.json
if diff -rq "$here/out" "$there/out"; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
