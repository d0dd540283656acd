#!/usr/bin/env bash
# tests/release.sh [OUT]: what `make release` leaves in OUT/thread-VERSION (OUT: build), each file tried in a place where nothing else
# of this source is: the static program with another root, thread.exe under Wine, the wheel in an environment of Python, the npm
# package in an empty folder, the Debian packages unpacked, with their own tests, the page's script read by node. Every one makes the
# dome and finds its least length, with an empty HOME. What is quick is made a second time, with the same bytes. Runs `make release`
# first. Closes with "N passed, N failed"; what cannot be tried here is said.
set -u
cd "$(dirname "$0")/.." || exit 1
out=${1:-build} passed=0 failed=0
version=$(sed -n 's/^VERSION := //p' Makefile)
folder=$out/thread-$version
length='1995\.24' # mm, of the dome with 7 x 7 nodes
export LC_ALL=C.UTF-8
home=$HOME
plain_make() { env -u MAKEFLAGS -u MAKELEVEL HOME="$home" "${MAKE:-make}" OUT="$out" "$@" >&2; }
plain_make release || { echo '0 passed, 1 failed' && exit 1; }
folder=$(realpath "$folder")
work=$(mktemp -d) || exit 1
leave() {
  if [ -e "$work/wine" ]; then WINEPREFIX=$work/wine wineserver --kill --wait; fi # Wine's own process, of this folder alone
  rm -rf "$work"
}
trap leave EXIT
mkdir "$work/home"
export HOME=$work/home

test_that() { # WORDS COMMAND ..
  local words=$1
  shift
  if "$@" >"$work/said" 2>&1; then passed=$((passed + 1)); return; fi
  failed=$((failed + 1))
  echo "not so: $words"
  tail -n 20 "$work/said" | sed 's/^/    /'
}
within() (cd "$1" && shift && "$@") # FOLDER COMMAND ..
finds() { # FOLDER COMMAND ..: the command, as `thread`, makes and plans the dome in the folder
  local folder=$1
  shift
  mkdir -p "$folder" && within "$folder" "$@" make dome -o dome.json && within "$folder" "$@" plan dome.json --cords 1 -o plan.json </dev/null |
    tee "$work/plan" | grep "$length" || { cat "$work/plan" && return 1; }
}

