#!/bin/sh
# tools/npm-packages.sh FROM TO: installs into the folder TO what FROM/package-lock.json names, unless it is there already. No
# script of any package is run.
set -eu
mkdir -p "$2"
if [ -d "$2/node_modules" ] && cmp -s "$1/package-lock.json" "$2/package-lock.json"; then exit 0; fi
if ! command -v npm >/dev/null 2>&1; then
  echo "npm-packages: npm is missing (Debian: nodejs, npm)" >&2
  exit 1
fi
cp "$1/package.json" "$1/package-lock.json" "$2"
for pause in 3 10 0; do # the network may stumble
  if (cd "$2" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2); then exit 0; fi
  sleep "$pause"
done
rm -rf "$2/node_modules"
exit 1
