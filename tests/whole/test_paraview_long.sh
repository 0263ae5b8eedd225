#!/bin/sh
# Frames of a run on two ranks, read back by ParaView's own readers (pvpython of python3-paraview): positions and velocities are the
# state's bits, by the index cloth.xmf and from each .vtkhdf file alone.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
command -v pvpython > /dev/null || skip_all "no pvpython (paraview, python3-paraview)"
grep -q '^#define HAVE_HDF5 1' config.h || skip_all "built without HDF5"
plan_later
. "$srcdir/tests/whole/read_back.sh"

reads() { PYTHONDONTWRITEBYTECODE=1 limited pvpython "$srcdir/tests/whole/read_paraview.py" two 2>&1; }
sees() { # that a coordinate which differs in its last bit is seen
    cp two/probes.csv kept && sed 's/0\.5,/0.50000000000000011,/' kept > two/probes.csv && ! cmp -s kept two/probes.csv && ! reads
}
ok "a run on two ranks writes frames in double precision" run_two --set 'output.hdf5={fields: [velocity, rank], precision: double}'
ok "ParaView reads the state" reads
ok "the comparison sees one bit" sees
