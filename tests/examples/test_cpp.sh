#!/bin/sh
# C++17 programs as users write them, by duite.h and by duite.hpp: they compile against an installed duite with pkg-config's flags alone,
# without a warning, and run; wrong use of duite.hpp is refused by the compiler, with a sentence.
. "${srcdir:-.}/tests/support/tap.sh"
test -z "${SANITIZER:-}" || skip_all "the sanitizers are those of the C compiler"
# shellcheck disable=SC2086 # a compiler and its options
command -v ${CXX:-c++} > /dev/null || skip_all "there is no C++ compiler (package g++)"

prefix=$scratch/usr
PKG_CONFIG_PATH=$prefix/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
export PKG_CONFIG_PATH
unset MAKEFLAGS MFLAGS MAKELEVEL

compile() { # PROGRAM SOURCE OPTION...
    compile_program=$scratch/$1 compile_source=$2
    shift 2
    # shellcheck disable=SC2046,SC2086 # lists of flags
    ${CXX:-c++} -std=c++17 -O1 -Wall -Wextra -Wpedantic -Wshadow -Werror "$@" -o "$compile_program" "$compile_source" \
        $(${PKG_CONFIG:-pkg-config} --cflags --libs duite) -pthread
}
# parsed CODE: a main program with this line
parsed() {
    cat > "$scratch/parsed.cpp" << END
#include <duite.hpp>
#include <string>
const duite::kernel SET("set", [](double to, duite::write<double> x) { x[0] = to; });
int main()
{
    duite::runtime rt(SET);
    duite::object<double> x(rt, 1);
    $1
}
END
    compile parsed "$scratch/parsed.cpp" -fsyntax-only
}
# refused SENTENCE CODE: the compiler refuses it with the sentence
refused() {
    ! parsed "$2" > "$scratch/said" 2>&1 || { echo "compiles: $2" && return 1; }
    cat "$scratch/said"
    grep -qF "$1" "$scratch/said"
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
# An exception that a body throws and main would catch.
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
ok "an example by duite.hpp compiles" compile stencil "$srcdir/tests/examples/stencil.cpp"
ok "it runs" limited "$scratch/stencil"
ok "it runs on 3 ranks" ranks 3 "$scratch/stencil"
ok "it runs in checking mode" checking limited "$scratch/stencil"
ok "all of duite.hpp compiles" compile front "$srcdir/tests/runtime/front.cpp"
ok "it does what it says" limited "$scratch/front"
ok "on 2 ranks, too" ranks 2 "$scratch/front"
ok "it compiles without exceptions" compile front "$srcdir/tests/runtime/front.cpp" -fno-exceptions -DDUITE_NO_EXCEPTIONS
ok "it does what it says without exceptions" limited "$scratch/front"
ok "it compiles as C++20" compile front "$srcdir/tests/runtime/front.cpp" -std=c++20
ok "a right line is taken" parsed 'rt.fork(SET, 1.0, x);'
ok "a kernel that captures is refused" refused "a kernel captures nothing" \
    'double by = 2; const duite::kernel scale("scale", [by](duite::readwrite<double> y) { y[0] *= by; });'
ok "arguments with pointers in them are refused" refused "arguments are copied as bytes" \
    'const duite::kernel name("name", [](const std::string &, duite::write<double>) {});'
ok "a parameter without a type is refused" refused "names the types of its parameters" \
    'const duite::kernel any("any", [](auto) {});'
ok "arguments behind objects are refused" refused "then objects" 'const duite::kernel late("late", [](duite::write<double>, int) {});'
ok "an object of other elements is refused" refused "has elements of the type of the kernel's parameter" \
    'duite::object<float> y(rt, 1); rt.fork(SET, 1.0, y);'
ok "a fork with too few objects is refused" refused "an object for each parameter" 'rt.fork(SET, 1.0);'
