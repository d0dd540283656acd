#!/usr/bin/env bash
# tests/schema/run.sh PROGRAM FOLDER: holds docs/plan.schema.json against the plans of PROGRAM, by a
# public validator; npm's packages and plans go into FOLDER. Closes with "N passed, N failed", or
# "N skipped" and exit code 77 without npm or its network.
set -u
here=$(cd "$(dirname "$0")" && pwd)
if ! "$here/../../tools/npm-packages.sh" "$here" "$2"; then
  echo "$(grep -c "^  ['\"].*: () =>" "$here/test.cjs") skipped"
  exit 77
fi
rm -rf "$2/scratch" && mkdir -p "$2/scratch"
exec timeout 600 node "$here/test.cjs" "$2" "$1" "$2/scratch"
