#!/bin/sh
# docs/embedding.md lists all that the library does by itself: threads, what it prints, signals, communicators, files, variables. Each row of
# its table names the sources that do it, and each source that does is named.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
page=$srcdir/docs/embedding.md

# Code without comments, so that a sentence about a call is none: FILE:LINE.
code() {
    (cd "$srcdir/runtime" && find . -name '*.[ch]' ! -name 'duite*' -exec awk '
        FNR == 1 { inside = 0 }
        {
            line = $0
            while (1) {
                if (inside) {
                    if (!match(line, /\*\//)) { line = ""; break }
                    line = substr(line, RSTART + 2)
                    inside = 0
                }
                if (!match(line, /\/\*/)) break
                rest = substr(line, RSTART + 2)
                kept = substr(line, 1, RSTART - 1)
                if (match(rest, /\*\//)) line = kept substr(rest, RSTART + 2)
                else { line = kept; print FILENAME ":" line; inside = 1; line = "" ; break }
            }
            if (line != "") print FILENAME ":" line
        }' {} +) | sed 's|^\./||' > "$scratch/code"
    test "$(wc -l < "$scratch/code")" -gt 10000
}

# does ROW PATTERN [EXCEPT]: the sources with the pattern, but for the file that wraps it, are those of the rows that begin so.
does() {
    grep -E "^[a-z_/0-9.]*:.*$2" "$scratch/code" | cut -d : -f 1 | grep -vx "${3:--}" | sort -u > "$scratch/in_code"
    sed -n "s/^| $1[^|]*|\([^|]*\)|.*/\1/p" "$page" | grep -o '[a-z_]*/[a-z_]*\.c' | sort -u > "$scratch/in_page"
    test -s "$scratch/in_page" && diff "$scratch/in_page" "$scratch/in_code"
}
only() { # FILES PATTERN: no other source has it
    grep -E "^[a-z_/0-9.]*:.*$2" "$scratch/code" | grep -v "^\($1\):" > "$scratch/others"
    cat "$scratch/others"
    test ! -s "$scratch/others"
}
variables() {
    grep -o '\(getenv\|variable_take\)("[A-Z_]*"' "$scratch/code" | grep -o '"[A-Z_]*"' | tr -d '"' | sort -u > "$scratch/in_code"
    sed -n '/^| variable /,/^$/p' "$page" | cut -d '|' -f 2 | grep -o '`[A-Z_]*`' | tr -d '`' | sort -u > "$scratch/in_page"
    test -s "$scratch/in_page" && diff "$scratch/in_page" "$scratch/in_code"
}
planted() { # what is not listed is seen
    cp "$scratch/code" "$scratch/kept"
    echo 'task/run.c:    fprintf(stderr, "here");' >> "$scratch/code"
    ! does prints '(fprintf\(stderr|base_report\()' 'base/error\.[ch]' > "$scratch/said"
    seen=$?
    mv "$scratch/kept" "$scratch/code"
    return $seen
}

ok "the library's code" code
ok "threads are started where the page says" does starts 'base_thread_start\(' 'base/thread\.[ch]'
ok "and in one way" only 'base/thread\.c' '\<(pthread_create|thrd_create|fork|vfork|posix_spawn|system|popen)\('
ok "it prints where the page says" does prints '(fprintf\(stderr|base_report\()' 'base/error\.[ch]'
ok "and never otherwise" only 'base/error\.c\|base/policy\.c' '(\<(printf|puts|putchar|perror|psignal)\(|\<std(out|err)\>|STD(OUT|ERR)_FILENO)'
ok "what prints and is not listed is seen" planted
ok "it binds threads where the page says" does binds 'sched_setaffinity\('
ok "it handles signals where the page says" does handles '\<(sigaction|signal|sigaltstack)\('
ok "it begins and ends MPI where the page says" does begins '\<MPI_(Init_thread|Finalize)\('
ok "it makes communicators where the page says" does makes '\<MPI_(Comm_(dup|split|split_type|create)|Intercomm_[a-z]*)\b'
ok "it opens files where the page says" does opens '\<(f|dl)?open\(' 'base/error\.[ch]'
ok "it acts at the end of the process where the page says" does ends '\<(atexit|_exit|abort)\('
ok "it changes nothing else of the process" only none \
    '\<(setlocale|setenv|putenv|unsetenv|chdir|umask|srand|srandom|setrlimit|prctl|alarm|setitimer|exit|raise|kill)\('
ok "the variables that it reads are those of the page" variables
