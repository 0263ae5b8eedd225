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
# What a body throws and main would catch.
throwing() {
    cat > "$scratch/throwing.cpp" << 'END'
#include <duite.h>
#include <stdexcept>
static int body(const duite_call *)
{
    throw std::runtime_error("not a code");
}
int main()
{
    static duite_kernel kernel = {};
    kernel.name = "throws";
    kernel.body = body;
    const duite_kernel *kernels[] = {&kernel, nullptr};
    duite_options options = duite_options_default();
    options.kernels = kernels;
    options.threads = 1;
    duite *rt;
    try {
        if (duite_start(&rt, &options) || duite_fork(rt, &kernel, nullptr, 0, nullptr))
            return 3;
        duite_wait(rt);
    } catch (const std::exception &) {
    }
    return duite_stop(&rt);
}
END
    compile throwing "$scratch/throwing.cpp"
}
told() { # SENTENCE COMMAND...
    sentence=$1
    shift
    "$@" > "$scratch/said" 2>&1
    cat "$scratch/said"
    grep -q "$sentence" "$scratch/said"
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
ok "a program whose body throws compiles" throwing
ok "it is told so, and does not hang" told "^duite: the body of kernel throws was left by a C++ exception" limited "$scratch/throwing"
