"""Files that duite's programs leave, as numpy arrays.

    import duite
    report = duite.report('report.json')            # DUITE_REPORT=report.json, duite-cloth --report
    runs = duite.table('comparison/summary.csv')    # duite-compare, probes: a dict of columns
    tables = duite.trace('run.trace')               # a dict of such dicts; duite-trace reads the files of all ranks
    x = duite.frames('frames/cloth.pc2')            # x[frame, vertex] is a position
    fields = duite.fields('frames/hdf5/frame-000000.vtkhdf')

A file that is wrong is a ValueError with a sentence. Nothing here runs tasks: duite.h, duite.hpp and duite.f90 are for that.
"""

import csv
import json
import os
import subprocess
import tempfile

import numpy

_PC2_HEADER = 32  # bytes: "POINTCACHE2\0", version, points, start, rate, frames


def report(path):
    """The report of a run: a dict; what a run does not have is None."""
    with open(path, encoding='utf-8') as file:
        return json.load(file)


def _numbers(column):
    """A column as whole numbers, else as floats with NaN for what is empty, else as texts."""
    try:
        return numpy.array([int(each) for each in column], dtype=numpy.int64)
    except (ValueError, OverflowError):
        pass
    try:
        return numpy.array([float(each) if each else numpy.nan for each in column])
    except ValueError:
        return numpy.array(column)


def table(path):
    """A file of comma-separated values with a line of names: {name: column}."""
    with open(path, newline='', encoding='utf-8') as file:
        reader = csv.reader(file)
        head = next(reader, None)
        rows = list(reader)
    if not head or any(len(row) != len(head) for row in rows):
        raise ValueError(f'{path}: not a table: its lines have not as many columns as the first')
    return {name: _numbers([row[i] for row in rows]) for i, name in enumerate(head)}


def trace(path, partial=False, program='duite-trace'):
    """The tables 'worker_state', 'events' and 'link' of a traced run, of all ranks: {table: {name: column}}.

    Times are milliseconds. docs/tracing.md says what there is. partial: what there is of a run that did not come to its end.
    program: the duite-trace that reads.
    """
    with tempfile.TemporaryDirectory() as folder:
        command = [program, '--csv', folder] + ['--partial'] * partial + [os.fspath(path)]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode:
            raise ValueError(run.stderr.strip() or f'{program} ended with {run.returncode}')
        return {name: table(f'{folder}/paje.{name}.csv') for name in ('worker_state', 'events', 'link')}


def frames(path):
    """A PC2 cache, of positions or forces: float32 [frame, vertex, 3], mapped into memory and read where it is used."""
    with open(path, 'rb') as file:
        head = file.read(_PC2_HEADER)
    if len(head) < _PC2_HEADER or head[:12] != b'POINTCACHE2\0':
        raise ValueError(f'{path}: not a PC2 cache')
    version, points = (int(each) for each in numpy.frombuffer(head, '<i4', 2, 12))
    count = int(numpy.frombuffer(head, '<i4', 1, 28)[0])
    if version != 1 or points < 1 or count < 0:
        raise ValueError(f'{path}: version {version}, {points} points, {count} frames make no sense')
    if os.path.getsize(path) < _PC2_HEADER + 12 * points * count:
        raise ValueError(f'{path}: the file ends early')
    if not count:
        return numpy.empty((0, points, 3), '<f4')
    return numpy.memmap(path, '<f4', 'r', _PC2_HEADER, (count, points, 3))


def fields(path):
    """A scientific frame, by h5py: {'Points', 'Connectivity', 'Offsets' and each field of vertices or cells}."""
    import h5py  # pylint: disable=import-outside-toplevel # only here

    with h5py.File(path, 'r') as file:
        if 'VTKHDF' not in file:
            raise ValueError(f'{path}: not a frame of duite-cloth')
        top = file['VTKHDF']
        found = {name: top[name][()] for name in ('Points', 'Connectivity', 'Offsets')}
        for group in ('PointData', 'CellData'):
            found.update({name: data[()] for name, data in top.get(group, {}).items()})
    return found
