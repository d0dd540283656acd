#!/usr/bin/env bash
# tests/web.sh [PROGRAM [BUILD [FOLDER [FRAMES]]]]: the program for browsers and node, as `make web` leaves it in BUILD (build/web),
# beside the installed one (build/release/thread): the same plans and evaluations for FRAMES frameworks (20), under node and in
# headless Chromium; thread.html walked by what a person sees; the command line under node; modes of files; sizes and times, which are printed and not judged but for the sizes.
# FOLDER (build/web-test) is for what it writes. Builds what is missing. Closes with "N passed, N failed", or, unless CI=true,
# "N skipped" and exit code 77 where Emscripten, the sources, npm or a browser cannot be had.
set -u
cd "$(dirname "$0")/.." || exit 1
program=${1:-build/release/thread} build=${2:-build/web} folder=${3:-build/web-test} frames=${4:-20}
skip() {
  echo "tests/web.sh: $1" >&2
  [ "${CI:-}" = true ] && echo '0 passed, 1 failed' && exit 1
  echo '1 skipped'
  exit 77
}
# not those of a make that runs this
plain_make() { env -u MAKEFLAGS -u MAKELEVEL "${MAKE:-make}" "$@" >&2; }
[ -x "$program" ] || plain_make BUILD=release || exit 1
if [ ! -e "$build/npm/package.json" ]; then
  command -v emcc >/dev/null || tools/install-packages.sh emscripten >&2 || skip 'there is no Emscripten'
  targets/libraries.sh --fetch "${LIBRARIES:-${XDG_CACHE_HOME:-$HOME/.cache}/thread-libraries}" || skip 'there are no sources of the libraries'
  plain_make web || { echo '0 passed, 1 failed' && exit 1; }
fi
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || tools/install-packages.sh chromium >&2 || skip 'there is no browser'
tools/npm-packages.sh tests/viewer "$folder/packages" || skip "npm's packages cannot be had"
rm -rf "$folder/scratch" && mkdir -p "$folder/scratch"
mkdir -p "$folder/scratch/page"
{
  timeout 1200 node tests/web/compare.cjs "$program" "$build" "$folder/packages" "$folder/scratch" "$frames"
  timeout 600 node tests/web/page.cjs "$folder/packages" "$program" "$build/thread.html" "$folder/scratch/page"
} | tee "$folder/scratch/log"
# The sum of both, each of which closes with a line of its own.
awk '
  /^[0-9]+ passed, [0-9]+ failed$/ { passed += $1; failed += $3; lines++ }
  END { failed += 2 - lines; printf "%d passed, %d failed\n", passed, failed; exit failed > 0 }' "$folder/scratch/log"
