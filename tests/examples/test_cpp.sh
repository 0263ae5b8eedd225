#!/bin/sh
# A C++17 program as a user writes it: it compiles against an installed duite with pkg-config's flags alone, without a warning, and
# runs; so does one that includes mpi.h and duite_policy.h before duite.h.
. "${srcdir:-.}/tests/support/tap.sh"
test -z "${SANITIZER:-}" || skip_all "the sanitizers are those of the C compiler"
# shellcheck disable=SC2086 # a compiler and its options
command -v ${CXX:-c++} > /dev/null || skip_all "there is no C++ compiler (package g++)"

prefix=$scratch/usr
PKG_CONFIG_PATH=$prefix/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
export PKG_CONFIG_PATH
unset MAKEFLAGS MFLAGS MAKELEVEL

compile() { # PROGRAM SOURCE
    # shellcheck disable=SC2046,SC2086 # lists of flags
    ${CXX:-c++} -std=c++17 -O1 -Wall -Wextra -Wpedantic -Wshadow -Werror -o "$scratch/$1" "$2" \
        $(${PKG_CONFIG:-pkg-config} --cflags --libs duite)
}
policies() {
    cat > "$scratch/policies.cpp" << 'END'
#include <mpi.h>
#include <duite_policy.h>
#include <duite.h>
#include <cstdio>
int main()
{
    const duite_scheduler *steal = duite_scheduler_find("steal");
    return steal ? std::puts(steal->summary) < 0 : 1;
}
END
    compile policies "$scratch/policies.cpp"
}
checking() { (DUITE_CHECK=accesses; export DUITE_CHECK; "$@"); }

plan_later
ok "make install" install_duite "$prefix"
ok "the C++ program compiles with pkg-config's flags" compile dot "$srcdir/tests/examples/dot.cpp"
ok "it runs" limited "$scratch/dot"
ok "it runs on 2 ranks" ranks 2 "$scratch/dot"
ok "it runs in checking mode" checking limited "$scratch/dot"
ok "duite_policy.h after mpi.h compiles" policies
ok "it runs, too" limited "$scratch/policies"
