#!/bin/sh
# viewer/build.sh FOLDER: builds the page in FOLDER, where npm's packages go too, and prints it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
"$here/../tools/npm-packages.sh" "$here" "$1"
cp "$here"/*.js "$here"/*.mjs "$here"/*.css "$here"/*.html "$here"/*.txt "$1"
node "$1/build.mjs"
