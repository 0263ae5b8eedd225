#!/bin/sh
# docs/runtime.md, docs/embedding.md and the library's man pages tell the truth: they quote the programs that make check runs, each function of the
# headers has a comment and a page, and the overview names all pages.
. "${srcdir:-.}/tests/support/tap.sh"

document=$srcdir/docs/runtime.md
embedding=$srcdir/docs/embedding.md
page=$srcdir/runtime/duite.3
pages=runtime/man
headers="$srcdir/runtime/duite.h $srcdir/runtime/duite_policy.h"

# Each block of C after a line <!-- FILE --> is a run of whole lines of this file; there is no other C.
quotes() {
    awk -v home="$srcdir/" '
        function read(file,    line, n) {
            if (file in lines) return lines[file]
            while ((getline line < (home file)) > 0) text[file, ++n] = line
            return lines[file] = n + 0
        }
        function found(    n, i, k) {
            n = read(file)
            for (i = 0; i + size <= n; i++) {
                for (k = 1; k <= size && text[file, i + k] == quoted[k]; k++) continue
                if (k > size) return 1
            }
            return 0
        }
        !inside && /^<!-- .* -->$/ { file = $2; next }
        !inside && /^```c(pp)?$/ { inside = 1; size = 0; begin = NR; next }
        inside && /^```$/ {
            inside = 0
            blocks++
            if (file == "" || !size || !found()) { print "line " begin ": not in " (file == "" ? "any file" : file); bad = 1 }
            file = ""
            next
        }
        inside { quoted[++size] = $0 }
        !inside && !/^$/ { file = "" }
        END { exit bad || inside || !blocks }' "$1"
}

# That quotes() sees one line too many, one changed, and one left out.
sees() {
    sed "$1" "$document" > "$scratch/changed.md" && ! cmp -s "$document" "$scratch/changed.md" && ! quotes "$scratch/changed.md"
}

examples() { # every program of tests/examples is quoted, and runs in make check
    for source in "$srcdir"/tests/examples/*.c; do
        name=$(basename "$source" .c)
        grep -qx "<!-- tests/examples/$name.c -->" "$document" "$embedding" || { echo "$name.c is not quoted" && return 1; }
        grep -q "^for example in .*\<$name\>" "$srcdir/tests/examples/test_examples.sh" || { echo "$name does not run" && return 1; }
    done
}

short() { # a reader sees it on two screens
    for source in "$srcdir"/tests/examples/*.c; do
        test "$(wc -l < "$source")" -le 150 || { echo "$source is too long" && return 1; }
    done
}

# The functions and macros with parameters that the headers declare; then all names of macros, codes and modes, too.
functions() {
    # shellcheck disable=SC2086 # a list of files
    sed -n '/^typedef/d; s/^[a-z].*[ *]\(duite_[a-z_0-9]*\)(.*/\1/p; s/^#define \([A-Za-z_]*\)(.*/\1/p' $headers | sort -u
}
names() {
    # shellcheck disable=SC2086
    { functions
      grep -oh '\<DUITE_[A-Z0-9_]*\>' $headers
    } | grep -v -x -e DUITE_H -e DUITE_POLICY_H | sort -u
}

mentions() { # FILE: every line of stdin occurs in it as a word
    tr -c 'A-Za-z0-9_' '\n' < "$1" | sort -u > "$scratch/words"
    sort -u > "$scratch/wanted"
    test -s "$scratch/wanted" && comm -23 "$scratch/wanted" "$scratch/words" > "$scratch/absent"
    cat "$scratch/absent"
    test ! -s "$scratch/absent"
}

