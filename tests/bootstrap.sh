#!/bin/sh
# ./bootstrap on machines where this or that is missing, without root or with an apt-get that fails: only what duite cannot be built without
# stops it. The machine is made of programs that say what they were told to.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

machine=$scratch/machine
tree=$scratch/tree
mkdir -p "$machine" "$tree/build-aux" "$tree/m4" "$tree/runtime" "$tree/cloth" "$tree/tests" "$tree/bench"
cp "$srcdir/bootstrap" "$tree"
touch "$tree/configure.ac" "$tree/Makefile.am" "$tree/m4/duite_none.m4" "$tree/build-aux/tap-driver.sh"
program() { cat > "$1" && chmod +x "$1"; }

# The files $scratch/missing and $scratch/broken name the packages that are not there and those that cannot be installed.
program "$machine/dpkg-query" << END
#!/bin/sh
for package; do :; done
if grep -qx -e "\$package" '$scratch/missing'; then exit 1; else echo installed; fi
END
program "$machine/apt-get" << END
#!/bin/sh
echo "\$*" >> '$scratch/asked'
case \$* in
    update*) test ! -e '$scratch/offline' ;;
    *--assume-no*) ;;
    *) for package; do ! grep -qx -e "\$package" '$scratch/broken' || exit 100; done ;;
esac
END
printf '#!/bin/sh\nexit 1\n' | program "$machine/apt-cache"
printf '#!/bin/sh\nexit 1\n' | program "$machine/sudo"
program "$machine/id" << END
#!/bin/sh
cat '$scratch/user'
END
touch "$tree/Makefile.in"
printf '#!/bin/sh\necho configured "$@"\n' | program "$tree/configure"

# told STATUS USER MISSING BROKEN OPTION...: runs ./bootstrap there; what it says is in $scratch/said.
told() {
    want=$1
    echo "$2" > "$scratch/user"
    printf '%s\n' $3 > "$scratch/missing"
    printf '%s\n' $4 > "$scratch/broken"
    shift 4
    rm -f "$scratch/asked"
    PATH=$machine:$PATH limited "$tree/bootstrap" "$@" > "$scratch/said" 2>&1 && status=0 || status=$?
    cat "$scratch/said"
    test $status = "$want" || echo "(exit status $status)"
    test $status = "$want"
}
configured() { grep -q '^configured' "$scratch/said"; }
says() { grep -q -e "$1" "$scratch/said"; }

optional() { # PACKAGE: without root it is named, and not waited for
    told 0 1000 "$1" "" && configured && says "apt-get install --no-install-recommends $1 *\$" && test ! -e "$scratch/asked"
}
needed() { told 1 1000 "$1" "" && ! configured && says "$1" && says "DUITE_NO_INSTALL=1"; }
nothing_asked() { DUITE_NO_INSTALL=1 told 0 0 "gcc check" "" && configured && test ! -e "$scratch/asked"; }
others_installed() { # one of the optional ones cannot be had: the others are, and it is named
    told 0 0 "libyaml-dev check libzmq3-dev libgmp-dev" libzmq3-dev && configured && says "could not install: libzmq3-dev *\$" &&
        grep -v assume-no "$scratch/asked" | grep -c libgmp-dev
}
core_not_to_be_had() { told 1 0 "libyaml-dev check" libyaml-dev && ! configured && says "could not install.*libyaml-dev"; }
offline() {
    : > "$scratch/offline"
    told 0 0 "check" "check" && configured && says "could not install: check *\$" && told 1 0 "gcc" "gcc"
    status=$?
    rm "$scratch/offline"
    return $status
}
other_mpi() { # MPICH will do, and with both missing Open MPI is installed
    told 0 0 "libopenmpi-dev openmpi-bin" "" && ! grep -q openmpi "$scratch/asked" 2> /dev/null &&
        told 0 0 "libopenmpi-dev openmpi-bin libmpich-dev mpich" "" && grep -q "libopenmpi-dev openmpi-bin" "$scratch/asked"
}
told_of() { "$tree/bootstrap" --help | grep DUITE_NO_INSTALL=1 && grep DUITE_NO_INSTALL=1 "$srcdir/docs/install.md"; }
notice() { # NOTICE has the licence of each package but those of the build
    eval "$(grep '^[a-z]*="' "$srcdir/bootstrap")"
    # shellcheck disable=SC2154 # its lists
    for package in $mpi $other_mpi $core $cloth $charts $tests $pictures $live $rivals $frames $traces $languages; do
        grep -Eq "^    ([a-z0-9+, -]+, )?$(echo "$package" | sed 's/+/[+]/g')(, [a-z0-9+, -]+)?  +[^ ]" "$srcdir/NOTICE" ||
            { echo "$package is missing" && return 1; }
    done
}

ok "without root and an optional package of the tests" optional check
ok "without root and an optional package of pictures" optional libglfw3-dev
ok "without root and the live view's package" optional libzmq3-dev
ok "without root and a compiler" needed gcc
ok "without root and a package of the core" needed libmetis-dev
ok "DUITE_NO_INSTALL=1" nothing_asked
ok "an optional package cannot be installed" others_installed
ok "a package of the core cannot be installed" core_not_to_be_had
ok "no network" offline
ok "--full without root" eval 'told 0 1000 hdf5-tools "" --full && configured'
ok "another MPI is there" other_mpi
ok "DUITE_NO_INSTALL=1 is documented" told_of
ok "NOTICE has each package" notice
