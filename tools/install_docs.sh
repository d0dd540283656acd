#!/bin/sh
# tools/install_docs.sh FOLDER: copies the documents and examples there as they lie in the source, so that links between them hold;
# what links to a file that is not installed is left as words.
set -eu
mkdir -p "$1/docs"
cp README.md CHANGELOG.md "$1/"
cp -R docs/*.md docs/plan.schema.json docs/pictures "$1/docs/"
cp -R examples "$1/"
find "$1" -name '*.md' -exec sed -i -E 's#\[([^]]*)\]\((\.\./)?(LICENSE|CONTRIBUTING|data|tests)[^)]*\)#\1#g' {} +
find "$1" -type d -exec chmod 755 {} +
find "$1" -type f ! -perm -u+x -exec chmod 644 {} +
