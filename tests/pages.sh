#!/bin/sh
# README.md and the pages of docs/ tell the truth: every command in their sh blocks runs as it is written, with the programs and scenes of an
# installed tree, in a folder of the page's own that also has the sources and the programs of the build. DUITE_PAGES="docs/cloth.md README.md"
# in the environment are the only ones.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -z "${SANITIZER:-}" || skip_all "the pages do not speak of a build with sanitizers"
. "$srcdir/tests/support/commands.sh"

# These run elsewhere: on two hosts, tests/cluster/test_document.sh and test_slurm.sh.
elsewhere="docs/cluster.md"

nothing_bare() { # a command in an indented block, which nobody would run
    ! grep -nE '^    (\./)?(duite-[a-z]+|bench/[a-z-]+|make|mpirun|cc|tests/[a-z/]+\.sh) ' "$srcdir"/README.md "$srcdir"/docs/*.md
}

readers_programs() { # FOLDER: those that docs/comparing.md compares, which are its reader's
    printf '#!/bin/sh\necho "Time: 0.1"\n' > "$1/openmp-program"
    printf '#!/bin/sh\nsleep 0.1\n' > "$1/mpi-program"
    # shellcheck disable=SC2046 # a list of flags
    (cd "$1" && cc -O2 dot.c -o duite-program $(pkg-config --cflags --libs duite) -lm) || return
    chmod +x "$1"/*-program
}

plan_later
ok "duite installs into the scratch folder" prepare
ok "no command hides from these tests" nothing_bare
for line in './bootstrap && make demo' './bootstrap && make check'; do # make check-long and .ci/run do what they say
    ok "README has $line" grep -qxF "$line" "$srcdir/README.md"
done
for page in "$srcdir/README.md" "$srcdir"/docs/*.md; do
    name=${page#"$srcdir/"}
    case " $elsewhere " in *" $name "*) continue ;; esac
    case " ${DUITE_PAGES:-$name} " in *" $name "*) ;; *) continue ;; esac
    home=$scratch/pages/${name%.md}
    home "$home" && cp "$srcdir/tests/examples/dot.c" "$home" && files "$page" "$home"
    test "$name" != docs/comparing.md || ok "$name: programs to compare" readers_programs "$home"
    run_commands "$page" "$name"
done
