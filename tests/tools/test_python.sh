#!/bin/sh
# tools/duite.py reads what programs leave, as the programs meant it, and refuses what is broken with a sentence.
. "${srcdir:-.}/tests/support/tap.sh"
python=
for each in python3 /usr/bin/python3; do # a python3 of its own kind may hide that of the system
    test -n "$python" || ! $each -c "import numpy" > "$scratch/output" 2>&1 || python=$each
done
test -n "$python" || skip_all "python3 is missing, or has no numpy (packages python3, python3-numpy)"
skip_unless ./duite-trace
plan_later
PYTHONPATH=$srcdir/tools${PYTHONPATH:+:$PYTHONPATH} PYTHONDONTWRITEBYTECODE=1
PATH=$PWD:$PATH
export PYTHONPATH PYTHONDONTWRITEBYTECODE PATH

python() { (cd "$scratch" && limited $python -c "import duite, numpy; $1"); }
traced() { (DUITE_TRACE=$scratch/dot.trace; export DUITE_TRACE; ranks 2 tests/examples/dot); }
says() { # SENTENCE CODE: code that raises a ValueError with it
    python "
try:
    $2
except ValueError as error:
    assert '$1' in str(error), error
else:
    raise AssertionError('read')"
}

ok "a traced program on 2 ranks" traced
ok "its events" python '
tables = duite.trace("dot.trace")
states = tables["worker_state"]
tasks = states["Kind"] == "task"
assert all(len({len(column) for column in table.values()}) == 1 for table in tables.values())
assert {worker.split("_")[0] for worker in states["ResourceId"]} == {"0", "1"} and set(states["Value"][tasks]) == {"fill", "dot"}
assert sum(states["Name"] == "dot") == 13 and sum(states["Name"] == "fill") == 26, states["Name"]
assert states["Start"].dtype == float and (states["Duration"] >= 0).all() and states["Number"].dtype.kind == "i"
assert numpy.isnan(states["SubmitOrder"][~tasks]).all() and (states["SubmitOrder"][tasks] > 0).all()
assert len(tables["link"]["Size"]) == sum(tables["events"]["Type"] == "send")'
printf 'not a trace' > "$scratch/broken.trace"
ok "a broken trace has duite-trace's sentence" says broken.trace 'duite.trace("broken.trace")'
printf 'name,n,x,hash\n"a, b",1,,9a5d\nc,2,0.5,12\n' > "$scratch/table.csv"
ok "a table" python '
t = duite.table("table.csv")
assert list(t) == ["name", "n", "x", "hash"] and list(t["name"]) == ["a, b", "c"] and list(t["n"]) == [1, 2]
assert numpy.isnan(t["x"][0]) and t["x"][1] == 0.5 and list(t["hash"]) == ["9a5d", "12"]'
printf 'a,b\n1\n' > "$scratch/short.csv"
ok "a table with a short line is refused" says "not as many columns" 'duite.table("short.csv")'

if test -x "$DUITE_CLOTH"; then
    sheet() {
        limited "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid={width: 1, height: 1, nx: 9, ny: 9}' --grain 100 \
            --end 0.2 --quiet --output "$scratch/frames" --report "$scratch/report.json" "$@"
    }
    ok "a run with frames" sheet
    ok "its report and frames agree" python '
report, x = duite.report("report.json"), duite.frames("frames/cloth.pc2")
assert x.shape == (6, report["vertices"], 3) and x.dtype == numpy.float32, x.shape
assert report["rest_seconds"] is None and x[-1, :, 2].min() < x[0, :, 2].min()'
    head -c 500 "$scratch/frames/cloth.pc2" > "$scratch/short.pc2"
    ok "frames that end early are refused" says "ends early" 'duite.frames("short.pc2")'
    ok "what is no cache is refused" says "not a PC2 cache" 'duite.frames("report.json")'
    if grep -q '^#define HAVE_HDF5 1' config.h && $python -c "import h5py" > "$scratch/output" 2>&1; then
        ok "a run with scientific frames" sheet --set 'output={hdf5: {fields: [velocity, strain]}}'
        ok "they have the same positions" python '
found, x = duite.fields("frames/hdf5/frame-000005.vtkhdf"), duite.frames("frames/cloth.pc2")
assert (found["Points"].astype("f4") == x[5]).all() and found["velocity"].shape == x[5].shape
assert len(found["strain"]) == len(found["Offsets"]) - 1'
    else
        skip "scientific frames" "no HDF5, or python3 has no h5py (package python3-h5py)"
    fi
else
    skip "reports and frames" "duite-cloth is not built"
fi
