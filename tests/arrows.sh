#!/bin/sh
# The include arrows of docs/design/: every #include of a header of ours, and of duite.h, is one that is allowed.
. "${srcdir:-.}/tests/support/tap.sh"

# arrows TREE: prints each include that is not allowed, fails if there is one.
arrows() {
    (cd "$1" && find runtime tools cloth -name '*.[ch]' -exec grep -HE '^[[:space:]]*#[[:space:]]*include' {} +) |
        awk -F: -v rules="$srcdir/tests/arrows.txt" '
        # The layer of a file or header: its two first folders, or what a program or a header for users is.
        function layer(path,    part, n) {
            n = split(path, part, "/")
            if (path ~ /^runtime\/(duite|duite_policy)\.h$/) return "users"
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
        }
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

# plant FILE HEADER: whether the check finds that include, alone in a tree.
plant() {
    rm -rf "$scratch/tree"
    mkdir -p "$scratch/tree/runtime" "$scratch/tree/tools" "$scratch/tree/cloth" "$scratch/tree/$(dirname "$1")"
    printf '#include %s\n' "$2" >> "$scratch/tree/$1"
    if arrows "$scratch/tree" > "$scratch/found"; then
        echo "not found: $1 including $2"
        return 1
    fi
    grep -F "$1: " "$scratch/found"
}

plan_later
ok "every include points downwards" arrows "$srcdir"
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
ok "finds a program's use of the runtime's inside" plant cloth/planted.c '"runtime/base/error.h"'
ok "finds an include relative to its folder" plant cloth/mesh/planted.c '"mesh.h"'
