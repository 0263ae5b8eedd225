#!/bin/sh
# run.sh SECONDS [NAME...]: `make fuzz`. Builds the harnesses (all, or those of these names) by clang with libFuzzer, AddressSanitizer and
# UndefinedBehaviorSanitizer from fuzz-source, in fuzz-build, and lets each look for so many seconds, one after the other. Its finds are
# kept in fuzz-build/found: a file that ends a reader by a crash, a leak, a limit of time (60 s) or of memory (256 MB in one piece, 2 GB in
# all). The inputs that reach new code are kept in fuzz-build/work/NAME, where the next run goes on. Exits 1 if anything was found.
#
# run.sh --merge NAME...: the smallest set of inputs, of the corpus and of fuzz-build/work, that reaches the same code, in
# fuzz-build/merged/NAME. It may take the place of tests/fuzz/corpus/NAME.
set -eu
top=$(pwd)
source=$top/fuzz-source build=$top/fuzz-build
seconds=$1
shift
MAKE=${MAKE:-make}
unset MAKEFLAGS MFLAGS MAKELEVEL
jobs=$(getconf _NPROCESSORS_ONLN)
test $# -gt 0 || set -- $(sed -n 's/^tests_fuzz_fuzz_\([a-z0-9]*\)_SOURCES.*/\1/p' "$source/tests/fuzz/module.mk")
programs=
for name; do programs="$programs tests/fuzz/fuzz_$name"; done

mkdir -p "$build/found" && cd "$build"
test -f Makefile || "$source/configure" --quiet CC="${FUZZ_CC:-clang}" CFLAGS='-gline-tables-only -O1' \
    --enable-sanitizer=fuzzer-no-link,address,undefined,float-cast-overflow
"$MAKE" -j"$jobs" --quiet LDFLAGS=-fsanitize=fuzzer $programs

# The words that readers compare with are literals of their sources.
words() { # FILE...
    cat "$@" | grep -v '#include' | grep -oh '"[A-Za-z0-9_.: -]\{1,32\}"' | sort -u
}
sources() { # NAME
    case $1 in
        obj) set -- cloth/mesh/obj.c cloth/mesh/detail/obj_*.c ;;
        pattern | seams) set -- cloth/scene/pattern/*.c cloth/scene/build/seams_file.c ;;
        output | live) set -- cloth/output/cache.c cloth/output/files/*.c cloth/contact/*.c ;;
        scene) set -- cloth/scene/schema/*.c cloth/scene/yaml/*.c cloth/mannequin/measures.c cloth/garment/own/*.c ;;
        *) set -- ;;
    esac
    test $# = 0 || words "$@"
    echo '"\x0a==NEXT==\x0a"'
}

limits='-timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=256 -print_final_stats=1 -verbosity=1 -reload=0'
options() { # NAME: a scene may well ask for a mesh of gigabytes, a checkpoint for room, and they get none here
    case $1 in
        scene | resume) ASAN_OPTIONS=max_allocation_size_mb=64:allocator_may_return_null=1 ;;
        *) ASAN_OPTIONS= ;;
    esac
    export ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=1" LSAN_OPTIONS="suppressions=$source/tests/support/lsan.supp"
    (cd "$source" && sources "$1") > "words-$1"
}

found=0
for name; do
    mkdir -p "work/$name" "merged/$name"
    options "$name"
    if test "$seconds" = --merge; then
        rm -rf "merged/$name" && mkdir "merged/$name"
        tests/fuzz/fuzz_"$name" -merge=1 $limits "merged/$name" "$source/tests/fuzz/corpus/$name" "work/$name"
        continue
    fi
    echo "== $name, $seconds s; all that is said is in fuzz-build/$name.log"
    nice tests/fuzz/fuzz_"$name" -max_total_time="$seconds" $limits -dict="words-$name" -artifact_prefix="found/$name-" \
        "work/$name" "$source/tests/fuzz/corpus/$name" > "$name.log" 2>&1 || found=1
    grep -E '^(Done|stat::|SUMMARY|artifact_prefix)|DONE  ' "$name.log" || tail -n 5 "$name.log"
done
exit $found