pages_name_all() {
    cat "$page" $pages/*.3 > "$scratch/pages"
    names | mentions "$scratch/pages"
}

# The pages of a build are those that the script makes of the headers, which are those that module.mk lists.
pages_are_made() {
    mkdir -p "$scratch/man"
    # shellcheck disable=SC2086
    ${AWK:-awk} -v out="$scratch/man" -f "$srcdir/runtime/man.awk" $headers || return
    diff -r $pages "$scratch/man" || return
    grep -o 'runtime/man/[A-Za-z_]*\.3' "$srcdir/runtime/module.mk" | sed 's|.*/||' | sort > "$scratch/in_build"
    (cd "$scratch/man" && ls ./*.3) | sed 's|./||' | sort | diff "$scratch/in_build" -
}

# A page has its sections; of a function that returns something, what that is.
pages_are_whole() {
    functions > "$scratch/functions"
    test -s "$scratch/functions" || return
    while read -r name; do
        for title in NAME SYNOPSIS DESCRIPTION 'SEE ALSO'; do
            grep -qx ".SH $title" "$pages/$name.3" || { echo "$name has no $title" && return 1; }
        done
        grep -q '^\.B "\(void [^*]\|#define\)' "$pages/$name.3" || grep -qx '.SH RETURN VALUE' "$pages/$name.3" ||
            { echo "$name does not say what it returns" && return 1; }
    done < "$scratch/functions"
}

overview_lists() { # duite.3 names each page
    for file in $pages/*.3; do basename "$file" .3; done | mentions "$page"
}

speechless() { # a function whose comment says neither what it returns nor its errors makes no page
    mkdir -p "$scratch/speechless"
    sed 's/ Errors: DUITE_E_OBJECT\. / /' "$srcdir/runtime/duite.h" > "$scratch/speechless/duite.h"
    ! cmp -s "$srcdir/runtime/duite.h" "$scratch/speechless/duite.h" &&
        ! ${AWK:-awk} -v out="$scratch/speechless" -f "$srcdir/runtime/man.awk" "$scratch/speechless/duite.h" 2> "$scratch/said" &&
        cat "$scratch/said" && grep -q 'duite_graph_free' "$scratch/said"
}

page_invents_nothing() { # what it calls duite_... or DUITE_... is in the headers
    # shellcheck disable=SC2086
    cat $headers | tr -c 'A-Za-z0-9_' '\n' | sort -u > "$scratch/known" &&
        grep -o '\<\(duite\|DUITE\)_[A-Za-z0-9_]*\>' "$page" "$document" $pages/*.3 | sed 's/.*://' | sort -u > "$scratch/said" &&
        test -s "$scratch/said" && comm -23 "$scratch/said" "$scratch/known" > "$scratch/invented"
    cat "$scratch/invented"
    test ! -s "$scratch/invented"
}

# Every function stands in a paragraph (lines without a blank one between) that begins with a comment.
commented() {
    for header in $headers; do
        awk '
            /^$/ { comment = 0; fresh = 1; next }
            fresh && /^\/\*/ { comment = 1 }
            { fresh = 0 }
            /^(static inline )?[a-z].*[ *]duite_[a-z_0-9]*\(/ && !/^typedef/ && !comment { print FILENAME ":" FNR ": " $0; bad = 1 }
            END { exit bad }' "$header" || return 1
    done
}

listed() { # FILES: the fields of options and counters, the modes and policies are in them
    {
        sed -n '/^typedef struct duite_options/,/^}/p; /^typedef struct duite_counters/,/^}/p' "$srcdir/runtime/duite.h" |
            tr '\n' ' ' | sed 's|/\*|\n&|g; s|\*/|&\n|g' | grep -v '^/\*' | tr ';' '\n' | sed -n 's/.*[ *]\([a-z_]*\) *$/\1/p' | grep -v '^duite_'
        grep -oh '\.name = "[a-z]*"' "$srcdir"/runtime/sched/*.c "$srcdir"/runtime/map/*.c "$srcdir"/runtime/balance/*.c | cut -d'"' -f2
        grep -o '^ *DUITE_[RWC]*W*P*\>' "$srcdir/runtime/duite.h" | tr -d ' ' | grep -v '_$'
    } > "$scratch/to_list"
    cat "$@" > "$scratch/lists"
    mentions "$scratch/lists" < "$scratch/to_list"
}

formats() { # FILE...: without a word from the formatter
    for file in "$@"; do
        groff -man -Tutf8 -ww -z "$file" 2>&1 || echo "$file: groff failed"
    done > "$scratch/warnings"
    cat "$scratch/warnings"
    test ! -s "$scratch/warnings"
}

ill_formed() { # a fault of a page is seen
    sed 's/^\.SH NAME$/.XX NAME/' $pages/duite_fork.3 > "$scratch/ill.3"
    ! formats "$scratch/ill.3"
}

# argp sorts options by name: no text may lean on its place among the others.
stands_alone() { # PROGRAM
    "$1" --help > "$scratch/help" && test -s "$scratch/help" || return
    ! grep -nEi 'likewise|\<(next|previous|following) (one|two|three|option)|\<(above|below)\>|\<in them\>|of its tasks|that each writes' "$scratch/help"
}

git_sees_sources_only() { # nothing that make leaves in its folders is untracked
    git -C "$srcdir" status --porcelain -- tests bench runtime tools cloth > "$scratch/status" || return
    sed -n 's/^?? //p' "$scratch/status" | while read -r file; do
        case $(head -c 4 "$srcdir/$file" 2> /dev/null | tail -c 3) in ELF) echo "$file" ;; esac
    done > "$scratch/programs"
    cat "$scratch/programs"
    test ! -s "$scratch/programs"
}

# Each function that a guided tour of docs/design/ stops at is defined in the file that the tour names, and each file that the page names
# is there.
tours() { # DOCUMENT
    sed -n 's/^| `\([a-z_/]*\.c\)` | `\([a-z_`, ]*\)` |.*/\1 \2/p' "$1" | tr -d '`,' > "$scratch/stops"
    test "$(wc -l < "$scratch/stops")" -ge 40 || { echo "the tours have few stops" && return 1; }
    while read -r file names; do
        test -e "$srcdir/$file" || file=runtime/$file
        for name in $names; do
            grep -q "^[A-Za-z].*[ *]$name(\|^PHYS_KERNEL($name,\|^FLOW_KERNEL[A-Z_]*(${name%_body}," "$srcdir/$file" || { echo "$file has no $name" && return 1; }
        done
    done < "$scratch/stops"
    grep -o '`[a-z_/]*/[a-z_]*\.[ch]`' "$1" | tr -d '`' | sort -u > "$scratch/files"
    while read -r file; do
        test -e "$srcdir/$file" || test -e "$srcdir/runtime/$file" || { echo "there is no $file" && return 1; }
    done < "$scratch/files"
}

stages() { # the stages of a step stand in the document's table in their order
    sed -n 's/^    {"\([^"]*\)", [A-Z]*,.*/\1/p' "$srcdir/cloth/flow/run/step.c" | tr '\n' ',' > "$scratch/stages"
    sed -n '/^| part | stage | it |/,/^$/p' "$1" | awk -F '|' 'NR > 2 && NF { gsub(/^ +| +$/, "", $3); gsub(/, /, ",", $3); printf "%s,", $3 }' \
        > "$scratch/listed"
    echo "step.c: $(cat "$scratch/stages")"
    echo "document: $(cat "$scratch/listed")"
    test -s "$scratch/stages" && cmp -s "$scratch/stages" "$scratch/listed"
}

# Each link between pages leads to a file that is there, and to a heading of it.
links() { # PAGE...
    awk -v home="$srcdir/" '
        function slug(title) { title = tolower(title); gsub(/`|[.,:;()?!\/"]|\047/, "", title); gsub(/ /, "-", title); return title }
        function read(file,    line, code) {
            if (file in there) return there[file]
            while ((getline line < file) > 0) {
                there[file] = 1
                if (line ~ /^```/) code = !code
                if (!code && line ~ /^#+ /) { sub(/^#+ /, "", line); heading[file, slug(line)] = 1 }
            }
            close(file)
            return there[file] = there[file] + 0
        }
        /^```/ { code = !code }
        !code {
            page = substr(FILENAME, length(home) + 1)
            rest = $0
            while (match(rest, /\]\([^)]*\)/)) {
                link = substr(rest, RSTART + 2, RLENGTH - 3)
                rest = substr(rest, RSTART + RLENGTH)
                if (link ~ /^[a-z]+:/ || link ~ /\/$/) continue
                file = anchor = link
                sub(/#.*/, "", file)
                if (!sub(/^[^#]*#/, "", anchor)) anchor = ""
                folder = FILENAME
                sub(/[^\/]*$/, "", folder)
                file = file == "" ? FILENAME : folder file
                while (sub(/[^\/]+\/\.\.\//, "", file)) continue
                count++
                if (!read(file)) { print page ": " link " is not there"; bad = 1 }
                else if (anchor != "" && !((file, anchor) in heading)) { print page ": " link " has no such heading"; bad = 1 }
            }
        }
        END { print count " links"; exit bad || count < 100 }' "$@"
}
documents="$srcdir/README.md $srcdir/docs/*.md $srcdir/docs/design/*.md"
lost() { # a link to a heading that is renamed is seen
    mkdir -p "$scratch/docs" && cp "$srcdir"/docs/*.md "$scratch/docs" && sed -i 's/^## Integrators$/## Schemes/' "$scratch/docs/physics.md" || return
    ! links "$scratch"/docs/*.md > "$scratch/said" && grep -q 'physics.md#integrators has no such heading' "$scratch/said"
}

# The names that the headers promise are those that the library exports: a change of either is seen here. A static one is none.
exported() {
    {
        sed -n '/^static/d; /^typedef/d; s/^[a-z].*[ *]\(duite_[a-z_0-9]*\)(.*/\1/p' $headers
        sed -n 's/^extern const duite_law \(.*\);/\1/p' $headers | tr -d ' ' | tr ',' '\n'
    } | LC_ALL=C sort -u | diff "$srcdir/runtime/duite.sym" -
}
# Fortran binds each of them, but for what it does in another way: printf's form, lists of C's texts, and laws, which duite_law_find finds; and for
# requests of MPI as C has them.
bound() {
    grep -o "name='duite_[a-z_]*'" "$srcdir/runtime/duite.f90" | cut -d "'" -f 2 | LC_ALL=C sort -u > "$scratch/bound"
    grep -v -x -e duite_fail -e duite_await_mpi -e 'duite_[a-z]*_names' -e 'duite_\(sum\|product\|min\|max\|bits_[a-z]*\|all\|any\)' "$srcdir/runtime/duite.sym" |
        diff "$scratch/bound" - || { echo "< has no function, > no binding in runtime/duite.f90" && return 1; }
}

plan_later
# shellcheck disable=SC2086 # a list of files
ok "links between pages lead somewhere" links $documents
ok "a heading that is lost is seen" lost
ok "docs/runtime.md quotes the examples as they are" quotes "$document"
ok "docs/embedding.md, too" quotes "$embedding"
ok "a quotation that differs is seen" sees 's/ += x\[i\] \* y\[i\];/ += x[i] - y[i];/'
ok "a line left out is seen" sees '/DUITE_FORK(rt, &FACTOR, NULL/d'
ok "C that nobody compiles is seen" sees '0,/^<!-- .* -->$/d'
ok "every example is quoted, and runs" examples
ok "examples are short" short
ok "the man pages are those of the headers, and module.mk has them all" pages_are_made
ok "each function and macro has its page, with all sections" pages_are_whole
ok "a function whose comment says too little has none" speechless
ok "the overview lists all pages" overview_lists
ok "pages list options, counters, modes and policies" \
    listed $pages/duite_options.3 $pages/duite_counters.3 $pages/duite_mode.3 $pages/duite_scheduler_find.3
ok "pages name every function, macro, code and mode" pages_name_all
ok "no document names what is not there" page_invents_nothing
if command -v groff > /dev/null; then
    ok "man pages format without warnings" formats "$page" $pages/*.3
    ok "a fault of a page is seen" ill_formed
else
    skip "man pages format without warnings" "no groff"
    skip "a fault of a page is seen" "no groff"
fi
ok "every public function has a comment before it" commented
ok "the list of exported names is that of the headers" exported
ok "Fortran's module has a binding for each" bound
for part in runtime cloth; do
    ok "guided tours of the $part stop at functions that are there" tours "$srcdir/docs/design/$part.md"
done
ok "docs/design/cloth.md lists the stages of a step" stages "$srcdir/docs/design/cloth.md"
for program in duite-cloth duite-garment duite-mannequin duite-view duite-trace duite-predict duite-compare duite-graph bench/duite-bench; do
    if test -x $program; then
        ok "every option in --help of $program says what it is by itself" stands_alone ./$program
    else
        skip "--help of $program" "not built"
    fi
done
if git -C "$srcdir" rev-parse --is-inside-work-tree > /dev/null 2>&1; then
    ok "git shows no program that make built" git_sees_sources_only
else
    skip "git shows no program that make built" "no sources of git"
fi
