#!/usr/bin/env bash
# tests/viewer/run.sh PROGRAM FOLDER: drives the viewer of PROGRAM's plans in headless Chromium; npm's packages, plans and pages go
# into FOLDER. Closes with "N passed, N failed".
set -u
here=$(cd "$(dirname "$0")" && pwd)
"$here/../../tools/npm-packages.sh" "$here" "$2" || { echo '0 passed, 1 failed'; exit 1; }
rm -rf "$2/scratch" && mkdir -p "$2/scratch"
exec timeout 300 node "$here/test.cjs" "$2" "$1" "$2/scratch"
