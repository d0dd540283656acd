# Completion of thread in fish: the program itself says what may follow.
function __thread_complete
    set -l words (commandline --tokenize --cut-at-cursor) (commandline --current-token --cut-at-cursor)
    thread complete $words[2..-1] 2>/dev/null
end
complete --command thread --condition 'test -z "$(__thread_complete)"' --force-files
complete --command thread --condition 'test -n "$(__thread_complete)"' --no-files --keep-order --arguments '(__thread_complete)'
