#!/bin/sh
# An installed duite: the first program of the tutorial is built by pkg-config and by CMake, others in C++ and Fortran where there are
# compilers for them, and each runs on one rank and on two. make installcheck calls it for what make install left, tests/install.sh and
# tests/bare_long.sh for theirs; PKG_CONFIG_PATH and duite_DIR lead there.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
cd "$scratch" || exit 99

by_pkg_config() {
    # shellcheck disable=SC2046,SC2086 # lists of flags
    ${CC:-cc} ${CFLAGS:-} -o by_pkg_config "$srcdir/tests/examples/dot.c" $(${PKG_CONFIG:-pkg-config} --cflags --libs duite)
}

# shellcheck disable=SC2046,SC2086 # lists of flags
by_cpp() { ${CXX:-c++} -std=c++17 -o by_cpp "$srcdir/tests/examples/stencil.cpp" $(${PKG_CONFIG:-pkg-config} --cflags --libs duite); }
# shellcheck disable=SC2046,SC2086
by_fortran() {
    ${FC:-gfortran} -c "$(${PKG_CONFIG:-pkg-config} --variable=fortran duite)" &&
        ${FC:-gfortran} -o by_fortran "$srcdir/tests/examples/dot.f90" duite.o $(${PKG_CONFIG:-pkg-config} --libs duite)
}
# Compilers other than CC have not the sanitizers of this build.
there() { test -z "${SANITIZER:-}" && command -v "${1%% *}" > "$scratch/output"; }

cmake_finds() { # VERSION
    mkdir -p tree && cat > tree/CMakeLists.txt << END && cmake -S tree -B "built-$1"
cmake_minimum_required(VERSION 3.13)
project(first C $(! there "${CXX:-c++}" || echo CXX))
find_package(duite $1 REQUIRED)
add_executable(by_cmake "$srcdir/tests/examples/dot.c")
target_link_libraries(by_cmake PRIVATE duite::duite)
if(CMAKE_CXX_COMPILER)
    add_executable(by_cmake_cpp "$srcdir/tests/examples/stencil.cpp")
    target_link_libraries(by_cmake_cpp PRIVATE duite::duite)
    target_compile_features(by_cmake_cpp PRIVATE cxx_std_17)
endif()
END
}
by_cmake() { cmake_finds 1 && cmake --build built-1 && mv built-1/by_cmake* .; }

ok "pkg-config builds it" by_pkg_config
if command -v cmake > "$scratch/output"; then
    ok "CMake builds it" by_cmake
    exits 1 "CMake finds no version 2" cmake_finds 2
else
    skip "CMake builds it" "no cmake"
fi
if there "${CXX:-c++}"; then ok "a program in C++" by_cpp; else skip "a program in C++" "no C++ compiler, or sanitizers"; fi
if there "${FC:-gfortran}"; then ok "a program in Fortran" by_fortran; else skip "a program in Fortran" "no Fortran compiler, or sanitizers"; fi
for program in by_*; do
    ok "$program on one rank" limited "./$program"
    if command -v "${MPIRUN:-mpirun}" > "$scratch/output"; then
        ok "$program on two" ranks 2 "./$program"
    else
        skip "$program on two" "no mpirun"
    fi
done
