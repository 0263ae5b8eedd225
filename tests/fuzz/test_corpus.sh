#!/bin/sh
# Each reader takes all files of its corpus, which fuzzing found, without a crash or a hang. Under AddressSanitizer none may ask for much
# memory in one piece; a scene may, since it may have a large mesh, and so may a checkpoint of many contacts, and they get none.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

options=${ASAN_OPTIONS:-}:detect_leaks=1 # no reader begins MPI
for folder in "$srcdir"/tests/fuzz/corpus/*; do
    name=${folder##*/}
    case $name in
        scene | resume) ASAN_OPTIONS=$options:max_allocation_size_mb=64:allocator_may_return_null=1 ;;
        *) ASAN_OPTIONS=$options:max_allocation_size_mb=256 ;;
    esac
    export ASAN_OPTIONS
    ok "$name" limited tests/fuzz/fuzz_"$name" "$folder"
done
