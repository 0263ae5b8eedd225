#!/bin/sh
# The pages of docs/ tell the truth: every command in their sh blocks runs as it is written, with the programs and scenes of an installed
# tree, in a folder of the page's own that also has the sources. CLASS=every: those of "sh long" blocks, too.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -z "${SANITIZER:-}" || skip_all "the pages do not speak of a build with sanitizers"
. "$srcdir/tests/support/commands.sh"

# These run elsewhere: on two hosts, tests/cluster/test_document.sh and test_slurm.sh.
elsewhere="cluster.md"

nothing_bare() { # a command in an indented block, which nobody would run
    ! grep -nE '^    (\./)?(duite-[a-z]+|bench/[a-z-]+|make|mpirun|cc|tests/[a-z/]+\.sh) ' "$srcdir"/docs/*.md
}

plan_later
ok "duite installs into the scratch folder" prepare
ok "no command hides from these tests" nothing_bare
for page in "$srcdir"/docs/*.md; do
    name=$(basename "$page")
    case " $elsewhere " in *" $name "*) continue ;; esac
    home=$scratch/pages/${name%.md}
    home "$home" && cp "$srcdir/tests/examples/dot.c" "$home" && files "$page" "$home"
    run_commands "$page" "${CLASS:-}" "$name"
done
