#!/bin/sh
# Predictions on platforms are SimGrid's: synthetic graphs, on hosts of two kinds whose links are shared. They part by up to three
# percent, since SimGrid gives what a flow leaves of a link to others, and tasks that are ready at one time begin in another order.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless ./duite-predict
skip_unless tests/tools/synthetic
command -v ${CXX:-c++} > /dev/null || skip_all "there is no C++ compiler (package g++)"
${PKG_CONFIG:-pkg-config} --exists simgrid || skip_all "there is no SimGrid (package libsimgrid-dev)"
plan_later

# shellcheck disable=SC2046
compiled() { ${CXX:-c++} -std=c++17 -O1 -o "$scratch/simgrid" "$srcdir/tests/tools/simgrid.cpp" $(${PKG_CONFIG:-pkg-config} --cflags --libs simgrid); }
ok "SimGrid is there" compiled

cat > "$scratch/alike" << 'END'
switch top
hosts 4 to top cores 2 latency 1e-5 bandwidth 1e9
END
cat > "$scratch/unlike" << 'END'
switch top
hosts 2 to top cores 4 speed 0.5 latency 1e-5 bandwidth 1e9
hosts 2 to top cores 1 speed 2 latency 1e-5 bandwidth 5e8
END
cat > "$scratch/racks" << 'END'
switch top capacity 1.5e9
switch left to top latency 1e-5 bandwidth 6e8
switch right to top latency 1e-5 bandwidth 6e8
hosts 2 to left cores 2 latency 1e-5 bandwidth 1e9
hosts 2 to right cores 2 speed 2 latency 1e-5 bandwidth 1e9
END

agrees() { # KIND PLATFORM PERCENT: the makespans are that near
    tests/tools/synthetic "$1" 4 "$scratch/trace" "$scratch/tasks" && limited "$scratch/simgrid" "$scratch/$2" "$scratch/tasks" > "$scratch/simulated" &&
        ./duite-predict "$scratch/trace" --platform "$scratch/$2" --mapping block --scheduler fifo --message 0 --look 0 --overhead 0 > "$scratch/predicted" || return 1
    { sed -n 's/^  makespan *\(.*\) s/\1/p' "$scratch/predicted"; cat "$scratch/simulated"; } |
        awk -v most="$3" '{ v[NR] = $1 } END { off = 100 * (v[1] / v[2] - 1); print "predicted", v[1], "SimGrid", v[2], off " %"; exit !(NR == 2 && off <= most && off >= -most) }'
}
for platform in alike unlike racks; do
    for kind in stencil shuffle; do
        ok "$kind on $platform" agrees $kind $platform 4
    done
done
