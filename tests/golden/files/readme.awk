# awk -f readme.awk PAGE OUTPUT: prints each line that the page shows as output of a command and that OUTPUT lacks or has
# earlier than the line before. Numbers may differ by 2 %: simulations end in other last digits on other processors. ".." stands for
# words left out, on a line of its own for lines.

function same(a, b,    x, y, u, v) {
  while (match(a, number)) {
    if (substr(a, 1, RSTART - 1) != substr(b, 1, RSTART - 1)) return 0
    x = substr(a, RSTART, RLENGTH); a = substr(a, RSTART + RLENGTH); b = substr(b, RSTART)
    if (match(b, number) != 1) return 0
    y = substr(b, 1, RLENGTH); b = substr(b, RLENGTH + 1)
    u = x - y; v = 0.02 * x
    if (u > v || -u > v) return 0
  }
  return a == b
}

# Words from to until of line.
function words(line, from, until,    w, i, out) {
  split(line, w, " ")
  for (i = from; i <= until; i++) out = out " " w[i]
  return out
}

function matches(a, b,    parts, scrap, left, right, n) {
  if (split(a, parts, " [.][.] ") < 2) return same(a, b)
  left = split(parts[1], scrap, " "); right = split(parts[2], scrap, " "); n = split(b, scrap, " ")
  return left + right <= n && same(words(parts[1], 1, left), words(b, 1, left)) && \
         same(words(parts[2], 1, right), words(b, n - right + 1, n))
}

BEGIN { number = "[0-9]+[.]?[0-9]*" }
FNR == 1 { file++ }
file == 1 && /^```/ { shown = 0 }
file == 1 && shown && NF && !/^[$] / && !/^[.][.]$/ { gsub(/ +/, " "); want[++n] = $0 }
file == 1 && /^[$] / { shown = 1 }
file == 2 { gsub(/ +/, " "); have[++m] = $0 }
END {
  for (i = j = 1; i <= n; i++) {
    for (k = j; k <= m && !matches(want[i], have[k]); k++) { }
    if (k > m) print want[i]
    else j = k + 1
  }
}
