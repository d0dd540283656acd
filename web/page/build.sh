#!/bin/sh
# thread.html: the page, its program and its worker in one file. web/page/build.sh FOLDER VERSION: the folder has thread-engine.js,
# thread-engine.wasm and engine.js, and receives thread.html. The program is kept compressed; a browser inflates it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1 version=${2:-0.1.0}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat "$folder/thread-engine.js" "$folder/engine.js" "$here/worker.js" >"$scratch/WORKER"
gzip -9 -n -c "$folder/thread-engine.wasm" | base64 -w 0 >"$scratch/WASM"
cat "$here/engine-client.js" "$here/sketch.js" "$here/zip.js" "$here/store.js" "$here/app.js" >"$scratch/SCRIPT"
cp "$here/style.css" "$scratch/STYLE"
picture() { printf 'data:image/png;base64,'; base64 -w 0 "$here/../../docs/pictures/rise-lines-$1.png"; }
if grep -q '</script' "$scratch/WORKER" "$scratch/SCRIPT"; then
  echo 'web/page/build.sh: a script ends itself' >&2
  exit 1
fi
# A line @NAME@ is the file of that name.
picture begin >"$scratch/begin" && picture end >"$scratch/end"
awk -v version="$version" -v begin="$scratch/begin" -v end="$scratch/end" '
  BEGIN { getline first <begin; getline last <end }
  { gsub(/@VERSION@/, version); sub(/@BEGIN@/, first); sub(/@END@/, last); print }' "$here/page.html" | while IFS= read -r line; do
  case $line in
  @*@) name=${line#@}; cat "$scratch/${name%@}"; echo ;;
  *) printf '%s\n' "$line" ;;
  esac
done >"$folder/thread.html.new"
mv "$folder/thread.html.new" "$folder/thread.html"
