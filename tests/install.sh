#!/bin/sh
# A user's way to the library: make install, pkg-config duite, a program of a few lines, and no symbols but ours. tests/installed.sh
# builds the first program.
. "${srcdir:-.}/tests/support/tap.sh"

prefix=$scratch/usr
PKG_CONFIG_PATH=$prefix/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
export PKG_CONFIG_PATH

install_staged() { # for packagers: nothing outside DESTDIR
    ${MAKE:-make} install prefix=/opt/duite exec_prefix=/opt/duite DESTDIR="$scratch/stage" &&
        test -f "$scratch/stage/opt/duite/include/duite.h" && test ! -e /opt/duite/include/duite.h
}

pc() { ${PKG_CONFIG:-pkg-config} "$@" duite; }

compile() {
    cat > "$scratch/three.c" << 'EOF'
#include <duite.h>
#include <stdio.h>
int main(void) { return puts(duite_code_text(DUITE_OK)) < 0 || duite_scheduler_find("no such") != NULL; }
EOF
    # shellcheck disable=SC2046,SC2086 # lists of flags
    ${CC:-cc} ${CFLAGS:-} -o "$scratch/three" "$scratch/three.c" $(pc --cflags --libs)
}

exports() { # the names of the list, which tests/documents.sh compares with the headers
    nm -D --defined-only "$prefix/lib/libduite.so" | awk '{ print $3 }' | LC_ALL=C sort | diff "$srcdir/runtime/duite.sym" -
}

one_version() {
    version=$(pc --modversion | awk -F. '{ print 10000 * $1 + 100 * $2 + $3 }')
    grep -qx "#define DUITE_VERSION $version" "$prefix/include/duite.h" &&
        grep -F "version(\"$(pc --modversion)\")" "$srcdir/contrib/spack/packages/duite/package.py"
}

pages() {
    sed -n '/^typedef/d; s/^[a-z].*[ *]\(duite_[a-z_0-9]*\)(.*/\1/p' "$prefix/include/duite.h" "$prefix/include/duite_policy.h" > "$scratch/called"
    test -s "$scratch/called" && while read -r name; do
        grep -q "$name" "$prefix/share/man/man3/$name.3" || return
    done < "$scratch/called"
}

# Names that libduite.so hides would be anybody's in a static library.
no_static_library() {
    test -z "$(find "$prefix" -name '*.a')" || return
    mkdir -p "$scratch/configured"
    if (cd "$scratch/configured" && "$srcdir/configure" --enable-static) > "$scratch/said" 2>&1; then return 1; fi
    cat "$scratch/said"
    grep -q 'libduite is a shared library only' "$scratch/said"
}

uninstalled() {
    # shellcheck disable=SC2046 # a list of settings
    ${MAKE:-make} uninstall $(locations "$prefix") && test -z "$(find "$prefix" ! -type d)"
}

unset MAKEFLAGS MFLAGS MAKELEVEL
plan_later
ok "make install" install_duite "$prefix"
ok "pkg-config knows duite and where mpi.h is" pc --exists
ok "a program compiles with pkg-config's flags" compile
ok "and runs, though no other path leads to the library" limited "$scratch/three"
ok "the first program is built by pkg-config and by CMake" env duite_DIR="$prefix/lib/cmake/duite" sh "$srcdir/tests/installed.sh"
ok "the man page is there" test -s "$prefix/share/man/man3/duite.3"
ok "each function has one" pages
ok "libduite.so exports the names of runtime/duite.sym" exports
ok "duite.h and the recipe for Spack are of the version that pkg-config tells" one_version
ok "there is no static library, and configure says why" no_static_library
ok "make install DESTDIR" install_staged
ok "make uninstall leaves no file" uninstalled
