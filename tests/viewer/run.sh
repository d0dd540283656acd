#!/usr/bin/env bash
# tests/viewer/run.sh PROGRAM FOLDER: drives the viewer of PROGRAM's plans in headless Chromium; npm's packages, plans and pages go
# into FOLDER. Closes with "N passed, N failed", or "N skipped" and exit code 77 without npm, its network or a browser.
set -u
here=$(cd "$(dirname "$0")" && pwd)
if ! [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || ! "$here/../../tools/npm-packages.sh" "$here" "$2"; then
  echo "$(grep -c "^  async '" "$here/test.cjs") skipped"
  exit 77
fi
rm -rf "$2/scratch" && mkdir -p "$2/scratch"
exec timeout 900 node "$here/test.cjs" "$2" "$1" "$2/scratch"
