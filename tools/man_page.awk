# Makes a man page of what `thread COMMAND --help` prints: awk -v command=plan -f man_page.awk help.txt; man_page.py folds it
# The first line is "usage: what it does"; a line that ends with a colon at the left margin begins a section; lines with options
# begin with blanks and a dash; lines that begin with three times as many blanks go on with the one above; all else is prose.
function plain(s) { gsub(/\\/, "\\e", s); gsub(/-/, "\\-", s); if (s ~ /^[.']/) s = "\\&" s; return s }
function trim(s) { gsub(/^ +| +$/, "", s); return s }
function close_block() { if (block) print ".fi"; block = 0 }
function option(s,    at, head, text) { # "-o, --output FILE    what it does"
  s = trim(s)
  at = match(s, /  +/)
  head = at ? substr(s, 1, at - 1) : s
  text = at ? trim(substr(s, at)) : ""
  print ".TP"
  print ".B " plain(head)
  if (text != "") print plain(text)
}
function options(s,    at) { # several may stand in one line
  while ((at = match(substr(s, 8), /   +-/))) {
    option(substr(s, 1, at + 7))
    s = substr(s, at + 8)
  }
  option(s)
}
NR == 1 {
  at = index($0, ": ")
  usage = substr($0, 1, at - 1); summary = substr($0, at + 2)
  printf ".TH THREAD-%s 1 \"\" \"thread\" \"User commands\"\n.SH NAME\nthread-%s \\- %s\n.SH SYNOPSIS\n.B %s\n", toupper(command), command, plain(summary), plain(usage)
  next
}
/^[A-Z].*:$/ {
  close_block()
  title = substr($0, 1, length($0) - 1)
  if (title ~ /^(Examples|Options)$/) print ".SH " toupper(title)
  else if (title ~ /^What is planned/) print ".SH OPTIONS\n.SS " title
  else print ".SS " plain(title)
  examples = title == "Examples"
  if (examples) { print ".nf"; block = 1 }
  next
}
/^$/ { close_block(); if (NR > 2) print ".PP"; examples = 0; next }
examples { print plain(trim($0)); next }
/^ +-[a-zA-Z-]/ && !/^                    / { options($0); next }
/^Exit codes: / { print ".SH EXIT STATUS"; print plain(substr($0, 13)); next }
/^  [a-z]+ +/ { print ".TP"; print ".B " plain($1); sub(/^ *[^ ]+ +/, ""); print plain($0); next }
/^                    / && match(trim($0), /^[a-z.,\- ]+  +/) { # what a value means
  s = trim($0); at = match(s, /  +/)
  print ".br"; print "\\fB" plain(substr(s, 1, at - 1)) "\\fR " plain(trim(substr(s, at))); next
}
/^  [A-Z]/ { print ".PP" }
{ print plain(trim($0)) }
END {
  close_block()
  print ".SH SEE ALSO\n.BR thread (1)"
}
