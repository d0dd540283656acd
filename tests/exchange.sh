#!/usr/bin/env bash
# tests/exchange.sh [PROGRAM]: what others find in the cords that PROGRAM (build/release/thread) draws. Blender reads glTF and OBJ,
# with and without --lanes, ezdxf reads DXF: the cords as long as cords.csv says, upright, the passes in their order.
# Closes with "N passed, N failed", or, unless CI=true, "1 skipped" and exit code 77 where Blender and ezdxf cannot be had.
set -u
cd "$(dirname "$0")/.." || exit 1
program=$(realpath "${1:-build/release/thread}") passed=0 failed=0
if ! tools/install-packages.sh blender python3-numpy python3-ezdxf >&2 || ! command -v blender >/dev/null; then
  echo 'tests/exchange.sh: there is no Blender' >&2
  [ "${CI:-}" = true ] && echo '0 passed, 1 failed' && exit 1
  echo '1 skipped'
  exit 77
fi
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

holds() { # WHAT COMMAND..: the command ends well
  local what=$1
  shift
  if "$@" >"$work/log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAIL $what"
    sed 's/^/  /' "$work/log"
  fi
}

in_blender() { # FILE PLAN CSV LANES
  blender -b --factory-startup --python-exit-code 1 --python tests/exchange/in_blender.py -- "$@"
}

draw() { # NAME TYPE OPTIONS..: NAME is the plan's
  "$program" draw "$work/$1.json" -T "$2" -o "$work/$1.${*: -1}.$2" "${@:3:$#-3}"
}

both() { # NAME WHAT: every file of the plan
  local name=$1 csv=$work/$1.csv plan=$work/$1.json
  holds "$2: cords.csv" "$program" draw "$plan" -T cords.csv -o "$csv"
  for lanes in plain lanes; do
    local -a how=()
    [ $lanes = lanes ] && how=(--lanes)
    for type in gltf obj dxf; do
      local -a up=()
      [ $type = obj ] && up=(--up y)
      holds "$2: $type, $lanes" draw "$name" $type "${how[@]}" "${up[@]}" $lanes
      [ $type = dxf ] && continue
      holds "$2: Blender reads $type, $lanes" in_blender "$work/$name.$lanes.$type" "$plan" "$csv" $lanes
    done
    holds "$2: ezdxf reads dxf, $lanes" /usr/bin/python3 tests/exchange/in_ezdxf.py "$work/$name.$lanes.dxf" "$plan" "$csv" $lanes
  done
}

"$program" make dome --size 5 -o "$work/dome.obj"
"$program" make sphere --size 1 -o "$work/sphere.obj"
"$program" plan -q "$work/dome.obj" --cords 1 -o "$work/one.json" || exit 1
"$program" plan -q "$work/dome.obj" --cords 4 --ends any -o "$work/four.json" || exit 1
"$program" plan -q "$work/sphere.obj" --cords 1 --cover 2 -o "$work/twice.json" || exit 1
both one 'one cord'
both four 'four cords'
both twice 'every edge twice'
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
