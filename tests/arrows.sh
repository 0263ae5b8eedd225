#!/bin/sh
# The arrows of docs/design/, by includes and by symbols: every #include of a header of ours, and of duite.h, and every name that
# an object uses of another one, is allowed.
. "${srcdir:-.}/tests/support/tap.sh"

# The rules, and the layer of a file, header or object: its two first folders (in cloth/app three), a program, or a header for
# users.
rules='
    function layer(path,    part, n) {
        n = split(path, part, "/")
        if (path ~ /^runtime\/(duite|duite_policy)\.h$/) return "users"
        if (path ~ /^cloth\/app\//) return n > 3 ? part[1] "/" part[2] "/" part[3] : "cloth/programs"
        if (n > 2) return part[1] "/" part[2]
        return part[1] "/programs"
    }
    BEGIN {
        while ((getline line < rules) > 0) {
            if (line ~ /^(#|[[:space:]]*$)/) continue
            n = split(line, word, /[[:space:]]+/)
            known[word[1]] = 1
            for (i = 3; i <= n; i++) allowed[word[1] " " word[i]] = 1
        }
    }'

# includes TREE: prints each include that is not allowed, fails if there is one.
includes() {
    (cd "$1" && find runtime tools cloth -name '*.[ch]' -exec grep -HE '^[[:space:]]*#[[:space:]]*include' {} +) |
        awk -F: -v rules="$srcdir/tests/arrows.txt" "$rules"'
        {
            file = $1
            from = layer(file)
            header = substr($0, length(file) + 2)
            if (header !~ /["<]/) next
            sub(/^[^"<]*["<]/, "", header)
            sub(/[">].*/, "", header)
            if (header ~ /^duite(_policy)?\.h$/) header = "runtime/" header
            if (header !~ /^(runtime|tools|cloth)\//) {
                if (index($0, "\"") == 0 || header == "config.h") next
                print file ": \"" header "\" is not written from the top of the tree"
                bad = 1
                next
            }
            to = layer(header)
            if (!(from in known)) {
                print file ": " from " has no line in tests/arrows.txt"
                bad = 1
            } else if (from != to && !((from " " to) in allowed) && !((from " " header) in allowed)) {
                print file ": may not include " header
                bad = 1
            }
        }
        END { exit bad }'
}

# objects: those that have a source. Others are left over from files that were moved.
objects() {
    find runtime tools cloth -name '*.o' | while read -r object; do
        folder=${object%/*} name=${object##*/}
        name=${name%.o}
        while [ ! -f "$srcdir/${folder%/.libs}/$name.c" ] && [ "${name#*-}" != "$name" ]; do
            name=${name#*-} # automake writes PROGRAM-FILE.o where a program has flags of its own
        done
        [ ! -f "$srcdir/${folder%/.libs}/$name.c" ] || echo "$object"
    done
}

# symbols [OBJECT]: prints each call, by an object, of a function or datum of a folder that is not allowed; fails if there is one.
# OBJECT is one more, of runtime/base. Names of duite.h are for users; inside the runtime they belong to their folders. A rule that
# allows one header allows the names in it.
symbols() {
    test -s "$scratch/names" || nm -A -P -g $(objects) > "$scratch/names" || return 1
    : > "$scratch/more"
    test $# = 0 || nm -A -P -g "$1" > "$scratch/more" || return 1
    awk -v rules="$srcdir/tests/arrows.txt" -v top="$srcdir" -v planted="${1:-}" "$rules"'
        function names(header, symbol,    line) {
            if (!(header in text)) {
                text[header] = " "
                while ((getline line < (top "/" header)) > 0) {
                    gsub(/[^A-Za-z0-9_]+/, " ", line)
                    text[header] = text[header] line " "
                }
            }
            return index(text[header], " " symbol " ")
        }
        function may(from, to, symbol,    rule, word) {
            if (from == to || ((from " " to) in allowed)) return 1
            if (symbol ~ /^duite_/ && from !~ /^runtime\// && ((from " users") in allowed)) return 1
            for (rule in allowed) {
                split(rule, word, " ")
                if (word[1] == from && word[2] ~ /\.h$/ && layer(word[2]) == to && names(word[2], symbol)) return 1
            }
            return 0
        }
        {
            object = substr($1, 1, length($1) - 1)
            if (object == planted) object = "runtime/base/planted.o"
            sub(/^\.\//, "", object)
            if ($3 == "U") uses[object " " $2] = 1
            else if ($3 ~ /^[TDBRVWC]$/) homes[$2] = homes[$2] " " layer(object)
        }
        END {
            for (use in uses) {
                split(use, part, " ")
                from = layer(part[1])
                n = split(homes[part[2]], to, " ")
                fine = !n
                for (i = 1; i <= n && !fine; i++) fine = may(from, to[i], part[2])
                if (fine) continue
                print part[1] ": may not use " part[2] " of" homes[part[2]]
                bad = 1
            }
            exit bad
        }' "$scratch/names" "$scratch/more"
}

# plant FILE HEADER: whether the check finds that include, alone in a tree.
plant() {
    rm -rf "$scratch/tree"
    mkdir -p "$scratch/tree/runtime" "$scratch/tree/tools" "$scratch/tree/cloth" "$scratch/tree/$(dirname "$1")"
    printf '#include %s\n' "$2" >> "$scratch/tree/$1"
    if includes "$scratch/tree" > "$scratch/found"; then
        echo "not found: $1 including $2"
        return 1
    fi
    grep -F "$1: " "$scratch/found"
}

# plant_call FUNCTION: whether the check finds a call of it by runtime/base, which declares it by hand.
plant_call() {
    printf 'void %s(void);\nvoid planted(void);\nvoid planted(void) { %s(); }\n' "$1" "$1" > "$scratch/planted.c"
    $CC -c -o "$scratch/planted.o" "$scratch/planted.c" || return 1
    if symbols "$scratch/planted.o" > "$scratch/found"; then
        echo "not found: a call of $1"
        return 1
    fi
    grep -F "runtime/base/planted.o: may not use $1 of" "$scratch/found"
}

plan_later
ok "every include points downwards" includes "$srcdir"
ok "finds runtime including cloth" plant runtime/base/planted.c '"cloth/base/error.h"'
ok "finds an upward include in the runtime" plant runtime/base/planted.h '"runtime/task/task.h"'
ok "finds a folder beside it" plant runtime/sched/planted.c '"runtime/map/planted.h"'
ok "finds a header for users that includes ours" plant runtime/duite.h '"runtime/base/error.h"'
ok "finds the runtime including its tools" plant runtime/trace/planted.c '"tools/trace/read.h"'
ok "finds the predictor including the chart" plant tools/predict/planted.c '"tools/chart/chart.h"'
ok "finds duite.h below flow" plant cloth/solve/planted.c '<duite.h>'
ok "finds duite.h below flow, quoted" plant cloth/mesh/planted.c '"runtime/duite.h"'
ok "finds physics including mesh" plant cloth/physics/planted.c '"cloth/mesh/mesh.h"'
ok "finds an upward include in the cloth" plant cloth/flow/planted.c '"cloth/scene/scene.h"'
ok "finds a program's use of the runtime's inside" plant cloth/app/planted.c '"runtime/base/error.h"'
ok "finds an include relative to its folder" plant cloth/mesh/planted.c '"mesh.h"'
ok "every call points downwards" symbols
ok "finds an upward call that no header declares" plant_call task_ready
ok "finds the library's use of its own interface" plant_call duite_fork
