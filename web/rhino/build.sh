#!/bin/sh
# thread-3dm.js, which thread.html loads when a 3dm file is opened: rhino3dm with its wasm, compressed, and read.js. web/rhino/build.sh
# PACKAGES FILE: npm's packages go into the folder PACKAGES. Where npm cannot be had it says so and makes no file.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
if ! "$here/../../tools/npm-packages.sh" "$here" "$1"; then
  echo 'make web: without npm there is no thread-3dm.js, and thread.html reads no 3dm files' >&2
  exit 0
fi
{
  echo '/*'
  cat "$here/LICENSE"
  echo '*/'
  cat "$1/node_modules/rhino3dm/rhino3dm.min.js"
  echo
  printf 'globalThis.RHINO3DM_WASM = "'
  gzip -9 -n -c "$1/node_modules/rhino3dm/rhino3dm.wasm" | base64 -w 0
  echo '";'
  echo '(() => {'
  cat "$here/read.js"
  echo '})();'
} >"$2.new"
mv "$2.new" "$2"