static() {
  local enter=(chroot "$work/static")
  [ "$(id -u)" = 0 ] || enter=(unshare --map-root-user chroot "$work/static")
  mkdir -p "$work/static" && cp "$folder"/thread-linux-* "$work/static/thread" && finds / "${enter[@]}" /thread &&
    "${enter[@]}" /thread plan /dome.json && [ -s "$work/static/dome/sheets.html" ] # there are no fonts
}
windows() { WINEPREFIX=$work/wine WINEDEBUG=-all finds "$work/windows" wine "$folder/thread.exe"; }
npm_package() {
  mkdir -p "$work/npm" && within "$work/npm" npm install --silent --offline --no-audit --no-fund "$folder/thread-plan-$version.tgz" &&
    finds "$work/npm" npx --offline thread-plan &&
    [ "$(within "$work/npm" node -p 'typeof require("thread-plan").makeEngine')" = function ]
}
wheel() {
  python3 -m venv --without-pip "$work/python" && python3 -m pip --python "$work/python/bin/python" install --no-index "$folder"/*.whl &&
    [ "$("$work/python/bin/python" -I -c 'import thread_plan; print("%.2f" % thread_plan.Frame.shape("dome", 7).set_feet().plan(cords=1, ends="closed").summary.length)')" = 1995.25 ]
}
debian() {
  local deb
  for deb in "$folder"/*.deb; do dpkg-deb -x "$deb" "$work/debian" || return; done
}
debian_test() { # NAME: of debian/tests, on what is unpacked
  local usr=$work/debian/usr
  local lib
  lib=$(dirname "$(find "$usr/lib" -name libthread.so.0)")
  mkdir -p "$work/tested/$1"
  env PATH="$usr/bin:$PATH" LD_LIBRARY_PATH="$lib" LIBTHREAD="$lib/libthread.so.0" PKG_CONFIG_PATH="$lib/pkgconfig" \
    CMAKE_PREFIX_PATH="$usr" PYTHONPATH="$usr/lib/python3/dist-packages" THREAD_DOC="$usr/share/doc/thread" \
    AUTOPKGTEST_TMP="$work/tested/$1" "debian/tests/$1"
}
source_tarball() {
  tar -xzf "$folder/thread-$version.tar.gz" -C "$work" && within "$work/thread-$version" make -n BUILD=release all | grep -c '  LINK'
}
page_scripts() { # are its scripts JavaScript, and is its program in it?
  python3 - "$folder/thread.html" "$work/page.js" <<'END' && node --check "$work/page.js" && node --check "$folder/thread-3dm.js"
import re, sys
text = open(sys.argv[1], encoding="utf-8").read()
scripts = re.findall(r"<script>(.*?)</script>", text, re.S)
assert scripts and re.search(r"[A-Za-z0-9+/]{500000}", text)
open(sys.argv[2], "w", encoding="utf-8").write("\n".join("{%s}" % s for s in scripts))
END
}
twice() { # PLACE NAME COMMAND ..: the command makes the file PLACE again, with the bytes that NAME has in the release
  local place=$1 name=$2
  shift 2
  rm -f "$place" && "$@" && cmp "$place" "$folder/$name"
}

without_tools() { # one line, before anything is built
  mkdir "$work/tools" && ln -s "$(command -v dirname)" "$(command -v git)" "$work/tools" || return
  PATH=$work/tools /bin/sh tools/release.sh --ready "$work/libraries" 2>"$work/line" && return 1
  cat "$work/line" && [ "$(wc -l <"$work/line")" = 1 ] && grep '^make release: missing: gcc .* emcc ' "$work/line" && [ ! -e "$work/libraries" ]
}

test_that 'without its tools it says in one line which are missing' without_tools
test_that 'the sums are those of the files' within "$folder" sha256sum --check --strict SHA256SUMS
test_that 'the README has no more than 25 lines' [ "$(wc -l <"$folder/README.txt")" -le 25 ]
test_that 'the static program runs alone, and without fonts' static
if command -v wine >/dev/null || tools/install-packages.sh wine wine64 >&2; then
  test_that 'thread.exe runs under Wine' windows
else
  echo 'not tried: thread.exe, for lack of Wine'
fi
test_that 'the npm package runs as npx thread-plan' npm_package
test_that 'the wheel plans' wheel
test_that 'the Debian packages can be unpacked' debian
for name in $(sed -n 's/^Tests: //p' debian/tests/control); do test_that "debian/tests/$name" debian_test "$name"; done
test_that 'the page is in its package' cmp "$folder/thread.html" "$work/debian/usr/share/thread/thread.html"
test_that 'the source tarball can be built' source_tarball
test_that "the page's scripts are whole" page_scripts
test_that 'the static program is linked twice with the same bytes' twice "$out/static/thread" "thread-linux-$(uname -m)" plain_make static
test_that 'thread.exe is linked twice with the same bytes' twice "$out/windows/thread.exe" thread.exe plain_make windows
test_that 'thread.html is made twice with the same bytes' twice "$out/web/thread.html" thread.html plain_make web
test_that 'the wheel is packed twice with the same bytes' twice "$(echo "$out"/wheel/*.whl)" "$(basename "$folder"/*.whl)" plain_make wheel
sums=$(cat "$folder/SHA256SUMS")
test_that 'the folder is filled twice with the same bytes' env SOURCE_DATE_EPOCH="$(stat -c %Y "$folder/README.txt")" tools/release.sh "$version" "$out"
test_that 'and the same sums' [ "$sums" = "$(cat "$folder/SHA256SUMS")" ]
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
